"""Archives of arrays: arrays come back as written, and sizes in a header are not trusted."""

from __future__ import annotations

import io
import struct
import zipfile
from typing import Any

import numpy as np
import pytest
from fixtures.thoroughness import examples
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays_of

from roomba.files.arrays import read_arrays
from roomba.files.atomic import UNREADABLE

KINDS = st.sampled_from(["<f4", "<f8", "|u1", "<i8", "|b1", "<U7"])
HEADERS = (
    "{'descr': '<f8', 'fortran_order': False, 'shape': (4, 99999999999999)}",
    "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999,)}",
    "{'descr': '|V0', 'fortran_order': False, 'shape': (999999999999,)}",
    "{'descr': '<U0', 'fortran_order': False, 'shape': (999999999999,)}",
    "{'descr': '|O', 'fortran_order': False, 'shape': (1,)}",
    "{'descr': '<f8', 'fortran_order': False, 'shape': (-1, -4)}",
    "{'descr': '<f8', 'fortran_order': False, 'shape': (4, 4)}",
    "{'descr': '<f8', 'fortran_order': False, 'shape': 3}",
    "{'descr': 'x', 'fortran_order': False, 'shape': (4,)}",
    "{'descr': '<f8', 'fortran_order': False}",
    "(" * 4000,
    "-" * 4000 + "1",
    "",
)


def archive_of(entries: dict[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", method) as archive:
        for name, content in entries.items():
            archive.writestr(name, content)
    return file.getvalue()


def array_file(header: str, data: bytes, version: int = 1) -> bytes:
    line = header.encode() + b"\n"
    length = struct.pack("<H" if version == 1 else "<I", len(line))
    return b"\x93NUMPY" + bytes([version, 0]) + length + line + data


@settings(deadline=None, suppress_health_check=list(HealthCheck))
@given(
    found=st.dictionaries(
        st.from_regex(r"[a-z]{1,8}", fullmatch=True),
        KINDS.flatmap(lambda kind: arrays_of.arrays(kind, arrays_of.array_shapes(min_dims=0))),
        max_size=3,
    ),
    is_packed=st.booleans(),
    is_by_columns=st.booleans(),
)
def test_any_arrays_come_back(found: dict[str, Any], is_packed: bool, is_by_columns: bool) -> None:
    file = io.BytesIO()
    if is_by_columns:
        found = {name: np.asfortranarray(array) for name, array in found.items()}
    (np.savez_compressed if is_packed else np.savez)(file, **found)
    read = read_arrays(file.getvalue())
    assert read.keys() == found.keys()
    for name, array in found.items():
        assert read[name].dtype == array.dtype
        assert read[name].shape == array.shape
        assert read[name].tobytes("A") == array.tobytes("A")
        assert read[name].flags.writeable


@pytest.mark.parametrize("header", HEADERS, ids=range(len(HEADERS)))
@pytest.mark.parametrize("version", [1, 2, 3])
def test_a_header_that_claims_anything_else_is_refused(header: str, version: int) -> None:
    content = archive_of({"learned.npy": array_file(header, bytes(64), version)})
    with pytest.raises(UNREADABLE):
        read_arrays(content)


def test_an_archive_that_unpacks_to_more_than_it_may_is_refused_before_that() -> None:
    header = "{'descr': '|u1', 'fortran_order': False, 'shape': (5000000,)}"
    content = archive_of({"a.npy": array_file(header, bytes(5_000_000))})
    assert len(content) < 10_000
    assert read_arrays(content, 6_000_000)["a"].shape == (5_000_000,)
    with pytest.raises(ValueError, match="expected at most 1000 arrays of 4000000 bytes together"):
        read_arrays(content, 4_000_000)
    many = archive_of({f"{number}.npy": b"" for number in range(1001)})
    with pytest.raises(ValueError, match=r"got 1001 of 0"):
        read_arrays(many)


@pytest.mark.parametrize("method", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_another_compression_is_refused(method: int) -> None:
    content = archive_of({"a.npy": bytes(1000)}, method)
    with pytest.raises(ValueError, match="another compression"):
        read_arrays(content)


def test_an_encrypted_archive_is_refused() -> None:
    content = bytearray(archive_of({"a.npy": bytes(10)}))
    for signature, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        content[content.index(signature) + offset] |= 1
    with pytest.raises(ValueError, match="encrypted"):
        read_arrays(bytes(content))


@settings(max_examples=examples(300), deadline=None, derandomize=True)
@given(content=st.binary(max_size=300), begin=st.sampled_from([b"", b"PK\x03\x04", b"\x93NUMPY"]))
def test_any_bytes_are_refused(content: bytes, begin: bytes) -> None:
    with pytest.raises(UNREADABLE):
        read_arrays(begin + content)

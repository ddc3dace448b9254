"""Archives of numpy arrays, read within bounds: what a header claims is not believed.

numpy itself allocates an array before it checks that the file holds so much, and unpacks all that
an archive holds.
"""

from __future__ import annotations

import io
import math
import zipfile
from tokenize import TokenError
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

MOST_UNPACKED: Final = 256_000_000
"""Bytes of all arrays of an archive."""
_MOST_ARRAYS: Final = 1000
_METHODS: Final = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_FORMAT: Final[Any] = np.lib.format
_READERS: Final = {
    (1, 0): _FORMAT.read_array_header_1_0,
    (2, 0): _FORMAT.read_array_header_2_0,
}


def read_arrays(content: bytes, most: int = MOST_UNPACKED) -> dict[str, NDArray[Any]]:
    """Return the arrays of an archive, as ``numpy.savez`` writes it, by name.

    Raises one of :data:`roomba.files.atomic.UNREADABLE` for what is none, and ValueError for one
    that holds more than ``most`` bytes.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            entries = archive.infolist()
            size = sum(entry.file_size for entry in entries)
            if size > most or len(entries) > _MOST_ARRAYS:
                raise ValueError(
                    f"expected at most {_MOST_ARRAYS} arrays of {most} bytes together, got "
                    f"{len(entries)} of {size}"
                )
            if any(entry.compress_type not in _METHODS for entry in entries):
                raise ValueError("expected arrays as numpy packs them, got another compression")
            return {
                entry.filename.removesuffix(".npy"): array_of(archive.read(entry))
                for entry in entries
            }
    except RuntimeError as error:
        # It is encrypted.
        raise ValueError(f"expected an archive of arrays, got another one ({error})") from error


def array_of(content: bytes) -> NDArray[Any]:
    """Return the array of a file of numpy; raises ValueError, or TypeError for an odd header."""
    file = io.BytesIO(content)
    read_header = _READERS.get(_FORMAT.read_magic(file))
    if read_header is None:
        raise ValueError("expected an array of numpy's format 1 or 2, got another one")
    try:
        shape, is_by_columns, kind = read_header(file)
    except (RecursionError, MemoryError, SyntaxError, TokenError) as error:
        raise ValueError(f"expected numpy's header, got another one ({error!r:.200})") from error
    if kind.hasobject or kind.itemsize == 0 or min(shape, default=0) < 0:
        raise ValueError(f"expected an array of numbers, got {kind} of shape {shape}")
    at = file.tell()
    if math.prod(shape) * kind.itemsize != len(content) - at:
        raise ValueError(f"expected what is told, {shape} of {kind}, got {len(content) - at} bytes")
    array: NDArray[Any] = np.ndarray(shape, kind, content, at, order="F" if is_by_columns else "C")
    return array.copy(order="K")

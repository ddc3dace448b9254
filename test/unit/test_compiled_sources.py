"""Compiled code is kept by its sources: when a part changes, it is compiled anew, once."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from roomba.compiled_sources import PACKAGE, Sources, files_with_compiled_functions

Answer = tuple[float, int, int]
"""What a compiled function returned, and how often it was loaded and compiled."""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """Some modules of a package of this name: a needs b and c.d, b and c.d need e."""
    folder = tmp_path / "roomba"
    (folder / "c").mkdir(parents=True)
    for name, text in {
        "__init__": "",
        "a": "import os\nfrom roomba.b import (\n    one,\n    other,\n)\nfrom roomba.c import d\n",
        "b": "def one():\n    import roomba.e\n",
        "c/__init__": "",
        "c/d": "from roomba.e import number\n",
        "e": "number = 1\n",
        "f": "from roomba.a import one\n",
    }.items():
        (folder / f"{name}.py").write_text(text)
    return folder


@pytest.mark.parametrize("changed", ["a", "b", "c/__init__", "c/d", "e"])
def test_the_key_is_that_of_a_file_and_of_all_that_it_imports(package: Path, changed: str) -> None:
    file, before = package / f"{changed}.py", Sources(package).key(package / "a.py")
    text = file.read_text()
    file.write_text(f"{text}# another\n")
    assert Sources(package).key(package / "a.py") != before
    file.write_text(text)
    os.utime(file, (1.0, 1.0))
    assert Sources(package).key(package / "a.py") == before


def test_what_a_file_does_not_import_does_not_count(package: Path) -> None:
    before = Sources(package).key(package / "a.py")
    (package / "f.py").write_text("# another\n")
    (package / "c/g.py").write_text("")
    assert Sources(package).key(package / "a.py") == before


def test_where_code_is_kept_has_no_part_in_it(package: Path) -> None:
    before = Sources(package).key(package / "a.py")
    with (package / "a.py").open("a") as file:
        file.write("import roomba.compiled_sources\n")
    with_import = Sources(package).key(package / "a.py")
    (package / "compiled_sources.py").write_text("")
    assert before != with_import == Sources(package).key(package / "a.py")


def test_files_that_import_each_other_have_keys(package: Path) -> None:
    (package / "e.py").write_text("from roomba.b import one\n")
    before = Sources(package)
    keys = before.key(package / "e.py"), before.key(package / "b.py")
    (package / "b.py").write_text("import roomba.e\n# another\n")
    after = Sources(package)
    assert after.key(package / "e.py") != keys[0]
    assert after.key(package / "b.py") != keys[1]


def test_the_key_of_files_is_of_all_of_them_in_any_order(package: Path) -> None:
    files = package / "c/__init__.py", package / "e.py"
    before = Sources(package).key(*files)
    assert before == Sources(package).key(*reversed(files))
    assert before not in {Sources(package).key(each) for each in files}
    (package / "e.py").write_text("number = 2\n")
    assert Sources(package).key(*files) != before


def test_files_that_compile_functions_import_what_does_it(package: Path) -> None:
    (package / "b.py").write_text('"""A word of compilation import."""\n')
    (package / "c/d.py").write_text("from roomba.compilation import part\n")
    (package / "e.py").write_text("import os\nfrom roomba.x.compilation import (\n  part\n)\n")
    assert files_with_compiled_functions(package) == [package / "c/d.py", package / "e.py"]


def test_a_file_is_read_again_only_when_it_changed(package: Path, tmp_path: Path) -> None:
    known, file = tmp_path / "known" / "sources.json", package / "a.py"
    first = Sources(package, known)
    before = first.key(file)
    first.remember()
    assert Sources(package, known).key(file) == before
    remembered = json.loads(known.read_text())
    remembered["e.py"]["content"] = "not read again"
    known.write_text(json.dumps(remembered))
    assert Sources(package, known).key(file) != before
    os.utime(package / "e.py")
    assert Sources(package, known).key(file) == before


@pytest.mark.parametrize("text", ["", "{", "[]", '{"e.py": 1}', '{"e.py": {"changed": "x"}}'])
def test_what_is_known_may_be_damaged(package: Path, tmp_path: Path, text: str) -> None:
    known = tmp_path / "sources.json"
    known.write_text(text)
    sources = Sources(package, known)
    assert sources.key(package / "a.py") == Sources(package).key(package / "a.py")
    sources.remember()
    assert len(json.loads(known.read_text())) == 5


def test_a_file_of_another_folder_counts_with_what_it_imports(package: Path) -> None:
    other = package.parent / "other.py"
    other.write_text("from roomba.b import one\n")
    before = Sources(package).key(other)
    assert before == Sources(package).key(other)
    (package / "c/d.py").write_text("# not imported\n")
    assert Sources(package).key(other) == before
    (package / "e.py").write_text("number = 22\n")
    assert Sources(package).key(other) != before


@pytest.mark.parametrize("module", ["roomba.outer", "outer"])
def test_a_part_that_changed_is_compiled_anew_and_one_that_changed_back_is_not(
    tmp_path: Path, module: str
) -> None:
    package = tmp_path / "roomba"
    package.mkdir()
    for name in ("__init__.py", "compilation.py", "compiled_sources.py"):
        shutil.copy(PACKAGE / name, package)
    (tmp_path / f"{module.replace('.', '/')}.py").write_text(
        "from roomba.compilation import entry\nfrom roomba.inner import added\n\n\n"
        "@entry\ndef more(value):\n    return added(value)\n"
    )
    inner = package / "inner.py"
    text = "from roomba.compilation import part\n\n\n@part\ndef added(value):\n"
    text += "    return value + 1.0\n"
    inner.write_text(text)
    assert answer_of(module, tmp_path) == (3.0, 0, 1)
    assert answer_of(module, tmp_path) == (3.0, 1, 0)
    # Of another length: Python takes a file of the same second and length for the same.
    inner.write_text(text.replace("1.0", "2.00"))
    assert answer_of(module, tmp_path) == (4.0, 0, 1)
    inner.write_text(text)
    assert answer_of(module, tmp_path) == (3.0, 1, 0)


def answer_of(module: str, folder: Path) -> Answer:
    """What a new process makes of ``more`` of a module that imports from a folder's package."""
    program = (
        f"from {module} import more; import json; value = more(2.0); stats = more.stats; "
        "print(json.dumps([value, sum(stats.cache_hits.values()), "
        "sum(stats.cache_misses.values())]))"
    )
    environment = {**os.environ, "PYTHONPATH": str(folder), "NUMBA_CACHE_DIR": str(folder / "kept")}
    done = subprocess.run(
        [sys.executable, "-c", program],
        env=environment,
        capture_output=True,
        text=True,
        check=True,
        timeout=120.0,
    )
    value, loaded, made = json.loads(done.stdout)
    return value, loaded, made

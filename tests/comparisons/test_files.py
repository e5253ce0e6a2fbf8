"""Files are whole or not there."""

import os
from pathlib import Path

import pytest

from comparisons.files import OutputError, replacing, writable_file, writable_folder, write_text


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    write_text(path, "old")

    def fail() -> None:
        with replacing(path) as temporary:
            temporary.write_text("half")
            assert temporary.suffix == path.suffix
            raise RuntimeError("power cut")

    with pytest.raises(RuntimeError, match="power cut"):
        fail()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]
    write_text(path, "new")
    assert path.read_text() == "new"


def test_places_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for folder in ("file", "file/below", "nul\0l"):
        with pytest.raises(OutputError, match="cannot be written"):
            writable_folder(tmp_path / folder)
    os.mkfifo(tmp_path / "pipe")
    for file in (tmp_path, tmp_path / "pipe", tmp_path / "none" / "a.json"):
        with pytest.raises(OutputError, match="cannot be written"):
            writable_file(file)
    assert writable_file(tmp_path / "a.json").parent == writable_folder(tmp_path / "new").parent
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", "new", "pipe"]


def test_a_link_is_followed_not_replaced(tmp_path: Path) -> None:
    target, link = tmp_path / "target.json", tmp_path / "link.json"
    target.write_text("old")
    link.symlink_to(target)
    write_text(writable_file(link), "new")
    assert link.is_symlink()
    assert target.read_text() == "new"

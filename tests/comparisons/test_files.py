"""Files are whole or not there."""

import errno
import os
from pathlib import Path
from threading import Thread

import pytest

from comparisons.files import OutputError, alone_in, replacing, writable_file, writable_folder, write_text


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


def test_no_room_names_the_file(tmp_path: Path) -> None:
    def fill() -> None:
        with replacing(tmp_path / "a.txt"):
            raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(OutputError, match=r"a\.txt: cannot be written: No space left on device"):
        fill()
    assert not list(tmp_path.iterdir())


def test_sets_of_files_are_written_one_after_the_other(tmp_path: Path) -> None:
    order: list[str] = []

    def write() -> None:
        with alone_in(tmp_path):
            order.append("second")

    other = Thread(target=write)
    with alone_in(tmp_path):
        other.start()
        other.join(0.2)
        order.append("first")
    other.join(10)
    assert order == ["first", "second"]

"""Files that are either whole or not there."""

import fcntl
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


class OutputError(ValueError):
    """A place where nothing can be written: one line."""


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a temporary name in the folder of `path`; rename it to `path` once the block has written it.

    The temporary name keeps the suffix, and it is removed if the block fails.

    Raises
    ------
    OutputError
        If there is no room for the file, or it cannot be written for another reason of the system's.
    """
    temporary = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    try:
        yield temporary
        temporary.replace(path)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror or error}") from error
    finally:
        temporary.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write `text` to `path` atomically."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Keep other runs that write a set of files into `folder` waiting, so that sets do not mix."""
    place = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):  # a file system without locks
            fcntl.flock(place, fcntl.LOCK_EX)
        yield
    finally:
        os.close(place)


def writable_folder(folder: Path) -> Path:
    """Return `folder`, made if it is not there, after a trial of writing in it.

    Raises
    ------
    OutputError
        If it cannot be made or written in.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise OutputError(f"{folder}: cannot be written: {reason}") from None


def writable_file(path: Path) -> Path:
    """Return `path`, links followed, after a trial of writing in its folder, which must be there.

    Raises
    ------
    OutputError
        If the folder is not there or not writable, or `path` is a folder or a device, which a rename would replace.
    """
    if path.exists() and not path.is_file():
        raise OutputError(f"{path}: cannot be written: is not a regular file")
    try:
        target = path.resolve()
    except (OSError, RuntimeError) as error:
        raise OutputError(f"{path}: cannot be written: {error}") from None
    if not target.parent.is_dir():
        raise OutputError(f"{path}: cannot be written: there is no folder {path.parent}")
    writable_folder(target.parent)
    return target

"""Files that are either whole or not there."""

import os
import signal
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

try:
    from fcntl import LOCK_EX, flock
except ImportError:  # Windows
    LOCKS_FOLDERS = False
else:
    LOCKS_FOLDERS = True


class OutputError(ValueError):
    """A place where nothing can be written: one line."""


def printable(text: object) -> str:
    r"""Return `text` with what a terminal would obey, or cannot show, as escapes.

    >>> printable("red \x1b[31m")
    'red \\x1b[31m'
    """
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in str(text))


def read_regular(path: str, most: int) -> bytes:
    """Return the bytes of a regular file; a pipe is not waited for, and nothing is read without end.

    Raises
    ------
    OSError, ValueError
        If it cannot be read, is no regular file, or has more than `most` bytes.
    """
    # a system without pipes in its file system has nothing to wait for
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    with os.fdopen(os.open(path, flags), "rb") as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise ValueError("is not a regular file")
        data = file.read(most + 1)
    if len(data) > most:
        raise ValueError(f"has more than {most / 1e6:g} MB")
    return data


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
    """Keep other runs that write a set of files into `folder` waiting, so that sets do not mix.

    The lock is on the folder itself, so it adds no file, and it ends with its process. Systems without `fcntl` lock files only: there
    the lock is on a file in the folder, which is removed with it.
    """
    if not LOCKS_FOLDERS:
        from filelock import FileLock

        with FileLock(folder / ".crossval.lock"):
            yield
        return
    place = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):  # a file system without locks
            flock(place, LOCK_EX)
        yield
    finally:
        os.close(place)


@contextmanager
def staging(folder: Path) -> Iterator[Path]:
    """Yield a new hidden folder in `folder`, from which finished files are moved; it is removed with what is left in it.

    Raises
    ------
    OutputError
        If there is no room, or it cannot be written for another reason of the system's.
    """
    try:
        with tempfile.TemporaryDirectory(dir=folder, prefix=".crossval-") as aside:
            yield Path(aside)
    except OutputError as error:
        # files are named by where they were to be in the end
        raise OutputError(str(error).replace(f"{aside}{os.sep}", f"{folder}{os.sep}")) from error
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written: {error.strerror or error}") from error


@contextmanager
def interrupts_held() -> Iterator[None]:
    """Hold back Ctrl-C; processes started meanwhile never see it, and leave its handling to this one."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


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

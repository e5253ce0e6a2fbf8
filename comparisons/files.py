"""Files of this program: each is written completely or not at all, and replaces only one that this program wrote.

The hidden list `WRITTEN` of a folder has the digests of the files that this program wrote there.
"""

import errno
import os
import signal
import stat
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from pathlib import Path
from shutil import get_terminal_size
from textwrap import wrap
from typing import Any

WRITTEN = ".crossval"
"""Name of the list of a folder: a line for each file, with its digest (SHA-256) and its name."""
LONGEST = 500
"""Most characters of a line whose words are those of a program of others."""


class OutputError(ValueError):
    """A file or folder cannot be written; the message is one line."""


def printable(text: object) -> str:
    r"""Return `text` with escapes for the characters that control a terminal or that it cannot show.

    >>> printable("red \x1b[31m")
    'red \\x1b[31m'
    """
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in str(text))


def filled(text: str, first: str = "", rest: str = "", width: int | None = None) -> list[str]:
    """Return lines that fit the terminal or a width, the first one and the others indented; no word is broken."""
    whole: dict[str, Any] = {"break_long_words": False, "break_on_hyphens": False}
    width = width or get_terminal_size().columns
    return wrap(text, width, initial_indent=first, subsequent_indent=rest, **whole)


def one_line(text: object) -> str:
    r"""Return the words of a program or file that may be anything: `printable`, in one line of at most `LONGEST` characters.

    >>> one_line("red\n \x1b[31m")
    'red \\x1b[31m'
    """
    line = printable(" ".join(str(text)[:LONGEST].split()))
    return line if len(line) < LONGEST else f"{line[: LONGEST - 3]}..."


def read_regular(path: str, most: int) -> bytes:
    """Return at most `most` bytes of a regular file; raise OSError or ValueError. A pipe is refused at once."""
    # O_NONBLOCK is missing on systems without named pipes, where opening a file never waits
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    with os.fdopen(os.open(path, flags), "rb") as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise ValueError("is not a regular file")
        data = file.read(most + 1)
    if len(data) > most:
        raise ValueError(f"has more than {most / 1e6:g} MB")
    return data


def _entry(path: Path, name: str) -> str:
    """Return the line of a list for the file `path`, whose name is or becomes `name`."""
    import hashlib  # 2 ms that only a command which writes needs

    with path.open("rb") as file:
        return f"{hashlib.file_digest(file, 'sha256').hexdigest()}  {printable(name)}"


def _listed(folder: Path) -> set[str]:
    """Return the lines of the list of a folder; none where there is no list."""
    with suppress(OSError, ValueError):
        return set((folder / WRITTEN).read_text(encoding="utf-8").splitlines())
    return set()


def own(folder: Path, names: Iterable[str]) -> set[str]:
    """Return those of `names` that are files in `folder` as this program wrote them."""
    listed = _listed(folder)
    paths = {name: folder / name for name in names} if listed else {}
    return {
        name
        for name, path in paths.items()
        if path.is_file() and not path.is_symlink() and _entry(path, name) in listed
    }


def check_free(folder: Path, *names: str) -> None:
    """Raise OutputError unless each of `names` is free in `folder`, or a file as this program wrote it."""
    owned = own(folder, names)
    for path in (folder / name for name in names if name not in owned):
        if os.path.lexists(path):
            raise OutputError(
                f"{path}: is there already, and is not as crossval wrote it: move it, or choose another name"
            )


def move(aside: Path, folder: Path, names: Iterable[str]) -> None:
    """Move finished files from the folder `aside` to `folder`, in the order of `names`; they are listed before."""
    names = list(names)
    if new := {_entry(aside / name, name) for name in names} - _listed(folder):
        with (folder / WRITTEN).open("a", encoding="utf-8") as file:
            file.writelines(f"{line}\n" for line in sorted(new))
    for name in names:
        (aside / name).replace(folder / name)


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Hold the lock of `folder`: other runs that write a set of files there wait, so that two sets never mix.

    The lock is on the folder itself, so it adds no file, and it ends with its process. Windows can lock files only.
    There the lock is a file in the folder, which is removed when the lock ends.
    """
    file = None
    try:
        from fcntl import LOCK_EX, flock

        place = os.open(folder, os.O_RDONLY)
    except ImportError:
        file = folder / ".crossval.lock"
        place = os.open(file, os.O_RDWR | os.O_CREAT)
    try:
        with suppress(OSError):  # a file system without locks
            if file is None:
                flock(place, LOCK_EX)
            while file is not None and not _locked(place):
                pass
        yield
    finally:
        os.close(place)
        if file is not None:
            with suppress(OSError):  # another run waits for it
                file.unlink()


def _locked(place: int) -> bool:
    """Whether a file of Windows could be locked within ten seconds."""
    windows = import_module("msvcrt")
    try:
        windows.locking(place, windows.LK_LOCK, 1)
    except OSError as error:
        if error.errno != errno.EDEADLOCK:
            raise
        return False
    return True


@contextmanager
def interrupts_held() -> Iterator[None]:
    """Hold back Ctrl-C. Processes started inside the block ignore it for good, so that this process alone handles it."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Raise OutputError, which names `path`, if the disk is full or the system refuses to write it."""
    try:
        yield
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror or error}") from error


@contextmanager
def staging(folder: Path, named: Path | None = None) -> Iterator[Path]:
    """Yield a new hidden folder in `folder`, for files that are moved out when they are finished; it is removed at the end.

    Raises OutputError, which names `named` or the folder, if the disk is full or the system refuses to write.
    """
    import tempfile  # 4 ms that only a command which writes needs

    with writing(named or folder):
        # an interrupt within its making or its removal would leave it; at any other point its finalizer removes it
        with interrupts_held():
            aside = tempfile.TemporaryDirectory(dir=folder, prefix=".crossval-")
        try:
            yield Path(aside.name)
        except OutputError as error:
            # the message names the final path of a file, not its temporary one
            raise OutputError(str(error).replace(f"{aside.name}{os.sep}", f"{folder}{os.sep}")) from error
        finally:
            with interrupts_held():
                aside.cleanup()


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a temporary place for a file, which moves to `path`, if that is free, once the block has written it."""
    check_free(path.parent, path.name)
    with staging(path.parent, path) as aside:
        yield aside / path.name
        move(aside, path.parent, [path.name])


def write_text(path: Path, text: str) -> None:
    """Write `text` to `path` atomically."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def writable_folder(folder: Path, *names: str) -> Path:
    """Return `folder`, made if it is not there, after a trial of writing in it; `names` must be free in it."""
    import tempfile

    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except (OSError, ValueError) as error:
        raise OutputError(
            f"{folder}: cannot be written: {getattr(error, 'strerror', None) or error}"
        ) from None
    check_free(folder, *names)
    return folder


def result_file(path: Path) -> Path:
    """Return `path` with links followed, after a trial of writing in its folder, which must exist."""
    if path.exists() and not path.is_file():
        raise OutputError(f"{path}: cannot be written: is not a regular file")
    try:
        target = path.resolve()
    except (OSError, RuntimeError) as error:
        raise OutputError(f"{path}: cannot be written: {error}") from None
    if not target.parent.is_dir():
        raise OutputError(f"{path}: cannot be written: there is no folder {path.parent}")
    writable_folder(target.parent, target.name)
    return target

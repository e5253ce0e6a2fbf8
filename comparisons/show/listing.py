"""Lists of files with their digests: what this program wrote into a folder, and may therefore replace there."""

import hashlib
import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from comparisons.files import OutputError

MARK = "<!-- crossval wrote these files and replaces what is unchanged (SHA-256)"
"""First line of the comment that ends a list."""
_ENTRY = re.compile(r"^([0-9a-f]{64})  (\S+)$", re.MULTILINE)


def digest(path: Path) -> str:
    """Return the SHA-256 of a file in hexadecimal digits."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def with_digests(text: str, digests: Mapping[str, str]) -> str:
    """Return the XML `text` of an unfinished list, followed by a comment with the digest of `text` and the `digests` of files by name."""
    own = hashlib.sha256(text.encode()).hexdigest()
    entries = "".join(f"{value}  {name}\n" for name, value in {"itself": own, **digests}.items())
    return f"{text}{MARK}\n{entries}-->\n"


def listed(path: Path) -> dict[str, str] | None:
    """Return the digests that the list `path` gives, by file name: empty where there is no such file, None if this program did not write it."""
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return {}
    except (OSError, ValueError):
        return None
    head, mark, comment = text.partition(MARK)
    found = {name: value for value, name in _ENTRY.findall(comment)}
    unchanged_head = mark and found.pop("itself", "") == hashlib.sha256(head.encode()).hexdigest()
    return found if unchanged_head else None


def check_free(folder: Path, names: Iterable[str], lists: Iterable[Path]) -> None:
    """Raise unless every one of `names` in `folder` is free, or a file as one of `lists` gives it; a list is absent or written by this program.

    Raises
    ------
    OutputError
        Names the first file that this program did not write there, or that was changed since.
    """
    known: dict[str, set[str]] = {}
    for path in lists:
        digests = listed(path)
        if digests is None:
            raise _foreign(path)
        for name, value in digests.items():
            known.setdefault(name, set()).add(value)
    for name in names:
        path = folder / name
        if path.is_symlink() or (path.exists() and not _is_as(path, known.get(name, set()))):
            raise _foreign(path)


def unchanged(folder: Path, digests: Mapping[str, str]) -> list[Path]:
    """Return the files in `folder` that are as `digests` give them."""
    paths = {folder / name: value for name, value in digests.items() if Path(name).name == name}
    return [path for path, value in paths.items() if not path.is_symlink() and _is_as(path, {value})]


def _is_as(path: Path, digests: set[str]) -> bool:
    return path.is_file() and digest(path) in digests


def _foreign(path: Path) -> OutputError:
    return OutputError(
        f"{path}: is there already, and is not as crossval wrote it: move it, or choose another folder"
    )

"""Check of a Gmsh text before it is parsed: every count must agree with the lines that follow.

A parser that trusts a wrong count may allocate any amount of memory.
"""

from collections.abc import Iterator
from math import isfinite
from pathlib import Path
from stat import S_ISREG

LARGEST = 16 * 2**20
"""Largest mesh file that is read [bytes]."""


class MeshError(ValueError):
    """A mesh file breaks a rule; the message is one line."""


def check_file(path: Path) -> None:
    """Require a regular file of at most `LARGEST` bytes, and check a Gmsh file line by line.

    Raises MeshError if the file cannot be read, is too large, or a line breaks the format.
    """
    try:
        info = path.stat()
    except (OSError, ValueError) as error:
        raise MeshError(f"cannot be read ({getattr(error, 'strerror', None) or error})") from None
    if not S_ISREG(info.st_mode):
        raise MeshError("must be a regular file")
    if info.st_size > LARGEST:
        raise MeshError(f"must not be larger than 16 MB, it has {info.st_size / 2**20:.4g}")
    if path.suffix == ".msh":
        _check_gmsh(path.read_bytes())


def _check_gmsh(content: bytes) -> None:
    lines = content.decode("latin-1").split("\n")
    first = next((number for number, line in enumerate(lines) if line.strip() == "$MeshFormat"), None)
    if first is None or first + 1 >= len(lines):
        raise MeshError("line 1: must begin with $MeshFormat")
    version, binary = [*lines[first + 1].split(), "", ""][:2]
    if binary != "0" or version[:1] not in ("2", "4"):
        raise MeshError(
            f"line {first + 2}: must be Gmsh's text format 2 or 4, it is {lines[first + 1].strip()!r}"
        )
    rows, missing = iter(enumerate(lines[first + 2 :], first + 3)), ["$Nodes", "$Elements"]
    for number, line in rows:
        section = line.strip()
        missing = [name for name in missing if name != section]
        if section in ("$Nodes", "$Elements"):
            read = _section_4 if version[0] == "4" else _section_2
            read(rows, len(lines), section)
            _expect_end(rows, section)
        elif section == "$PhysicalNames":
            for _ in range(_count(rows, len(lines), 1)[0]):
                row, name = _row(rows)
                if len(name.split(None, 2)) != 3 or not name.rstrip().endswith('"'):
                    raise MeshError(f'line {row}: must be a dimension, a number and a "name"')
            _expect_end(rows, section)
        elif section.startswith("$") and not section.startswith("$End") and section != "$Comments":
            _skip(rows, number, section)
    if missing:
        raise MeshError(f"ends before {missing[0]}")


def _section_2(rows: Iterator[tuple[int, str]], lines: int, section: str) -> None:
    for _ in range(_count(rows, lines, 1)[0]):
        _numbers(rows, 4, whole=1) if section == "$Nodes" else _numbers(rows, None, whole=None)


def _section_4(rows: Iterator[tuple[int, str]], lines: int, section: str) -> None:
    blocks = _count(rows, lines, 4, counts=(0, 1))[0]
    for _ in range(blocks):
        inside = _count(rows, lines, 4, counts=(3,))[3]
        if section == "$Nodes":
            for _ in range(inside):
                _numbers(rows, 1, whole=1)
            for _ in range(inside):
                _numbers(rows, 3, whole=0)
        else:
            for _ in range(inside):
                _numbers(rows, None, whole=None)


def _row(rows: Iterator[tuple[int, str]]) -> tuple[int, str]:
    row = next(rows, None)
    if row is None:
        raise MeshError("ends before the last line that it announces")
    return row


def _count(
    rows: Iterator[tuple[int, str]], lines: int, size: int, counts: tuple[int, ...] = (0,)
) -> list[int]:
    """Read ``size`` whole numbers; the entries ``counts`` must not exceed the number of lines that follow."""
    number, line = _row(rows)
    try:
        entries = [int(word) for word in line.split()]
    except ValueError:
        entries = []
    if len(entries) != size:
        raise MeshError(
            f"line {number}: must be {size} whole number{'s' * (size > 1)}, it is {line.strip()[:40]!r}"
        )
    for k in counts:
        if not 0 <= entries[k] <= lines - number:
            raise MeshError(
                f"line {number}: announces {entries[k]} entries, but {lines - number} lines follow"
            )
    return entries


def _numbers(rows: Iterator[tuple[int, str]], size: int | None, *, whole: int | None) -> None:
    """Require ``size`` finite numbers (None: any count), the first ``whole`` being integers (None: all)."""
    number, line = _row(rows)
    words = line.split()
    split = len(words) if whole is None else whole
    try:
        values = [*(int(word) for word in words[:split]), *(float(word) for word in words[split:])]
    except ValueError:
        values = []
    right = len(values) == size if size is not None else len(values) > 1
    if not (right and all(map(isfinite, values))):
        kind = "whole numbers" if size is None else f"{size} finite number{'s' * (size > 1)}"
        raise MeshError(f"line {number}: must be {kind}, it is {line.strip()[:40]!r}")


def _expect_end(rows: Iterator[tuple[int, str]], section: str) -> None:
    number, line = _row(rows)
    if line.strip() != f"$End{section[1:]}":
        raise MeshError(f"line {number}: must be $End{section[1:]}, it is {line.strip()[:40]!r}")


def _skip(rows: Iterator[tuple[int, str]], number: int, section: str) -> None:
    for _, line in rows:
        if line.strip() == f"$End{section[1:]}":
            return
    raise MeshError(f"line {number}: {section} does not end")

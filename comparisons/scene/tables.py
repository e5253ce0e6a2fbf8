"""Reader of TOML input files: it checks the keys and raises errors of one line."""

import difflib
import re
import tomllib
from collections.abc import Iterable
from typing import Any

from comparisons.files import read_regular
from comparisons.scene.rules import MISSING, FieldError

LARGEST_FILE = 16_000_000
"""Largest size of an input file [byte]."""
DEEPEST = 50
"""Largest number of parts of a dotted key; the time to parse a key rises with the square of this number."""
_DEEP = re.compile(rf"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){{{DEEPEST}}}""")


class InputError(ValueError):
    """An input file that cannot be read: exactly one line, ``FILE: KEY = VALUE: RULE``."""

    def __init__(self, source: str, reason: str) -> None:
        super().__init__(" ".join(f"{source}: {reason}".split()))


class SceneError(InputError):
    """A scene that cannot be read."""


def read_text(path: str, absent: str, kind: type[InputError]) -> str:
    """Return the text of the regular file `path`, of 16 MB at most.

    Raises
    ------
    InputError
        An error of the given kind, with the reason `absent` where the file does not exist.
    """
    try:
        return read_regular(path, LARGEST_FILE).decode("utf-8")
    except FileNotFoundError:
        raise kind(path, absent) from None
    except UnicodeDecodeError as error:
        raise kind(path, f"must be UTF-8 text, byte {error.start} is not") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise kind(path, f"cannot be read: {reason}") from None


def read_tables(text: str, source: str, kind: type[InputError]) -> dict[str, Any]:
    """Return the tables of the TOML `text`; `source` names it in errors of the given kind."""
    if _DEEP.search(text):
        raise kind(source, f"must be valid TOML: a key has more than {DEEPEST} parts")
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise kind(source, f"must be valid TOML: {error}") from None


def check_keys(table: dict[str, Any], known: Iterable[str], required: Iterable[str] = ()) -> None:
    """Raise `FieldError` for the first key of `table` that is not known, or that is required and not there."""
    names = sorted(known)
    for key, value in table.items():
        if key not in names:
            near = difflib.get_close_matches(key, names, n=1, cutoff=0.5)
            hint = f"did you mean {near[0]}?" if near else "known are " + ", ".join(names)
            raise FieldError(key if key.isprintable() else repr(key), value, f"unknown key, {hint}")
    for key in required:
        if key not in table:
            raise FieldError(key, MISSING, "must be given")

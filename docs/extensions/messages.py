"""The messages of the scene reader with their cures, from ``docs/reference/messages.toml``."""

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

REFERENCE = Path(__file__).parents[1] / "reference"
FILE = REFERENCE / "messages.toml"
_DATA: dict[str, Any] = tomllib.loads(FILE.read_text(encoding="utf-8"))
SCENES: dict[str, str] = _DATA["scenes"]
"""Good scenes, each wrong after a change."""


def changed(base: str, change: Sequence[str], append: str) -> str:
    """Return a scene of `SCENES` with words replaced, given as old, new, old, new, and with what is appended."""
    text = SCENES[base]
    for old, new in zip(change[::2], change[1::2], strict=True):
        if old and text.count(old) != 1:
            raise ValueError(f"{old!r} must stand once in scene {base}")
        text = text.replace(old, new)
    return text + append


@dataclass(frozen=True, kw_only=True)
class Message:
    """One sentence of the reader, ``{}`` for its values; a whole line as it is printed; the cure in Markdown; what provokes it."""

    sentence: str
    example: str
    cure: str
    base: str = "strip"
    change: tuple[str, str] = ("", "")
    append: str = ""
    encoding: str = "utf-8"
    arguments: Sequence[str] | None = None
    python: str | None = None

    @property
    def text(self) -> str:
        """The file that provokes the message."""
        return changed(self.base, self.change, self.append)


def groups() -> dict[str, tuple[Message, ...]]:
    """Return the messages by the titles of their groups."""
    return {one["title"]: tuple(Message(**entry) for entry in one["message"]) for one in _DATA["group"]}


def messages() -> tuple[Message, ...]:
    """Return all messages in order."""
    return tuple(message for group in groups().values() for message in group)

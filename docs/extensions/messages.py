"""The messages of the scene reader with their cures, from ``docs/reference/messages.toml``."""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

FILE = Path(__file__).parents[1] / "reference" / "messages.toml"
FENCE = "```{code-block} text\n:class: message\n\n"
_DATA: dict[str, Any] = tomllib.loads(FILE.read_text(encoding="utf-8"))
SCENES: dict[str, str] = _DATA["scenes"]
"""Good scenes, each wrong after a change."""


@dataclass(frozen=True, kw_only=True)
class Message:
    """One sentence of the reader, how it comes about and what to do.

    Attributes
    ----------
    sentence : str
        With ``{}`` for every value in it.
    example : str
        A whole line as it is printed.
    cure : str
        In Markdown.
    base, change, append, encoding : str, (str, str), str, str
        The scene of `SCENES`, what is replaced in it and by what, what is added, and how the file is encoded.
    arguments, python : tuple of str, str
        Arguments of the command; or Python code that provokes the message where no file does.
    """

    sentence: str
    example: str
    cure: str
    base: str = "strip"
    change: tuple[str, str] = ("", "")
    append: str = ""
    encoding: str = "utf-8"
    arguments: tuple[str, ...] | None = None
    python: str | None = None

    @property
    def text(self) -> str:
        """The file that provokes the message."""
        old, new = self.change
        good = SCENES[self.base]
        if old and good.count(old) != 1:
            raise ValueError(f"{FILE.name}: {old!r} must stand once in scene {self.base}")
        return (good.replace(old, new) if old else good) + self.append


def groups() -> dict[str, tuple[Message, ...]]:
    """Return the messages by the titles of their groups."""
    return {group["title"]: tuple(_message(entry) for entry in group["message"]) for group in _DATA["group"]}


def messages() -> tuple[Message, ...]:
    """Return all messages in order."""
    return tuple(message for group in groups().values() for message in group)


def _message(entry: dict[str, Any]) -> Message:
    given = {("base" if key == "in" else key): value for key, value in entry.items()}
    return Message(**{key: tuple(item) if isinstance(item, list) else item for key, item in given.items()})


def page() -> str:
    """Return one section for every group: an example of each line, then its cure."""
    parts = []
    for title, group in groups().items():
        parts.append(f"## {title}")
        parts += [f"{FENCE}{message.example}\n```\n\n{message.cure}" for message in group]
    return "\n\n".join(parts) + "\n"

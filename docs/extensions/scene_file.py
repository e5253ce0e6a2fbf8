"""The tables of a scene file, from the records that read them."""

from dataclasses import MISSING, fields
from typing import Any

from comparisons.scene.read import LISTS
from comparisons.scene.record import Record, lists_of, rule_of
from comparisons.scene.scene import Scene
from comparisons.scene.stages import StageSpec
from comparisons.scene.values import toml_value
from docs.extensions.markdown import table, text


def page() -> str:
    """Return one section for every table of a scene file, with a row for every key."""
    moves = ((f"{name} of [[stage]]", kind) for name, kind in lists_of(StageSpec).items())
    sections = [_section("[scene]", Scene, leave=lists_of(Scene).keys())]
    sections += [_section(f"[[{kind}]]", record) for kind, record in LISTS.items()]
    sections += [_section(header, kind) for header, kind in moves if kind not in LISTS.values()]
    return "\n\n".join(sections) + "\n"


def _section(header: str, kind: type[Record], leave: Any = ()) -> str:
    rows = [
        (
            f"`{item.name}`",
            text(rule_of(item).accepts),
            _default(item.default),
            text(item.metadata["meaning"]),
        )
        for item in fields(kind)
        if item.name not in leave
    ]
    said = (kind.__doc__ or "").partition("\n\nParameters\n")[0].split("\n\n")
    head = [text(" ".join(part.split())) for part in said]
    return "\n\n".join([f"## `{header}`", *head, table(("key", "value", "default", "meaning"), rows)])


def _default(value: Any) -> str:
    if value is MISSING:
        return "required"
    return "" if value is None else f"`{toml_value(value)}`"

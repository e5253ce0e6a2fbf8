"""The tables of a scene file, from the records that read them."""

from dataclasses import MISSING, fields
from inspect import getdoc
from typing import Any

from numpydoc.docscrape import NumpyDocString

from comparisons.scene.read import LISTS, STAGE_LISTS
from comparisons.scene.records import Scene
from comparisons.scene.rules import Choice, Subset, field_rules
from comparisons.scene.values import toml_value
from docs.extensions.markdown import table, text


def page() -> str:
    """Return one section for every table of a scene file, with a row for every key."""
    sections = [_section("[scene]", Scene, leave={f"{kind}s" for kind in LISTS})]
    sections += [_section(f"[[{kind}]]", record) for kind, record in LISTS.items()]
    moves = ((name, record) for name, record in STAGE_LISTS.items() if record not in LISTS.values())
    sections += [_section(f"{name} of [[stage]]", record) for name, record in moves]
    return "\n\n".join(sections) + "\n"


def _section(header: str, kind: type, leave: set[str] = frozenset()) -> str:  # type: ignore[assignment]
    doc = NumpyDocString(getdoc(kind) or "")
    described = {
        name.strip(): (item.type, " ".join(item.desc))
        for item in doc["Parameters"]
        for name in item.name.split(",")
    }
    rows = []
    for item in fields(kind):
        if item.name in leave:
            continue
        sort, meaning = described[item.name]
        value = _value(field_rules(kind)[item.name]) or text(sort)
        rows.append((f"`{item.name}`", value, _default(item.default), text(meaning)))
    head = [" ".join(doc["Summary"]), " ".join(doc["Extended Summary"])]
    return "\n\n".join(
        [
            f"## `{header}`",
            *(text(part) for part in head if part),
            table(("key", "value", "default", "meaning"), rows),
        ]
    )


def _default(value: Any) -> str:
    if value is MISSING:
        return "required"
    return "" if value is None else f"`{toml_value(value)}`"


def _value(rule: Any) -> str:
    """Return what a rule accepts: its options, or the words of its docstring."""
    if isinstance(rule, Choice | Subset):
        kind = "one of" if isinstance(rule, Choice) else "a list of some of"
        return f"{kind} " + ", ".join(f'`"{option}"`' for option in rule.options)
    sentence = (rule.__doc__ or "").partition("\n")[0]
    return text(sentence.removeprefix("Accept ").removesuffix(".")) if sentence.startswith("Accept") else ""

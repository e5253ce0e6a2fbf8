"""The pages that are made from the code before every build."""

import json
import re
import tomllib
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import MISSING, dataclass, fields
from pathlib import Path
from typing import Any

import fem_reference
import tsm
from comparisons.answer.file import SCHEMA
from comparisons.answer.quantities import QUANTITIES
from comparisons.models import MODELS
from comparisons.models.outside.child import ProgramStatus
from comparisons.models.rod_response import STOPS
from comparisons.output import markdown
from comparisons.referee import Verdict
from comparisons.scene import Scene, load_scene, read_scene
from comparisons.scene.read import LISTS
from comparisons.scene.record import Record, lists_of
from comparisons.scene.rules import toml_value
from comparisons.scene.stages import StageSpec
from comparisons.scene.words import NOT_MODELLED
from docs.extensions.messages import REFERENCE, changed, groups

STATUSES: dict[str, dict[str, str]] = {
    title: kind if isinstance(kind, dict) else {one.name: one.value for one in kind}
    for title, kind in (
        ("Beams", tsm.Status),
        ("Solid", fem_reference.Status),
        ("Exact rods", STOPS),
        ("Certificates", Verdict),
        ("Programs of others", ProgramStatus),
    )
}
"""Statuses with their sentences, by where they come from."""
SCHEMAS: dict[str, dict[str, Any]] = {
    "response": SCHEMA,
    "resolved-scene": json.loads((REFERENCE / "resolved-scene.schema.json").read_text(encoding="utf-8")),
}


def line(docstring: str) -> str:
    r"""Return one line of Markdown for a docstring's text: code marks and what Markdown would read as its own.

    Examples
    --------
    >>> line("a name, ``pin->beam``, of `Beam` * 2")
    'a name, `pin->beam`, of `Beam` \\* 2'
    """
    parts = re.split(r"(``[^`]+``|`[^`]+`)", " ".join(docstring.split()))
    return "".join(
        f"`{part.strip('`')}`" if part.startswith("`") else re.sub(r"([*_<\[{$\\])", r"\\\1", part)
        for part in parts
    )


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table; cells are Markdown in one line."""
    return markdown([dict(zip(head, row, strict=True)) for row in rows]).rstrip("\n")


def scene_file() -> str:
    """Return one section for every table of a scene file, with a row for every key, from the records that read them."""
    kinds = {f"[[{name}]]": kind for name, kind in LISTS.items()}
    moves = {f"{name} of [[stage]]": kind for name, kind in lists_of(StageSpec).items()}
    kinds |= {header: kind for header, kind in moves.items() if kind not in LISTS.values()}
    return "\n\n".join([_record("[scene]", Scene, lists_of(Scene)), *map(_record, kinds, kinds.values())])


def _record(header: str, kind: type[Record], leave: Collection[str] = ()) -> str:
    said = (kind.__doc__ or "").partition("\n\nParameters\n")[0].split("\n\n")
    rows = []
    for item in (one for one in fields(kind) if one.name not in leave):
        has = {MISSING: "required", None: ""}
        default = has[item.default] if item.default in has else f"`{toml_value(item.default)}`"
        accepts, meaning = kind.rules[item.name].accepts, item.metadata["meaning"]
        rows.append((f"`{item.name}`", line(accepts), default, line(meaning)))
    parts = [f"## `{header}`", *map(line, said), table(("key", "value", "default", "meaning"), rows)]
    return "\n\n".join(parts)


def messages() -> str:
    """Return one section for every group of messages: an example of each line, then its cure."""
    shown = "```{{code-block}} text\n:class: message\n\n{}\n```\n\n{}"
    return "\n\n".join(
        "\n\n".join([f"## {title}", *(shown.format(one.example, one.cure) for one in group)])
        for title, group in groups().items()
    )


@dataclass(frozen=True, kw_only=True)
class Question:
    """Something that a scene can say: see ``docs/reference/scope.toml``."""

    wish: str
    keys: str
    limits: str = ""
    built_in: str = ""
    change: Sequence[str] = ()
    append: str = ""

    @property
    def scene(self) -> Scene:
        """A scene that says it."""
        if self.built_in:
            return load_scene(self.built_in)
        return read_scene(changed("strip", self.change, self.append), self.wish)


def questions() -> dict[str, list[Question]]:
    """Return what a scene can say, by kinds of question."""
    found = tomllib.loads((REFERENCE / "scope.toml").read_text(encoding="utf-8"))["group"]
    return {group["title"]: [Question(**entry) for entry in group["question"]] for group in found}


def scope() -> str:
    """Return one table for every kind of question with the models that answer it, and the table of what is not modelled."""
    head, parts = ("you want", "you write", *MODELS, "limits"), []
    for title, group in questions().items():
        rows = []
        for one in group:
            said = (model.unstated(one.scene) or model.refusal(one.scene) for model in MODELS.values())
            rows.append((one.wish, one.keys, *("yes" if why is None else "no" for why in said), one.limits))
        parts.append(f"## {title}\n\n{table(head, rows)}")
    rows = [
        (one.title, line(one.answer), ", ".join(f"`{word}`" for word in one.words)) for one in NOT_MODELLED
    ]
    return "\n\n".join([*parts, "## What is not modelled\n\n" + table(("topic", "answer", "words"), rows)])


def statuses() -> str:
    """Return the statuses with their sentences, by where they come from."""
    return "\n\n".join(
        f"### {title}\n\n"
        + table(("status", "meaning"), [(f"`{one}`", line(why)) for one, why in rows.items()])
        for title, rows in STATUSES.items()
    )


def keys(name: str) -> str:
    """Return a table with a row for every key of a JSON text, from its schema in `SCHEMAS`."""
    return table(("key", "type", "meaning"), _keys(SCHEMAS[name], SCHEMAS[name], ""))


def _keys(schema: dict[str, Any], inside: dict[str, Any], prefix: str) -> Iterator[tuple[str, str, str]]:
    """Yield the rows of the keys of a table, and below each those of what it holds: tables by name, a list of tables, a table."""
    for key, item in inside.get("properties", {}).items():
        yield f"`{prefix}{key}`", _sort(_resolved(schema, item)), line(item["description"])
        tables = {".NAME.": item.get("additionalProperties"), "[].": item.get("items"), ".": item}
        for between, held in tables.items():
            if isinstance(held, dict):
                yield from _keys(schema, _resolved(schema, held), f"{prefix}{key}{between}")


def _resolved(schema: dict[str, Any], item: dict[str, Any]) -> dict[str, Any]:
    return dict(schema["$defs"][item["$ref"].rpartition("/")[2]]) if "$ref" in item else item


def _sort(item: dict[str, Any]) -> str:
    """Return what a value is: by the title of its definition, its values or its types."""
    if "title" in item:
        return str(item["title"])
    if "enum" in item:
        return " or ".join(f"`{value}`" for value in item["enum"])
    names = {"object": "table", "array": "list", "string": "text", "boolean": "truth value"}
    kinds = item["type"] if isinstance(item["type"], list) else [item["type"]]
    return " or ".join(names.get(kind, kind) for kind in kinds)


PAGES: dict[str, Callable[[], str]] = {
    "scene-file.md": scene_file,
    "messages.md": messages,
    "scope.md": scope,
    "statuses.md": statuses,
    "response.md": lambda: keys("response"),
    "resolved-scene.md": lambda: keys("resolved-scene"),
    "quantities.md": lambda: table(
        ("quantity", "unit", "what is compared"),
        ((f"`{name}`", row.unit, line(row.meaning)) for name, row in QUANTITIES.items()),
    ),
}
"""What makes the text of each page."""


def write_pages(folder: Path) -> None:
    """Write every page into `folder`; a page that has not changed keeps its time."""
    folder.mkdir(exist_ok=True)
    for name, page in PAGES.items():
        path, text = folder / name, page() + "\n"
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")

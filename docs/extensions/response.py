"""The JSON texts of a response and of a resolved scene, from their schemas, and the quantities that are compared."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from comparisons.quantities import QUANTITIES
from comparisons.response.file import SCHEMA, resolved
from docs.extensions.markdown import table, text

FOLDER = Path(__file__).parents[1] / "reference"
SCENE: dict[str, Any] = json.loads((FOLDER / "resolved-scene.schema.json").read_text(encoding="utf-8"))


def page() -> str:
    """Return a table with a row for every key of a response."""
    return table(("key", "type", "meaning"), _rows("", SCHEMA)) + "\n"


def quantities_page() -> str:
    """Return a table with a row for every quantity that is compared."""
    rows = ((f"`{name}`", row.unit, text(row.meaning)) for name, row in QUANTITIES.items())
    return table(("quantity", "unit", "what is compared"), rows) + "\n"


def scene_page() -> str:
    """Return a table with a row for every key of a resolved scene."""
    return table(("key", "type", "meaning"), _rows("", SCENE)) + "\n"


def _rows(prefix: str, schema: dict[str, Any]) -> Iterator[tuple[str, str, str]]:
    for key, field in schema.get("properties", {}).items():
        item = resolved(field)
        yield f"`{prefix}{key}`", _sort(item), text(item["description"])
        yield from _inner(f"{prefix}{key}", item)


def _inner(prefix: str, item: dict[str, Any]) -> Iterator[tuple[str, str, str]]:
    """Yield the rows of what a key holds: a table by name, a list of tables, a table."""
    named, listed = item.get("additionalProperties"), resolved(item.get("items", {}))
    if isinstance(named, dict):
        yield from _rows(f"{prefix}.NAME.", resolved(named))
    elif "properties" in listed:
        yield from _rows(f"{prefix}[].", listed)
    elif "properties" in item:
        yield from _rows(f"{prefix}.", item)


def _sort(item: dict[str, Any]) -> str:
    shapes = {"history": "s numbers", "vectors": "s pairs of numbers", "vector": "2 numbers"}
    name = item.get("$ref", "").rpartition("/")[2]
    if name in shapes:
        return shapes[name]
    if "enum" in item:
        return " or ".join(f"`{value}`" for value in item["enum"])
    kind = item["type"]
    names = {"object": "table", "array": "list", "string": "text", "boolean": "truth value"}
    return " or ".join(names.get(part, part) for part in ([kind] if isinstance(kind, str) else kind))

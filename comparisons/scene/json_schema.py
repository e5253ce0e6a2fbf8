"""The JSON Schema of scene files, for editors: made from the records and their rules."""

import json
import re
from dataclasses import MISSING, fields
from inspect import getdoc
from pathlib import Path
from typing import Any

from comparisons.scene import rules
from comparisons.scene.read import LISTS, STAGE_LISTS
from comparisons.scene.records import Scene
from comparisons.scene.rules import Choice, Rule, Subset, field_rules
from comparisons.scene.stages import StageSpec

Schema = dict[str, Any]
NUMBER: Schema = {"type": "number"}
COUNT: Schema = {"type": "integer", "minimum": 1, "maximum": 100_000}
POINT: Schema = {"type": "array", "items": NUMBER, "minItems": 2, "maxItems": 2}
END: Schema = {"enum": ["start", "end"]}
OF_RULES: dict[Rule, Schema] = {
    rules.number: NUMBER,
    rules.positive: {"type": "number", "exclusiveMinimum": 0},
    rules.not_negative: {"type": "number", "minimum": 0},
    rules.dimension: {
        "anyOf": [
            {"type": "number", "exclusiveMinimum": 0},
            {
                "type": "array",
                "items": {"type": "number", "exclusiveMinimum": 0},
                "minItems": 2,
                "maxItems": 2,
            },
        ]
    },
    rules.turn: {
        "type": "number",
        "exclusiveMinimum": -6.2831853071795865,
        "exclusiveMaximum": 6.2831853071795865,
    },
    rules.fraction: {"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1},
    rules.span: {
        "type": "array",
        "items": {"type": "number", "minimum": 0, "maximum": 1},
        "minItems": 2,
        "maxItems": 2,
    },
    rules.stiffnesses: {
        "type": "array",
        "items": {"type": "number", "minimum": 0},
        "minItems": 2,
        "maxItems": 2,
    },
    rules.further_points: {"type": "array", "items": POINT, "minItems": 1},
    rules.friction: {"type": "number", "minimum": 0, "maximum": rules.MOST_FRICTION},
    rules.poissons_ratio: {"type": "number", "exclusiveMinimum": -1, "exclusiveMaximum": 0.5},
    rules.whole_number: COUNT,
    rules.parts: {
        "type": "array",
        "items": {"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1},
    },
    rules.mesh: {"type": "array", "items": COUNT, "minItems": 2, "maxItems": 2},
    rules.point: POINT,
    rules.polyline: {"type": "array", "items": POINT, "minItems": 2},
    rules.text: {"type": "string", "minLength": 1},
    rules.name: {"type": "string", "pattern": r"^[\w-]+$"},
    rules.units: {"type": "string", "pattern": "^[^,]*[^, ][^,]*,[^,]*[^, ][^,]*$"},
    rules.truth: {"type": "boolean"},
    rules.ends: {"type": "array", "items": END, "uniqueItems": True},
}
"""The part of each rule that JSON Schema can express."""


def json_schema() -> Schema:
    """Return the schema. A file that the schema refuses is refused by the reader too; rules between keys are checked by the reader only.

    Examples
    --------
    >>> json_schema()["properties"]["beam"]["items"]["properties"]["youngs_modulus"]["exclusiveMinimum"]
    0
    """
    tables = {kind: _list(record) for kind, record in LISTS.items()}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Scene of tsm-crossval",
        "type": "object",
        "properties": {
            "scene": _record(Scene, leave=tuple(f"{kind}s" for kind in LISTS)),
            **tables,
        },
        "required": ["scene", "beam"],
        "additionalProperties": False,
    }


def _list(kind: type) -> Schema:
    return {"type": "array", "minItems": 1, "items": _record(kind)}


def json_schema_text() -> str:
    """Return the schema as the text of ``scene.schema.json``, which is shipped."""
    return json.dumps(json_schema(), indent=1) + "\n"


def _record(kind: type, leave: tuple[str, ...] = ()) -> Schema:
    known = [item for item in fields(kind) if item.name not in leave]
    of_fields, texts = field_rules(kind), _descriptions(kind)
    properties = {}
    inner = STAGE_LISTS if kind is StageSpec else {}
    for item in known:
        if item.name in inner:
            properties[item.name] = {**_list(inner[item.name]), "description": texts[item.name]}
            continue
        default = {} if item.default in (MISSING, None) else {"default": item.default}
        properties[item.name] = {"description": texts[item.name], **_of_rule(of_fields[item.name]), **default}
    return {
        "type": "object",
        "description": (getdoc(kind) or "").partition("\n")[0],
        "properties": properties,
        "required": [item.name for item in known if item.default is MISSING],
        "additionalProperties": False,
    }


def _of_rule(rule: Rule) -> Schema:
    if isinstance(rule, Choice):
        return {"enum": list(rule.options)}
    if isinstance(rule, Subset):
        return {"type": "array", "items": {"enum": list(rule.options)}, "uniqueItems": True, "minItems": 1}
    return OF_RULES[rule]


def _descriptions(kind: type) -> dict[str, str]:
    """Return what a record's docstring says about its fields."""
    found: dict[str, str] = {}
    for names, text in re.findall(r"^(\w[\w, ]*) : .*\n((?: +.*\n?)+)", getdoc(kind) or "", re.MULTILINE):
        for name in names.split(", "):
            found[name] = " ".join(text.split()).replace("``", "`")
    return found


if __name__ == "__main__":
    Path(__file__).with_name("scene.schema.json").write_text(json_schema_text(), encoding="utf-8")

"""A response as JSON and as a few readable lines."""

import json
import math
import sys
from importlib import metadata
from typing import Any

import numpy as np

from comparisons.response import Response

DISTRIBUTIONS = ("numpy", "scipy", "scikit-fem", "tsm-crossval")


def versions() -> dict[str, str]:
    """Return the versions of Python and of the distributions behind the numbers."""
    found = {name: metadata.version(name) for name in DISTRIBUTIONS}
    return {"python": ".".join(map(str, sys.version_info[:3])), **found}


def as_json(response: Response) -> str:
    """Return the response as JSON text; a value that is not a number is null."""
    return json.dumps(plain(as_dict(response)), allow_nan=False, indent=1) + "\n"


def as_dict(response: Response) -> dict[str, Any]:
    """Return what a response states, by the names of the JSON file."""
    return {
        "status": response.status,
        "model": response.model,
        "scene": response.scene,
        "load_parameter": response.load_parameter,
        "contacts": {
            pair: {"force": contact.force, "arc_position": contact.arc_position, "gap": contact.gap}
            for pair, contact in response.contacts.items()
        },
        "supports": {
            beam: {"moment": support.moment, "force": support.force}
            for beam, support in response.supports.items()
        },
        "tips": response.tips,
        "newton_iterations": response.newton_iterations,
        "cutbacks": response.cutbacks,
        "unknowns": response.unknowns,
        "wall_seconds": response.wall_seconds,
        "versions": versions(),
    }


def plain(value: Any) -> Any:
    """Return `value` in JSON's own types."""
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [plain(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def summary(response: Response, units: str) -> str:
    """Return a few lines for a reader: how the run ended and the last state reached."""
    force, length = (unit.strip() for unit in units.split(","))
    rows = [("status", f"{response.status}: {response.message}")]
    if len(response.load_parameter):
        rows.append(("load parameter", f"{response.load_parameter[-1]:.6g}"))
        for pair, contact in response.contacts.items():
            rows.append((f"{pair} force", f"{contact.force[-1]:.9g} {force}"))
            if np.isfinite(contact.arc_position[-1]):
                rows.append((f"{pair} arc position", f"{contact.arc_position[-1]:.9g} {length}"))
        for beam, support in response.supports.items():
            rows.append((f"{beam} clamp moment", f"{support.moment[-1]:.9g} {force} {length}"))
        rows += [
            (f"{beam} tip", f"({tip[-1, 0]:.9g}, {tip[-1, 1]:.9g}) {length}")
            for beam, tip in response.tips.items()
        ]
    rows += [
        ("unknowns", f"{response.unknowns}"),
        ("Newton iterations", f"{response.newton_iterations.sum()}, cut-backs {response.cutbacks}"),
        ("seconds", f"{response.wall_seconds:.3f}"),
    ]
    width = max(len(label) for label, _ in rows)
    return "\n".join(
        [f"{response.scene}, model {response.model}", *(f"  {a:<{width}}  {b}" for a, b in rows)]
    )

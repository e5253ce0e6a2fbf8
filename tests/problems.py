"""The built-in scenes with their answers, from ``problems.toml``: the one place of these digits, their sources and their tolerances."""

import tomllib
from dataclasses import dataclass, field
from decimal import Decimal
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.answer import ContactEvent, Response
from comparisons.models import MODELS
from comparisons.models.model import Options
from comparisons.scene import load_scene

RUNS = {
    "exact": ("tsm", Options(element="exact")),
    "mixed": ("tsm", Options(element="mixed")),
    "timoshenko": ("tsm", Options(element="timoshenko", elements=20)),
    **{name: (name, Options()) for name in MODELS if name != "tsm"},
}
"""The models of the table, with their options."""
QUANTITIES = {
    "force": ("contacts", "force"), "arc": ("contacts", "arc_position"), "dissipated": ("contacts", "friction.dissipated"),
    "reaction": ("supports", "force"), "moment": ("supports", "moment"), "spring": ("springs", "force"), "tip": ("tips", ""),
}  # fmt: skip
"""Where a response has the first word of a name."""


@dataclass(frozen=True, kw_only=True)
class Problem:
    """A scene, its answers by load parameter and name, and their source.

    A model of `RUNS` has its error in `errors`, or the fragment of its refusal or the status of its stop in `others`.
    """

    scene: str
    source: str
    errors: dict[str, float]
    answers: dict[float, dict[str, tuple[Decimal, ...]]]
    others: dict[str, str] = field(default_factory=dict)
    events: list[list[Any]] = field(default_factory=list)

    def at(self, load_parameter: float) -> dict[str, Any]:
        """The answers at a load parameter by name, as ``force pin->cantilever``: numbers, and vectors of two."""
        rows = {name: tuple(map(float, row)) for name, row in self.answers[load_parameter].items()}
        return {name: row[0] if len(row) == 1 else row for name, row in rows.items()}

    def mistakes(self, response: Response, error: float) -> list[str]:
        """The answers at load parameters of a response that are off by more than an error and half a unit of the last digit."""
        found, times = [], response.load_parameter
        for t, row in self.answers.items():
            k = int(np.abs(times - t).argmin())
            if abs(times[k] - t) > 1e-12:
                continue
            for name, digits in row.items():
                own, true = np.atleast_1d(value(response, name, k)), np.array([float(one) for one in digits])
                size = self.length(name) if name.startswith(("arc ", "tip ")) else np.abs(true).max()
                if not np.abs(own - true).max() <= max(error * size, *map(half_unit, digits)):
                    found.append(f"{self.scene}: {name} at {t:g} is {own}, must be {true}")
        return found

    def misplaced(self, response: Response) -> list[ContactEvent]:
        """The events of a response that has others than the table, which may have none."""
        happened = [item for item in response.events or () if item.kind != "pass-through"]
        right = len(happened) == len(self.events) and all(
            own.kind == kind and abs(own.load_parameter - float(t)) <= 1e-8 and stage in ([], [own.stage])
            for own, (kind, t, *stage) in zip(happened, self.events, strict=True)
        )
        return [] if right or not self.events else happened

    def length(self, name: str) -> float:
        """Length of the beam of an arc position or a tip."""
        return load_scene(self.scene).beam(name.rsplit(maxsplit=1)[-1].rpartition("->")[2]).length


def half_unit(number: Decimal) -> float:
    """Half a unit of the last digit, with round-off; 0 of an exact number, which has less than nine digits."""
    _, digits, exponent = number.as_tuple()
    return 0.50001 * 10.0**exponent if len(digits) >= 9 and isinstance(exponent, int) else 0.0


def value(response: Response, name: str, k: int) -> Any:
    """Number or vector of an answer by its name at a position of the load parameters."""
    what, where = name.split()
    table, key = QUANTITIES[what]
    record = getattr(response, table)[where]
    return (attrgetter(key)(record) if key else record)[k]


def _problems() -> dict[str, Problem]:
    text = Path(__file__).with_suffix(".toml").read_text(encoding="utf-8")
    found = {}
    for scene, table in tomllib.loads(text, parse_float=Decimal).items():
        errors = {name: float(one) for name, one in table["errors"].items()}
        answers: dict[float, dict[str, tuple[Decimal, ...]]] = {}
        for row in table.pop("answers"):
            rows = answers.setdefault(float(row.pop("at")), {})
            rows |= {
                key: tuple(map(Decimal, one if isinstance(one, list) else [one])) for key, one in row.items()
            }
        found[scene] = Problem(scene=scene, **{**table, "errors": errors, "answers": answers})
    return found


PROBLEMS = _problems()

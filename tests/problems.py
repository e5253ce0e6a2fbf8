"""The built-in scenes with their answers, from ``problems.toml``: the one place of these digits, their sources and their tolerances."""

import tomllib
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.models import MODELS
from comparisons.models.options import Options
from comparisons.response import Response
from comparisons.scene import load_scene

RUNS = {
    "exact": ("tsm", Options(element="exact")),
    "mixed": ("tsm", Options(element="mixed")),
    "timoshenko": ("tsm", Options(element="timoshenko", elements=20)),
    **{name: (name, Options()) for name in MODELS if name != "tsm"},
}
"""The models of the table, with their options."""


@dataclass(frozen=True, kw_only=True)
class Problem:
    """A scene, its answers by load parameter and name, their source, and what each model makes of it.

    A model has a tolerance, the fragment of its refusal, or the name of its stop in capitals.
    """

    scene: str
    source: str
    models: dict[str, float | str]
    answers: dict[float, dict[str, tuple[Decimal, ...]]]

    def at(self, load_parameter: float) -> dict[str, Any]:
        """The answers at a load parameter by name, as ``force pin->cantilever``: numbers, and vectors of two."""
        rows = {name: tuple(map(float, row)) for name, row in self.answers[load_parameter].items()}
        return {name: row[0] if len(row) == 1 else row for name, row in rows.items()}

    def mistakes(self, response: Response, tolerance: float, least: float = 0.0) -> list[str]:
        """The answers behind load parameter `least` that differ by more than a tolerance and half a unit of the last digit.

        A tolerance is relative to the number, of an arc position and a tip to the length of the beam.
        """
        found, times = [], response.load_parameter
        for t, row in self.answers.items():
            if t < least or not np.isclose(times, t, rtol=0, atol=1e-12).any():
                continue
            k = int(np.abs(times - t).argmin())
            for name, digits in row.items():
                is_ = np.atleast_1d(value(response, name, k))
                true = np.array([float(one) for one in digits])
                unit = max(map(half_unit, digits))
                size = self.length(name) if name.startswith(("arc ", "tip ")) else np.abs(true).max()
                if not np.abs(is_ - true).max() <= max(tolerance * size, unit):
                    found.append(f"{self.scene}: {name} at {t:g}: {is_} is not {true}")
        return found

    def length(self, name: str) -> float:
        """Length of the beam of an arc position or a tip."""
        return load_scene(self.scene).beam(name.split()[-1].rpartition("->")[2]).length


def half_unit(number: Decimal) -> float:
    """Half a unit of the last digit, with round-off; 0 of an exact number, which has less than nine digits."""
    _, digits, exponent = number.as_tuple()
    return 0.50001 * 10.0**exponent if len(digits) >= 9 and isinstance(exponent, int) else 0.0


def value(response: Response, name: str, k: int) -> Any:
    """Number or vector of an answer by its name at a position of the load parameters."""
    what, where = name.split()
    if what in ("force", "arc"):
        contact = response.contacts[where]
        return (contact.force if what == "force" else contact.arc_position)[k]
    if what == "tip":
        return response.tips[where][k]
    held = response.supports[where] if where in response.supports else response.springs[where]
    return held.moment[k] if what == "moment" else held.force[k]


def _problems() -> dict[str, Problem]:
    text = Path(__file__).with_suffix(".toml").read_text(encoding="utf-8")
    found = {}
    for scene, table in tomllib.loads(text, parse_float=Decimal).items():
        models = {name: float(one) if isinstance(one, Decimal) else one for name, one in table["models"].items()}
        answers = {
            float(row.pop("at", 1)): {
                name: tuple(map(Decimal, one)) if isinstance(one, list) else (Decimal(one),)
                for name, one in row.items()
            }
            for row in table["answers"]
        }
        found[scene] = Problem(scene=scene, source=table["source"], models=models, answers=answers)
    return found


PROBLEMS = _problems()

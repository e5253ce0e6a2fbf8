"""What a page and a terminal begin with: one sentence, at most five points, and the answer in units, model by model."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from comparisons.answer import Array, Response
from comparisons.answer.along import ALONG, extremes_along
from comparisons.answer.quantities import forces, moments, size
from comparisons.answer.round_off import round_off
from comparisons.answer.table import unit_names
from comparisons.files import filled
from comparisons.output import Row, tabulated
from comparisons.scene import Scene

POINTS = 5
"""Points of a brief at most."""
BOLD = "\x1b[1m{}\x1b[0m"
DIGITS, LEAST = 4, 1e-9
"""Significant digits of an answer in a brief, and the least relative difference that is no round-off."""


class Brief(NamedTuple):
    """What is found: a sentence, points, and a table of the answer with what it is about."""

    sentence: str
    points: Sequence[str] = ()
    answer: Sequence[Row] = ()
    about: str = ""

    def text(self, *, bold: bool = False) -> str:
        """Return lines that fit the terminal; no word is broken."""
        head = [BOLD.format(line) if bold else line for line in filled(self.sentence)]
        points = [line for point in self.points[:POINTS] for line in filled(point, "- ", "  ")]
        answer = ["", *filled(self.about), "", tabulated(self.answer, folded=True)] if self.answer else []
        return "\n".join([*head, *points, *answer])


def at_largest(response: Response) -> int:
    """Return the number of the load parameter with the largest contact force, or support force without contact; of the first one if several have it."""
    found = [size(values) for values in forces(response).values()]
    return int(np.argmax(np.max(found, axis=0))) if found else len(response.load_parameter) - 1


def travel(scene: Scene, load_parameter: Array) -> Array | None:
    """Return how far the one pin that moves has come along its path; None with more pins, or without a path."""
    moving = [pin for pin in scene.pins if pin.moving]
    if len(moving) != 1:
        return None
    fine = np.linspace(0.0, scene.times[-1], 100 * len(scene.times) + 1)
    steps = np.hypot(*np.diff([moving[0].position(float(t)) for t in fine], axis=0).T)
    return np.asarray(np.interp(load_parameter, fine, np.append(0.0, np.cumsum(steps))))


def across(scene: Scene, load_parameter: Array) -> tuple[str, Array]:
    """Return what histories are drawn over, with its words: the `travel` of a pin, or the load parameter."""
    way = travel(scene, load_parameter)
    if way is None:
        return "load parameter", load_parameter
    return f"travel of the pin [{unit_names(scene.units)['length']}]", way


def spring_rate(response: Response, scene: Scene) -> float:
    """Return the rise of the force of the one moving pin over its travel as it begins to push; nan without one."""
    way = travel(scene, response.load_parameter)
    moving = {pin.name for pin in scene.pins if pin.moving}
    pushing = [one.force for pair, one in response.contacts.items() if pair.partition("->")[0] in moving]
    if way is None or len(pushing) != 1:
        return np.nan
    closed = np.flatnonzero(pushing[0] > 0.0)
    rise = np.diff(pushing[0][closed[:2]]) / np.diff(way[closed[:2]])
    return float(rise[0]) if len(rise) else np.nan


def in_units(scene: Scene, responses: Mapping[str, Response], t: float) -> list[Row]:
    """Return the answers of models at a load parameter, a row for each quantity and a column for each model; what none has is left out.

    With several models a column says how far the second is apart from the first.
    """
    columns = {label: values_at(scene, one, t) for label, one in responses.items()}
    named = dict.fromkeys(name for values in columns.values() for name in values)
    rows = []
    for name in named:
        found = [values.get(name) for values in columns.values()]
        cells = ["-" if value is None else f"{value:.{DIGITS}g}" for value in found]
        row = {"": "{} [{}]".format(*name), **dict(zip(columns, cells, strict=True))}
        if len(found) > 1:
            one, other = found[:2]
            apart = other / one - 1.0 if one and other is not None else np.nan
            row["apart"] = f"{100.0 * apart * (abs(apart) > LEAST):.2g} %" if np.isfinite(apart) else "-"
        rows.append(row)
    return rows


def values_at(scene: Scene, response: Response, t: float) -> dict[tuple[str, str], float]:
    """Return quantities at a load parameter by their names and units; zero for what is below round-off."""
    at = np.flatnonzero(np.isclose(response.load_parameter, t, rtol=0.0, atol=1e-9))
    if not len(at):
        return {}
    k, units, least = int(at[0]), unit_names(scene.units), round_off(response, scene)
    found: dict[str, tuple[str, float]] = {}
    what = "contact force" if response.contacts else "support force"
    acting = forces(response)
    for name, values in acting.items():
        found[f"{what} {name}" if len(acting) > 1 else what] = "force", float(size(values)[k])
    turned = {name: float(values[k]) for name, values in moments(response).items() if values.any()}
    for name, moment in turned.items():
        found[f"moment {name}" if len(turned) > 1 else "support moment"] = "moment", moment
    along = extremes_along(response, scene, steps=[k])
    for name in ("tensile_stress", "compressive_stress", "displacement"):
        sizes = [extremes[name].value[0] for extremes in along.values() if name in extremes]
        if sizes:
            kind, words = ALONG[name]
            words = words.removeprefix("nominal axial ").removesuffix(" of the axis")
            found[f"largest {words}"] = kind, max(sizes, key=abs)
    rate = spring_rate(response, scene)
    if np.isfinite(rate):
        found["spring rate at first touch"] = "stiffness", rate
    return {
        (name, units[kind]): value if abs(value) > getattr(least, kind, 0.0) else 0.0
        for name, (kind, value) in found.items()
    }

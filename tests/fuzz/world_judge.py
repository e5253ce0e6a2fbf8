"""Judge the answers to a drawn scene: certified, the same by every element, and the same with any number of load parameters.

A model may stop by name. It may not complete with what the referee does not certify, raise, hang, disagree with another that completed,
lie inside a round pin, or end otherwise because more or fewer load parameters were asked for.
"""

import math
import traceback
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from comparisons.answer import Response
from comparisons.models import solve
from comparisons.models.model import ModelError, Options
from comparisons.models.verify import penetration
from comparisons.referee import Judgement, Verdict, certify
from comparisons.scene import Scene, to_toml
from tests.fuzz.judge import LIMIT, Hang, time_limit

MODELS = {
    "exact": ("tsm", Options(element="exact")),
    "mixed": ("tsm", Options(element="mixed")),
    "solid": ("solid", Options()),
    "rod": ("rod", Options()),
}
BEAMS = ("exact", "mixed")
ALLOWED = {"exact": 1e-6, "mixed": 1e-2, "solid": math.inf, "rod": 1e-6}
"""Largest distance from the exact equilibrium in forces and places, where it is less than the certificate's own."""
SECTIONS = 0.2
"""Largest difference of a section force that the sixteen `mixed` elements state in the middles of steep parts: of second order, and refused beyond 5 %."""
NOTHING = 1e-3
"""Force below which nothing happens, over EI/L^2: Newton's methods end at 1e-10."""
NEWTON = 1e-10
"""Force that Newton's method leaves, over the largest EI/L^2."""
BETWEEN = 2e-2
"""Largest difference between `exact` and `mixed` at the last load parameter: twice what each may be off."""
INSIDE = {"exact": 1e-9, "mixed": 1e-4, "solid": math.inf, "rod": 1e-9}
"""Largest depth of a completed axis inside a round pin, over the beam's length. The axis of `mixed` is drawn through element ends."""
NO_NEXT_STEP = {
    "CUTBACK_FLOOR", "STEP_LIMIT", "SINGULAR_TANGENT", "ITERATION_LIMIT", "NOT_FINITE", "INACCURATE",
}  # fmt: skip
"""Statuses of a step that was not found: which of them depends on the step's length."""
GAVE_UP = "no next step"
SAME = 1e-6
"""Largest difference between two answers of one element at the same load parameter."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Row:
    """One solution: model, number of load parameters, how it ended, and its certificate."""

    model: str
    number: int
    ended: str
    response: Response | None = field(default=None, repr=False)
    certificate: str = ""
    certified: bool = False
    lost: bool = False
    """Whether the referee finds no equilibrium at all near the answer."""

    @property
    def completed(self) -> bool:
        """Whether the model says that it went through."""
        return self.ended == "COMPLETED"

    def line(self) -> str:
        return f"{self.model}, {self.number} load parameters: {self.ended} {self.certificate}"


@dataclass(frozen=True, kw_only=True)
class Finding:
    """What is wrong with the answers to a scene: a kind to sort by, and a sentence."""

    kind: str
    text: str


@dataclass(frozen=True, kw_only=True, eq=False)
class Judged:
    """All solutions of a scene and what is wrong with them."""

    scene: Scene
    rows: tuple[Row, ...]
    findings: tuple[Finding, ...]

    def bare(self) -> "Judged":
        """Return the same without the responses."""
        return replace(self, rows=tuple(replace(row, response=None) for row in self.rows))

    def report(self) -> str:
        """Return what is wrong, the solutions and the scene."""
        lines = [f"# WRONG {item.kind}: {item.text}" for item in self.findings]
        lines += [f"# {row.line()}" for row in self.rows]
        return "\n".join([*lines, to_toml(self.scene)])


def judged(scene: Scene, models: Sequence[str] = ("exact", "mixed"), numbers: Sequence[int] = ()) -> Judged:
    """Solve `scene` with its own and with other `numbers` of load parameters, and judge the answers."""
    rows: list[Row] = []
    for model in models:
        if model == "solid" and not _is_one_structure_for_both(scene):
            continue
        own = run(scene, model)
        rows.append(own)
        if own.ended == "refused":
            continue
        if model != "solid":
            others = [number for number in numbers if number != scene.load_parameters]
            rows += [run(replace(scene, load_parameters=number), model, every=False) for number in others]
    return Judged(scene=scene, rows=tuple(rows), findings=tuple(findings(scene, rows)))


def _is_one_structure_for_both(scene: Scene) -> bool:
    """Whether the solid is the same structure: it has no shear area of its own.

    Struts under dead loads are left out: near the buckling load a part of (h/L)^2, which a rod leaves out, decides the deflection.
    """
    return bool(scene.pins) and all(
        beam.height is not None and beam.shear_area is None for beam in scene.beams
    )


def run(scene: Scene, model: str, *, every: bool = True) -> Row:
    """Solve and certify: every load parameter, or the last one and those beside events."""
    name, options = MODELS[model]
    row = Row(model=model, number=scene.load_parameters, ended="refused")
    try:
        with time_limit(LIMIT):
            response = solve(scene, name, options)
        row = replace(row, ended=response.status, certificate=response.message, response=response)
        if not response.completed:
            return row
        with time_limit(LIMIT):
            found = certify(response, scene, at=range(len(scene.times)) if every else None)
    except ModelError as error:
        return replace(row, certificate=str(error))
    except Hang:
        what = "solution" if row.response is None else "certificate"
        return replace(row, ended="HANG", certificate=what, response=None)
    except Exception:  # noqa: BLE001 - whatever it is, it is found
        return replace(row, ended="RAISED", certificate=traceback.format_exc(), response=None)
    off = max((_off(scene, item) for item in found.judged), default=math.nan)
    near = off <= ALLOWED[model]
    sections = max((item.distance.sizes["sections"] for item in found.judged if item.distance), default=0.0)
    steep = model == "mixed" and found.reason.startswith("sections off") and sections <= SECTIONS
    sound = found.certified or found.reason.startswith("nothing to judge") or steep
    line = found.line() if near or not sound else f"FAR: off by {off:.2g}, allowed {ALLOWED[model]:g}"
    lost = any(item.verdict is Verdict.NOT_AN_EQUILIBRIUM and item.exact is None for item in found.judged)
    return replace(row, certificate=line, certified=sound and near, lost=lost)


def _off(scene: Scene, item: Judgement) -> float:
    """Largest difference, without that of the stated polyline from its own contacts, which chords decide.

    Forces only where they are more than what Newton's method leaves.
    """
    if item.distance is None or item.exact is None:
        return 0.0
    pushes = [*item.exact.reactions.values(), *(contact.force for contact in item.exact.contacts.values())]
    size = max((float(np.hypot(*force[:2])) for force in pushes), default=0.0)
    # what is interpolated between stated points has an error of its own
    names = {"arc_position", "tip", "shape"} | (
        {"force", "reaction"} if size > NOTHING * least_force(scene) else set()
    )
    return max(value for name, value in item.distance.sizes.items() if name in names)


def least_force(scene: Scene) -> float:
    """Smallest EI/L^2 of the beams, at least what the last bit of positions is in stretch."""
    bent = min(beam.EI / beam.length**2 for beam in scene.beams)
    return max(bent, 1e3 * np.finfo(float).eps * max(beam.EA for beam in scene.beams))


def findings(scene: Scene, rows: Sequence[Row]) -> Iterator[Finding]:
    """Yield what is wrong with the solutions of a scene."""
    for row in rows:
        if row.ended in ("HANG", "RAISED"):
            yield Finding(kind=f"{row.ended} {row.model}", text=row.line())
        elif row.completed and not row.certified:
            yield Finding(kind=f"{row.certificate.partition(':')[0]} {row.model}", text=row.line())
        if row.completed and row.response is not None:
            depths = [
                penetration(row.response, scene, item).max() / scene.beam(item.beam).length
                for item in scene.contacts
            ]
            depth = max(depths, default=0.0)
            if not depth <= INSIDE[row.model]:
                yield Finding(kind=f"INSIDE {row.model}", text=f"{depth:.2g} L: {row.line()}")
    for model in dict.fromkeys(row.model for row in rows):
        first, *others = (row for row in rows if row.model == model)
        yield from (found for other in others for found in _depends(scene, first, other))
    certified = {row.model: row for row in reversed(rows) if row.completed and row.certified}
    if certified.keys() >= {"exact", "mixed"}:
        both = certified["exact"], certified["mixed"]
        off = apart(scene, *both)
        if not off <= BETWEEN:
            yield Finding(kind="BRANCHES", text=f"{off:.2g} apart: " + " | ".join(row.line() for row in both))


def wrong(found: Judged) -> Iterator[Finding]:
    """Yield the findings on answers that are completed and wrong.

    What the referee refuses is right if the other elements complete with it at every load parameter and are certified, or if the
    referee finds no equilibrium near either.
    """
    own = found.scene.load_parameters
    rows = {row.model: row for row in found.rows if row.completed and row.number == own}
    known = any(row.certified for row in rows.values()) or all(row.lost for row in rows.values())
    every = range(len(found.scene.times))
    same = len(rows) > 1 and all(apart(found.scene, *rows.values(), at=k) <= BETWEEN for k in every)
    fine = {"HANG", "RAISED", Verdict.NOT_JUDGED.name}
    if known and same:
        fine |= set(Verdict.__members__)
    for item in found.findings:
        kind = item.kind.partition(" ")[0]
        if kind not in fine and (kind != "DEPENDS" or "apart" in item.text):
            yield item


def _depends(scene: Scene, first: Row, other: Row) -> Iterator[Finding]:
    """Yield how an answer depends on the number of load parameters."""
    lines = f"{first.line()} | {other.line()}"
    if "CHECK_FAILED" in (first.ended, other.ended) and not (first.completed or other.completed):
        # the check looks at the load parameters that are asked for, of a solution that stopped anyway
        return
    if kind(first.ended) != kind(other.ended):
        yield Finding(kind=f"DEPENDS {first.model}", text=lines)
    elif first.completed:
        off = apart(scene, first, other)
        if not off <= SAME:
            yield Finding(kind=f"DEPENDS {first.model}", text=f"{off:.2g} apart: {lines}")


def kind(ended: str) -> str:
    """Return how a solution ended; the ways to find no next step are one."""
    return GAVE_UP if ended in NO_NEXT_STEP else ended


def apart(scene: Scene, one: Row, other: Row, at: int = -1) -> float:
    """Return the largest difference of two answers at one load parameter, the last one: tips over the length, forces over the largest."""
    a, b = one.response, other.response
    assert a is not None and b is not None, "they are completed"  # noqa: PT018 - for a type checker
    tips = [(a.tips[beam.name][at] - b.tips[beam.name][at]) / beam.length for beam in scene.beams]
    sides = [[found.supports[node].force[at] for node in a.supports] for found in (a, b)]
    pushes = [[(found.contacts[pair].force[at], 0.0) for pair in a.contacts] for found in (a, b)]
    forces = np.array([side + push for side, push in zip(sides, pushes, strict=True)]).reshape(2, -1, 2)
    left = 2.0 * NEWTON * max(beam.EI / beam.length**2 for beam in scene.beams)
    size = max(NOTHING * least_force(scene), left / SAME, np.hypot(*forces.T).max(initial=0.0))
    # nan, of whatever cannot be compared, is kept
    return float(np.hypot(*np.array([*tips, *(forces[0] - forces[1]) / size]).T).max())

"""The error budget of beams against the solid: the parts of their difference, each measured by itself.

With n the TSM elements, h the solid's mesh and eps its penalty,

    q_TSM(n) - q_solid(h, eps) = [TSM mesh] + [TSM theory] + [solid beside the rod] + [material law]
                                 + [solid mesh] + [penalty] + [load steps] + rest.

Each part is extrapolated from runs that differ in one setting only. The sum of the parts is therefore not the difference by
construction, and the rest is a measured number.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from comparisons.answer import Array
from comparisons.answer.quantities import QUANTITIES, forces, moments, size
from comparisons.frozen import Frozen
from comparisons.models import ROD, SOLID, TSM, solve
from comparisons.models.model import Count, ModelError, unwatched
from comparisons.scene import Scene
from comparisons.suite import Case, case
from comparisons.suite.settings import Changes, changed

TIMES = (0.25, 0.5, 0.75, 1.0)
"""Load parameters of the budget."""
STEPS = 8
"""Load steps of the solutions that the budget is computed from; the part for load steps compares with twice as many."""
ELEMENTS = 20
"""TSM elements, of the type `mixed`."""
LEAST = 1e-3
"""Least value of the rods, over the largest of its kind, that differences are relative to. A smaller one has no budget."""
PARTS = {
    "TSM mesh": "20 elements against their limit, extrapolated with fourth order from 20 and 40",
    "TSM theory": "that limit against the exact Reissner rods",
    "solid beside the rod": "the rods against the limit of the solid with the rod's law, linear in Biot's strain, and no penetration",
    "material law": "the law linear in Biot's strain against the scene's",
    "solid mesh": "the limit against the scene's mesh, extrapolated with second order from that and one twice as fine",
    "penalty": "no penetration, by augmented Lagrangian steps, against the scene's penalty",
    "load steps": "twice as many load parameters",
}
"""The parts and what each measures."""
Values = Mapping[str, Array]
"""Values at the load parameters `TIMES`, shape (4,), by quantity."""


class Budget(Frozen):
    """The difference of TSM and solid and its parts, relative to the exact rods' value at the same load parameter."""

    scene: str
    total: Values  #: ``(q_TSM - q_solid) / q_rod`` by quantity; nan where the rods' value is zero or the pair is open.
    parts: dict[str, Values]  #: By quantity and part.

    def rest(self, quantity: str) -> Array:
        """Difference that the parts do not explain, over the total."""
        total = self.total[quantity]
        explained: Array = np.sum(list(self.parts[quantity].values()), axis=0)
        # a force that vanishes in both models has no difference to explain
        return np.divide(total - explained, total, out=np.zeros_like(explained), where=total != 0)


def budget_cases(scene: Scene) -> dict[str, Case]:
    """Return the solutions behind the budget by name; a name ``finer ...`` is that of a mesh twice as fine."""
    short = replace(scene, load_parameters=STEPS)
    free: Changes = {"contact.penalty": None, "contact.penetration": 1e-12}
    law: Changes = {"beam.material": "biot-linear"}
    halved: Changes = {f"beam.{one.name}.mesh": (2 * one.mesh[0], 2 * one.mesh[1]) for one in scene.beams}
    solids: dict[str, Changes] = {
        "bodies": {},
        "linear": law,
        "free": free,
        "like rods": {**law, **free},
        "finer bodies": halved,
        "finer like rods": {**law, **free, **halved},
        "careful": {"scene.load_parameters": 2 * STEPS},
    }
    return {
        "rods": case(short, ROD),
        "beams": case(short, TSM, elements=ELEMENTS),
        "finer beams": case(short, TSM, elements=2 * ELEMENTS),
        **{name: case(changed(short, own), SOLID) for name, own in solids.items()},
    }


def error_budget(scene: Scene, count: Count = unwatched) -> Budget:
    """Measure the budget of a scene that beams and solid state; `count` receives every solution.

    The quantities are the forces and arc positions of all contact pairs, or the forces of the supports in a scene without contact,
    and the moments of the supports.

    Raises
    ------
    ModelError
        If the solid cannot state the scene, a solution behind the budget stops, or no quantity has a value.
    """
    found: dict[str, Array] = {}  # of shape (quantities, 4)
    names: list[str] = []
    cases = budget_cases(scene)
    for name, one in cases.items():
        values = _values(one)
        names = names or [q for q, found_q in values.items() if np.isfinite(found_q).any()]
        if not names:
            raise ModelError(
                "the budget is relative to the exact rods, which have no force at its load parameters"
            )
        found[name] = np.array([values[q] for q in names])
        count(len(found), len(cases))
    rod, beams, solid, like_rod = (found[name] for name in ("rods", "beams", "bodies", "like rods"))

    def step(name: str, order: int) -> Array:
        """Return the limit minus the answer, from that on a mesh twice as fine (Richardson)."""
        return (found[f"finer {name}"] - found[name]) / (1.0 - 2.0**-order)

    parts = {
        "TSM mesh": -step("beams", 4),
        "TSM theory": beams + step("beams", 4) - rod,
        "solid beside the rod": rod - like_rod - step("like rods", 2),
        "material law": found["linear"] - solid,
        "solid mesh": step("bodies", 2),
        "penalty": found["free"] - solid,
        "load steps": found["careful"] - solid,
    }
    return Budget(
        scene=scene.name,
        total=dict(zip(names, (beams - solid) / rod, strict=True)),
        parts={q: {name: part[k] / rod[k] for name, part in parts.items()} for k, q in enumerate(names)},
    )


def _values(case: Case) -> Values:
    """Return the quantities of a case; nan where a value is small against the largest of its kind."""
    response = solve(case.scene, case.model, case.options)
    if not response.completed:
        raise ModelError(f"the budget's {case.model} stopped: {response.message}")
    held = {item.node for item in case.scene.all_supports if "rotation" in item.held}
    acting = {name: size(values) for name, values in forces(response).items()}
    kinds = {
        f"{'contact' if response.contacts else 'support'}_force": acting,
        "arc_position": QUANTITIES["arc"].read(response),
        "clamp_moment": {node: values for node, values in moments(response).items() if node in held},
    }
    ks = [int(np.argmin(np.abs(response.load_parameter - t))) for t in TIMES]
    found = {}
    for kind, columns in kinds.items():
        largest = np.nanmax(np.abs(list(columns.values())), initial=0.0)
        for name, values in columns.items():
            seen = np.abs(values[ks]) > LEAST * largest
            found[f"{kind} {name}" if len(columns) > 1 else kind] = np.where(seen, values[ks], np.nan)
    return found


def budget_rows(budget: Budget) -> Iterator[dict[str, Any]]:
    """Yield one row for every quantity and load parameter with a value: total, parts and rest."""
    for quantity, total in budget.total.items():
        rest = budget.rest(quantity)
        for k in np.flatnonzero(~np.isnan(total)):
            yield {
                "quantity": quantity,
                "load_parameter": TIMES[k],
                "total": float(total[k]),
                "parts": {name: float(values[k]) for name, values in budget.parts[quantity].items()},
                "rest_over_total": float(rest[k]),
            }

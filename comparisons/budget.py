"""The error budget of beams against the solid: the parts of their difference, each measured by itself.

With n the TSM elements, h the solid's mesh and eps its penalty,

    q_TSM(n) - q_solid(h, eps) = [TSM mesh] + [TSM theory] + [solid beside the rod] + [material law]
                                 + [solid mesh] + [penalty] + [load steps] + rest.

Each part is extrapolated from runs that differ in one setting only. The sum of the parts is therefore not the difference by
construction, and the rest is a measured number.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from comparisons.models import ROD, SOLID, TSM, solve
from comparisons.models.options import ModelError, Options
from comparisons.models.progress import Count, uncounted
from comparisons.quantities import forces, moments, size
from comparisons.response import Array, Response
from comparisons.scene import Scene

TIMES = (0.25, 0.5, 0.75, 1.0)
"""Load parameters of the budget."""
STEPS = 20
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
BIOT = "biot-linear"
Values = Mapping[str, Array]
"""Values at the load parameters `TIMES`, shape (4,), by quantity."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Budget:
    """The difference of TSM and solid and its parts, relative to the exact rods' value at the same load parameter.

    Attributes
    ----------
    scene : str
        Name.
    total : dict of ndarray, shape (4,)
        ``(q_TSM - q_solid) / q_rod`` by quantity, at the load parameters `TIMES`; nan where the rods' value is zero or the pair is open.
    parts : dict of dict of ndarray, shape (4,)
        By quantity and part.
    """

    scene: str
    total: Values
    parts: dict[str, Values]

    def rest(self, quantity: str) -> Array:
        """Difference that the parts do not explain, over the total."""
        total = self.total[quantity]
        explained: Array = np.sum(list(self.parts[quantity].values()), axis=0)
        return np.asarray((total - explained) / total)


SOLUTIONS = 10
"""Solutions behind a budget."""


def error_budget(scene: Scene, count: Count = uncounted) -> Budget:
    """Measure the budget of a scene that beams and solid state; `count` receives every solution.

    The quantities are the forces and arc positions of all contact pairs, or the forces of the supports in a scene without contact,
    and the moments of the supports.

    Raises
    ------
    ModelError
        If the solid cannot state the scene, a solution behind the budget stops, or no quantity has a value.
    """
    done = 0

    def values(scene: Scene, model: str, options: Options | None = None) -> Values:
        nonlocal done
        found = _values(scene, model, options)
        done += 1
        count(done, SOLUTIONS)
        return found

    short = replace(scene, load_parameters=STEPS)
    rod = values(short, ROD.name)
    quantities = tuple(name for name, values in rod.items() if np.isfinite(values).any())
    if not quantities:
        raise ModelError(
            "the budget is relative to the exact rods, which have no force at its load parameters"
        )
    coarse, fine = (values(short, TSM.name, Options(elements=n)) for n in (ELEMENTS, 2 * ELEMENTS))
    solid, finer = values(short, SOLID.name), values(_refined(short), SOLID.name)
    augmented = values(_augmented(short), SOLID.name)
    careful = values(replace(short, load_parameters=2 * STEPS), SOLID.name)
    biot = replace(short, beams=tuple(replace(beam, material=BIOT) for beam in short.beams))
    like_rod, finer_like_rod = (values(_augmented(one), SOLID.name) for one in (biot, _refined(biot)))
    linear = values(biot, SOLID.name)
    parts: dict[str, Callable[[str], Array]] = {
        "TSM mesh": lambda q: -_step(coarse, fine, q, order=4),
        "TSM theory": lambda q: coarse[q] + _step(coarse, fine, q, order=4) - rod[q],
        "solid beside the rod": lambda q: rod[q] - like_rod[q] - _step(like_rod, finer_like_rod, q, order=2),
        "material law": lambda q: linear[q] - solid[q],
        "solid mesh": lambda q: _step(solid, finer, q, order=2),
        "penalty": lambda q: augmented[q] - solid[q],
        "load steps": lambda q: careful[q] - solid[q],
    }
    assert tuple(parts) == tuple(PARTS), "every part is explained"
    assert done == SOLUTIONS, "every solution is counted"
    return Budget(
        scene=scene.name,
        total={q: (coarse[q] - solid[q]) / rod[q] for q in quantities},
        parts={q: {name: part(q) / rod[q] for name, part in parts.items()} for q in quantities},
    )


def _step(coarse: Values, fine: Values, quantity: str, *, order: int) -> Array:
    """Estimate the limit minus the coarse answer, from the answer at half the element length (Richardson)."""
    step: Array = (fine[quantity] - coarse[quantity]) / (1.0 - 2.0**-order)
    return step


def _values(scene: Scene, model: str, options: Options | None = None) -> Values:
    """Return the quantities of a model's response; nan where a value is small against the largest of its kind."""
    response = solve(scene, model, options)
    if not response.completed:
        raise ModelError(f"the budget's {model} stopped: {response.message}")
    ks = [int(np.argmin(np.abs(response.load_parameter - t))) for t in TIMES]
    found = {}
    for kind, columns in _kinds(response, scene).items():
        largest = max((float(np.abs(values).max(initial=0.0)) for values in columns.values()), default=0.0)
        for name, values in columns.items():
            seen = np.abs(values[ks]) > LEAST * largest
            found[f"{kind} {name}" if len(columns) > 1 else kind] = np.where(seen, values[ks], np.nan)
    return found


def _kinds(response: Response, scene: Scene) -> dict[str, Values]:
    """Return the histories of all quantities by kind, and by pair or supported end."""
    acting = {name: size(values) for name, values in forces(response).items()}
    held = {item.node for item in scene.all_supports if "rotation" in item.held}
    turning = {node: values for node, values in moments(response).items() if node in held}
    if not response.contacts:
        return {"support_force": acting, "clamp_moment": turning}
    arcs = {pair: contact.arc_position for pair, contact in response.contacts.items()}
    return {"contact_force": acting, "arc_position": arcs, "clamp_moment": turning}


def _refined(scene: Scene) -> Scene:
    return replace(
        scene,
        beams=tuple(replace(beam, mesh=(2 * beam.mesh[0], 2 * beam.mesh[1])) for beam in scene.beams),
    )


def _augmented(scene: Scene) -> Scene:
    contacts = tuple(replace(contact, penalty=None, penetration=1e-12) for contact in scene.contacts)
    return replace(scene, contacts=contacts)


def budget_rows(budget: Budget) -> Iterator[dict[str, Any]]:
    """Yield one row for every quantity and load parameter with a value: total, parts and rest."""
    for quantity, total in budget.total.items():
        rest = budget.rest(quantity)
        for k, t in enumerate(TIMES):
            if np.isnan(total[k]):
                continue
            yield {
                "quantity": quantity,
                "load_parameter": t,
                "total": float(total[k]),
                "parts": {name: float(values[k]) for name, values in budget.parts[quantity].items()},
                "rest_over_total": float(rest[k]),
            }

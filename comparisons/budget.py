"""The error budget of beams against the solid: the parts of their difference, each measured by itself.

With n the TSM elements, h the solid's mesh and eps its penalty,

    q_TSM(n) - q_solid(h, eps) = [TSM mesh] + [TSM theory] + [solid beside the rod] + [material law]
                                 + [solid mesh] + [penalty] + [load steps] + rest.

Each part is extrapolated from runs that differ in one setting only. The sum of the parts is therefore not the difference by
construction, and the rest is a measured number.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.models import ROD, TSM, solve
from comparisons.models.options import ModelError, Options
from comparisons.models.translate import to_rod, to_solid
from comparisons.response import Array
from comparisons.scene import Scene

if TYPE_CHECKING:
    from fem_reference import SolidProblem

TIMES = (0.25, 0.5, 0.75, 1.0)
"""Load parameters of the budget."""
STEPS = 20
"""Load steps of the solutions that the budget is computed from; the part for load steps compares with twice as many."""
ELEMENTS = 20
"""TSM elements, of the type `mixed`."""
QUANTITIES = ("contact_force", "arc_position", "clamp_moment")
PARTS = {
    "TSM mesh": "20 elements against their limit, extrapolated with fourth order from 20 and 40",
    "TSM theory": "that limit against the exact Reissner rod",
    "solid beside the rod": "the rod against the limit of the solid with the rod's law, linear in Biot's strain, and no penetration",
    "material law": "the law linear in Biot's strain against the scene's",
    "solid mesh": "the limit against the scene's mesh, extrapolated with second order from that and one twice as fine",
    "penalty": "no penetration, by augmented Lagrangian steps, against the scene's penalty",
    "load steps": "twice as many load parameters and a hundredth of the tolerance",
}
"""The parts and what each measures."""
BIOT = "biot-linear"


@dataclass(frozen=True, kw_only=True, eq=False)
class Budget:
    """The difference of TSM and solid and its parts, relative to the exact rod's value at the same load parameter.

    Attributes
    ----------
    scene : str
        Name.
    total : dict of ndarray, shape (4,)
        ``(q_TSM - q_solid) / q_rod`` by quantity, at the load parameters `TIMES`.
    parts : dict of dict of ndarray, shape (4,)
        By quantity and part.
    """

    scene: str
    total: dict[str, Array]
    parts: dict[str, dict[str, Array]]

    def rest(self, quantity: str) -> Array:
        """Difference that the parts do not explain, over the total."""
        total = self.total[quantity]
        explained: Array = np.sum(list(self.parts[quantity].values()), axis=0)
        return np.asarray((total - explained) / total)


Values = dict[str, Array]


def error_budget(scene: Scene) -> Budget:
    """Measure the budget of a scene with one cantilever under one pin.

    Raises
    ------
    ModelError
        If a model cannot state the scene, or a solution behind the budget stops.
    """
    contact = to_rod(scene).contact
    if contact is None:
        raise ModelError("the budget is that of a contact, the scene has none")
    short = replace(scene, load_parameters=STEPS)
    problem = to_solid(short)
    rod = _response(short, ROD.name, Options())
    if not all(np.all(np.isfinite(values) & (values != 0)) for values in rod.values()):
        raise ModelError("the budget is relative to the exact rod, which is not in contact all the time")
    coarse, fine = (_response(short, TSM.name, Options(elements=n)) for n in (ELEMENTS, 2 * ELEMENTS))
    solid, finer = _solid(problem), _solid(_refined(problem))
    augmented, careful = _solid(_augmented(problem)), _solid(problem, careful=True)
    biot = _with(problem, BIOT)
    like_rod, finer_like_rod = (_solid(_augmented(one)) for one in (biot, _refined(biot)))
    linear = _solid(biot)
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
    return Budget(
        scene=scene.name,
        total={q: (coarse[q] - solid[q]) / rod[q] for q in QUANTITIES},
        parts={q: {name: part(q) / rod[q] for name, part in parts.items()} for q in QUANTITIES},
    )


def _step(coarse: Values, fine: Values, quantity: str, *, order: int) -> Array:
    """Estimate the limit minus the coarse answer, from the answer at half the element length (Richardson)."""
    step: Array = (fine[quantity] - coarse[quantity]) / (1.0 - 2.0**-order)
    return step


def _response(scene: Scene, model: str, options: Options) -> Values:
    response = solve(scene, model, options)
    if not response.completed:
        raise ModelError(f"the budget's {model} stopped: {response.message}")
    contact, support = response.contacts[scene.contacts[0].pair], response.supports[scene.beams[0].name]
    return _at_times(response.load_parameter, (contact.force, contact.arc_position, support.moment))


def _solid(problem: "SolidProblem", *, careful: bool = False) -> Values:
    import fem_reference

    steps = 2 * STEPS if careful else STEPS
    settings = fem_reference.Settings(tolerance=1e-11) if careful else fem_reference.Settings()
    result = fem_reference.solve(problem, np.arange(1, steps + 1) / steps, settings, throw=False)
    if result.status is not fem_reference.Status.COMPLETED:
        raise ModelError(f"the budget's solid stopped: {result.message}")
    contact, support = (next(iter(table.values())) for table in (result.contacts, result.supports))
    return _at_times(result.load_parameter, (contact.force, contact.arc_position, support.moment))  # type: ignore[attr-defined]


def _at_times(load_parameter: Array, histories: tuple[Array, ...]) -> Values:
    ks = [int(np.argmin(np.abs(load_parameter - t))) for t in TIMES]
    return {name: history[ks] for name, history in zip(QUANTITIES, histories, strict=True)}


def _with(problem: "SolidProblem", material: str) -> "SolidProblem":
    return replace(problem, strips=(replace(problem.strips[0], material=material),))


def _refined(problem: "SolidProblem") -> "SolidProblem":
    nx, ny = problem.strips[0].mesh
    return replace(problem, strips=(replace(problem.strips[0], mesh=(2 * nx, 2 * ny)),))


def _augmented(problem: "SolidProblem") -> "SolidProblem":
    return replace(problem, contacts=(replace(problem.contacts[0], penetration=1e-12),))


def budget_rows(budget: Budget) -> Iterator[dict[str, Any]]:
    """Yield one row for every quantity and load parameter: total, parts and rest."""
    for quantity in QUANTITIES:
        rest = budget.rest(quantity)
        for k, t in enumerate(TIMES):
            yield {
                "quantity": quantity,
                "load_parameter": t,
                "total": float(budget.total[quantity][k]),
                "parts": {name: float(values[k]) for name, values in budget.parts[quantity].items()},
                "rest_over_total": float(rest[k]),
            }

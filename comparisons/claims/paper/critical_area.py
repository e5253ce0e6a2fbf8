"""Fig. 7b: how near to a beam node each element formulation finds equilibrium, and why not nearer.

Two measurements: the smallest l_i/l with equilibrium before every beam node, by starting position and tolerance, and the
floor of the unbalanced force against l_i/l, which no tolerance can pass.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from comparisons.claims.paper import turned_frame
from comparisons.claims.paper.approach import approaches
from comparisons.claims.paper.force_floor import force_floor
from comparisons.claims.paper.formulations import FORMULATIONS
from comparisons.models.tsm import to_structure
from comparisons.response import Array
from comparisons.scene import load_scene
from tsm.elements import EULER_BERNOULLI_CANTILEVER, EULER_BERNOULLI_SIMPLE, TIMOSHENKO

Report = Callable[[str], None]

SCENE = "cantilever-critical-area"
STARTS = (4.05, 4.1, 4.2, 4.3, 4.35, 4.4)
"""The paper's starting positions of the pin [m]."""
PRINTED = {
    EULER_BERNOULLI_SIMPLE.name: (0.07749, 0.12952),
    EULER_BERNOULLI_CANTILEVER.name: (0.02164, 0.03865),
    TIMOSHENKO.name: (0.00067, 0.00501),
}
"""The ranges of the critical area in [P] section 4.1."""
TOLERANCES = (1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
SHOWN_TOLERANCE = 1e-10
"""Tolerance of the curves against displacement."""
RATIOS = 10.0 ** -np.arange(1.0, 16.5, 0.5)
FITTED = (1e-13, 1e-2)
"""Ratios of the fitted slopes: below, a ratio has no digits left; above, it is no small one."""
PSI = 9.0
"""EI/(G A_e l0^2) in section 4.1."""
PRINTED_SHEAR_PSI = 4.5e-9
"""The same in section 4.2 with its printed shear modulus and 20 elements."""

_ENDS: tuple[Literal["start"], Literal["end"]] = ("start", "end")
_FLOOR_CASES = (
    *((formulation.element, end, PSI) for formulation in FORMULATIONS for end in _ENDS),
    *((turned_frame.NAME, end, PSI) for end in _ENDS),
    (TIMOSHENKO.name, _ENDS[1], PRINTED_SHEAR_PSI),
)


@dataclass(frozen=True, kw_only=True, eq=False)
class Measured:
    """The way of the contact to one beam node.

    Attributes
    ----------
    element : str
        Formulation.
    start : float
        Starting position of the pin [m].
    tolerance : float
        Tolerance of Newton's method.
    node : float
        Arc position of the beam node or the tip [m].
    displacement, ratio : ndarray, shape (k,)
        Displacement of the pin [m] and l_i/l at the equilibria found.
    smallest : float
        Smallest ratio, the critical area; nan where no equilibrium was found in the element.
    """

    element: str
    start: float
    tolerance: float
    node: float
    displacement: Array
    ratio: Array
    smallest: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Floor:
    """Floor of the unbalanced force over `RATIOS`, relative to the contact force, at one end of the element.

    Attributes
    ----------
    element, end : str
        Formulation, and which end of the element is near.
    psi : float
        EI/(G A_e l0^2).
    floor : ndarray
        Median over random states.
    slope : float
        Slope of the straight line fitted to the logarithms; nan at `PRINTED_SHEAR_PSI`, where one line does not fit.
    """

    element: str
    end: str
    psi: float
    floor: Array
    slope: float


@dataclass(frozen=True, kw_only=True, eq=False)
class CriticalAreas:
    """What Fig. 7b shows."""

    tolerances: tuple[float, ...]
    measured: tuple[Measured, ...]
    floors: tuple[Floor, ...]

    def areas(self, element: str, tolerance: float) -> Array:
        """Critical areas of all nodes and starting positions; 1, the whole element, where nothing was found in it."""
        found = [
            one.smallest for one in self.measured if (one.element, one.tolerance) == (element, tolerance)
        ]
        areas: Array = np.nan_to_num(np.array(found), nan=1.0)
        return areas

    def median(self, element: str, tolerance: float) -> float:
        """Median of `areas`."""
        return float(np.median(self.areas(element, tolerance)))

    def tolerance_for(self, element: str, area: float) -> float:
        """Tolerance at which the median is `area`, interpolated in logarithms; nan outside what was measured."""
        medians = np.log([max(self.median(element, tolerance), 1e-300) for tolerance in self.tolerances])
        if not medians.min() <= np.log(area) <= medians.max():
            return np.nan
        order = np.argsort(medians)
        return float(np.exp(np.interp(np.log(area), medians[order], np.log(self.tolerances)[order])))

    def slopes(self, element: str) -> tuple[float, ...]:
        """Fitted slopes of the floor in section 4.1, one per end of the element."""
        return tuple(one.slope for one in self.floors if (one.element, one.psi) == (element, PSI))


def critical_areas(*, quick: bool, report: Report) -> CriticalAreas:
    """Measure both; `quick` takes fewer starting positions, tolerances and samples."""
    starts = STARTS[::4] if quick else STARTS
    tolerances = TOLERANCES[::3] if quick else TOLERANCES
    measured: list[Measured] = []
    for tolerance in tolerances:
        report(f"approach to the nodes at tolerance {tolerance:.0e}")
        for formulation in FORMULATIONS:
            for start in starts:
                measured += _measure(formulation.element, start, tolerance)
    report("floor of the unbalanced force")
    floors = tuple(_floors(samples=8 if quick else 50))
    return CriticalAreas(tolerances=tolerances, measured=tuple(measured), floors=floors)


def _measure(element: str, start: float, tolerance: float) -> Iterable[Measured]:
    scene = load_scene(SCENE)
    pin = replace(scene.pins[0], start=(start, 0.0))
    travel = abs(pin.points[1][1])
    for way in approaches(to_structure(replace(scene, pins=(pin,)), element=element), tolerance):
        yield Measured(
            element=element,
            start=start,
            tolerance=tolerance,
            node=way.node,
            displacement=way.load_parameter * travel,
            ratio=way.ratio,
            smallest=way.smallest,
        )


def _floors(samples: int) -> Iterable[Floor]:
    middle, half = np.log(FITTED).mean(), np.log(FITTED[1] / FITTED[0]) / 2.0
    fitted = np.abs(np.log(RATIOS) - middle) < half + 1e-9
    for element, end, psi in _FLOOR_CASES:
        floor = np.array([force_floor(element, ratio, end=end, Psi=psi, samples=samples) for ratio in RATIOS])
        slope = np.polyfit(np.log(RATIOS[fitted]), np.log(floor[fitted]), 1)[0]
        yield Floor(
            element=element, end=end, psi=psi, floor=floor, slope=float(slope) if psi == PSI else np.nan
        )

"""Cases of frames that snap through: limit loads, by arc-length control."""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from comparisons.claims.manual.models import ANSWER, EXACT, FOURTH, SECOND, Model, mixed, paper, trial
from comparisons.claims.manual.peaks import summit
from comparisons.claims.manual.record import Answer, Curve, Picture, Problem, Quantity, StoppedError, Trial
from comparisons.exact.chain import Chain, load_path
from comparisons.models.translate import to_structure
from comparisons.response import Array
from comparisons.scene import BeamSpec, LoadSpec, Scene, SupportSpec


@dataclass(frozen=True, kw_only=True)
class Path:
    """A frame's path under its load, how it is followed and drawn.

    Attributes
    ----------
    scene : Scene
        With one load.
    arc_length, steps : float, int
        For `tsm.trace`.
    limits : int
        Number of limit points that are read.
    unit : float
        What a load parameter is multiplied by.
    highest : float
        Load at which the drawing ends.
    """

    scene: Scene
    arc_length: float
    steps: int
    limits: int
    unit: float
    highest: float

    def trial(self, model: Model, tolerance: float, reason: str) -> Trial:
        """Return the trial that follows the path and reads its limit points."""
        return trial(model, tolerance, reason, lambda: self._followed(model))

    def _followed(self, model: Model) -> Answer:
        import tsm

        structure = to_structure(self.scene, elements=model.options.elements, element=model.options.element)
        result = tsm.trace(structure, arc_length=self.arc_length, steps=self.steps, throw=False)
        found = [event.load_parameter for event in result.events if event.kind is tsm.EventKind.LIMIT_POINT]
        if len(found) < self.limits:
            raise StoppedError(
                f"{result.status.name}: {result.message}; {len(found)} limit points of {self.limits}"
            )
        load = self.unit * np.append(0.0, result.load_parameter)
        end = int(np.argmax(np.append(load > self.highest, True)))
        joint = self.scene.loads[0]
        start = self.scene.place(joint.node)[1]
        down = np.append(0.0, start - result.tips[joint.beam][:, 1])
        curve = Curve(style=model.name, points=np.stack([down, load], axis=1)[:end])
        return Answer(values=tuple(self.unit * value for value in found[: self.limits]), curves=(curve,))


CLOSED = "no mesh error: what is left are the tolerances of Newton's method and of the integration (1e-9)"
COUPLED = (
    "Reissner rods, rigidly joined, by shooting with spectral collocation at prescribed deflections (comparisons.exact.chain, which "
    "shares nothing with the models); the limit is read off a polynomial through eleven deflections around it"
)
LEE_UNIT = 120.0**2 / 1440.0
"""L^2/EI [1/kN]."""


def lee_scene() -> Scene:
    """Return Lee's frame."""
    section: dict[str, Any] = {
        "area": 6.0,
        "second_moment": 2.0,
        "youngs_modulus": 720.0,
        "shear_modulus": 7.2e8,
    }
    corner, loaded = (0.0, 120.0), (24.0, 120.0)
    return Scene(
        name="lees-frame",
        units="kN, cm",
        load_parameters=1,
        beams=(
            BeamSpec(name="column", start=(0.0, 0.0), end=corner, **section),
            BeamSpec(name="near", start=corner, end=loaded, **section),
            BeamSpec(name="far", start=loaded, end=(120.0, 120.0), **section),
        ),
        supports=(
            SupportSpec(beam="column", end="start", kind="pinned"),
            SupportSpec(beam="far", end="end", kind="pinned"),
        ),
        loads=(LoadSpec(beam="near", end="end", force=(0.0, -0.1)),),
    )


def toggle_scene() -> Scene:
    """Return Williams' toggle."""
    section: dict[str, Any] = {
        "youngs_modulus": 1.03e7,
        "area": 1.885e6 / 1.03e7,
        "second_moment": 9274.0 / 1.03e7,
        "shear_modulus": 1.03e11,
    }
    apex = (12.94328, 0.386)
    return Scene(
        name="williams-toggle",
        units="lb, in",
        load_parameters=1,
        beams=(
            BeamSpec(name="left", start=(0.0, 0.0), end=apex, clamped=("start",), **section),
            BeamSpec(name="right", start=apex, end=(25.88656, 0.0), clamped=("end",), **section),
        ),
        loads=(LoadSpec(beam="left", end="end", force=(0.0, -1.0)),),
    )


@cache
def exact_path(scene: Scene, deflections: tuple[float, ...]) -> Array:
    """Return deflections of a frame's loaded joint and its load there, columns of one array, by exact rods."""
    first, loaded = scene.beams[0], scene.loads[0]
    chain = Chain(
        joints=(first.start, *(beam.end for beam in scene.beams)),
        loaded=1 + [beam.name for beam in scene.beams].index(loaded.beam),
        clamped=bool(first.clamped),
        EA=first.EA,
        GA=first.GA,
        EI=first.EI,
    )
    return np.stack([np.array(deflections), load_path(chain, deflections)], axis=1)


LEE_DOWN = (*np.linspace(3.0, 45.0, 15).tolist(), *np.linspace(46.0, 51.5, 12).tolist())
"""Deflections of Lee's frame [cm], closer around its limit point."""
TOGGLE_DOWN = tuple((np.arange(1, 52) / 100.0).tolist())
"""Deflections of Williams' toggle [in]."""


def lee_limit() -> float:
    """Return ``P L^2/EI`` of Lee's frame at its limit point, by exact rods."""
    down, load = exact_path(lee_scene(), LEE_DOWN).T
    return LEE_UNIT * summit(down, load)[0]


def toggle_limits() -> tuple[float, float]:
    """Return the greatest load of Williams' toggle and the least one after it [lb], by exact rods."""
    down, load = exact_path(toggle_scene(), TOGGLE_DOWN).T
    return summit(down[:32], load[:32])[0], -summit(down[26:], -load[26:])[0]


def lee() -> Problem:
    """Lee's frame."""
    scene = lee_scene()
    path = Path(scene=scene, arc_length=0.3, steps=60, limits=1, unit=0.1 * LEE_UNIT, highest=20.0)
    return Problem(
        name="lees-frame",
        title="Lee's frame snaps through",
        statement="A column and a girder, 120 cm each, rigidly joined, hinged at their far ends; E = 720 kN/cm^2, A = 6 cm^2, I = 2 cm^4, rigid in "
        "shear. A dead load P presses the girder down 24 cm from the corner.",
        source=f"{COUPLED}; the frame is that of Lee, Manuel and Rossow, Journal of the Engineering Mechanics Division, ASCE 94 (1968), 521-547",
        quantities=(Quantity(name="P L^2/EI at the limit point", exact=lee_limit()),),
        trials=(
            path.trial(EXACT, 1e-8, CLOSED),
            path.trial(mixed(8), 1e-5, FOURTH),
            path.trial(paper(15), 1e-2, SECOND),
        ),
        picture=Picture(
            axes=("deflection under the load [cm]", "P L^2/EI"),
            curves=(Curve(style=ANSWER, points=exact_path(scene, LEE_DOWN) * [1.0, LEE_UNIT]),),
            shape=False,
        ),
    )


def toggle() -> Problem:
    """Williams' toggle."""
    scene = toggle_scene()
    path = Path(scene=scene, arc_length=0.01, steps=60, limits=2, unit=1.0, highest=70.0)
    greatest, least = toggle_limits()
    return Problem(
        name="williams-toggle",
        title="Williams' toggle: two limit loads",
        statement="Two beams clamped at their outer ends meet at an apex, half span 12.94328 in, rise .386 in; EA = 1.885e6 lb, EI = 9274 lb in^2, "
        "rigid in shear. A dead load presses the apex down.",
        source=f"{COUPLED}; the frame is that of Williams, Quarterly Journal of Mechanics and Applied Mathematics 17 (1964), 451-469",
        quantities=(
            Quantity(name="greatest load [lb]", exact=greatest),
            Quantity(name="least load after it [lb]", exact=least),
        ),
        trials=(
            path.trial(EXACT, 1e-8, CLOSED),
            path.trial(mixed(8), 1e-4, FOURTH),
            path.trial(paper(15), 1e-2, SECOND),
        ),
        picture=Picture(
            axes=("deflection of the apex [in]", "load [lb]"),
            curves=(Curve(style=ANSWER, points=exact_path(scene, TOGGLE_DOWN)),),
            shape=False,
        ),
    )

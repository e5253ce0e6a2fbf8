"""Cases of frames that snap through: limit loads, by arc-length control."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from comparisons.manual.models import EXACT, SECOND, Model, mixed, paper, trial
from comparisons.manual.record import Answer, Curve, Picture, Problem, Quantity, StoppedError, Trial
from comparisons.scene import BeamSpec, LoadSpec, Scene, SupportSpec
from comparisons.translate import to_structure


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


LEE_LIMIT = 18.557
"""``P L^2/EI`` of Lee's frame at its limit point: Lee, Manuel and Rossow (1968)."""
TOGGLE_LIMITS = (33.87, 31.28)
"""Greatest and then least load [lb] of Williams' toggle: Wood and Zienkiewicz (1977)."""


def lee() -> Problem:
    """Lee's frame."""
    section: dict[str, Any] = {
        "area": 6.0,
        "second_moment": 2.0,
        "youngs_modulus": 720.0,
        "shear_modulus": 7.2e8,
    }
    corner, loaded = (0.0, 120.0), (24.0, 120.0)
    scene = Scene(
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
    unit = 0.1 * 120.0**2 / 1440.0
    path = Path(scene=scene, arc_length=0.3, steps=60, limits=1, unit=unit, highest=20.0)
    digits = "the digits of the source"
    return Problem(
        name="lees-frame",
        title="Lee's frame snaps through",
        statement="A column and a girder, 120 cm each, rigidly joined, hinged at their far ends; E = 720 kN/cm^2, A = 6 cm^2, I = 2 cm^4, rigid in "
        "shear. A dead load P presses the girder down 24 cm from the corner.",
        source="Lee, Manuel and Rossow, Journal of the Engineering Mechanics Division, ASCE 94 (1968), 521-547",
        quantities=(Quantity(name="P L^2/EI at the limit point", exact=LEE_LIMIT),),
        trials=(
            path.trial(EXACT, 5e-5, digits),
            path.trial(mixed(8), 5e-5, f"{digits}; fourth order: 4 elements a beam leave 6e-5"),
            path.trial(paper(15), 1e-2, SECOND),
        ),
        picture=Picture(axes=("deflection under the load [cm]", "P L^2/EI"), shape=False),
    )


def toggle() -> Problem:
    """Williams' toggle."""
    section: dict[str, Any] = {
        "youngs_modulus": 1.03e7,
        "area": 1.885e6 / 1.03e7,
        "second_moment": 9274.0 / 1.03e7,
        "shear_modulus": 1.03e11,
    }
    apex = (12.94328, 0.386)
    scene = Scene(
        name="williams-toggle",
        units="lb, in",
        load_parameters=1,
        beams=(
            BeamSpec(name="left", start=(0.0, 0.0), end=apex, clamped=("start",), **section),
            BeamSpec(name="right", start=apex, end=(25.88656, 0.0), clamped=("end",), **section),
        ),
        loads=(LoadSpec(beam="left", end="end", force=(0.0, -1.0)),),
    )
    path = Path(scene=scene, arc_length=0.01, steps=60, limits=2, unit=1.0, highest=70.0)
    digits = "the digits of the source, by finite elements"
    return Problem(
        name="williams-toggle",
        title="Williams' toggle: two limit loads",
        statement="Two beams clamped at their outer ends meet at an apex, half span 12.94328 in, rise .386 in; EA = 1.885e6 lb, EI = 9274 lb in^2, "
        "rigid in shear. A dead load presses the apex down.",
        source="Williams, Quarterly Journal of Mechanics and Applied Mathematics 17 (1964), 451-469; the values of Wood and Zienkiewicz, "
        "Computers and Structures 7 (1977), 725-735",
        quantities=(
            Quantity(name="greatest load [lb]", exact=TOGGLE_LIMITS[0]),
            Quantity(name="least load after it [lb]", exact=TOGGLE_LIMITS[1]),
        ),
        trials=(
            path.trial(EXACT, 3e-4, digits),
            path.trial(mixed(8), 3e-4, digits),
            path.trial(paper(15), 1e-2, SECOND),
        ),
        picture=Picture(axes=("deflection of the apex [in]", "load [lb]"), shape=False),
    )

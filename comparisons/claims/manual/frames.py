"""Cases of frames that snap through: limit loads, by arc-length control."""

from dataclasses import dataclass

import numpy as np

from comparisons.claims.claim import Quantity, StoppedError
from comparisons.claims.manual.models import (
    ANSWER,
    EXACT,
    FOURTH,
    SECOND,
    Model,
    mixed,
    on_scene,
    paper,
    trial,
    undeformed,
)
from comparisons.claims.manual.record import Curve, Measured, Picture, Problem, Trial
from comparisons.claims.manual.scenes import MM
from comparisons.claims.problems.frames import (
    LEE_FORCE,
    LEE_LIMIT,
    LEE_UNIT,
    PORTAL_SWAY,
    TOGGLE_FORCE,
    TOGGLE_LIMITS,
    under_load,
)
from comparisons.models.tsm import to_structure
from comparisons.response import Response
from comparisons.scene import Scene, load_scene


@dataclass(frozen=True, kw_only=True)
class Path:
    """A frame's path under a dead load in place of the support that presses it, how it is followed and drawn.

    Attributes
    ----------
    force : float
        The load at load parameter 1.
    arc_length, steps : float, int
        For `tsm.trace`.
    limits : int
        Number of limit points that are read.
    unit : float
        What a load parameter is multiplied by.
    highest : float
        Load at which the drawing ends.
    """

    force: float
    arc_length: float
    steps: int
    limits: int
    unit: float
    highest: float

    def trial(self, model: Model, tolerance: float, reason: str) -> Trial:
        """Return the trial that follows the path and reads its limit points."""
        return trial(model, tolerance, reason, lambda scene: self._followed(scene, model))

    def _followed(self, scene: Scene, model: Model) -> Measured:
        import tsm

        loaded = under_load(scene, self.force)
        structure = to_structure(loaded, elements=model.options.elements, element=model.options.element)
        result = tsm.trace(structure, arc_length=self.arc_length, steps=self.steps, throw=False)
        found = [event.load_parameter for event in result.events if event.kind is tsm.EventKind.LIMIT_POINT]
        if len(found) < self.limits:
            raise StoppedError(
                f"{result.status.name}: {result.message}; {len(found)} limit points of {self.limits}"
            )
        load = self.unit * np.append(0.0, result.load_parameter)
        end = int(np.argmax(np.append(load > self.highest, True)))
        joint = loaded.loads[0]
        start = loaded.place(joint.node)[1]
        down = np.append(0.0, start - result.tips[joint.beam][:, 1])
        curve = Curve(style=model.name, points=np.stack([down, load], axis=1)[:end])
        return Measured(values=tuple(self.unit * value for value in found[: self.limits]), curves=(curve,))


CLOSED = "no mesh error: what is left are the tolerances of Newton's method and of the integration (1e-9)"
COUPLED = (
    "Reissner rods, rigidly joined, by shooting with spectral collocation at prescribed deflections (tests/oracles/frames.py, which "
    "shares nothing with the models)"
)


def _level(load: float, width: float) -> Curve:
    """Return the line of a limit load."""
    return Curve(style=ANSWER, points=np.array([[0.0, load], [width, load]]))


def lee() -> Problem:
    """Lee's frame."""
    path = Path(force=LEE_FORCE, arc_length=0.3, steps=60, limits=1, unit=LEE_FORCE * LEE_UNIT, highest=20.0)
    return Problem(
        name="lees-frame",
        title="Lee's frame snaps through",
        purpose="A limit point of the load in a frame, with large rotations before it.",
        uncertainty=1e-10,
        scene=load_scene("lees-frame"),
        statement="A column and a girder, 120 cm each, rigidly joined, hinged at their far ends; E = 720 kN/cm^2, A = 6 cm^2, I = 2 cm^4, rigid in "
        "shear. A dead load P presses the girder down 24 cm from the corner.",
        source=f"{COUPLED}; the frame is that of Lee, Manuel and Rossow, Journal of the Engineering Mechanics Division, ASCE 94 (1968), 521-547",
        quantities=(Quantity(name="P L^2/EI at the limit point", exact=LEE_LIMIT),),
        trials=(
            path.trial(EXACT, 1e-8, CLOSED),
            path.trial(mixed(8), 1e-5, FOURTH),
            path.trial(paper(15), 1e-2, SECOND),
        ),
        picture=Picture(
            axes=("deflection under the load [cm]", "P L^2/EI"),
            curves=(_level(LEE_LIMIT, 50.0),),
            shape=False,
        ),
    )


def toggle() -> Problem:
    """Williams' toggle."""
    path = Path(force=TOGGLE_FORCE, arc_length=0.01, steps=60, limits=2, unit=1.0, highest=70.0)
    return Problem(
        name="williams-toggle",
        title="Williams' toggle: two limit loads",
        purpose="Two limit points of the load in a shallow frame, where stretch and bending are of one size.",
        uncertainty=1e-10,
        scene=load_scene("williams-toggle"),
        statement="Two beams clamped at their outer ends meet at an apex, half span 12.94328 in, rise .386 in; EA = 1.885e6 lb, EI = 9274 lb in^2, "
        "rigid in shear. A dead load presses the apex down.",
        source=f"{COUPLED}; the frame is that of Williams, Quarterly Journal of Mechanics and Applied Mathematics 17 (1964), 451-469",
        quantities=(
            Quantity(name="greatest load [lb]", exact=TOGGLE_LIMITS[0]),
            Quantity(name="least load after it [lb]", exact=TOGGLE_LIMITS[1]),
        ),
        trials=(
            path.trial(EXACT, 1e-8, CLOSED),
            path.trial(mixed(8), 1e-4, FOURTH),
            path.trial(paper(15), 1e-2, SECOND),
        ),
        picture=Picture(
            axes=("deflection of the apex [in]", "load [lb]"),
            curves=tuple(_level(limit, 0.5) for limit in TOGGLE_LIMITS),
            shape=False,
        ),
    )


def portal() -> Problem:
    """Portal frame under a horizontal load at a corner."""
    scene = load_scene("portal-frame")

    def read(response: Response) -> tuple[float]:
        return (float(response.tips["left"][-1, 0]),)

    return Problem(
        name="portal-frame",
        title="Portal frame sways under a load at its corner",
        purpose="Rigid joints through large rotations, with a support at either end.",
        uncertainty=1e-11,
        scene=scene,
        statement="Two columns of 200 mm, clamped at their feet, and a girder of 300 mm, rigidly joined; section 10 mm x 2 mm, E = 2.1e5 N/mm^2, nu = .3. A dead load of 400 N "
        "pushes the left corner sideways.",
        source=COUPLED,
        quantities=(Quantity(name="sideways displacement of the left corner [mm]", exact=PORTAL_SWAY),),
        trials=(
            on_scene(EXACT, 1e-8, CLOSED, read),
            on_scene(mixed(20), 1e-6, FOURTH, read),
            on_scene(paper(20), 1e-2, SECOND, read),
        ),
        picture=Picture(axes=MM, curves=undeformed(scene)),
    )

"""Cases with the exact Reissner rod, with stretch and shear, solved independently by quadrature and collocation."""

from collections.abc import Sequence
from functools import partial

import numpy as np

from comparisons.claims.claim import Quantity
from comparisons.claims.manual.models import (
    ANSWER,
    ELASTICA,
    EXACT,
    FOURTH,
    ROD,
    SECOND,
    answered,
    deflected,
    mixed,
    on_scene,
    paper,
    solid,
    step,
    undeformed,
)
from comparisons.claims.manual.record import Picture, Problem
from comparisons.claims.manual.scenes import PAIR, cantilever, ks, under_pin
from comparisons.claims.problems.double_beam import EVENTS, FORCES, LOWER, TIP, UPPER
from comparisons.exact.rod import rod_under_pin
from comparisons.response import Response
from comparisons.scene import Scene, load_scene

TIMES = (0.25, 0.5, 0.75, 1.0)
CLOSED = "no mesh error: what is left are the tolerances of Newton's method and of the integration (1e-9)"
LAW = "its law, St. Venant-Kirchhoff, is softer than the rod's at 3 % strain; the mesh leaves below 1e-4"
ROD_SOURCE = (
    "Reissner's rod by quadratures of its first integral in two unknowns (comparisons.exact.rod, which shares nothing with the "
    "models); Reissner, Zeitschrift fuer angewandte Mathematik und Physik 23 (1972), 795-804"
)


def _at_times(scene: Scene) -> tuple[tuple[Quantity, ...], Response]:
    """Force, arc position and clamp moment by the rod."""
    rod = answered(scene, ROD)
    beam, values = scene.beams[0], _read(scene, rod)
    force, length = (unit.strip() for unit in scene.units.split(","))
    names = [
        *(f"F [{force}] at t = {t:g}" for t in TIMES),
        *(f"s [{length}] at t = {t:g}" for t in TIMES),
        *(f"M [{force} {length}] of the clamp at t = {t:g}" for t in TIMES),
    ]
    scales = [None] * 4 + [beam.length] * 4 + [None] * 4
    return (
        tuple(Quantity(name=n, exact=v, scale=s) for n, v, s in zip(names, values, scales, strict=True)),
        rod,
    )


def _read(scene: Scene, response: Response) -> list[float]:
    at = [step(response, t) for t in TIMES]
    contact = response.contacts[scene.contacts[0].pair]
    moment = response.supports[scene.all_supports[0].node].moment
    return [
        float(value) for history in (contact.force, contact.arc_position, moment) for value in history[at]
    ]


KS_TEXT = (
    "The cantilever of Konyukhov and Schweizerhof as Nizam et al. take it: L = 1 m, section .02 m x .02 m, E = 2.1e4 N/m^2, nu = .3, "
    "effective shear area 5/6 of the area. A frictionless pin moves straight by (-1, 2/pi) m"
)


def ks_axis() -> Problem:
    """The main scene."""
    scene = ks()
    (quantities, rod), read = _at_times(scene), partial(_read, scene)
    return Problem(
        name="ks-axis",
        title="Konyukhov-Schweizerhof cantilever, contact on the axis",
        purpose="Sliding contact of a pin with the axis at rotations beyond a right angle, with stretch and shear.",
        uncertainty=1e-11,
        scene=scene,
        statement=f"{KS_TEXT}, in contact with the axis, from the tip.",
        source=ROD_SOURCE,
        quantities=quantities,
        trials=(
            on_scene(EXACT, 1e-9, CLOSED, read, TIMES),
            on_scene(mixed(20), 2e-6, FOURTH, read, TIMES),
            on_scene(paper(20), 1e-2, SECOND, read, TIMES),
            on_scene(solid(50, 2), 5e-3, LAW, read, TIMES),
            on_scene(ELASTICA, 2e-3, "it neither stretches nor shears", read, TIMES),
        ),
        picture=Picture(curves=(*undeformed(scene), deflected(scene, rod, ANSWER, TIMES))),
    )


def ks_face() -> Problem:
    """The main scene with the contact on the face."""
    scene = ks("ks-face")
    (quantities, rod), read = _at_times(scene), partial(_read, scene)
    return Problem(
        name="ks-face",
        title="Konyukhov-Schweizerhof cantilever, contact on the face",
        purpose="The lever of a contact force on the face, half a height off the axis.",
        uncertainty=1e-11,
        scene=scene,
        statement=f"{KS_TEXT}, in contact with the lower face, from (1, -.01) m: the contact is half the height away from the axis.",
        source=ROD_SOURCE,
        quantities=quantities,
        trials=(
            on_scene(EXACT, 1e-9, CLOSED, read, TIMES),
            on_scene(mixed(20), 3e-6, FOURTH, read, TIMES),
            on_scene(paper(20), 1e-2, SECOND, read, TIMES),
            on_scene(solid(50, 2), 6e-3, LAW, read, TIMES),
        ),
        picture=Picture(curves=(*undeformed(scene), deflected(scene, rod, ANSWER, TIMES))),
    )


def ks_biot() -> Problem:
    """The main scene with a solid whose material law is equivalent to the rod's."""
    scene = ks(material="biot-linear")
    (quantities, rod), read = _at_times(scene), partial(_read, scene)
    return Problem(
        name="ks-biot",
        title="Konyukhov-Schweizerhof cantilever, solid of the rod's own law",
        purpose="The difference between a strip and a rod without the difference of their material laws.",
        uncertainty=1e-11,
        scene=scene,
        statement=f"{KS_TEXT}, in contact with the axis. The solid's stress is linear in Biot's strain, as the rod's is.",
        source=ROD_SOURCE,
        quantities=quantities,
        trials=(
            on_scene(
                solid(50, 2),
                1.2e-3,
                "what a rod leaves out of a strip with h/L = .02, of the order h^2",
                read,
                TIMES,
            ),
        ),
        picture=Picture(curves=(*undeformed(scene), deflected(scene, rod, ANSWER, TIMES))),
    )


def ks_tied() -> Problem:
    """The main scene's other reading: the point is tied to the tip."""
    scene = load_scene("ks-tied-tip")
    beam = scene.beams[0]

    def read(response: Response) -> list[float]:
        clamp, tip = (response.supports[f"{beam.name}.{end}"] for end in ("start", "end"))
        return [
            *(float(force) for force in np.hypot(*tip.force[[24, 49]].T) * beam.length**2 / beam.EI),
            float(clamp.moment[-1] * beam.length / beam.EI),
        ]

    exact = (19.7787697911997, 8.98941070906149, -1.77086483545219)
    names = ("F L^2/EI at t = .5", "F L^2/EI at t = 1", "M L/EI of the clamp at t = 1")
    return Problem(
        name="ks-tied-tip",
        title="Konyukhov-Schweizerhof cantilever, point tied to the tip",
        purpose="A prescribed motion of a beam's end through buckling in the first step.",
        uncertainty=1e-11,
        scene=scene,
        statement=f"{KS_TEXT.replace('A frictionless pin', 'Its tip, free to turn,')}; it buckles in the first step, at t = .0007.",
        source="Reissner's rod by spectral collocation (tests/oracles/tied.py, which shares nothing with the models)",
        quantities=tuple(Quantity(name=n, exact=v) for n, v in zip(names, exact, strict=True)),
        trials=(
            on_scene(EXACT, 1e-8, CLOSED, read, TIMES[1::2]),
            on_scene(mixed(20), 1e-5, FOURTH, read, TIMES[1::2]),
            on_scene(paper(20), 1e-2, SECOND, read, TIMES[1::2]),
        ),
        picture=Picture(curves=undeformed(scene)),
    )


def short_cantilever() -> Problem:
    """Small deflection of a short cantilever."""
    place, depth, height = 0.8, 1e-5, 0.1
    beam = cantilever(width=0.1, height=height, youngs_modulus=1e6, poissons_ratio=0.3)
    scene = under_pin(beam, (place, 0.0), (place, depth), load_parameters=1, name="short-cantilever")
    bending, shear = place**3 / (3.0 * beam.EI), place / beam.GA
    exact = depth / (bending + shear)

    def read(response: Response) -> Sequence[float]:
        return float(response.contacts[PAIR].force[-1]), float(
            response.supports["cantilever.start"].moment[-1]
        )

    linear = "of the order of the deflection's square, 1e-10; Newton's tolerance is 1e-10 EI/L^2, 4e-6 of the force"
    return Problem(
        name="short-cantilever",
        title="Small deflection of a short cantilever",
        purpose="Shear deformation in the limit of small deflections.",
        uncertainty=1e-9,
        scene=scene,
        statement="A clamped beam, L = 1 m, section .1 m x .1 m, E = 1e6 N/m^2, nu = .3, effective shear area 5/6 of the area, is lifted by "
        f"a frictionless pin at a = .8 m by d = 1e-5 m. Shear has {100 * shear / (bending + shear):.1f} % of that.",
        source="closed form of Timoshenko's beam: F = d/(a^3/(3 EI) + a/GA), M = -F a",
        quantities=(
            Quantity(name="F [N]", exact=exact),
            Quantity(name="M of the clamp [N m]", exact=-exact * place),
        ),
        trials=(
            *(on_scene(model, 1e-5, linear, read) for model in (EXACT, mixed(9), paper(9), ROD)),
            on_scene(
                solid(50, 4),
                2e-3,
                "5/6 is for sections that may warp, which the clamp's may not; the contact is as wide as the height",
                read,
            ),
        ),
        picture=Picture(curves=undeformed(scene), shape=False),
    )


def slip_off_41() -> Problem:
    """Slip-off in the paper's section 4.1, a beam soft in shear."""
    scene = load_scene("cantilever-critical-area")
    beam, pin = scene.beams[0], scene.pins[0]
    rod = rod_under_pin(
        [pin.position(t) for t in (0.0, 1.0)], EA=beam.EA, GA=beam.GA, EI=beam.EI, length=beam.length
    )
    near = answered(scene, ROD)

    def read(response: Response) -> Sequence[float]:
        return (1.8 * response.contacts[PAIR].slip_off,)

    return Problem(
        name="slip-off-in-shear",
        title="A raised pin leaves a beam that is soft in shear",
        purpose="The instant at which a contact leaves a beam over its tip, with 3 % shear strain.",
        uncertainty=1e-10,
        scene=scene,
        statement="Nizam et al., section 4.1: L = 4.5 m, A = .005 m^2, I = .001 m^4, E = 2.1e11 N/m^2, G = 7.5e10 N/m^2, effective shear area A; "
        "a frictionless pin moves straight up at x = 4.05 m until the beam slips off it.",
        source=ROD_SOURCE,
        quantities=(Quantity(name="displacement of the pin [m]", exact=1.8 * rod.slip_off),),
        trials=(
            on_scene(EXACT, 1e-8, CLOSED, read, (0.9,)),
            on_scene(
                mixed(18),
                1e-5,
                "its strain measures leave the third power of the shear strain, 3 % here",
                read,
                (0.9,),
            ),
        ),
        picture=Picture(curves=(*undeformed(scene), deflected(scene, near, ANSWER, (0.9,)))),
    )


def double_beam() -> Problem:
    """Two cantilevers, a pin that is handed over from one to the other."""
    scene = load_scene("double-beam")

    def read(response: Response) -> Sequence[float]:
        assert response.events is not None, "the beams locate events"
        happened = {(event.kind, event.pair): 0.76 * event.load_parameter for event in response.events}
        forces = [response.contacts[name].force[step(response, 31 / 76)] for name in (UPPER, TIP)]
        events = (("touch", TIP), ("slip-off", UPPER), ("slip-off", LOWER))
        return [*forces, *(happened.get(event, np.nan) for event in events)]

    exact = (*FORCES, *EVENTS.values())
    names = (
        "force of the pin at .31 m [N]",
        "force between the beams at .31 m [N]",
        "depth at which the tip meets the lower beam [m]",
        "depth at which the pin leaves the upper beam [m]",
        "depth at which it leaves the lower beam [m]",
    )
    return Problem(
        name="double-beam",
        title="Double beam: a pin is handed over",
        purpose="Contact between beams, and a pin that is handed over from one beam to the next.",
        uncertainty=1e-10,
        scene=scene,
        statement="Nizam et al., section 4.3, with sizes of this project: two cantilevers, L = 1 m, .2 m apart, A = 3e-4 m^2, I = 2.2e-8 m^4, "
        "E = 2e7 N/m^2, G = 7.142e6 N/m^2, effective shear area A. A frictionless pin presses the upper one down at x = .8 m; its tip meets the lower one, "
        "the pin passes to that and leaves it.",
        source="two coupled Reissner rods by spectral collocation and quadratures (tests/oracles/coupled.py), then a single one",
        quantities=tuple(Quantity(name=n, exact=v) for n, v in zip(names, exact, strict=True)),
        trials=(
            on_scene(EXACT, 1e-8, CLOSED, read, (52 / 76,)),
            on_scene(mixed(10), 1e-6, FOURTH, read, (52 / 76,)),
        ),
        picture=Picture(curves=undeformed(scene)),
    )

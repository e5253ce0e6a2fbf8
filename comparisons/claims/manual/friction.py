"""Cases of contact with Coulomb friction, and of the force that frictionless pins exert along a beam."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from comparisons.claims.claim import Quantity
from comparisons.claims.manual.elastica import READ_OFF, RIGID
from comparisons.claims.manual.models import (
    EXACT,
    FOURTH,
    Model,
    answered,
    deflected,
    mixed,
    on_scene,
    solid,
    trial,
    undeformed,
)
from comparisons.claims.manual.record import Measured, Picture, Problem, Trial
from comparisons.claims.manual.rods import CLOSED, KS_TEXT
from comparisons.claims.manual.scenes import (
    ELASTICA_TEXT,
    INFINITE,
    MM,
    PAIR,
    cantilever,
    ks,
    rigid,
    under_pin,
)
from comparisons.claims.problems.peaks import summit
from comparisons.response import Response
from comparisons.scene import Scene, load_scene

KS_PATH = ((1.0, 0.0), (0.0, 2.0 / np.pi))
ELASTICA_BY_FRICTION = {
    0.1: (7.841931727558, 0.873153311584, 0.625520218912, 0.657907419618),
    0.3: (7.541844254804, 0.847105863940, 0.620650977891, 0.682554111942),
    0.5: (7.582736946124, 0.831181215881, 0.614238368032, 0.701126617807),
}
"""Force and arc position at the end, and load parameters of stick and slip; `tests/oracles/friction.py` computes them."""
ROD_BY_FRICTION = {
    0.1: (0.00219358031585571, 0.873335466586381, -0.00100138429587205, 8.87404663866967e-05),
    0.3: (0.00211030486208590, 0.847142560461239, -0.00116976219266563, 2.33016806724164e-04),
    0.5: (0.00212228281136253, 0.831119109268655, -0.00129117497499545, 3.51983886357871e-04),
}
"""Force, arc position and moment of the clamp at the end, and the energy dissipated; `tests/oracles` holds them."""
COEFFICIENTS = tuple(ROD_BY_FRICTION)
SOURCE = (
    "quadratures with the force tilted by the angle of friction, and stick at a held place (comparisons.exact.rod_with_friction, which shares nothing "
    "with the models)"
)


def _with(scene: Scene, friction: float) -> Scene:
    """Return the scene with one coefficient of friction at all contacts."""
    return replace(scene, contacts=tuple(replace(item, friction=friction) for item in scene.contacts))


def _each(model: Model, tolerance: float, reason: str, read: Callable[[Response], Sequence[float]]) -> Trial:
    """Return the trial that solves the problem's scene with every coefficient of friction."""

    def measure(scene: Scene) -> Measured:
        answers = [answered(_with(scene, friction), model) for friction in COEFFICIENTS]
        return Measured(
            values=tuple(float(value) for response in answers for value in read(response)),
            curves=tuple(deflected(scene, response, model.name) for response in answers),
        )

    return trial(model, tolerance, reason, measure)


def _stick_and_slip(response: Response) -> list[float]:
    """Load parameters at which a contact sticks and slips again, which happens once."""
    assert response.events is not None, "the beams locate events"
    located = {event.kind: event.load_parameter for event in response.events if event.load_parameter > 0.5}
    return [located.get("stick", np.nan), located.get("slip", np.nan)]


def ks_friction_elastica() -> Problem:
    """The main scene's path on the elastica with friction."""
    scene = under_pin(cantilever(), *KS_PATH, load_parameters=20, name="ks-friction-elastica", friction=0.3)
    quantities = []
    for mu, (force, arc, stick, slip) in ELASTICA_BY_FRICTION.items():
        quantities += [
            Quantity(name=f"F L^2/EI at t = 1, mu = {mu:g}", exact=force),
            Quantity(name=f"s/L at t = 1, mu = {mu:g}", exact=arc, scale=1.0),
            Quantity(name=f"t at which the pin sticks, mu = {mu:g}", exact=stick, scale=1.0),
            Quantity(name=f"t at which it slips back, mu = {mu:g}", exact=slip, scale=1.0),
        ]

    def read(response: Response) -> list[float]:
        contact = response.contacts[PAIR]
        return [contact.force[-1], contact.arc_position[-1], *_stick_and_slip(response)]

    return Problem(
        name="ks-friction-elastica",
        title="Pin that slides with friction along a cantilever, elastica",
        purpose="Coulomb friction against a closed form: slip, stick, slip the other way, and where they begin.",
        uncertainty=1e-10,
        scene=scene,
        statement=f"A cantilever, {ELASTICA_TEXT}; a pin with the coefficient of friction mu starts at its tip (1, 0) and moves straight to (0, 2/pi). It "
        "slides towards the clamp, sticks, and slides towards the tip.",
        source="closed form by integrals of the tangent angle, theta'^2 = (2F/EI)(sin(u + psi) - sin psi) with psi = +-atan mu "
        "(tests/oracles/friction.py)",
        quantities=tuple(quantities),
        trials=(
            _each(EXACT, 1e-8, RIGID, read),
            _each(mixed(20), 5e-6, FOURTH, read),
        ),
        picture=Picture(curves=undeformed(scene)),
    )


def ks_friction() -> Problem:
    """The main scene with friction."""
    scene = ks("ks-friction", material="biot-linear")
    beam = scene.beams[0]
    quantities = []
    for mu, (force, arc, moment, dissipated) in ROD_BY_FRICTION.items():
        quantities += [
            Quantity(name=f"F [N] at t = 1, mu = {mu:g}", exact=force),
            Quantity(name=f"s [m] at t = 1, mu = {mu:g}", exact=arc, scale=beam.length),
            Quantity(name=f"M [N m] of the clamp at t = 1, mu = {mu:g}", exact=moment),
            Quantity(name=f"energy dissipated [N m], mu = {mu:g}", exact=dissipated),
        ]

    def read(response: Response) -> list[float]:
        contact = response.contacts[PAIR]
        assert contact.friction is not None, "all state their friction"
        return [
            contact.force[-1],
            contact.arc_position[-1],
            response.supports[f"{beam.name}.start"].moment[-1],
            contact.friction.dissipated[-1],
        ]

    return Problem(
        name="ks-friction",
        title="Konyukhov-Schweizerhof cantilever with friction",
        purpose="Coulomb friction with stretch and shear, and the energy that it dissipates.",
        uncertainty=1e-11,
        scene=scene,
        statement=f"{KS_TEXT.replace('frictionless pin', 'pin with the coefficient of friction mu')}, in contact with the axis, from the tip. The solid's "
        "stress is linear in Biot's strain, as the rod's is.",
        source=f"Reissner's rod by {SOURCE}",
        quantities=tuple(quantities),
        trials=(
            _each(EXACT, 1e-9, CLOSED, read),
            _each(mixed(20), 5e-6, FOURTH, read),
            _each(
                solid(50, 2), 2e-3, "what a rod leaves out of a strip with h/L = .02, of the order h^2", read
            ),
        ),
        picture=Picture(curves=undeformed(scene)),
    )


LIMITS = {
    "drawn in": (0.948651379546643, 0.522089479583248),
    "pushed back": (0.727371650251847, 0.427640054969161),
}
"""Greatest load of a support and its place, with the friction .2; `tests/oracles/elastica.py` computes them."""


def three_point_friction() -> Problem:
    """Limit loads of three-point bending with friction, drawn in and pushed back."""
    friction, load_parameters = 0.2, 96
    built_in = load_scene("three-point-friction")
    scene = replace(rigid(built_in, 10.0 * INFINITE), load_parameters=load_parameters)
    pin, EI = scene.pins[1], scene.beams[0].EI
    a, turn = pin.points[0][0], pin.corners[0]

    def read(response: Response) -> list[float]:
        t = response.load_parameter
        rise = np.array([pin.position(one)[1] for one in t]) / a
        load = -response.supports["left.end"].force[:, 1] * a**2 / EI / 2.0
        back = (t > turn)[::-1]
        return [*summit(rise[t <= turn], load[t <= turn]), *summit(rise[::-1][back], load[::-1][back])]

    by_mixed = on_scene(mixed(60), 2e-6, f"{FOURTH}; stretch, EA = {INFINITE / 100.0:g} EI/L^2", read)
    stretched = replace(scene, beams=rigid(built_in, INFINITE / 100.0).beams)
    quantities = []
    for way, (load, deflection) in LIMITS.items():
        quantities += [
            Quantity(name=f"V a^2/EI, {way}", exact=load),
            Quantity(name=f"deflection over a, {way}", exact=deflection),
        ]
    return Problem(
        name="three-point-friction",
        title="Limit loads of three-point bending with friction",
        purpose="Friction that turns: the limit load while a beam is drawn in between its supports, and while it is pushed back.",
        uncertainty=1e-12,
        scene=scene,
        statement=f"The beam of three-point-bending, EI = 1,400,000 N mm^2, half span a = 100 mm, neither stretch nor shear (EA = GA = {10 * INFINITE:g} EI/L^2 in "
        f"their place), over supports with the coefficient of friction {friction:g}, which rise by .7 a and go back to .2 a. V is the vertical force of one support.",
        source="closed form: V = EI cos(tc + psi) X(tc)^2/(2 a^2) at its maximum, psi = -+atan mu (tests/oracles/elastica.py)",
        quantities=tuple(quantities),
        trials=(
            on_scene(EXACT, 1e-9, READ_OFF, read),
            replace(by_mixed, measure=lambda _: by_mixed.measure(stretched)),
        ),
        picture=Picture(axes=MM, curves=undeformed(scene)),
    )


SECOND_CYCLE = {60: (44.8989432868212, 63.9216785602630), 80: (19.1915545096094, 82.9545104380966)}
"""Force [N] and arc position [mm] by the place of the pin [mm]; `tests/oracles` holds them."""
DISSIPATED = 322.713530813987
"""Energy dissipated in the second cycle [N mm]."""


def hysteresis() -> Problem:
    """A pin that goes to and fro."""
    scene = load_scene("hysteresis")
    length = scene.beams[0].length
    legs = np.array([3, 7, 11, 15, 19])

    def read(response: Response) -> list[float]:
        contact = response.contacts[PAIR]
        assert contact.friction is not None, "the beams state their friction"
        assert response.work is not None, "the beams state their work"
        force, spent, work = (x[legs] for x in (contact.force, contact.friction.dissipated, response.work))
        return [
            *force[3:],
            *contact.arc_position[legs[3:]],
            spent[4] - spent[2],
            force[3] / force[1],
            force[4] / force[2],
            (work[4] - work[2]) / (spent[4] - spent[2]),
        ]

    return Problem(
        name="hysteresis",
        title="A pin goes to and fro below a cantilever",
        purpose="History: a loop is closed after one cycle, and the work of a cycle is dissipated.",
        uncertainty=1e-11,
        scene=scene,
        statement="A cantilever of 100 mm, section 10 mm x 1 mm, E = 2.1e5 N/mm^2, nu = .3. A pin with the coefficient of friction .3 lifts it at x = 80 mm by 20 mm, and goes "
        "straight to x = 60 mm and back, twice.",
        source=f"Reissner's rod by {SOURCE}; the closed loop and the balance of energy hold for any material",
        quantities=(
            *(
                Quantity(name=f"F [N] at x = {x} mm, second cycle", exact=force)
                for x, (force, _) in SECOND_CYCLE.items()
            ),
            *(
                Quantity(
                    name=f"s [mm] at x = {x} mm, second cycle",
                    exact=arc,
                    scale=length,
                )
                for x, (_, arc) in SECOND_CYCLE.items()
            ),
            Quantity(
                name="energy dissipated in the second cycle [N mm]",
                exact=DISSIPATED,
            ),
            *(
                Quantity(name=f"F of the second cycle over F of the first, x = {x} mm", exact=1.0)
                for x in (60, 80)
            ),
            Quantity(name="work over dissipated energy, second cycle", exact=1.0),
        ),
        trials=(
            on_scene(EXACT, 1e-9, CLOSED, read),
            on_scene(mixed(20), 1e-6, FOURTH, read),
        ),
        picture=Picture(axes=MM, curves=undeformed(scene)),
    )


DISTANCES = (10.0, 2.0, 1.0)


def sleeve() -> Problem:
    """The configurational force of a sleeve."""
    scene = load_scene("sleeve")
    beam = scene.beams[0]
    inner, outer = scene.pins

    def at(distance: float) -> Scene:
        return replace(
            scene, pins=(inner, replace(outer, start=(inner.points[0][0] + distance, inner.points[0][1])))
        )

    def force(response: Response) -> float:
        clamp = response.supports[f"{beam.name}.start"]
        N, Q = -clamp.force[-1]
        H = clamp.moment[-1] ** 2 / (2.0 * beam.EI) + N + N**2 / (2.0 * beam.EA) + Q**2 / (2.0 * beam.GA)
        return float(H * beam.EI / scene.loads[0].moment ** 2)

    def measured(model: Model, tolerance: float, reason: str) -> Trial:
        def measure(_: Scene) -> Measured:
            answers = [answered(at(distance), model) for distance in DISTANCES]
            return Measured(
                values=tuple(force(response) for response in answers),
                curves=(deflected(scene, answers[1], model.name),),
            )

        return trial(model, tolerance, reason, measure)

    return Problem(
        name="sleeve",
        title="Configurational force of a sliding sleeve",
        purpose="The directions of two contact forces that all but cancel each other.",
        uncertainty=1e-15,
        scene=scene,
        statement="A cantilever of 100 mm, section 10 mm x 1 mm, E = 2.1e5 N/mm^2, nu = .3, has a dead moment M = 1750 N mm at its tip. Two opposed frictionless pins, a "
        "distance apart, slide along it by 20 mm towards the clamp. They push the beam along by H, the material force at the clamp.",
        source="closed form, H = m^2/2EI + N + N^2/2EA + Q^2/2GA is constant along a rod under frictionless contacts and M^2/2EI at the tip; Bigoni, Dal Corso, Bosi and "
        "Misseroni, Mechanics of Materials 80 (2015), 368-374",
        quantities=tuple(
            Quantity(name=f"H EI/M^2, {distance:g} mm apart", exact=0.5) for distance in DISTANCES
        ),
        trials=(measured(EXACT, 1e-9, CLOSED), measured(mixed(20), 1e-3, FOURTH)),
        picture=Picture(axes=MM, curves=undeformed(scene)),
    )

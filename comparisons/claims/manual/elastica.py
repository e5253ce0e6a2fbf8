"""Cases of the elastica under a pin: an inextensible, shear-rigid cantilever, in closed form."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from comparisons.claims.claim import Quantity
from comparisons.claims.manual.models import (
    ANSWER,
    EXACT,
    FOURTH,
    SECOND,
    Model,
    answered,
    mixed,
    on_scene,
    paper,
    pieces,
    solid,
    step,
    trial,
    undeformed,
)
from comparisons.claims.manual.record import Curve, Measured, Picture, Problem, Trial
from comparisons.claims.manual.scenes import ELASTICA_TEXT, INFINITE, PAIR, cantilever, ks, rigid, under_pin
from comparisons.claims.problems.peaks import summit
from comparisons.exact.elastica import elastica_under_pin
from comparisons.response import Array, Response
from comparisons.scene import Scene, load_scene

KS_END = (0.0, 2.0 / np.pi)
TIMES = (0.25, 0.5, 0.75, 1.0)
BEAM = cantilever()
RIGID = "no mesh error: what is left is F/EA, below 1e-9, and the tolerances of Newton's method and of the integration (1e-9)"


def ks_elastica() -> Problem:
    """The main scene's path on the elastica: force, arc position and clamp moment."""
    scene = under_pin(BEAM, (1.0, 0.0), KS_END, load_parameters=20, name="ks-elastica")
    exact = [elastica_under_pin(1.0 - t, t * KS_END[1]) for t in TIMES]
    quantities = [
        Quantity(name=f"F L^2/EI at t = {t:g}", exact=state.magnitude)
        for t, state in zip(TIMES, exact, strict=True)
    ]
    quantities += [
        Quantity(name=f"s/L at t = {t:g}", exact=state.arc_position, scale=1.0)
        for t, state in zip(TIMES, exact, strict=True)
    ]
    quantities += [Quantity(name="M L/EI of the clamp at t = 1", exact=-np.pi)]

    def read(response: Response) -> list[float]:
        at, contact = [step(response, t) for t in TIMES], response.contacts[PAIR]
        return [
            *contact.force[at],
            *contact.arc_position[at],
            response.supports["cantilever.start"].moment[-1],
        ]

    return Problem(
        name="ks-elastica",
        title="Pin that slides along a cantilever, elastica",
        purpose="Sliding contact against a closed form, without stretch and shear.",
        uncertainty=1e-12,
        scene=scene,
        statement=f"A cantilever, {ELASTICA_TEXT}; a frictionless pin starts at its tip (1, 0), moves straight to (0, 2/pi) and bends it by "
        "143 degrees: the path of Konyukhov and Schweizerhof. The clamp moment at the end is pi EI/L.",
        source="closed form by elliptic integrals of the tangent angle tc at the pin, y/x = tan(tc - arctan(I2/I1)), "
        "F = EI (I1^2 + I2^2)/(2 (x^2 + y^2)) (comparisons.exact.elastica)",
        quantities=tuple(quantities),
        trials=(
            on_scene(EXACT, 1e-8, RIGID, read, TIMES),
            on_scene(mixed(20), 3e-6, FOURTH, read, TIMES),
            on_scene(paper(20), 1e-2, SECOND, read, TIMES),
        ),
        picture=Picture(curves=(*undeformed(scene), pieces(ANSWER, (state.shape(401) for state in exact)))),
    )


def identity() -> Problem:
    """An identity of the elastica for any pin: force, place and direction are not independent."""
    path = ((0.9, 0.0), (0.4, 0.5))
    scene = under_pin(BEAM, *path, load_parameters=10, name="identity")

    def read(response: Response) -> list[float]:
        vector = response.contacts[PAIR].vector
        assert vector is not None, "both state the force's direction"
        found = []
        for t in (0.3, 0.6, 1.0):
            (fx, fy), (x, y) = vector[step(response, t)], scene.pins[0].position(t)
            force, tangent = np.hypot(fx, fy), np.arctan2(-fx, fy)
            lever = x * np.cos(tangent) + y * np.sin(tangent)
            found.append(float(force * lever**2 / (2.0 * np.sin(tangent))))
        return found

    return Problem(
        name="elastica-identity",
        title="Force, place and direction of a frictionless contact",
        purpose="The direction of a frictionless contact force: normal to the axis.",
        uncertainty=1e-15,
        scene=scene,
        statement=f"A cantilever, {ELASTICA_TEXT}; a frictionless pin moves from (.9, 0) to (.4, .5). What is compared holds for any pin, "
        "with the contact force's own direction: tc is the angle of the tangent that is normal to it.",
        source="closed form, first integral of the elastica: F (x cos tc + y sin tc)^2 = 2 EI sin tc",
        quantities=tuple(
            Quantity(name=f"F (x cos tc + y sin tc)^2/(2 EI sin tc) at t = {t:g}", exact=1.0)
            for t in (0.3, 0.6, 1.0)
        ),
        trials=(
            on_scene(EXACT, 1e-8, RIGID, read),
            on_scene(mixed(20), 1e-6, FOURTH, read),
        ),
        picture=Picture(
            curves=(*undeformed(scene), pieces(ANSWER, [elastica_under_pin(*path[-1]).shape(401)]))
        ),
    )


LONG = cantilever(length=3.0)
HIGHEST = 0.8


def _limit(model: Model, read: Callable[[Scene, Response], Array]) -> Trial:
    """Return the trial that reads the greatest load and its place from columns of displacements and loads."""

    def measure(scene: Scene) -> Measured:
        response = answered(scene, model)
        curve = Curve(style=model.name, points=read(scene, response))
        height, load = curve.points.T
        return Measured(values=summit(height, load), curves=(curve,))

    return trial(model, 1e-7, READ_OFF if model == EXACT else FOURTH, measure)


def _limit_curve(force: str) -> Curve:
    heights = np.linspace(0.01, HIGHEST, 200)
    states = [elastica_under_pin(1.0, float(d), length=3.0) for d in heights]
    loads = [2.0 * state.force[1] if force == "vertical" else state.magnitude for state in states]
    return Curve(style=ANSWER, points=np.stack([heights, np.array(loads)], axis=1))


def force_limit() -> Problem:
    """Greatest contact force of a pin that is raised."""
    scene = under_pin(LONG, (1.0, 0.0), (1.0, HIGHEST), load_parameters=64)

    def read(_: Scene, response: Response) -> Array:
        return np.stack([HIGHEST * response.load_parameter, response.contacts[PAIR].force], axis=1)

    return Problem(
        name="force-limit",
        title="Greatest contact force of a raised pin",
        purpose="A contact force that falls while the pin moves on.",
        uncertainty=1e-12,
        scene=scene,
        statement=f"A long cantilever, {ELASTICA_TEXT.replace('L = 1 m', 'L = 3 m')}, is lifted by a frictionless pin at x = a = 1 m. "
        "The force grows, has a maximum and falls, since the beam turns away.",
        source="closed form: F = EI X(tc)^2/(2 a^2) where X' = 0 (tests/oracles/elastica.py)",
        quantities=(
            Quantity(name="F a^2/EI", exact=1.178533618979285),
            Quantity(name="height over a", exact=0.723666355414946),
        ),
        trials=(
            _limit(EXACT, read),
            _limit(mixed(60), read),
        ),
        picture=Picture(axes=("height/a", "F a^2/EI"), curves=(_limit_curve("normal"),), shape=False),
    )


READ_OFF = "the maximum is read off a polynomial through eleven load parameters around it"


def three_point_bending() -> Problem:
    """Limit load of three-point bending without friction."""
    scene = replace(rigid(load_scene("three-point-bending")), load_parameters=56)

    def read(scene: Scene, response: Response) -> Array:
        (a, _), EI = scene.pins[1].points[0], scene.beams[0].EI
        rise = (scene.pins[1].displacement or (0.0, 0.0))[1]
        load = -response.supports["left.end"].force[:, 1]
        return np.stack([rise / a * response.load_parameter, load * a**2 / EI], axis=1)

    return Problem(
        name="three-point-bending",
        title="Limit load of frictionless three-point bending",
        purpose="Sliding supports, and a limit load that sliding alone causes.",
        uncertainty=1e-12,
        scene=scene,
        statement="A beam of 600 mm over two frictionless supports, half span a = 100 mm, EI = 1,400,000 N mm^2, neither stretch nor shear "
        f"(EA = GA = {INFINITE:g} EI/L^2 in their place), is bent by the load P on a hinge in the middle, until it slides through: "
        "the supports rise. Half of it is the cantilever of the case before.",
        source="closed form: P = EI cos tc X(tc)^2/a^2 where 2 X' cos tc = X sin tc (tests/oracles/elastica.py)",
        quantities=(
            Quantity(name="P a^2/EI", exact=1.667952108595431),
            Quantity(name="deflection over a", exact=0.476377597825455),
        ),
        trials=(
            _limit(EXACT, read),
            _limit(mixed(60), read),
        ),
        picture=Picture(axes=("deflection/a", "P a^2/EI"), curves=(_limit_curve("vertical"),), shape=False),
    )


def slip_off() -> Problem:
    """Height at which a raised pin leaves the beam over its tip."""
    height = 0.6
    scene = under_pin(BEAM, (0.8, 0.0), (0.8, height), load_parameters=12, name="slip-off")
    strip = ks(load_parameters=12)

    def read(response: Response) -> Sequence[float]:
        return (height * response.contacts[PAIR].slip_off,)

    on_strip = on_scene(solid(50, 2), 5e-4, "a strip with h/L = .02 stretches and shears", read, (10 / 12,))

    before = elastica_under_pin(0.8, height * 10 / 12)
    return Problem(
        name="slip-off",
        title="A raised pin leaves the beam over its tip",
        purpose="The instant at which a contact leaves a beam over its tip.",
        uncertainty=1e-12,
        scene=scene,
        statement=f"A cantilever, {ELASTICA_TEXT}, is lifted by a frictionless pin at x = .8 m, along which it slides down, until its tip has passed. "
        "The solid is the strip of the main scene, h/L = .02.",
        source="closed form: x/L = X(tc)/I0(tc), d/L = Y(tc)/I0(tc) (tests/oracles/elastica.py)",
        quantities=(Quantity(name="d/L", exact=0.538697355156334),),
        trials=(
            on_scene(EXACT, 1e-8, RIGID, read, (10 / 12,)),
            on_scene(mixed(20), 1e-7, FOURTH, read, (10 / 12,)),
            replace(on_strip, measure=lambda scene: on_strip.measure(replace(strip, pins=scene.pins))),
        ),
        picture=Picture(curves=(*undeformed(scene), pieces(ANSWER, [before.shape(401)]))),
    )

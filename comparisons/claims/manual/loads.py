"""Cases without contact: cantilevers and columns under loads at their ends."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

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
    trial,
    undeformed,
)
from comparisons.claims.manual.record import Curve, Measured, Picture, Problem, Trial
from comparisons.claims.manual.scenes import ELASTICA_TEXT, UNIT, cantilever
from comparisons.exact.end_loads import tip_under_dead_load, tip_under_moment
from comparisons.response import Response
from comparisons.scene import BeamSpec, LoadSpec, Scene, SupportSpec

TURNED = (0.25, 0.5, 1.0)
LOADS = (1.0, 2.0, 5.0, 10.0)
ROUND_OFF = "no mesh error: what is left is EI/(EA L^2) = 1e-10 and the tolerances of Newton's method and of the integration (1e-9)"


def dead_load() -> Problem:
    """Cantilever under a dead load at its tip."""
    scene = Scene(
        name="dead-load",
        load_parameters=10,
        beams=(cantilever(),),
        loads=(LoadSpec(beam="cantilever", end="end", force=(0.0, LOADS[-1])),),
    )

    def deflections(response: Response) -> Iterator[float]:
        return (response.tips["cantilever"][round(load) - 1, 1] for load in LOADS)

    return Problem(
        name="dead-load",
        title="Cantilever under a dead load at its tip",
        statement=f"A cantilever, {ELASTICA_TEXT}, carries a load P across its axis at its tip, which keeps its direction.",
        source="elastica by elliptic integrals: Bisshopp and Drucker, Quarterly of Applied Mathematics 3 (1945), 272-275",
        quantities=tuple(
            Quantity(name=f"v/L of the tip at P L^2/EI = {load:g}", exact=float(tip_under_dead_load(load)[1]))
            for load in LOADS
        ),
        trials=(
            on_scene(scene, EXACT, 2e-9, ROUND_OFF, deflections, (0.1, 0.2, 0.5, 1.0)),
            on_scene(scene, mixed(20), 2e-6, FOURTH, deflections, (0.1, 0.2, 0.5, 1.0)),
            on_scene(scene, paper(20), 1e-3, SECOND, deflections, (0.1, 0.2, 0.5, 1.0)),
        ),
        picture=Picture(curves=undeformed(scene)),
    )


def roll_up() -> Problem:
    """Cantilever rolled up by a moment at its tip."""
    scene = Scene(
        name="roll-up",
        load_parameters=8,
        beams=(cantilever(),),
        loads=(LoadSpec(beam="cantilever", end="end", moment=2.0 * np.pi),),
    )
    quarter, half, whole = (tip_under_moment(2.0 * np.pi * t) for t in TURNED[:3])

    def tip(response: Response) -> tuple[float, ...]:
        at_quarter, at_half, at_whole = response.tips["cantilever"][[1, 3, 7]]
        return float(at_quarter[0]), float(at_half[1]), float(np.hypot(*(at_whole - whole)))

    return Problem(
        name="roll-up",
        title="Roll-up by an end moment",
        statement=f"A cantilever, {ELASTICA_TEXT}, is bent to a full circle by the moment M = 2 pi EI/L at its tip.",
        source="closed form: an arc of the angle t = M L/EI, x/L = sin t / t, y/L = (1 - cos t)/t; Bathe and Bolourchi, "
        "International Journal for Numerical Methods in Engineering 14 (1979), 961-986",
        quantities=(
            Quantity(name="x/L of the tip, a quarter of a circle", exact=float(quarter[0])),
            Quantity(name="y/L of the tip, half a circle", exact=float(half[1])),
            Quantity(name="distance of the tip from the clamp over L, a full circle", exact=0.0, scale=1.0),
        ),
        trials=(
            on_scene(scene, EXACT, 2e-9, ROUND_OFF, tip, TURNED),
            on_scene(scene, mixed(20), 1e-6, FOURTH, tip, TURNED),
            on_scene(scene, paper(20), 3e-3, SECOND, tip, TURNED),
        ),
        picture=Picture(curves=undeformed(scene)),
    )


STIFF: dict[str, Any] = {**UNIT, "area": 1e6}
"""A column's section: with EA = GA neither changes its buckling load, and round-off in the axial force grows with EA."""


def column(load: float, aside: float, **section: Any) -> Scene:
    """Return an upright column, clamped at its foot, under a load on its head, which is held aside."""
    beam = BeamSpec(
        name="column",
        start=(0.0, 0.0),
        end=(0.0, 1.0),
        clamped=("start",),
        **(section or STIFF),
    )
    return Scene(
        name="column",
        load_parameters=10,
        beams=(beam,),
        supports=(SupportSpec(beam="column", end="end", fixed=("x",), displacement=(aside, 0.0)),),
        loads=(LoadSpec(beam="column", end="end", force=(0.0, -load)),),
    )


ASIDE = 1e-3
"""Sideways displacement of the head of a buckling column, over its length."""
HELD_ASIDE = "the head is held L/1000 aside, which raises the load by pi^2/32 of the square, 3e-7"


def _critical(model: Model, estimate: float, tolerance: float, reason: str, **section: Any) -> Trial:
    """Return the trial that seeks the load at which a column needs no force to stay aside."""

    def sideways(load: float) -> float:
        scene = replace(column(load, ASIDE, **section), load_parameters=1)
        at_head = answered(scene, model).supports["column"].other_end
        assert at_head is not None, "the head is held"
        return float(at_head.force[-1, 0])

    def measure() -> Measured:
        loads = estimate * np.linspace(0.0, 1.2, 13)[1:]
        forces = np.array([sideways(float(load)) for load in loads])
        found = float(brentq(sideways, 0.8 * estimate, 1.2 * estimate, xtol=1e-12, rtol=1e-12))
        return Measured(
            values=(found,), curves=(pieces(model.name, [np.stack([loads, forces / ASIDE], axis=1)]),)
        )

    return trial(model, tolerance, reason, measure)


COLUMN_AXES = ("P L^2/EI", "force holding the head aside / distance [EI/L^3]")


def _stiffness(highest: float, EA: float = np.inf, GA: float = np.inf) -> Curve:
    """Return the force that holds the head aside over the distance, for loads up to `highest`, in units of EI and L.

    ``R/d = 1/(c (tan k - k)/(P k) + 1/GA)``, ``c = 1 + P/GA - P/EA``, ``k^2 = P c``: Reissner's rod for small d.
    """
    load = np.linspace(0.01, highest, 200)
    c = 1.0 + load / GA - load / EA
    k = np.sqrt(load * c)
    sine, cosine = np.sin(k), np.cos(k)
    force = load * k * cosine / (c * (sine - k * cosine) + load * k * cosine / GA)
    return Curve(style=ANSWER, points=np.stack([load, force], axis=1))


def euler() -> Problem:
    """Euler's column."""
    exact = np.pi**2 / 4.0
    return Problem(
        name="euler-column",
        title="Euler's buckling load of a clamped column",
        statement="A column, L = 1 m, EI = 1 N m^2, EA = GA = 1e6 N, clamped at its foot, carries a dead load P on its head. The head is held L/1000 aside; "
        "the load sought is that under which no force is needed for that.",
        source="closed form: P = pi^2 EI/(4 L^2), Euler 1744; the force that holds the head aside is P k d/(tan k L - k L), k^2 = P/EI (Timoshenko and Gere, "
        "Theory of Elastic Stability, 1961, ch. 1)",
        quantities=(Quantity(name="P L^2/EI", exact=exact),),
        trials=tuple(_critical(model, exact, 1e-6, HELD_ASIDE) for model in (EXACT, mixed(20))),
        picture=Picture(axes=COLUMN_AXES, curves=(_stiffness(1.2 * exact),), shape=False),
    )


SOFT_GA, SOFT_EA = 30.0, 78.0
SOFT: dict[str, Any] = {
    "youngs_modulus": 1.0,
    "second_moment": 1.0,
    "area": SOFT_EA,
    "shear_modulus": SOFT_GA / SOFT_EA,
}


def haringx() -> Problem:
    """Column that stretches and shears."""
    c, buckling = 1.0 / SOFT_GA - 1.0 / SOFT_EA, np.pi**2 / 4.0
    exact = (np.sqrt(1.0 + 4.0 * c * buckling) - 1.0) / (2.0 * c)
    return Problem(
        name="haringx-column",
        title="Buckling load of a column soft in shear",
        statement=f"The column of the case before with EA = {SOFT_EA:g} EI/L^2 and GA = {SOFT_GA:g} EI/L^2 (a rubber spring).",
        source="closed form of Reissner's rod: P (1 + P/GA - P/EA) = pi^2 EI/(4 L^2); Haringx, Philips Research Reports 3 (1948), "
        "401-449; Reissner, Zeitschrift fuer angewandte Mathematik und Physik 23 (1972), 795-804",
        quantities=(Quantity(name="P L^2/EI", exact=float(exact)),),
        trials=(
            _critical(EXACT, float(exact), 1e-6, HELD_ASIDE, **SOFT),
            _critical(
                mixed(20),
                float(exact),
                0.5 * float(exact / SOFT_GA) ** 3,
                "its strain measures leave half the third power of P/GA, with any number of elements",
                **SOFT,
            ),
        ),
        picture=Picture(
            axes=COLUMN_AXES, curves=(_stiffness(1.2 * float(exact), SOFT_EA, SOFT_GA),), shape=False
        ),
    )


def post_buckling() -> Problem:
    """Column far beyond its buckling load."""
    angle = np.deg2rad(90.0)
    k = float(np.sin(angle / 2.0))
    K, E = float(ellipk(k**2)), float(ellipe(k**2))
    scene = column(K**2, 2.0 * k / K)

    short = f"the column shortens by P/EA = {K**2 / 1e6:.1e} at its foot"

    def head(response: Response) -> tuple[float, float]:
        at_head = response.supports["column"].other_end
        assert at_head is not None, "the head is held"
        return float(response.tips["column"][-1, 1]), float(at_head.force[-1, 0]) / K**2

    return Problem(
        name="post-buckling",
        title="Column far beyond its buckling load",
        statement="A column, L = 1 m, EI = 1 N m^2, EA = GA = 1e6 N, clamped at its foot, carries the dead load P = K^2 EI/L^2 on its head, with which it is in "
        "equilibrium with its head turned by 90 degrees. The head is moved to where it then is sideways, while the load grows: "
        "at the end no force is needed to hold it there.",
        source="elastica: P = K^2 EI/L^2, x/L = 2 k/K, y/L = 2 E/K - 1, K(k) and E(k) complete elliptic integrals, k = sin 45 degrees "
        "(Timoshenko and Gere, Theory of Elastic Stability, 1961, sec. 2.7)",
        quantities=(
            Quantity(name="y/L of the head", exact=2.0 * E / K - 1.0, scale=1.0),
            Quantity(name="sideways force over P", exact=0.0, scale=1.0),
        ),
        trials=(
            on_scene(scene, EXACT, 1e-5, short, head),
            on_scene(scene, mixed(20), 1e-5, short, head),
        ),
        picture=Picture(curves=undeformed(scene)),
    )

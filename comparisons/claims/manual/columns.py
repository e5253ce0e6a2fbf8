"""Cases of columns: buckling loads, and equilibria far beyond them."""

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
from comparisons.claims.manual.scenes import MM, UNIT, rigid
from comparisons.response import Response
from comparisons.scene import BeamSpec, LoadSpec, Scene, SupportSpec, load_scene

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


def _critical(model: Model, estimate: float, tolerance: float, reason: str) -> Trial:
    """Return the trial that seeks the load at which a column needs no force to stay aside."""

    def sideways(load: float, scene: Scene) -> float:
        loaded = replace(scene, load_parameters=1, loads=(replace(scene.loads[0], force=(0.0, -load)),))
        return float(answered(loaded, model).supports["column.end"].force[-1, 0])

    def measure(scene: Scene) -> Measured:
        loads = estimate * np.linspace(0.0, 1.2, 13)[1:]
        forces = np.array([sideways(float(load), scene) for load in loads])
        found = float(brentq(sideways, 0.8 * estimate, 1.2 * estimate, args=(scene,), xtol=1e-12, rtol=1e-12))
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
        purpose="Loss of stiffness under compression, up to the buckling load.",
        uncertainty=1e-15,
        scene=column(exact, ASIDE),
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
        purpose="Stretch and shear under compression: formulations of shear differ here.",
        uncertainty=1e-15,
        scene=column(float(exact), ASIDE, **SOFT),
        statement=f"The column of the case before with EA = {SOFT_EA:g} EI/L^2 and GA = {SOFT_GA:g} EI/L^2 (a rubber spring).",
        source="closed form of Reissner's rod: P (1 + P/GA - P/EA) = pi^2 EI/(4 L^2); Haringx, Philips Research Reports 3 (1948), "
        "401-449; Reissner, Zeitschrift fuer angewandte Mathematik und Physik 23 (1972), 795-804",
        quantities=(Quantity(name="P L^2/EI", exact=float(exact)),),
        trials=(
            _critical(EXACT, float(exact), 1e-6, HELD_ASIDE),
            _critical(
                mixed(20),
                float(exact),
                0.5 * float(exact / SOFT_GA) ** 3,
                "its strain measures leave half the third power of P/GA, with any number of elements",
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
        sideways = float(response.supports["column.end"].force[-1, 0])
        return float(response.tips["column"][-1, 1]), sideways / K**2

    return Problem(
        name="post-buckling",
        title="Column far beyond its buckling load",
        purpose="Equilibrium far beyond buckling, with the head turned by a right angle.",
        uncertainty=1e-14,
        scene=scene,
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
            on_scene(EXACT, 1e-5, short, head),
            on_scene(mixed(20), 1e-5, short, head),
        ),
        picture=Picture(curves=undeformed(scene)),
    )


NEARLY_RIGID = 1e8
"""EA and GA over EI/L^2 of a column that neither stretches nor shears: round-off in the axial force grows with this ratio."""
SHORTER = "the column shortens and shears by P/EA = P/GA, below 1e-7, which its side-sway amplifies"
IMPERFECT = (
    "elastica by elliptic integrals (tests/oracles/elastica.py); without the moment it is the column of Timoshenko and Gere, Theory "
    "of Elastic Stability, 1961, sec. 2.7"
)
HEIGHT, SIDEWAYS = 0.137580063666666, 0.804166309778207
"""Place of the head over L with P L^2/EI = 80/17.5 and M L/EI = .08/17.5; `tests/oracles/elastica.py` computes it."""
STRIP_COLUMN = "EI = 175,000 N mm^2, neither stretch nor shear (EA = GA = 1e8 EI/L^2 in their place)"


def clamped_column() -> Problem:
    """Clamped column with an imperfection, beyond its buckling load."""
    scene = rigid(load_scene("clamped-column"), NEARLY_RIGID)
    load, length = scene.loads[0], scene.beams[0].length

    def read(response: Response) -> tuple[float, float, float]:
        x, y = response.tips["column"][-1]
        return float(y) / length, float(x) / length, float(response.supports["column.start"].moment[-1])

    return Problem(
        name="clamped-column",
        title="Column with an imperfection beyond its buckling load",
        purpose="A path that turns sharply at a buckling load, without a bifurcation.",
        uncertainty=1e-12,
        scene=scene,
        statement=f"A column of 100 mm, {STRIP_COLUMN}, clamped at its foot. A dead load grows to 80 N at its head, 1.85 times the buckling load, and with it a "
        "moment of 8 N mm, the imperfection.",
        source=IMPERFECT,
        quantities=(
            Quantity(name="y/L of the head", exact=HEIGHT, scale=1.0),
            Quantity(name="x/L of the head", exact=-SIDEWAYS, scale=1.0),
            Quantity(name="M of the clamp [N mm]", exact=load.force[1] * length * SIDEWAYS - load.moment),
        ),
        trials=(
            on_scene(EXACT, 1e-6, SHORTER, read),
            on_scene(mixed(20), 1e-5, FOURTH, read),
            on_scene(paper(20), 1e-2, SECOND, read),
        ),
        picture=Picture(axes=MM, curves=undeformed(scene)),
    )


def pinned_column() -> Problem:
    """Column between hinges with an imperfection, beyond its buckling load."""
    scene = rigid(load_scene("pinned-column"), NEARLY_RIGID)
    length = scene.beams[0].length

    def read(response: Response) -> tuple[float, float]:
        line = response.axis_line("column", len(response.load_parameter) - 1)[1]
        return float(line[-1, 1]) / length, abs(float(line[len(line) // 2, 0])) / length

    return Problem(
        name="pinned-column",
        title="Column between hinges beyond Euler's load",
        purpose="A sliding hinge that goes down by most of the column's length.",
        uncertainty=1e-12,
        scene=scene,
        statement=f"A column of 200 mm, {STRIP_COLUMN}, on a hinge below, and above on one that slides down. A dead load grows to 80 N at its head, 1.85 times Euler's "
        "load, and with it two moments of 8 N mm at its ends, the imperfection.",
        source=f"half of the column is a clamped one; {IMPERFECT}",
        quantities=(
            Quantity(name="y/L of the upper end", exact=HEIGHT, scale=1.0),
            Quantity(name="distance of the middle from the y axis over L", exact=SIDEWAYS / 2.0, scale=1.0),
        ),
        trials=(
            on_scene(EXACT, 1e-6, SHORTER, read),
            on_scene(mixed(20), 1e-5, FOURTH, read),
            on_scene(paper(20), 1e-2, SECOND, read),
        ),
        picture=Picture(axes=MM, curves=undeformed(scene)),
    )

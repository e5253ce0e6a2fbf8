"""Loads along a beam, natural curvature and taper against shooting and against numbers known in closed form."""

import math
from dataclasses import replace

import numpy as np
import pytest

import tsm
from tests.oracles.shooting import Rod, free, pinned
from tests.tsm.structures import CLAMP, beam, cantilever, raised

E, G, WIDTH, HEIGHT = 1.2e5, 4.5e4, (0.1, 0.06), (0.1, 0.05)
"""EI is 1 at the clamp; EA is 1200."""
WHOLE = (((0.4, -1.8), (-0.3, 0.5), (0.2, 0.7)), 0.0, 1.0)
PART = (((-0.5, 2.6),), 0.3, 0.8)
KEYS = {
    "load": {"loads": (WHOLE,)},
    "load on a part": {"loads": (PART,)},
    "natural curvature": {"turn": 1.1},
    "taper": {"tapered": True},
    "all": {"loads": (WHOLE, PART), "turn": 1.1, "tapered": True},
}


def rod(*, loads=(), turn=0.0, tapered=False, tip=(0.0, 0.0, 0.0), **_):
    """The rod for shooting; its axis begins along the x axis."""

    def value(coefficients):
        return lambda x: np.array([sum(c[k] * x**n for n, c in enumerate(coefficients)) for k in range(2)])

    laden = tuple((value(coefficients), begin, end) for coefficients, begin, end in loads)
    height, width = ((a, c if tapered else a) for a, c in (HEIGHT, WIDTH))
    return Rod(height=height, width=width, youngs_modulus=E, shear_modulus=G, turn=turn, loads=laden, tip=tip)


def section(number):
    return tsm.Section.rectangle(
        width=WIDTH[number], height=HEIGHT[number], youngs_modulus=E, shear_modulus=G
    )


def structure(
    *,
    loads=(),
    turn=0.0,
    tapered=False,
    tip=(0.0, 0.0, 0.0),
    pin=None,
    offset=0.0,
    more=(),
    elements=1,
    element="exact",
):
    """The same rod of unit length as a structure, with a pin that moves by `pin` from the surface of its undeformed axis."""
    half = turn / 2
    chord = math.sin(half) / half if half else 1.0
    strip = beam(
        "b", (0.0, 0.0), (chord * math.cos(half), chord * math.sin(half)), section=section(0), turn=turn,
        end_section=section(1) if tapered else None, elements=elements, element=element,
    ).divided(*(end for _, a, b in loads for end in (a, b)))  # fmt: skip
    pins, contacts = (), ()
    if pin:
        place, begin, move = pin
        end = dict(more).get("end_offset", offset)
        (x, y), angle, depth = strip.point(place), strip.direction(place), offset + place * (end - offset)
        x, y = x + depth * math.sin(angle), y - depth * math.cos(angle)
        pins = (tsm.Pin(name="p", path=((x + begin[0], y + begin[1]), (x + move[0], y + move[1]))),)
        contacts = (tsm.ContactPair(node="p", beam="b", offset=offset, **dict(more)),)
    return tsm.Structure(
        beams=(strip,),
        supports=(CLAMP,),
        loads=(tsm.Load(beam="b", end="end", force=tip[:2], moment=tip[2]),),
        line_loads=tuple(tsm.LineLoad(beam="b", force=force, start=a, end=b) for force, a, b in loads),
        pins=pins,
        contacts=contacts,
    )


PIN = (0.7, (0.0, 0.0), (-0.1, 0.3))
CASES = {
    "tip load": {"tip": (0.3, 0.9, -0.2)},
    "pin": {"pin": PIN, "offset": 0.05},
    # the contact force leans by the slope of the surface from the normal of the axis
    "face": {"pin": (0.6, (0.02, -0.01), (-0.1, 0.3)), "offset": 0.08, "more": (("end_offset", 0.02),)},
}


@pytest.mark.parametrize(
    ("case", "key"), [*(("tip load", key) for key in KEYS), ("pin", "all"), ("face", "all")]
)
def test_exact_against_shooting(case, key):
    """Position and angle of the tip, force and moment at the clamp, force and place of the contact, all of the order 1."""
    given = {**KEYS[key], **CASES[case]}
    problem = structure(**given)
    result = tsm.solve(problem, [0.5, 1.0])
    assert result.status is tsm.Status.COMPLETED
    support, strip = result.supports["b.start"], problem.beams[0]
    tip = result.shape("b", -1)[-1]
    found = [*tip[:2], tip[2] + strip.direction(1.0), *-support.force[-1], -support.moment[-1]]
    if case == "tip load":
        shot = free(rod(**given), np.array(found[3:]) + 1e-3)
        expected = [*shot.tip, *shot.clamp]
    else:
        touch, contact = result.equilibria[-1].state.touches[0], result.contacts["p->b"]
        found += [*touch.force, contact.arc_position[-1]]
        reach = (given["offset"], dict(given.get("more", ())).get("end_offset", given["offset"]))
        shot = pinned(rod(**KEYS[key]), problem.pins[0].path[-1], reach, np.array(found[3:]) + 1e-3)
        expected = [*shot.tip, *shot.clamp, *shot.force, shot.arc]
        assert contact.force[-1] == pytest.approx(np.hypot(*shot.force), abs=1e-9)
    assert np.array(found) == pytest.approx(np.array(expected), abs=1e-9)


@pytest.mark.slow
def test_too_coarse_a_mesh_for_a_boundary_layer_is_told():
    """Tension along the clamp's normal, 40,000 EI/L^2: the layer at the clamp has the length L/200."""
    tight = {"loads": (((((0.0, 1e-3),)), 0.0, 1.0),), "tip": (0.0, 4e4, 0.0)}
    stiff = tsm.Section(EA=1e9, GA=1e9, EI=1.0)

    def status(elements, element):
        given = structure(**tight, elements=elements, element=element)
        stiffer = replace(given, beams=(replace(given.beams[0], section=stiff),))
        return tsm.solve(stiffer, [1.0], throw=False).status

    assert status(4, "mixed") is tsm.Status.INACCURATE
    assert status(150, "mixed") is status(8, "exact") is tsm.Status.COMPLETED


@pytest.mark.slow
def test_largest_span_of_a_heavy_strip_on_two_points():
    """Curtis, Griffiths and Vella: up to the half span 1/e of its half length a strip bears any weight on two points without friction.

    Beyond, the weight f has a limit, with ``a - 1/e = c f^(-1/2) + ...``: the half span is extrapolated to infinite weight.
    """
    spans, limits = [], []
    for beyond in (0.012, 0.008, 0.006, 0.004):
        span, weight = 1 / math.e + beyond, 1.1 * (1.167 / beyond) ** 2
        stiff = tsm.Section(EA=1e9 * weight, GA=1e9 * weight, EI=1.0)
        slider = (replace(CLAMP, uy=None),)
        half = cantilever(raised(span, 1e-9), section=stiff, elements=4, element="exact", supports=slider)
        weighted = replace(half, line_loads=(tsm.LineLoad(beam="b", force=((0.0, -weight),)),))
        result = tsm.solve(weighted, [1.0], throw=False)
        assert result.status is tsm.Status.LIMIT_POINT
        spans.append(span)
        limits.append(result.critical[-1].load_parameter * weight)
    least = np.polyfit(np.array(limits) ** -0.5, spans, 3)[-1]
    assert least == pytest.approx(1 / math.e, abs=1e-6)

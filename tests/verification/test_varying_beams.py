"""Loads along a beam, natural curvature and taper against shooting and against numbers known in closed form."""

import math

import numpy as np
import pytest

import tsm
from tests.verification.rod_by_shooting import Rod, free, pinned

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


def rod(*, loads=(), turn=0.0, tapered=False, tip=(0.0, 0.0, 0.0)):
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
    elements=1,
    element="exact",
):
    """The same rod of unit length as a structure, with a pin that moves from its undeformed axis by `pin`."""
    half = turn / 2
    chord = math.sin(half) / half if half else 1.0
    beam = tsm.Beam(
        name="b",
        start=(0.0, 0.0),
        end=(chord * math.cos(half), chord * math.sin(half)),
        section=section(0),
        end_section=section(1) if tapered else None,
        turn=turn,
        elements=elements,
        element=element,
    ).divided(*(end for _, a, b in loads for end in (a, b)))
    pins, contacts = (), ()
    if pin:
        (x, y), angle = beam.point(0.7), beam.direction(0.7)
        x, y = x + offset * math.sin(angle), y - offset * math.cos(angle)
        pins = (tsm.Pin(name="p", path=((x, y), (x + pin[0], y + pin[1]))),)
        contacts = (tsm.ContactPair(node="p", beam="b", offset=offset),)
    return tsm.Structure(
        beams=(beam,),
        supports=(tsm.Support(beam="b", end="start"),),
        loads=(tsm.Load(beam="b", end="end", force=tip[:2], moment=tip[2]),),
        line_loads=tuple(tsm.LineLoad(beam="b", force=force, start=a, end=b) for force, a, b in loads),
        pins=pins,
        contacts=contacts,
    )


def apart(result, shot):
    """Largest difference in position, angle, force and moment; all of the order 1."""
    support = result.supports["b.start"]
    tip = result.shape("b", -1)[-1]
    clamp = np.array([*support.force[-1], support.moment[-1]])
    beam = result.model.structure.beams[0]
    turned = tip[2] + beam.direction(1.0)
    differences = [*(tip[:2] - shot.tip[:2]), turned - shot.tip[2], *(clamp + shot.clamp)]
    if not math.isnan(shot.arc):
        touch = result.equilibria[-1].state.touches[0]
        differences += [
            *(np.array(touch.force) - shot.force),
            result.contacts["p->b"].arc_position[-1] - shot.arc,
        ]
    return np.abs(differences).max()


@pytest.mark.parametrize("key", KEYS)
@pytest.mark.parametrize("pin", [None, (-0.1, 0.3)], ids=["tip load", "pin"])
def test_exact_against_shooting(key, pin):
    given = KEYS[key]
    tip = (0.0, 0.0, 0.0) if pin else (0.3, 0.9, -0.2)
    offset = 0.05 if pin else 0.0
    result = tsm.solve(structure(**given, tip=tip, pin=pin, offset=offset), [0.5, 1.0])
    assert result.status is tsm.Status.COMPLETED
    support = result.supports["b.start"]
    guess = -np.array([*support.force[-1], support.moment[-1]])
    if pin:
        touch = result.equilibria[-1].state.touches[0]
        assert touch is not None
        guess = np.array([*guess, *touch.force, result.contacts["p->b"].arc_position[-1]])
        place = result.model.structure.pins[0].path[-1]
        shot = pinned(rod(**given), place, offset, guess + 1e-3)
    else:
        shot = free(rod(**given, tip=tip), guess + 1e-3)
    assert apart(result, shot) <= 1e-9


@pytest.mark.parametrize("key", KEYS)
@pytest.mark.parametrize("pin", [None, (-0.1, 0.3)], ids=["tip load", "pin"])
def test_mixed_converges_with_fourth_order_at_least(key, pin):
    """8 and 32 elements, between the ends of loads; 8 elements are good for six digits."""
    tip, offset = ((0.0, 0.0, 0.0), 0.05) if pin else ((0.3, 0.9, -0.2), 0.0)
    given = {**KEYS[key], "tip": tip, "pin": pin, "offset": offset}

    def numbers(elements, element):
        result = tsm.solve(structure(**given, elements=elements, element=element), [0.5, 1.0])
        support = result.supports["b.start"]
        found = [*result.shape("b", -1)[-1], *support.force[-1], support.moment[-1]]
        if pin:
            history = result.contacts["p->b"]
            found += [history.force[-1], history.arc_position[-1]]
        return np.array(found)

    exact = numbers(1, "exact")
    coarse, fine = (np.abs(numbers(n, "mixed") - exact).max() for n in (8, 32))
    assert coarse <= 1e-6
    assert fine <= max(coarse / 4**4, 1e-11)


def test_too_few_mixed_elements_say_how_much_they_bend():
    for elements in (1, 5):
        result = tsm.solve(
            structure(turn=5.0, element="mixed", tip=(0.0, 0.0, 0.1), elements=elements), [1.0]
        )
        assert result.deformation.turn[-1] == pytest.approx(5.1 / elements, rel=0.05)
        assert (result.deformation.turn[-1] > result.deformation.bearable) == (elements == 1)


def test_an_arc_is_straightened_by_its_natural_moment():
    """A moment ``-EI k0`` at the tip makes a straight line of an arc of almost a full circle."""
    turn = 5.0
    bent = structure(turn=turn)
    beam = bent.beams[0]
    moment = -beam.section.EI * beam.curvature
    result = tsm.solve(structure(turn=turn, tip=(0.0, 0.0, moment)), [0.5, 1.0])
    arc, line = result.axis_line("b", -1)
    assert np.abs(line - np.outer(arc, [1.0, 0.0])).max() <= 1e-12
    assert result.supports["b.start"].moment[-1] == pytest.approx(-moment, rel=1e-12)
    half = result.axis_line("b", 0)[1][-1]
    assert half == pytest.approx(
        [math.sin(turn / 2) / (turn / 2), (1 - math.cos(turn / 2)) / (turn / 2)], abs=1e-12
    )


def test_small_weight_bends_a_cantilever_by_the_eighth():
    """``q L^4/8EI`` and the shear ``q L^2/2GA``; what is left falls with the square of the weight."""
    given = section(0)
    left = []
    for weight in (1e-1, 1e-2):
        result = tsm.solve(structure(loads=((((0.0, -weight),), 0.0, 1.0),)), [1.0])
        linear = weight * (1 / (8 * given.EI) + 1 / (2 * given.GA))
        left.append(abs(-result.tips["b"][-1][1] / linear - 1))
    assert left[0] < 1e-3
    assert math.log10(left[0] / left[1]) == pytest.approx(2.0, abs=0.01)

"""Hinges and springs: structures whose exact answers follow by hand."""

from dataclasses import replace

import pytest

import tsm
from tests.tsm.structures import TENTHS as T
from tests.tsm.structures import beam as made

SECTION = tsm.Section(EA=1e4, GA=4e3, EI=2.0)
FOOT = tsm.Support(beam="b", end="start")


def beam(name, start, end, element):
    elements = 1 if element == "exact" else 4
    return made(name, start, end, element=element, section=SECTION, elements=elements)


def on_foot(held, element, **more):
    """A beam whose start turns freely, on a hinge in its clamp or on a pinned support."""
    return tsm.Structure(
        beams=(beam("b", (0, 0), (1.0, 0.0), element),),
        supports=(replace(FOOT, rotation=0.0 if held == "hinge" else None),),
        hinges=(tsm.Hinge(beam="b", end="start"),) if held == "hinge" else (),
        **more,
    )


def test_a_mechanism_has_a_name():
    """A frame of three beams with two hinges, unless a spring holds it; a beam that nothing holds."""
    corners = ((0, 0), (0, 1), (1, 1), (1, 0))
    structure = tsm.Structure(
        beams=tuple(beam(name, *corners[n : n + 2], "mixed") for n, name in enumerate("abc")),
        supports=tuple(
            tsm.Support(beam=name, end=end, rotation=None) for name, end in (("a", "start"), ("c", "end"))
        ),
        hinges=(tsm.Hinge(beam="a", end="end"), tsm.Hinge(beam="b", end="end")),
        loads=(tsm.Load(beam="b", end="start", force=(0.1, 0)),),
    )
    assert tsm.solve(structure, T, throw=False).status is tsm.Status.MECHANISM
    held = replace(structure, springs=(tsm.Spring(beam="b", end="start", x=1.0),))
    assert tsm.solve(held, T).springs["b.start"].force[-1, 0] == pytest.approx(-0.1, rel=0.02)
    free = tsm.Structure(beams=structure.beams[1:2], loads=structure.loads)
    assert tsm.solve(free, T, throw=False).status is tsm.Status.MECHANISM


@pytest.mark.parametrize(("element", "held"), [("mixed", "hinge"), ("exact", "pinned")])
def test_a_contact_without_force_holds_no_mechanism(element, held):
    """A beam on a hinge or a pinned support, and on a pin: it may lie there or lift off unless a load presses it down, at the start and where a stage begins."""
    load, back = (tsm.Load(beam="b", end="end", force=(0, f), stage=k) for k, f in enumerate((-1e-3, 1e-3)))
    structure = on_foot(
        held, element, loads=(load, back),
        pins=(tsm.Pin(name="p", path=((0.5, 0.0), (0.5, 0.1)), onward=((), ((0.5, 0.2),))),),
        contacts=(tsm.ContactPair(node="p", beam="b"),),
    )  # fmt: skip
    pressed = tsm.solve(structure, [*T, 1.5, 2.0, 2.5, 3.0], throw=False)
    assert pressed.status is tsm.Status.MECHANISM
    assert pressed.load_parameter[-1] == 2.0
    by_hand = 2e-3 * T / (1.0 + (0.2 * T) ** 2)
    assert pressed.contacts["p->b"].force[:10] == pytest.approx(by_hand, rel=1e-3)
    for force in ((0.0, 0.0), (0.0, 1e-3)):
        result = tsm.solve(replace(structure, loads=(replace(load, force=force),)), T, throw=False)
        assert result.status is tsm.Status.MECHANISM
        assert not len(result.load_parameter)

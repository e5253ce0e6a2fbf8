"""Stages that move pins, supports and loads on."""

import numpy as np
import pytest

import fem_reference as fr
from fem_reference.stages import amount, increment
from tests.fem_reference.conftest import PAIR, STRIP, make_problem, make_strip

EI = make_strip().bending_stiffness


def test_amounts_add_up():
    changes = (2.0, -1.0, 4.0)
    assert [amount(changes, t) for t in (0.5, 1.0, 1.5, 2.0, 2.25)] == [1.0, 2.0, 1.5, 1.0, 2.0]
    assert [increment(changes, a, a + 0.5) for a in (0.5, 1.0, 1.5, 2.0)] == [2.0, -1.0, -1.0, 4.0]


def test_a_pin_goes_on_from_where_it_is():
    pin = fr.Pin(name="p", path=((0.0, 0.0),), onward=(((1.0, 0.0), (1.0, 1.0)), (), ((0.0, 1.0),)))
    places = [pin.position(t).tolist() for t in (0.5, 1.0, 1.5, 2.0, 2.7, 3.5, 4.0)]
    assert places == [[0, 0], [0, 0], [1, 0], [1, 1], [1, 1], [0.5, 1], [0, 1]]
    assert pin.turns == (1.5,)


def staged(mesh=(20, 1)):
    """A pin, a support and a load of every kind, moved in the first stage, and back in the third one."""
    inner = [fr.LineLoad(strip=STRIP, force=((0.0, sign * EI),), stage=k) for sign, k in ((-3, 0), (3, 2))]
    inner += [
        fr.PointLoad(strip=STRIP, at=0.6, force=(0.0, sign * EI), stage=k) for sign, k in ((-1, 0), (1, 2))
    ]
    ends = [fr.EndLoad(strip=STRIP, moment=sign * EI, stage=k) for sign, k in ((0.5, 1), (-0.5, 2))]
    support = fr.Support(
        strip=STRIP,
        end="start",
        motion=(0.0, 0.02, 0.3),
        onward=((0.0, 0.0, 0.0), (0.0, -0.02, -0.3)),
    )
    pin = fr.Pin(name="pin", path=((0.8, -0.001), (0.8, 0.1)), onward=((), ((0.8, -0.001),)))
    contact = fr.Contact(node="pin", strip=STRIP, penalty=1e4)
    return fr.SolidProblem(
        strips=(make_strip(mesh=mesh, clamped=()),),
        pins=(pin,),
        contacts=(contact,),
        supports=(support,),
        loads=tuple(ends),
        inner_loads=tuple(inner),
    )


def test_a_stage_leads_back_on_the_way_there():
    """What the first two stages have done, the third one undoes, and every state of it is in balance."""
    problem = staged()
    assert problem.stages == 3
    assert problem.turns == (1.0, 2.0)
    result = fr.solve(problem, np.arange(1, 13) / 4)
    assert result.contacts[PAIR].force[3] > 0.01 * EI
    assert np.abs(result.displacement[-1]).max() < 1e-8
    assert np.abs(result.supports[f"{STRIP}.start"].force[-1]).max() < 1e-8 * EI
    middle = result.supports[f"{STRIP}.start"]
    assert middle.force[7, 1] != pytest.approx(middle.force[3, 1], rel=1e-3)  # the moment of the second stage


def test_one_stage_in_two_has_the_same_end():
    """Half a motion in each of two stages leads to the states of the whole motion."""
    whole = make_problem(path=((0.8, 0.0), (0.8, 0.2)), mesh=(20, 1))
    pin = fr.Pin(name="pin", path=((0.8, 0.0), (0.8, 0.1)), onward=(((0.8, 0.2),),))
    halves = fr.SolidProblem(strips=whole.strips, pins=(pin,), contacts=whole.contacts)
    one, two = fr.solve(whole, np.array([0.5, 1.0])), fr.solve(halves, np.array([1.0, 2.0]))
    np.testing.assert_allclose(two.contacts[PAIR].force, one.contacts[PAIR].force, rtol=1e-8)
    np.testing.assert_allclose(two.displacement, one.displacement, atol=1e-9)


def test_mistakes_cost_one_line():
    with pytest.raises(ValueError, match=r"must be a one-dimensional increasing array in \(0, 3\]"):
        fr.solve(staged(), np.array([3.1]))
    with pytest.raises(ValueError, match=r"path = .*must have at least one point"):
        fr.Pin(name="p", path=())
    with pytest.raises(ValueError, match="stage = -1: must not be negative"):
        fr.EndLoad(strip=STRIP, moment=1.0, stage=-1)
    with pytest.raises(ValueError, match=r"onward = .*must be three finite values"):
        fr.Support(strip=STRIP, end="end", onward=((0.0, 0.0),))

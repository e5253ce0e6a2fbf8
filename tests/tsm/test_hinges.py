"""Hinges and springs: structures whose exact answers follow by hand."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

import tsm

SECTION = tsm.Section(EA=1e4, GA=4e3, EI=2.0)
T = np.linspace(0.1, 1.0, 10)
ELEMENTS = ("mixed", "exact", "timoshenko")


def beam(
    name: str, start: tuple[float, float], end: tuple[float, float], element: str, **more: object
) -> tsm.Beam:
    given = {"section": SECTION, "elements": 1 if element == "exact" else 4, **more}
    return tsm.Beam(name=name, start=start, end=end, element=element, **given)


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_beam_on_two_springs_turns_without_strain(element: str) -> None:
    structure = tsm.Structure(
        beams=(beam("b", (0, 0), (2, 0), element),),
        supports=(tsm.Support(beam="b", end="start", uy=None, rotation=None),),
        springs=(tsm.Spring(beam="b", end="start", y=3.0), tsm.Spring(beam="b", end="end", y=5.0)),
        loads=(
            tsm.Load(beam="b", end="start", force=(0, 1.2)),
            tsm.Load(beam="b", end="end", force=(0, -4.0)),
        ),
    )
    result = tsm.solve(structure, T)
    down, angle = -4.0 * T / 5.0, np.arcsin((-4.0 * T / 5.0 - 1.2 * T / 3.0) / 2.0)
    assert result.tips["b"] == pytest.approx(np.stack([2.0 * np.cos(angle), down], axis=1), abs=1e-12)
    assert result.springs["b.end"].force == pytest.approx(np.stack([0 * T, 4.0 * T], axis=1), abs=5e-12)
    assert result.strain_energy == pytest.approx(1.5 * (1.2 * T / 3.0) ** 2 + 2.5 * down**2, abs=1e-12)
    assert (result.index == 0).all()


@pytest.mark.parametrize("held", ["hinge", "spring"])
def test_a_spring_at_the_foot_turns_a_beam_that_rolls_up(held: str) -> None:
    M, k, L = 2.5, 4.0, 1.0
    structure = tsm.Structure(
        beams=(beam("b", (0, 0), (L, 0), "exact"),),
        supports=(tsm.Support(beam="b", end="start", rotation=0.0 if held == "hinge" else None),),
        loads=(tsm.Load(beam="b", end="end", moment=M),),
    )
    if held == "hinge":
        structure = replace(structure, hinges=(tsm.Hinge(beam="b", end="start", stiffness=k),))
    else:
        structure = replace(structure, springs=(tsm.Spring(beam="b", end="start", rotation=k),))
    result = tsm.solve(structure, T)
    foot, curvature = M * T / k, M * T / SECTION.EI
    end = foot + curvature * L
    tip = np.stack([np.sin(end) - np.sin(foot), np.cos(foot) - np.cos(end)], axis=1) / curvature[:, None]
    assert result.tips["b"] == pytest.approx(tip, abs=1e-13)
    assert result.shape("b", -1)[0, 2] == pytest.approx(M / k, abs=1e-14)
    reaction = result.supports["b.start"].moment if held == "hinge" else result.springs["b.start"].moment
    assert reaction == pytest.approx(-M * T, abs=1e-13)


def truss(element: str, height: float, load: float, **more: object) -> tsm.Structure:
    section = tsm.Section(EA=100.0, GA=40.0, EI=30.0)
    return tsm.Structure(
        beams=(
            beam("left", (0, 0), (1, height), element, section=section),
            beam("right", (1, height), (2, 0), element, section=section),
        ),
        supports=(
            tsm.Support(beam="left", end="start", rotation=None),
            tsm.Support(beam="right", end="end", rotation=None),
        ),
        hinges=(tsm.Hinge(beam="left", end="end"),),
        loads=(tsm.Load(beam="left", end="end", force=(0, -load)),),
        **more,
    )


@pytest.mark.parametrize("element", ELEMENTS)
def test_two_hinged_bars_snap_through_at_the_load_of_mises(element: str) -> None:
    height, EA = 0.4, 100.0
    length = math.hypot(1.0, height)
    limit = 2.0 * EA * math.sqrt(1.0 - (1.0 / length) ** (2 / 3)) ** 3

    def off(result: tsm.Result, load: np.ndarray) -> float:
        """Largest error of the load at the positions of the apex, over the greatest load."""
        rise = result.tips["left"][:, 1]
        now = np.hypot(1.0, rise)
        return float(np.abs(2.0 * EA * (1.0 - now / length) * rise / now - load).max() / limit)

    # what is left is Newton's tolerance
    for settings, allowed in ((tsm.Settings(), 1e-9), (tsm.Settings(tolerance=1e-13), 1e-12)):
        assert off(tsm.solve(truss(element, height, 0.9 * limit), T, settings), 0.9 * limit * T) < allowed
        path = tsm.trace(truss(element, height, 5.0 * limit), arc_length=0.1, steps=60, settings=settings)
        assert off(path, 5.0 * limit * path.load_parameter) < allowed
        assert [event.load_parameter for event in path.events] == pytest.approx([0.2, -0.2], abs=1e-12)


@pytest.mark.parametrize("held", ["hinge", "spring"])
def test_a_column_on_a_spring_buckles_at_its_load(held: str) -> None:
    L, k = 1.0, 3.0
    x = brentq(lambda x: x * math.tan(x) - k * L / SECTION.EI, 0.1, 1.5, xtol=1e-15)
    critical = SECTION.EI * x * x / L**2
    stiff = tsm.Section(EA=1e9, GA=1e9, EI=SECTION.EI)
    structure = tsm.Structure(
        beams=(beam("b", (0, 0), (0, L), "exact", section=stiff),),
        supports=(tsm.Support(beam="b", end="start", rotation=0.0 if held == "hinge" else None),),
        hinges=(tsm.Hinge(beam="b", end="start", stiffness=k),) if held == "hinge" else (),
        springs=() if held == "hinge" else (tsm.Spring(beam="b", end="start", rotation=k),),
        loads=(tsm.Load(beam="b", end="end", force=(0, -2.0 * critical)),),
    )
    result = tsm.solve(structure, T, throw=False)
    assert result.status is tsm.Status.BIFURCATION
    assert result.critical[0].load_parameter == pytest.approx(0.5, abs=1e-8)
    followed = tsm.solve(structure, T, tsm.Settings(branch="primary"))
    assert followed.index.tolist() == [0] * 5 + [1] * 5 if followed.index[4] == 0 else [0] * 4 + [1] * 6


@pytest.mark.parametrize("element", ["mixed", "exact"])
def test_a_hinge_carries_a_pin_to_both_beams(element: str) -> None:
    """A pin beside a hinge between two cantilevers: forces balance, and the hinge carries no moment."""
    structure = tsm.Structure(
        beams=(beam("a", (0, 0), (1, 0), element), beam("b", (1, 0), (2, 0), element)),
        supports=(tsm.Support(beam="a", end="start"), tsm.Support(beam="b", end="end", ux=None)),
        hinges=(tsm.Hinge(beam="b", end="start"),),
        springs=(tsm.Spring(beam="a", end="end", y=6.0),),
        pins=(tsm.Pin(name="p", path=((0.8, 0.0), (0.8, 0.3))),),
        contacts=(tsm.ContactPair(node="p", beam="a", side="right"),),
    )
    result = tsm.solve(structure, T)
    moment = result.section_forces("a", -1)[-1, 1, 2], result.section_forces("b", -1)[0, 0, 2]
    assert np.array(moment) == pytest.approx(0.0, abs=1e-9)
    joint = [result.shape("a", -1)[-1], result.shape("b", -1)[0]]
    assert joint[0][:2] == pytest.approx(joint[1][:2], abs=1e-15)
    assert abs(joint[0][2] - joint[1][2]) > 0.5
    assert result.springs["a.end"].force[-1, 1] == pytest.approx(-6.0 * joint[0][1], abs=1e-12)
    work = np.trapezoid  # the pin's work is the strain energy
    fine = tsm.solve(structure, np.linspace(0.0, 1.0, 401)[1:])
    force = np.array([equilibrium.system.forces[0][1] for equilibrium in fine.equilibria])
    done = work(np.append(0.0, force), dx=0.3 / 400)
    assert fine.strain_energy[-1] == pytest.approx(done, rel=1e-5)


def test_a_mechanism_has_a_name() -> None:
    structure = tsm.Structure(
        beams=(
            beam("a", (0, 0), (0, 1), "mixed"),
            beam("b", (0, 1), (1, 1), "mixed"),
            beam("c", (1, 1), (1, 0), "mixed"),
        ),
        supports=(
            tsm.Support(beam="a", end="start", rotation=None),
            tsm.Support(beam="c", end="end", rotation=None),
        ),
        hinges=(tsm.Hinge(beam="a", end="end"), tsm.Hinge(beam="b", end="end")),
        loads=(tsm.Load(beam="b", end="start", force=(0.1, 0)),),
    )
    assert tsm.solve(structure, T, throw=False).status is tsm.Status.MECHANISM
    held = replace(structure, springs=(tsm.Spring(beam="b", end="start", x=1.0),))
    assert tsm.solve(held, T).springs["b.start"].force[-1, 0] == pytest.approx(-0.1, rel=0.02)


@pytest.mark.parametrize("held", ["hinge", "pinned"])
@pytest.mark.parametrize("element", ["mixed", "exact"])
def test_a_contact_without_force_holds_no_mechanism(element: str, held: str) -> None:
    """A beam on a hinge or a pinned support, and on a pin: it may lie there or lift off unless a load presses it down, at the start and where a stage begins."""
    load, back = (tsm.Load(beam="b", end="end", force=(0, f), stage=k) for k, f in enumerate((-1e-3, 1e-3)))
    structure = tsm.Structure(
        beams=(beam("b", (0, 0), (1, 0), element),),
        supports=(tsm.Support(beam="b", end="start", rotation=0.0 if held == "hinge" else None),),
        hinges=(tsm.Hinge(beam="b", end="start"),) if held == "hinge" else (),
        pins=(tsm.Pin(name="p", path=((0.5, 0.0), (0.5, 0.1)), onward=((), ((0.5, 0.2),))),),
        contacts=(tsm.ContactPair(node="p", beam="b", side="right"),),
        loads=(load, back),
    )
    pressed = tsm.solve(structure, [*T, 1.5, 2.0, 2.5, 3.0], throw=False)
    assert pressed.status is tsm.Status.MECHANISM
    assert pressed.load_parameter[-1] == 2.0
    by_hand = 2e-3 * T / (1.0 + (0.2 * T) ** 2)
    assert pressed.contacts["p->b"].force[:10] == pytest.approx(by_hand, rel=1e-3)
    for force in ((0.0, 0.0), (0.0, 1e-3)):
        lifted = replace(structure, loads=(replace(load, force=force),))
        result = tsm.solve(lifted, T, throw=False)
        assert result.status is tsm.Status.MECHANISM
        assert not len(result.load_parameter)


@pytest.mark.parametrize(("length", "force"), [(1e-3, 1e8), (1e3, 1e-8)])
def test_a_hinged_structure_in_small_or_large_units_is_no_mechanism(length: float, force: float) -> None:
    """An open contact, whose unknowns nothing couples to the others, has no part in the singular values."""
    section = tsm.Section(EA=1e4 * force, GA=4e3 * force, EI=force * length**2)
    frame = tsm.Structure(
        beams=(
            tsm.Beam(name="a", start=(0, 0), end=(length, 0), section=section, elements=1, element="exact"),
            tsm.Beam(
                name="b",
                start=(length, 0),
                end=(length, length),
                section=section,
                elements=1,
                element="exact",
            ),
        ),
        supports=(tsm.Support(beam="a", end="start"), tsm.Support(beam="b", end="end", rotation=None)),
        hinges=(tsm.Hinge(beam="b", end="start"),),
        pins=(tsm.Pin(name="p", path=((0.5 * length, -0.1 * length), (0.5 * length, 0.1 * length))),),
        contacts=(tsm.ContactPair(node="p", beam="a", side="right"),),
    )
    result = tsm.solve(frame, T, throw=False)
    assert result.status is tsm.Status.COMPLETED
    assert result.contacts["p->a"].arc_position[-1] / length == pytest.approx(0.51, abs=0.02)


def test_many_slender_elements_are_no_mechanism() -> None:
    """Their stiffness of bending is below the round-off of the tangent, but a mechanism strains no element."""
    stiff = tsm.Section(EA=1e11, GA=1e11, EI=1.0)
    frame = tsm.Structure(
        beams=tuple(
            beam(name, (x, 0), (x + 1, 0), "mixed", section=stiff, elements=60) for x, name in enumerate("ab")
        ),
        supports=(tsm.Support(beam="a", end="start"), tsm.Support(beam="b", end="end", ux=None)),
        hinges=(tsm.Hinge(beam="b", end="start"),),
        loads=(tsm.Load(beam="b", end="start", force=(0, -0.01)),),
    )
    result = tsm.solve(frame, T)
    assert result.tips["a"][-1, 1] == pytest.approx(-0.01 / 6, rel=1e-3)


def test_a_hinge_or_spring_that_cannot_be_is_refused() -> None:
    with pytest.raises(ValueError, match=r"Hinge\(b.end\): the joint turns freely"):
        tsm.solve(replace(truss("mixed", 0.4, 1.0), beams=(beam("b", (0, 0), (1, 0), "mixed"),), loads=(),
                          supports=(tsm.Support(beam="b", end="start"),), hinges=(tsm.Hinge(beam="b", end="end"),)), T)  # fmt: skip
    with pytest.raises(ValueError, match="stiffness = -1"):
        tsm.Hinge(beam="b", end="end", stiffness=-1.0)
    with pytest.raises(ValueError, match="y = -2"):
        tsm.Spring(beam="b", end="end", y=-2.0)

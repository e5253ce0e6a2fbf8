"""What cannot be is refused by a ``ValueError`` of one line that names field, value and rule; what is at the limits is solved."""

import re
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

import tsm
from tests.tsm.structures import SECTION, as_mixed, beam, cantilever, hook, leaning, pushed, raised

ONE = cantilever(raised(0.8, 0.1), elements=4)
STAGED = replace(ONE, pins=(tsm.Pin(name="p0", path=((0.8, 0.0),), onward=(((0.8, 0.1),),)),))
FACE = {"node": "p", "beam": "b", "offset": 0.04, "end_offset": 0.02}


def of_beam(**changes):
    return lambda: replace(ONE.beams[0], **changes)


def structure(**changes):
    return lambda: replace(ONE, **changes)


def solved(structure, t=(1.0,)):
    return lambda: tsm.solve(structure, t)


def on_hook(**load):
    given = {"beam": "b", "force": ((0.0, -1.0),), **load}
    return lambda: hook(line_loads=(tsm.LineLoad(**given),))


def pair(**changes):
    return lambda: tsm.ContactPair(**{"node": "p", "beam": "b", **changes})


BY_THE_PAPER = "such elements are straight and uniform, without loads along them; use mixed"
STRAIGHT = beam("b", (0.0, 0.0), (1.0, 0.2), element="mixed", elements=4)
BOTH = replace(leaning(), beams=(leaning().beams[0], as_mixed(leaning()).beams[1]))
FREE_JOINT = replace(ONE, pins=(), contacts=(), hinges=(tsm.Hinge(beam="b", end="end"),))
PARTED = tsm.Structure(
    beams=(beam("a", (0.0, 0.0), (1.0, 0.0)), beam("c", (1.0, 0.0), (2.0, 0.0))),
    supports=(
        tsm.Support(beam="a", end="end"),
        tsm.Support(beam="c", end="start", onward=((0.0, 0.1, 0.0),)),
    ),
)
LONG = replace(ONE.beams[0], elements=600_000)
BAD = {
    "far end": (of_beam(end=(1e155, 0)), r"Beam\(b\)\.end = \(1e\+155, 0\): must be two finite numbers, of at most 1e\+50"),
    "huge integer": (of_beam(start=(10**400, 0)), r"Beam\(b\)\.start = "),
    "element": (of_beam(element="cubic"), "must be one of mixed"),
    "elements in all": (structure(beams=(LONG, replace(LONG, name="c"))), r"Structure\.elements = 1200000: must be at most 1000000 in all"),
    "memory": (
        solved(cantilever(elements=100_000), np.linspace(1e-5, 1, 100_000)),
        r"load_parameters = 100000: with 100000 elements and 0 contacts needs 5e\+03 GB, more than 80% of the memory",
    ),
    "node at the end": (of_beam(nodes=(0.2, 0.5, 1.0)), "must rise between 0 and 1"),
    "too few nodes": (of_beam(nodes=(0.5,)), "must be one less than elements = 4"),
    "whole turn": (of_beam(turn=2 * np.pi), "must lie between -2 pi and 2 pi"),
    "shear of a taper": (of_beam(end_section=tsm.Section(EA=1.0, GA=1.0, EI=1.0)), "must have the GA/EA of section"),
    "negative section": (lambda: tsm.Section(EA=1.0, GA=-1.0, EI=1.0), "must be positive"),
    "large section": (lambda: tsm.Section.rectangle(width=1.0, height=1e200, youngs_modulus=1.0, shear_modulus=1.0), r"EI = .*: must be positive and finite"),
    "support that is free and moves": (lambda: tsm.Support(beam="b", end="end", rotation=None, onward=((0.0, 0.0, 0.1),)), "must be zero where the component is free"),
    "stage of a load": (lambda: tsm.Load(beam="b", end="end", stage=-1), "stage = -1"),
    "point load beside a node": (lambda: hook(loads=(tsm.Load(beam="b", arc=0.4),)), "must be a node, see Beam"),
    "line load of nothing": (on_hook(force=()), "must hold pairs of finite numbers"),
    "curved beam of the paper": (solved(replace(hook(element="timoshenko"), line_loads=())), BY_THE_PAPER),
    "mixed and exact": (solved(BOTH), r'Beam\(low\).element = .mixed.: must be "exact" as of other beams here'),
    "pin without a point": (lambda: tsm.Pin(name="p", path=(), onward=((),)), "must have at least one point"),
    "pin behind the surface": (solved(cantilever(((0.8, 0.1), (0.8, 0.2)))), r"side = 'right': the node starts at \(0.8, 0.1\), 0.1 behind"),
    "friction": (pair(friction=-0.1), r"p->b.friction = .*: must lie between 0 and 100"),
    "friction on a taper": (pair(**FACE, friction=0.3), "must be 0 on a surface with an end_offset"),
    "steep face": (lambda: pushed(offset=0.04, end_offset=2.0), "must differ from offset by less than the length"),
    "face of a straight beam": (solved(replace(pushed(offset=0.04, end_offset=0.02), line_loads=(), beams=(STRAIGHT,))), "belongs to a beam that tapers or has elements"),
    "no such beam": (structure(contacts=(tsm.ContactPair(node="p0", beam="x"),)), "beam = 'x': names no beam"),
    "itself": (structure(contacts=(tsm.ContactPair(node="b.end", beam="b"),)), "does not touch itself"),
    "hinge on nothing": (solved(FREE_JOINT), r"Hinge\(b.end\): the joint turns freely"),
    "supports that part": (solved(PARTED), r"Support\(c.start\): contradicts another at the joint"),
    "spring that pushes": (lambda: tsm.Spring(beam="b", end="end", y=-2.0), "y = -2"),
    "past the last stage": (solved(STAGED, [1.0, 2.5]), r"must increase within \(0, 2\]"),
    "arc length over stages": (lambda: tsm.trace(STAGED, arc_length=0.1, steps=2), "arc-length control follows a single stage"),
    "arc length of nothing": (lambda: tsm.trace(ONE, arc_length=0.0, steps=2), "arc_length = 0.0: must be positive"),
    "no arc": (lambda: tsm.trace(ONE, arc_length=0.1, steps=0), "steps = 0: must be at least 1"),
    **{
        f"load parameters {t}": (solved(ONE, np.array(t)), "must increase within")
        for t in ([], [0.5, 0.5], [0.5, 1.5], [float("nan")], [[0.5]])
    },
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_what_cannot_be_is_refused(case):
    make, sentence = BAD[case]
    with pytest.raises(ValueError, match=sentence) as caught:
        make()
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("size", [1e-40, 1e40])
def test_a_structure_at_the_limits_is_solved(size):
    """The same cantilever in other units of length and force."""
    force = 1e-3 if size < 1 else 1e3
    section = tsm.Section(EA=8.4 * force, GA=2.7 * force, EI=2.8e-4 * force * size**2)
    load = tsm.Load(beam="b", end="end", force=(0.0, 2.8e-4 * force))
    result = tsm.solve(cantilever(section=section, length=size, elements=4, load=load), [0.5, 1.0])
    assert result.tips["b"][-1] / size == pytest.approx([0.9436, 0.3017], abs=1e-3)


@pytest.mark.parametrize("element", ["mixed", "exact"])
def test_the_estimate_of_the_memory_holds(element):
    """What a solution keeps of an element and a step is at most the estimate and at least half of it."""
    load = tsm.Load(beam="b", end="end", force=(0.0, 0.3 * SECTION.EI))
    structure = cantilever(element=element, elements=200, load=load)
    tsm.solve(structure, [1.0])
    tracemalloc.start()
    result = tsm.solve(structure, np.linspace(0.05, 1, 20))
    kept, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert result.status is tsm.Status.COMPLETED
    many = 100_000
    with pytest.raises(ValueError, match="of the memory") as refused:
        tsm.solve(cantilever(element=element, elements=many), np.arange(1, many + 1) / many)
    needed = 1e9 * float(re.findall(r"needs (\S+) GB", str(refused.value))[0])
    estimate = needed * 21 * 200 / ((many + 1) * many)
    assert 0.5 * estimate < kept < estimate

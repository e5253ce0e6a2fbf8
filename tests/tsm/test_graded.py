"""Beams of unequal elements."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import tsm
from comparisons.exact.rod import rod_under_pin
from comparisons.models.translate import to_structure
from comparisons.scene import load_scene
from tsm.model import Model
from tsm.projection import arc_position, slide

T = np.linspace(0.05, 1.0, 20)


def graded(nodes, element="mixed"):
    structure = to_structure(load_scene("ks-cantilever"), element=element)
    beam = replace(structure.beams[0], elements=len(nodes) + 1, nodes=tuple(nodes))
    return replace(structure, beams=(beam,))


@pytest.fixture(scope="module")
def rod():
    beam = load_scene("ks-cantilever").beams[0]
    path = np.array([(1 - t, 2 / np.pi * t) for t in (0.0, *T)])
    return np.hypot(*rod_under_pin(path, EA=beam.EA, GA=beam.GA, EI=beam.EI, length=1.0).force[1:].T)


def force(structure):
    return tsm.solve(structure, T).contacts["pin->cantilever"].force


@pytest.mark.parametrize(
    ("nodes", "rule"),
    [
        ((0.5, 0.5), "must rise between 0 and 1"),
        ((0.0, 0.5), "must rise between 0 and 1"),
        ((0.2, 1.0), "must rise between 0 and 1"),
        ((float("nan"), 0.5), "must rise between 0 and 1"),
        ((0.5,), "must be one less than elements = 3"),
    ],
)
def test_nodes_that_are_none(nodes, rule):
    beam = graded((0.2, 0.4)).beams[0]
    with pytest.raises(ValueError, match=rf"Beam\(cantilever\)\.nodes = .*{rule}"):
        replace(beam, nodes=nodes)


def test_a_position_passes_from_element_to_element():
    target = Model(graded((0.1, 0.5, 0.6))).beams["cantilever"]
    for element, xi in ((0, 1.5), (0, 7.0), (3, -0.5), (3, -1.2), (2, 1.0), (1, -1e-17), (3, 1.5), (0, -0.5)):
        arc = target.arcs[element] + xi * target.lengths[element]
        owner, at = slide(target.lengths, element, xi)
        assert arc_position(target, owner, at) == pytest.approx(arc, abs=1e-15)
        assert 0.0 <= at <= 1.0 or arc < 0.0 or arc > 1.0


@pytest.mark.parametrize("element", ["mixed", "exact"])
@pytest.mark.parametrize("ratio", [1e1, 1e3, 1e6])
def test_lengths_of_elements_may_differ(rod, element, ratio):
    """One short element among long ones, in the middle of the pin's way: it changes nothing but round-off."""
    nodes = np.union1d(np.arange(1, 10) / 10, 0.75 + 0.1 / ratio * np.array([0.0, 1.0]))
    bound = 2e-5 if element == "mixed" else 1e-11
    assert np.abs(force(graded(nodes, element)) - rod).max() <= bound * rod.max()


def test_order_on_unequal_elements(rod):
    """Fourth order on elements of which every other one is three times as long."""
    errors = []
    for count in (10, 20, 40):
        lengths = np.where(np.arange(count) % 2, 3.0, 1.0)
        nodes = np.cumsum(lengths)[:-1] / lengths.sum()
        errors.append(np.abs(force(graded(nodes)) - rod).max() / rod.max())
    orders = np.diff(np.log2(errors))
    assert (orders < -3.7).all(), errors

"""The numbers of this platform are those stored; a lock ends with its process."""

import copy
import json

import pytest

from tests.platforms.numbers import BOUND, STORED, computed, differences
from tests.platforms.processes import check


@pytest.mark.slow
def test_numbers_are_those_stored():
    stored = json.loads(STORED.read_text())["numbers"]
    assert max(differences(computed(), stored)) <= (BOUND, "")


def test_differences_are_seen(stated):
    stated("platforms.bound", BOUND)
    stored = json.loads(STORED.read_text())["numbers"]
    assert max(differences(stored, stored))[0] == 0.0
    for change in (lambda value: value * (1 + 1e-9), lambda _: None):
        other = copy.deepcopy(stored)
        forces = other["ks-cantilever, rod"]["force of pin->cantilever"]
        forces[5] = change(forces[5])
        apart, name = max(differences(other, stored))
        assert apart > BOUND
        assert name == "force of pin->cantilever, ks-cantilever, rod"


def test_a_lock_ends_with_its_process(tmp_path):
    check(tmp_path)

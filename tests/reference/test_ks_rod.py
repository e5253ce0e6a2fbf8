"""The stored numbers of the rod are those of their generator."""

import tomllib

import pytest

from tests.reference.ks_rod import OFFSETS, STORED, path, text


def test_one_number_is_generated():
    """The first of the axis, from the tip in twenty small steps."""
    stored = tomllib.loads(STORED.read_text())["axis"]
    forces, arcs = path(0.0, last=stored["load_parameter"][0])
    assert forces == pytest.approx(stored["force"][:1], rel=1e-9)
    assert arcs == pytest.approx(stored["arc_position"][:1], rel=1e-9)


@pytest.mark.slow
def test_stored_numbers_are_generated():
    """To 1e-9, so that another processor's last digits do not count; the file's form as well."""
    stored, generated = STORED.read_text(), text()
    keys = [[line.split("=")[0] for line in one.splitlines()] for one in (stored, generated)]
    assert keys[0] == keys[1]
    for name in OFFSETS:
        for key in ("force", "arc_position"):
            assert tomllib.loads(generated)[name][key] == pytest.approx(
                tomllib.loads(stored)[name][key], rel=1e-9
            )

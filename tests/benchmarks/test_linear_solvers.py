"""The systems of `linear_solvers` belong to equilibria, and every solver that is installed gives the same answer."""

from importlib.util import find_spec

import numpy as np
import pytest

from tests.benchmarks import linear_solvers

MESH, LOAD = (200, 4), 0.5


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = str(tmp_path_factory.mktemp("systems"))
    linear_solvers.write_systems(MESH, [LOAD], path)
    return path


def test_strip_is_in_equilibrium(folder):
    """Turning the strip as a whole turns its nodal forces, which vanish away from clamp and contact."""
    system = linear_solvers.read_system(LOAD, folder)
    away = slice(len(system.b) // 10, len(system.b) // 2)
    forces = np.abs(system.K @ system.modes)[away].max(axis=0)
    assert np.all(forces <= 1e-6 * np.abs(system.K).max())


@pytest.mark.parametrize(
    "name", [name for name, (_, package) in linear_solvers.SOLVERS.items() if find_spec(package)]
)
def test_solvers_agree(folder, name):
    x, reference = (linear_solvers.measure(one, LOAD, folder).x for one in (name, linear_solvers.REFERENCE))
    assert np.abs(x - reference).max() <= 1e-6 * np.abs(reference).max()

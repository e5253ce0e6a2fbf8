"""The contact force at the end of the main scene over the coefficient of friction, against the exact rod."""

import json
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from comparisons.claims.problems.friction import COEFFICIENTS, forces_over_friction, rubbing
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.models.outside.programs import ADAPTERS
from comparisons.response import Array
from tsm.elements import EXACT

pytestmark = pytest.mark.slow
MISSING = ADAPTERS["opensees"].missing()


@cache
def exact() -> tuple[float, ...]:
    return tuple(forces_over_friction("rod"))


def errors(forces: Array) -> tuple[float, ...]:
    return tuple(np.abs(forces / np.array(exact()) - 1.0))


def test_the_force_of_the_rod_over_friction(stated: Callable[..., None]) -> None:
    """It falls with the friction at first, and grows again."""
    forces = 1e3 * np.array(exact())
    stated("friction-over-mu.rod", *forces)
    assert forces[0] == forces.max()
    assert 0 < np.argmin(forces) < len(COEFFICIENTS) - 1


@pytest.mark.parametrize("elements", [10, 20])
def test_mixed_elements_over_friction(elements: int, stated: Callable[..., None]) -> None:
    found = errors(forces_over_friction("tsm", Options(elements=elements)))
    stated(f"friction-over-mu.mixed-{elements}", *found)


def test_one_exact_element_over_friction(stated: Callable[..., None]) -> None:
    found = errors(forces_over_friction("tsm", Options(element=EXACT.name)))
    stated("friction-over-mu.exact", max(found), bound=True)


@pytest.mark.parametrize("material", ["st-venant-kirchhoff", "biot-linear"])
def test_the_solid_over_friction(material: str, stated: Callable[..., None]) -> None:
    found = errors(forces_over_friction("solid", Options(mesh=(50, 2)), material=material))
    stated(f"friction-over-mu.solid-{material}", *found)


@pytest.mark.skipif(MISSING is not None, reason=str(MISSING))
def test_opensees_over_friction(stated: Callable[..., None]) -> None:
    """With 20 elements and 1,000 load steps; with a friction of .1 it stops where the stick ends."""
    answers = [solve(rubbing(mu, 20), "opensees", Options(elements=20)) for mu in COEFFICIENTS]
    found = [float(response.contacts["pin->cantilever"].force[-1]) for response in answers]
    assert [response.status == "COMPLETED" for response in answers] == [True, False, True, True, True, True]
    stated("friction-over-mu.opensees", *np.delete(errors(np.array(found)), 1))


@pytest.mark.skipif(MISSING is not None, reason=str(MISSING))
def test_opensees_over_load_steps(tmp_path: Path, stated: Callable[..., None]) -> None:
    """It loses the contact in 10, 50 and 200 load steps, and reports success."""
    scene, found = rubbing(0.3, 10), []
    for steps in (10, 50, 200, 1000, 2000):
        words = [sys.executable, "-m", "comparisons.models.outside.adapters.opensees", str(steps)]
        file = tmp_path / f"opensees-{steps}.toml"
        file.write_text(
            f'[program]\nname = "in-{steps}-steps"\ncommand = {json.dumps(words)}\nelements = [20]\n'
        )
        response = solve(scene, str(file), Options(elements=20))
        assert response.reported_success
        found.append(float(response.contacts["pin->cantilever"].force[-1]))
    assert found[:3] == [0.0, 0.0, 0.0]
    exact_force = exact()[COEFFICIENTS.index(0.3)]
    stated("friction-over-mu.steps", *(abs(force / exact_force - 1.0) for force in found[3:]))

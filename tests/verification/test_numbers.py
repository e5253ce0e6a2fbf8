"""Numbers of the pages: the table of errors on the main scene, and the contact force at its end over the coefficient of friction."""

from functools import cache

import numpy as np
import pytest

from comparisons.answer.errors import errors
from comparisons.models import TSM, find, solve
from comparisons.models.model import Options
from comparisons.scene import load_scene
from comparisons.suite import changed
from comparisons.suites.compare import ELASTICA, MIXED, PAPER, ROD, RUNS, SOLID, run_of
from tests.comparisons.models.outside.test_adapters import in_steps

COLUMNS = ("force", "arc", "moment", "tip")
ROWS = {
    "timoshenko-10": PAPER[0],
    "timoshenko-50": PAPER[2],
    "mixed-10": RUNS[3],
    "mixed-20": MIXED,
    "exact-1": RUNS[5],
    "solid": SOLID,
    "elastica": ELASTICA,
}
MESHES = {f"mixed-{count}": run_of(TSM, Options(elements=count)) for count in (5, 40, 200)}
IN_WORDS = ("timoshenko-10", "mixed-10", "mixed-20", "solid", *MESHES)
"""Runs whose error of the force stands in a sentence."""


@cache
def rod():
    return solve(load_scene("ks-cantilever"), ROD.model)


@pytest.mark.slow_at("solid", "timoshenko-50", "mixed-200")
@pytest.mark.parametrize("name", ROWS | MESHES)
def test_the_table_of_errors(name, stated):
    """To half a unit of the last digit stated; what the exact elements leave is round-off, and bounded only."""
    scene, run = load_scene("ks-cantilever"), (ROWS | MESHES)[name]
    response = solve(scene, run.model, run.options)
    found = errors(response, rod(), scene)["path"]
    assert response.cutbacks == 0 or not name.startswith("mixed")
    if name in ROWS:
        stated(f"unknowns.{name}", response.unknowns)
        stated(f"errors.{name}", *(found[column] for column in COLUMNS), bound=run.options.element == "exact")
    if name == "mixed-10":
        stated("ks.shape-10", found["shape"])
    if name in IN_WORDS:
        stated(f"force.{name}", found[COLUMNS[0]])


COEFFICIENTS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5)


def rubbing(friction, load_parameters=1, material=None):
    """The main scene with a coefficient of friction, and with another material of the solid."""
    changes = {"contact.friction": friction, "scene.load_parameters": load_parameters}
    material = {"beam.material": material} if material else {}
    return changed(load_scene("ks-friction"), changes | material)


def force(response):
    return float(response.contacts["pin->cantilever"].force[-1]) if response.completed else np.nan


def forces(model, options=None, material=None):
    return np.array([force(solve(rubbing(mu, material=material), model, options)) for mu in COEFFICIENTS])


@cache
def exact():
    return forces("rod")


@pytest.mark.slow
def test_the_force_of_the_rod_over_friction(stated):
    """It falls with the friction at first, and grows again."""
    stated("friction-over-mu.rod", *1e3 * exact())
    assert exact()[0] == exact().max()
    assert 0 < np.argmin(exact()) < len(exact()) - 1


def off(*model):
    return np.abs(forces(*model) / exact() - 1.0)


@pytest.mark.slow
def test_beams_over_friction(stated):
    for elements in (10, 20):
        stated(f"friction-over-mu.mixed-{elements}", *off("tsm", Options(elements=elements)))
    stated("friction-over-mu.exact", off("tsm", Options(element="exact")).max(), bound=True)


@pytest.mark.slow
@pytest.mark.parametrize("material", ["st-venant-kirchhoff", "biot-linear"])
def test_the_solid_over_friction(material, stated):
    stated(f"friction-over-mu.solid-{material}", *off("solid", Options(mesh=(50, 2)), material))


@pytest.mark.slow
@pytest.mark.skipif(find("opensees").missing() is not None, reason="OpenSees is not installed")
def test_opensees_over_friction_and_load_steps(tmp_path, stated):
    """With 20 elements and 1,000 load steps; with a friction of .1 it stops where the stick ends.

    It loses the contact in 10, 50 and 200 load steps, and reports success.
    """
    answers = [solve(rubbing(mu, 20), "opensees", Options(elements=20)) for mu in COEFFICIENTS]
    assert [response.status == "COMPLETED" for response in answers] == [True, False, True, True, True, True]
    stated(
        "friction-over-mu.opensees",
        *np.delete(np.abs([force(answer) for answer in answers] / exact() - 1.0), 1),
    )
    found = []
    for steps in (10, 50, 200, 1000, 2000):
        (folder := tmp_path / str(steps)).mkdir()
        response = solve(rubbing(0.3, 10), in_steps("opensees", steps, folder), Options(elements=20))
        assert response.reported_success
        found.append(float(response.contacts["pin->cantilever"].force[-1]))
    assert found[:3] == [0.0, 0.0, 0.0]
    right = exact()[COEFFICIENTS.index(0.3)]
    stated("friction-over-mu.steps", *(abs(force / right - 1.0) for force in found[3:]))

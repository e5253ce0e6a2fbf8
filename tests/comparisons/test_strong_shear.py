"""`mixed` in shear from none to twice the shear stiffness: within 1 % of the exact equilibrium, or it does not complete."""

import math

import numpy as np
import pytest

from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.referee import certify
from comparisons.scene import read_scene

SHEAR = (0.01, 0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.5, 0.77, 1.0, 1.5, 2.0)
"""Force over GA."""
WITHIN = 1e-2
"""Largest error of an answer that is stated as completed."""


def error(cause: str, shear_stiffness: float) -> float | None:
    """Error of forces and places of the completed answer of a cantilever with EI = L = 1, None where the model does not complete."""
    scene = read_scene(
        f"""
scene = {{ name = "shear", load_parameters = 4 }}
beam = [{{ name = "b", start = [0, 0], end = [1, 0], clamped = ["start"], elements = 20, shear_modulus = 1.0,\
 area = 1e4, second_moment = 1.0, youngs_modulus = 1.0, shear_area = {shear_stiffness!r} }}]
{cause}
""",
        "shear",
    )
    response = solve(scene, "tsm", Options(element="mixed"))
    if not response.completed:
        assert response.status in ("CHECK_FAILED", "LIMIT_POINT", "CUTBACK_FLOOR")
        return None
    (judged,) = certify(response, scene, at=[-1], allowance=math.inf).judged
    assert judged.distance is not None, judged.reason
    sizes = judged.distance.sizes
    return max(sizes[name] for name in ("force", "arc_position", "reaction", "tip", "shape"))


def check(errors: list[float | None], stated) -> None:
    assert errors[0] is not None
    assert all(found is None or found < WITHIN for found in errors)
    stated("shear.strong", max(found for found in errors if found is not None), part=True)


@pytest.mark.slow_at("-45.0-12.0", "-90.0-0.3", "-90.0-12.0", "150.0-12.0", "150.0-2.0")
@pytest.mark.parametrize("force", [0.3, 2.0, 12.0])
@pytest.mark.parametrize("direction", [-90.0, 0.0, -45.0, 150.0])
def test_a_load_at_the_tip(force, direction, stated):
    x, y = force * math.cos(math.radians(direction)), force * math.sin(math.radians(direction))
    load = f'load = [{{ beam = "b", end = "end", force = [{x!r}, {y!r}] }}]'
    errors = [error(load, force / ratio) for ratio in SHEAR]
    check(errors, stated)
    assert errors[-1] is None


@pytest.mark.parametrize(("depth", "refused"), [(0.05, False), (0.2, True)])
def test_a_pin(depth, refused, stated):
    """A small depth strains little, however soft the beam; the force follows from GA."""
    pin = f'pin = [{{ name = "p", start = [0.5, 0], displacement = [0, {-depth!r}] }}]\ncontact = [{{ node = "p", beam = "b", side = "left" }}]'
    errors = [error(pin, stiffness) for stiffness in np.geomspace(300.0, 0.1, 12).tolist()]
    check(errors, stated)
    assert (errors[-1] is None) == refused

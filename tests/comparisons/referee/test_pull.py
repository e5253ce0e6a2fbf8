"""A contact without force may pull by round-off, which is measured by the bending force of the touched beam."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.referee.judge import impossible
from comparisons.scene import read_scene

SCENE = """
[scene]
name = "back"
load_parameters = 1
[[beam]]
name = "post"
start = [0.0, 0.0]
end = [0.0, 1.0]
clamped = ["start"]
area = 1.0
second_moment = 1e-6
youngs_modulus = 1.0
poissons_ratio = 0.3
[[beam]]
name = "bar"
start = [0.0, 1.0]
end = [1.0, 1.0]
area = 1.0
second_moment = 1e-3
youngs_modulus = 1.0
poissons_ratio = 0.3
[[pin]]
name = "pin"
start = [0.7, 1.0]
displacement = [-0.02, -0.05]
[[contact]]
node = "pin"
beam = "bar"
side = "left"
[[stage]]
load_parameters = 1
pin = [{ name = "pin", displacement = [0.02, 0.05] }]
"""


@pytest.mark.parametrize(("pull", "found"), [(1e-10, []), (1e-6, ["the contact force of pin->bar pulls"])])
def test_round_off_of_a_stiff_beam_is_no_pull(pull: float, found: list[str]) -> None:
    scene = read_scene(SCENE, "back")
    response = solve(scene, "tsm", Options(element="exact"))
    contact = response.contacts["pin->bar"]
    assert abs(contact.force[-1]) < 1e-12 * contact.force[0]
    force = np.array([contact.force[0], -pull * scene.beam("bar").EI])
    forged = replace(response, contacts={"pin->bar": replace(contact, force=force, vector=None)})
    assert list(impossible(forged, scene, 1)) == found

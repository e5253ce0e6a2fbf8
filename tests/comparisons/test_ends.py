"""A pin that meets the end of a beam: named, with its load parameter, by every model."""

import math
import re
from dataclasses import replace

import pytest

from comparisons.exact.rod import rod_under_pin
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.models.translate import to_rod
from comparisons.models.verify import verified
from comparisons.response import Response
from comparisons.scene import Scene, load_scene
from comparisons.scene.ends import near_ends
from comparisons.scene.tables import InputError
from tests.comparisons.drawn_ends import KINDS, approach

MODELS = {
    "exact": ("tsm", Options(element="exact")),
    "mixed": ("tsm", Options(elements=10)),
    "rod": ("rod", Options()),
    "solid": ("solid", Options(mesh=(25, 2))),
}
WITHIN = 1e-8
MESH = {"mixed": 1e-6, "solid": 2e-3}
"""Ten `mixed` elements, and a strip of finite height, wound into an arc."""
SLIPPED = {"mixed": 1e-3, "solid": 1e-2}
"""The same where the pin bends the beam and slides to its corner."""

NOSE = """
scene = {{ name = "nose", units = "N, mm", load_parameters = {count} }}
beam = [{{ name = "b", start = [0, 0], end = [40, 0], clamped = ["start"], width = 5, height = 0.8, youngs_modulus = 2e5, poissons_ratio = 0.3 }}]
pin = [{{ name = "ball", start = {start}, displacement = {displacement}, radius = 2.5 }}]
contact = [{{ node = "ball", beam = "b", side = "right", surface = "face" }}]
"""


def nose(tmp_path, *, count=10, start=(40.5, -4.0), displacement=(0.0, 4.0)) -> Scene:
    file = tmp_path / "nose.toml"
    file.write_text(NOSE.format(count=count, start=list(start), displacement=list(displacement)))
    return load_scene(str(file))


def met_at(response: Response) -> float:
    """Load parameter that the message states, to its digits."""
    found = re.search(r"meets the \w+ of b\D* at load parameter ([0-9.e-]*\d)", response.message)
    assert found, response.message
    events = [event.load_parameter for event in response.events or () if event.kind == "end-contact"]
    assert events == pytest.approx([float(found[1])] * len(events), rel=1e-8)
    return events[-1] if events else float(found[1])


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(
    "seed", [*range(7), *(pytest.param(k, marks=pytest.mark.slow) for k in range(7, 105))]
)
def test_approaches_end_where_the_pin_meets_the_end(seed, model):
    drawn = approach(seed)
    found = solve(drawn.scene, *MODELS[model])
    if drawn.load_parameter is None:
        assert found.status == "COMPLETED"
        return
    assert found.status == "END_CONTACT", found.message
    expected = drawn.load_parameter
    if math.isnan(expected):
        local = to_rod(drawn.scene)
        beam = local.beam
        expected = rod_under_pin(
            local.path, offset=local.offset, EA=beam.EA, GA=beam.GA, EI=beam.EI, length=beam.length
        ).slip_off
    coarse = {"moment": MESH, "slip-off": SLIPPED}.get(drawn.kind, {})
    assert met_at(found) == pytest.approx(expected, abs=coarse.get(model, WITHIN))
    assert found.load_parameter.max(initial=0.0) < met_at(found)


def test_all_kinds_are_drawn():
    assert [approach(seed).kind for seed in range(7)] == list(KINDS)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("count", [1, 10])
def test_a_ball_beside_a_tip_meets_its_corner(model, count, tmp_path):
    """The tip was 2 mm inside the ball, completed and certified. The corner is (40, -.4)."""
    found = solve(nose(tmp_path, count=count), *MODELS[model])
    assert (found.status, len(found.load_parameter)) == ("END_CONTACT", 0 if count == 1 else 2)
    assert met_at(found) == pytest.approx((4.0 - 0.4 - math.sqrt(2.5**2 - 0.5**2)) / 4.0, abs=WITHIN)


def test_a_pin_over_an_end_is_refused(tmp_path):
    with pytest.raises(
        InputError, match=r'pin\[0\].start = .* must lie clear of the end of beam "b", overlap 0.5'
    ):
        nose(tmp_path, start=(42.0, 0.0))
    nose(tmp_path, start=(42.5, 0.0))


def test_check_names_a_path_that_comes_to_an_end(tmp_path):
    assert list(near_ends(nose(tmp_path))) == [
        "ball meets the end of b, if it has not moved: END_CONTACT ends the solution there"
    ]
    assert not list(near_ends(nose(tmp_path, start=(42.6, -4.0), displacement=(0.0, 9.0))))


@pytest.mark.parametrize("deep", [0.9, 1.1])
def test_an_answer_of_others_with_a_pin_over_an_end_fails(deep, tmp_path):
    """The ball comes to the middle of the end face from beyond, up to a depth beside the tolerance of 1e-3 L."""
    clear = nose(tmp_path, start=(45.0, 0.0), displacement=(-2.4, 0.0))
    scene = nose(tmp_path, start=(45.0, 0.0), displacement=(-2.5 - 0.04 * deep, 0.0))
    given = replace(solve(clear, "tsm", Options(element="exact")), outside=True)
    checked = verified(given, scene)
    assert checked.status == ("COMPLETED" if deep < 1.0 else "CHECK_FAILED")
    assert deep < 1.0 or "ball overlaps the end of beam b at load parameter 1" in checked.message

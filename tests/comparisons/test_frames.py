"""Frames by TSM beams through the scene's own chain: closed forms, reactions at several supports, the balance of the whole."""

import json
import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from comparisons.exact.end_loads import tip_under_dead_load, tip_under_moment
from comparisons.models import solve
from comparisons.models.verify import CHECK_FAILED, verified
from comparisons.response import Response, SupportHistory
from comparisons.response.to_json import as_json
from comparisons.scene import BeamSpec, ContactSpec, LoadSpec, PinSpec, Scene, SupportSpec

STIFF = {"youngs_modulus": 1e6, "shear_modulus": 1e6, "area": 1.0, "second_moment": 1e-6}
"""EI = 1 with EA = GA = 1e6: the elastica to a few millionths."""


def cantilever(load: LoadSpec, load_parameters: int = 5, **changes: object) -> Scene:
    beam = BeamSpec(name="beam", start=(0, 0), end=(1, 0), clamped=("start",), **(STIFF | changes))  # type: ignore[arg-type]
    return Scene(name="cantilever", load_parameters=load_parameters, beams=(beam,), loads=(load,))


def test_roll_up_by_an_end_moment() -> None:
    load = LoadSpec(beam="beam", end="end", moment=2.0 * np.pi)
    response = solve(cantilever(load, 10, elements=40), "tsm")
    assert response.completed, response.message
    expected = np.array([tip_under_moment(2.0 * np.pi * t) for t in response.load_parameter])
    np.testing.assert_allclose(response.tips["beam"], expected, atol=2e-5)
    np.testing.assert_allclose(
        response.supports["beam.start"].moment, -2.0 * np.pi * response.load_parameter, rtol=1e-9
    )
    assert (response.contacts, response.events) == ({}, ())


def test_dead_load_at_the_tip() -> None:
    response = solve(cantilever(LoadSpec(beam="beam", end="end", force=(0.0, 10.0)), elements=40), "tsm")
    assert response.completed, response.message
    expected = np.array([tip_under_dead_load(10.0 * t) for t in response.load_parameter])
    np.testing.assert_allclose(response.tips["beam"], expected, atol=1e-4)
    np.testing.assert_allclose(
        response.supports["beam.start"].force, np.outer(response.load_parameter, [0.0, -10.0]), atol=1e-9
    )


def test_settlement_of_a_beam_clamped_at_both_ends() -> None:
    """``Q = 12 EI d/L^3``, ``M = 6 EI d/L^2``; each support is stated by the name of its end."""
    beam = BeamSpec(name="beam", start=(0, 0), end=(1, 0), clamped=("start",), **STIFF)  # type: ignore[arg-type]
    moved = SupportSpec(beam="beam", end="end", kind="clamped", displacement=(0.0, 1e-6))
    response = solve(Scene(name="s", load_parameters=2, beams=(beam,), supports=(moved,)), "tsm")
    assert response.completed, response.message
    first, other = response.supports["beam.start"], response.supports["beam.end"]
    shear = 1.0 / (1.0 + 12.0 / 1e6)
    assert [first.force[-1, 1], other.force[-1, 1]] == pytest.approx(
        [-12e-6 * shear, 12e-6 * shear], rel=1e-6
    )
    assert first.force[-1, 0] == pytest.approx(-other.force[-1, 0])  # the stretch, of second order
    assert [first.moment[-1], other.moment[-1]] == pytest.approx([-6e-6, -6e-6], rel=1e-4)
    stated = json.loads(as_json(response))["supports"]
    assert list(stated) == ["beam.start", "beam.end"]
    assert stated["beam.end"] == {"moment": list(other.moment), "force": other.force.tolist()}


def portal() -> Scene:
    """Return a portal frame, joined at two corners: one foot clamped, one on a roller that moves; loads on a joint and a corner."""
    section = {"youngs_modulus": 1e6, "poissons_ratio": 0.3, "width": 0.1, "height": 0.05, "elements": 6}
    places = {"left": ((3, 1), (3, 2)), "girder": ((3, 2), (5, 2)), "right": ((5, 1), (5, 2))}
    beams = tuple(BeamSpec(name=name, start=a, end=b, **section) for name, (a, b) in places.items())  # type: ignore[arg-type]
    return Scene(
        name="portal",
        load_parameters=5,
        beams=(replace(beams[0], clamped=("start",)), *beams[1:]),
        supports=(SupportSpec(beam="right", end="start", kind="roller", free="x", displacement=(0.0, -0.1)),),
        loads=(
            LoadSpec(beam="girder", end="start", force=(0.1, -0.2), moment=0.05),
            LoadSpec(beam="right", end="end", force=(0.0, -0.3)),
        ),
    )


@pytest.fixture(scope="module")
def frame() -> Response:
    response = solve(portal(), "tsm")
    assert response.completed, response.message
    return response


def test_a_portal_frame_is_in_balance_and_its_roller_is_free(frame: Response) -> None:
    assert list(frame.supports) == ["left.start", "right.start"]
    roller, clamp = frame.supports["right.start"], frame.supports["left.start"]
    assert np.all(roller.force[:, 0] == 0.0)
    assert np.all(roller.moment == 0.0)
    np.testing.assert_allclose(clamp.force[-1] + roller.force[-1], [-0.1, 0.5], atol=1e-9)
    foot = frame.axis_line("right", 4)[1][0]
    assert foot[1] == pytest.approx(0.9, abs=1e-15)
    assert abs(foot[0] - 5.0) > 1e-3
    corner = [frame.axis_line(beam, 4)[1][end] for beam, end in (("left", -1), ("girder", 0))]
    np.testing.assert_allclose(corner[0], corner[1], atol=1e-14)
    assert "left.start" in frame.page()


def changed(node: str, **changes: Callable[[np.ndarray], np.ndarray]) -> Callable[[Response], Response]:
    def change(response: Response) -> Response:
        old = response.supports[node]
        new: SupportHistory = replace(old, **{key: edit(getattr(old, key)) for key, edit in changes.items()})
        return replace(response, supports={**response.supports, node: new})

    return change


BREAKS: dict[str, tuple[Callable[[Response], Response], str]] = {
    "force of one support": (
        changed("right.start", force=lambda force: force * (1 + 1e-4)),
        "support reactions",
    ),
    "moment of the clamp": (
        changed("left.start", moment=lambda moment: moment * (1 + 1e-4)),
        "support moments",
    ),
    "moment of a roller": (changed("right.start", moment=lambda moment: moment + 1e-3), "support moments"),
    "support left out": (
        lambda response: replace(response, supports={"left.start": response.supports["left.start"]}),
        "support reactions",
    ),
    "place of a load": (
        lambda response: replace(
            response, axis_line=lambda beam, k: (np.zeros(2), 1.001 * response.axis_line(beam, k)[1])
        ),
        "support moments",
    ),
}


@pytest.mark.parametrize("case", BREAKS)
def test_a_frame_out_of_balance_is_no_success(frame: Response, case: str) -> None:
    change, reason = BREAKS[case]
    checked = verified(change(frame), portal())
    assert (checked.status, checked.completed) == (CHECK_FAILED, False)
    assert re.search(reason, checked.message)


def two_pins() -> Scene:
    beam = BeamSpec(name="beam", start=(0, 0), end=(1, 0), clamped=("start",), **STIFF)  # type: ignore[arg-type]
    pins = (
        PinSpec(name="low", start=(0.8, 0.0), displacement=(0.0, 0.2)),
        PinSpec(name="high", start=(0.5, 0.0), displacement=(0.0, -0.02)),
    )
    contacts = (
        ContactSpec(node="low", beam="beam", side="right", keep=True),
        ContactSpec(node="high", beam="beam", side="left", keep=True),
    )
    load = LoadSpec(beam="beam", end="end", force=(0.5, -1.0))
    return Scene(name="pins", load_parameters=4, beams=(beam,), pins=pins, contacts=contacts, loads=(load,))


def test_two_pins_and_a_load_balance_by_their_stated_forces() -> None:
    response = solve(two_pins(), "tsm")
    assert response.completed, response.message
    assert all(np.all(contact.force > 0.0) for contact in response.contacts.values())
    history = response.contacts["high->beam"]
    assert history.vector is not None
    np.testing.assert_allclose(np.hypot(*history.vector.T), history.force, rtol=1e-12)
    for vector in (history.vector * (1 + 1e-4), None):
        contacts = {**response.contacts, "high->beam": replace(history, vector=vector)}
        checked = verified(replace(response, contacts=contacts), two_pins())
        assert re.search("support reactions", checked.message)


def test_a_contact_that_must_persist_may_not_open_silently() -> None:
    response = solve(two_pins(), "tsm")
    contact = response.contacts["low->beam"]
    arc = np.where(np.arange(4) == 2, np.nan, contact.arc_position)
    force = np.where(np.arange(4) == 2, 0.0, contact.force)
    contacts = {
        **response.contacts,
        "low->beam": replace(contact, arc_position=arc, force=force, gap=arc * 0.0),
    }
    opened = replace(response, contacts=contacts)
    assert "low->beam must persist and is open at load parameter 0.75" in verified(opened, two_pins()).message
    contacts = tuple(replace(spec, keep=False) for spec in two_pins().contacts)
    assert "must persist" not in verified(opened, replace(two_pins(), contacts=contacts)).message

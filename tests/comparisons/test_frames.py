"""Frames by TSM beams through the scene's own chain: closed forms, reactions at several supports, the balance of the whole."""

import re
from dataclasses import replace

import numpy as np

from comparisons.models import solve
from comparisons.models.verify import verified
from comparisons.scene import BeamSpec, ContactSpec, LoadSpec, PinSpec, Scene

STIFF = {"youngs_modulus": 1e6, "shear_modulus": 1e6, "area": 1.0, "second_moment": 1e-6}
"""EI = 1 with EA = GA = 1e6: the elastica to a few millionths."""


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

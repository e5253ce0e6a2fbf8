"""The check of an answer whose forces are given as vectors, and of a contact that must persist."""

from dataclasses import replace

import numpy as np

from comparisons.models import solve
from comparisons.models.verify import verified
from comparisons.scene import load_scene

SCENE = load_scene("two-pins")
KEPT = replace(SCENE, contacts=tuple(replace(spec, keep=True) for spec in SCENE.contacts))


def test_two_pins_balance_by_the_vectors_of_their_forces() -> None:
    response = solve(SCENE, "tsm")
    for pair, history in response.contacts.items():
        assert np.all(history.force > 0.0)
        assert history.vector is not None
        np.testing.assert_allclose(np.hypot(*history.vector.T), history.force, rtol=1e-12)
        for vector in (history.vector * (1 + 1e-4), None):
            forged = replace(response, contacts={**response.contacts, pair: replace(history, vector=vector)})
            assert "support reactions" in verified(forged, SCENE).message


def test_a_contact_that_must_persist_may_not_open_silently() -> None:
    response = solve(SCENE, "tsm")
    pair, contact = next(iter(response.contacts.items()))
    gone = np.arange(len(contact.force)) == 2
    opened = replace(
        contact, arc_position=np.where(gone, np.nan, contact.arc_position), force=np.where(gone, 0.0, contact.force),
    )  # fmt: skip
    forged = replace(response, contacts={**response.contacts, pair: opened})
    line = f"{pair} must persist and is open at load parameter"
    assert line in verified(forged, KEPT).message
    assert line not in verified(forged, SCENE).message

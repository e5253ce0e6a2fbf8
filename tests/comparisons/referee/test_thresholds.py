"""The thresholds of the referee and of the models' own checks: an answer a tenth inside each one passes, a tenth beyond it is refused."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from comparisons.answer import ContactHistory, Response
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.models.verify import CHECK_FAILED, verified
from comparisons.referee import certify
from comparisons.scene import ContactSpec, PinSpec, Scene, load_scene
from tests.comparisons.referee.forged import contact, deformed, scene_of, support

KS = replace(load_scene("ks-cantilever"), load_parameters=2)
RUBBED = replace(load_scene("ks-friction"), load_parameters=6)
SLIPS = replace(RUBBED, load_parameters=2, pins=(replace(RUBBED.pins[0], displacement=(-0.5, 1.0 / np.pi)),))
"""The first half of it, in which the pin does not stick."""
PAIR, CLAMP = "pin->cantilever", "cantilever.start"
ARC = scene_of("arc")
(STRIP,) = ARC.beams
SOFTER = replace(STRIP, name="softer", start=(0.0, 5.0), end=(1.0, 5.0), second_moment=1e-7)
TWO = replace(ARC, beams=(STRIP, SOFTER))
"""The strip of ARC, and a softer one, on which nothing depends."""


@cache
def answer(scene: Scene) -> Response:
    found = solve(scene, "tsm", Options(element="exact"))
    assert found.completed, found.message
    return found


def more(values: np.ndarray, size: float, k: int = -1) -> np.ndarray:
    """Return the values with one of them larger."""
    changed = values.copy()
    changed[k] += size
    return changed


def held(scene: Scene, force: float = 0.0, moment: float = 0.0) -> Response:
    """An answer whose clamp bears more, by a part of its force and moment."""
    history = (response := answer(scene)).supports[CLAMP]
    new = (
        more(table, part * table[-1]) for table, part in ((history.force, force), (history.moment, moment))
    )
    return support(response, force=next(new), moment=next(new))


def bulged(response: Response, size: float, first: float, last: float) -> Response:
    """An axis that lies beside its place, most in the middle between two arc positions."""

    def axis_line(beam: str, k: int) -> tuple[np.ndarray, np.ndarray]:
        arc, line = response.axis_line(beam, k)
        part = np.clip((arc - first) / (last - first), 0.0, 1.0)
        return arc, line + np.outer(np.sin(np.pi * part) ** 2, [0.0, size])

    return replace(response, axis_line=axis_line)


def on_the_arc(
    gap: float = 0.0, radius: float | None = None, force: float = 0.0, way: float = 0.1, base: Scene = ARC
) -> tuple[Response, Scene]:
    """The arc and a pin that comes from its centre to a gap from its middle, with a contact force that the beam does not feel."""
    out = np.array([np.sin(0.5), -np.cos(0.5)])
    place = np.array([0.0, 1.0]) + (1.0 - (radius or 0.0) - gap) * out
    start, motion = (tuple(map(float, vector)) for vector in (place - way * out, way * out))
    scene = replace(
        base,
        pins=(PinSpec(name="pin", start=start, displacement=motion, radius=radius),),
        contacts=(ContactSpec(node="pin", beam="cantilever", side="left"),),
    )
    history = ContactHistory(
        force=np.array([force]),
        arc_position=np.array([0.5 if force else np.nan]),
        gap=np.array([gap]),
        vector=np.array([force * out]),
    )
    return replace(answer(base), contacts={PAIR: history}), scene


def off_the_cone(part: float) -> Response:
    """A slipping contact with more tangential force, by a part of the contact force."""
    history = (response := answer(SLIPS)).contacts[PAIR]
    assert history.friction is not None
    assert history.friction.slip[-1]
    drag = history.friction.tangential
    size = part * float(history.force[-1]) * np.sign(drag[-1])
    return contact(response, friction=replace(history.friction, tangential=more(drag, size)))


def regained(part: float) -> Response:
    """Dissipation that falls in the stick, by a part of the largest work."""
    history = (response := answer(RUBBED)).contacts[PAIR]
    assert history.friction is not None
    assert response.work is not None
    stick = int(np.flatnonzero(history.friction.slip == 0)[0])
    spent = history.friction.dissipated.copy()
    spent[:stick] += spent[stick] - spent[stick - 1] + part * response.work.max()
    return contact(response, friction=replace(history.friction, dissipated=spent))


def overpaid(part: float) -> Response:
    """More work at the end."""
    response = answer(SLIPS)
    assert response.work is not None
    return replace(response, work=more(response.work, part * response.work.max()))


def grown(part: float) -> Response:
    """Contact forces larger than their components."""
    return contact(answer(KS), force=answer(KS).contacts[PAIR].force * (1.0 + part))


def ajar(gap: float) -> Response:
    return contact(answer(KS), gap=more(answer(KS).contacts[PAIR].gap, gap))


def pressed(most: float) -> Response:
    """Contacts of a penalty, which lie inside the beam in proportion to their forces."""
    force = answer(KS).contacts[PAIR].force
    return replace(contact(answer(KS), gap=-most * force / force.max()), continuum=True)


def pressed_in(size: float) -> tuple[Response, Scene]:
    """The arc around a pin of almost its radius, in which it lies away from the contact."""
    response, scene = on_the_arc(radius=1.0 - 1e-6, force=1e-8)
    return bulged(response, size, 0.1, 0.3), scene


def refused(response: Response, scene: Scene, allowance: float | None = None) -> str:
    found = certify(response, scene, at=[-1], allowance=allowance)
    return "" if found.certified else found.line()


def failed(response: Response, scene: Scene) -> str:
    found = verified(response, scene)
    return found.message if found.status == CHECK_FAILED else ""


CASES: dict[str, tuple[float, Callable[[float], str], str]] = {
    "certify.ALLOWED": (5e-2, lambda x: refused(bulged(answer(KS), x, 0.1, 0.4), KS), "shape off"),
    "judge.PLACE": (
        1e-3,
        lambda x: refused(bulged(answer(KS), x, -0.1, 0.1), KS, 1.0),
        "supports and contacts are off",
    ),
    "judge.LAST_PLACES": (1e-9, lambda x: refused(grown(x), KS), "components differ"),
    "balance.BALANCE of forces": (1e-6, lambda x: refused(held(KS, force=x), KS), "balance"),
    "balance.BALANCE of moments": (1e-6, lambda x: refused(held(ARC, moment=x), ARC), "balance"),
    "start.PULL": (1e-9, lambda x: refused(*on_the_arc(force=-x, base=TWO)), "pulls"),
    "admissible.INSIDE": (1e-9, lambda x: refused(*on_the_arc(-x, 0.1)), "inside the beam"),
    "rubbing.LAW": (1e-6, lambda x: refused(off_the_cone(x), SLIPS), "slips with"),
    "rubbing.FALL": (1e-8, lambda x: refused(regained(x), RUBBED), "falls"),
    "rubbing.ENERGY": (1e-4, lambda x: refused(overpaid(x), SLIPS), "the work is not"),
    "verify.PULL": (1e-9, lambda x: failed(*on_the_arc(force=-x, base=TWO)), "pulls"),
    "verify.CLOSED": (1e-9, lambda x: failed(ajar(x), KS), "open gap"),
    "verify.PENETRATION": (1e-2, lambda x: failed(pressed(x), KS), "the penetration of"),
    "verify.INSIDE": (1e-3, lambda x: failed(*pressed_in(x)), "L inside beam"),
    "verify.STRAIN": (
        0.1,
        lambda x: failed(deformed(answer(KS), 1.0, strain=x), KS),
        "beyond elements of small strain",
    ),
    # a shorter path is refused
    "verify.MOTION": (1e-10, lambda x: failed(*on_the_arc(0.01, way=1e-20 / x)), "is not resolved"),
}
"""Value, what is said of an answer at a size, and a part of the sentence."""


@pytest.mark.slow_at("rubbing.FALL", "rubbing.ENERGY", "rubbing.LAW")
@pytest.mark.parametrize("name", CASES)
def test_a_threshold_lies_where_it_is_stated(name, stated):
    value, said, words = CASES[name]
    if name in ("verify.INSIDE", "verify.STRAIN", "verify.MOTION"):
        stated(f"verify.{name[7:]}", value)
    assert said(0.9 * value) == ""
    assert words in said(1.1 * value)


def test_a_coarse_axis_excuses_no_more_than_its_chords():
    """The arc position of a contact is off by more than `judge.PLACE`: by less than the bound of 16 chords of an arc, .00195, or by more."""
    response, scene = on_the_arc(force=1e-8)
    arc = np.linspace(0.0, 1.0, 17)
    line = np.stack([np.sin(arc), 1.0 - np.cos(arc)], axis=1)
    coarse = replace(response, axis_line=lambda *_: (arc, line))
    assert refused(contact(coarse, arc_position=np.array([0.502])), scene) == ""
    assert "supports and contacts are off" in refused(contact(coarse, arc_position=np.array([0.506])), scene)

"""Cases of contact with several pins or beams, or with several touches."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from comparisons.claims.claim import Quantity
from comparisons.claims.manual.models import (
    EXACT,
    FOURTH,
    ROD,
    SECOND,
    answered,
    mixed,
    on_scene,
    paper,
    step,
    undeformed,
)
from comparisons.claims.manual.record import Picture, Problem, Trial
from comparisons.claims.manual.scenes import MM, PAIR
from comparisons.exact.rod import rod_under_pin
from comparisons.response import Response
from comparisons.scene import Scene, load_scene

CLOSED = "no mesh error: what is left are the tolerances of Newton's method and of the integration (1e-9)"
REFEREE = (
    "Reissner rods by finite elements of high order whose nodes move with the contacts (comparisons.referee, which shares nothing with the models; its "
    "search starts from an answer)"
)


def _at_the_end(scene: Scene) -> tuple[Quantity, ...]:
    """Return forces and arc positions of all contacts at the whole load, by exact rods."""
    values = _read_at_the_end(answered(replace(scene, load_parameters=2), ROD))
    force, length = (unit.strip() for unit in scene.units.split(","))
    named = [
        one
        for contact in scene.contacts
        for one in (
            (f"F of {contact.pair} [{force}]", None),
            (f"s of {contact.pair} [{length}]", scene.beam(contact.beam).length),
        )
    ]
    return tuple(
        Quantity(name=name, exact=value, scale=scale)
        for (name, scale), value in zip(named, values, strict=True)
    )


def _read_at_the_end(response: Response) -> list[float]:
    return [
        float(history[-1])
        for contact in response.contacts.values()
        for history in (contact.force, contact.arc_position)
    ]


def _trials(fourth: float, reason: str, second: float | None) -> tuple[Trial, ...]:
    more = () if second is None else (on_scene(paper(20), second, SECOND, _read_at_the_end),)
    return (
        on_scene(EXACT, 1e-8, CLOSED, _read_at_the_end),
        on_scene(mixed(20), fourth, reason, _read_at_the_end),
        *more,
    )


def two_pins() -> Problem:
    """Simply supported beam under two pins."""
    scene = load_scene("two-pins")
    return Problem(
        name="two-pins",
        title="Simply supported beam under two pins",
        purpose="Two contacts on one beam whose support slides, so that symmetry is lost.",
        uncertainty=1e-10,
        scene=scene,
        statement="A beam of 1 m, section .02 m x .01 m, E = 2.1e11 N/m^2, nu = .3, on a hinge and a roller. Two frictionless pins at .33 m and .67 m press its upper "
        "face down by .05 m.",
        source=REFEREE,
        quantities=_at_the_end(scene),
        trials=_trials(5e-6, FOURTH, 1e-2),
        picture=Picture(curves=undeformed(scene)),
    )


def crossed_beams() -> Problem:
    """A strut that buckles on a beam."""
    scene = load_scene("crossed-beams")
    return Problem(
        name="crossed-beams",
        title="A strut presses on a beam and buckles",
        purpose="Contact of a beam's end with another beam's face through buckling: the end slides away.",
        uncertainty=1e-10,
        scene=scene,
        statement="A strip of 200 mm, section 10 mm x 2 mm, E = 2.1e5 N/mm^2, nu = .3, is clamped at both ends. An upright strip of 99 mm with the same section, which leans "
        "by 1 mm, is moved down by 10 mm at its clamped upper end; its lower end presses without friction on the middle of the first one.",
        source=REFEREE,
        quantities=_at_the_end(scene),
        trials=_trials(3e-4, f"{FOURTH}; the buckled strut amplifies the error", None),
        picture=Picture(axes=MM, curves=undeformed(scene)),
    )


TIMES = (0.25, 0.4, 0.8, 1.0)


def touch_again() -> Problem:
    """A pin that touches, releases and touches again."""
    scene = load_scene("touch-again")
    beam, pin = scene.beams[0], scene.pins[0]
    rods = [
        rod_under_pin([(90.0, 0.0), pin.position(t)], EA=beam.EA, GA=beam.GA, EI=beam.EI, length=beam.length)
        for t in TIMES
    ]
    events = (("touch", 1.0 / 11.0), ("release", 5.0 / 11.0), ("touch", 7.0 / 11.0))

    def read(response: Response) -> Sequence[float]:
        assert response.events is not None, "the beams locate events"
        located = [event.load_parameter for event in response.events if event.kind in {"touch", "release"}]
        force = response.contacts[PAIR].force
        return [*(force[step(response, t)] for t in TIMES), *(located if len(located) == 3 else [np.nan] * 3)]

    return Problem(
        name="touch-again",
        title="A pin touches, releases and touches again",
        purpose="A contact that opens and closes: nothing is left of the first touch.",
        uncertainty=1e-11,
        scene=scene,
        statement="A cantilever of 100 mm, section 10 mm x 1 mm, E = 2.1e5 N/mm^2, nu = .3. A frictionless pin moves along x = 90 mm at constant speed from y = -5 mm to 10 mm, back "
        "to -5 mm, and up to 20 mm.",
        source="Reissner's rod by quadratures (comparisons.exact.rod, which shares nothing with the models); the events by geometry, at 1/11, 5/11 and 7/11 of the path",
        quantities=(
            *(
                Quantity(name=f"F [N] at t = {t:g}", exact=float(rod.magnitude[-1]))
                for t, rod in zip(TIMES, rods, strict=True)
            ),
            *(
                Quantity(name=f"t of the {count} {kind}", exact=t, scale=1.0)
                for count, (kind, t) in zip(("first", "only", "second"), events, strict=True)
            ),
        ),
        trials=(
            on_scene(EXACT, 1e-8, CLOSED, read),
            on_scene(mixed(20), 1e-5, FOURTH, read),
        ),
        picture=Picture(axes=MM, curves=undeformed(scene)),
    )

"""How a solution ended."""

from __future__ import annotations

from enum import Enum
from typing import Any

_LEAST_PART = 0.1
"""Shortest part of a refused step that is tried next."""


class Status(Enum):
    """Outcome of a solution; the value is its sentence."""

    COMPLETED = "all load parameters were reached"
    CONVERGED = "equilibrium was found"
    ITERATION_LIMIT = "Newton's iteration did not converge within its limit"
    NOT_FINITE = "a residual or an update was not finite"
    SINGULAR_TANGENT = "the tangent is singular"
    MECHANISM = "the structure is a mechanism: it can move without strain"
    CUTBACK_FLOOR = "the load step was cut back to its floor"
    STEP_LIMIT = (
        "the load steps stayed so short that the next load parameter was not reached within their limit"
    )
    INACCURATE = "the integration inside an element does not reach its accuracy: more elements do"
    PING_PONG = "the contact went back and forth between two elements"
    TWO_CONTACTS = "two nodes touch one element whose matrix knows a single contact"
    LIMIT_POINT = "the load has a limit point: no equilibrium lies beyond it on this branch"
    BIFURCATION = "the path has a bifurcation point: beyond it this branch is unstable"
    LINE_CONTACT = (
        "the beam bends as much as a round pin: beyond, it touches along a line instead of at a point"
    )
    FALLING = "a structure that a contact slipped off was not found to come to rest"
    JAMMED = "a contact with friction can neither stick nor slip as the load goes on"
    TWO_SLIPS = "a contact with friction that has just closed could slip either way"
    REST_UNKNOWN = "a structure fell onto contacts with friction: where it rests depends on its motion"
    LOST_CONTACT = "a contact that must persist was released"
    SLIPPED_OFF = "a contact that must persist slipped off the beam"
    END_CONTACT = (
        "contact with the end of a beam, or with a side that a contact does not have, is not modelled"
    )
    FOLDED = "a contact reached the held end of its beam"
    CONTACT_CHANGED = (
        "a contact opened or closed under arc-length control, which follows a fixed set of contacts"
    )
    CHATTER = "contact opened and closed again and again at one load parameter"


class StopError(Exception):
    """The path ends here, by its status; `met` is the pair that meets an end of its beam there, and the state."""

    def __init__(self, status: Status, met: Any = None) -> None:
        super().__init__(status.value)
        self.status, self.met = status, met


class RefusedError(Exception):
    """A step is given up, by its status; the fraction `part` of it is tried next."""

    def __init__(self, status: Status = Status.ITERATION_LIMIT, part: float = 1 / 2) -> None:
        super().__init__(status.value)
        self.status, self.part = status, min(max(part, _LEAST_PART), 1 / 2)

"""How a solution ended."""

from __future__ import annotations

from enum import Enum


class Status(Enum):
    """Outcome of a solution; the value is its sentence."""

    COMPLETED = "all load parameters were reached"
    CONVERGED = "equilibrium was found"
    ITERATION_LIMIT = "Newton's iteration did not converge within its limit"
    NOT_FINITE = "a residual or an update was not finite"
    SINGULAR_TANGENT = "the tangent is singular"
    CUTBACK_FLOOR = "the load step was cut back to its floor"
    CHATTER = "contact opened and closed again and again at one load parameter"
    UNBALANCED = "the support reactions do not balance the contact forces"

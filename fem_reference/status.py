"""How a solution or one of its steps can end."""

from enum import Enum


class Status(Enum):
    """Outcome of a solution or of one of its steps; the value is its sentence."""

    COMPLETED = "every load parameter was reached, and every accepted state was checked"
    CONVERGED = "the residual is below its tolerance and the state was checked"
    ITERATION_LIMIT = "Newton's method did not converge within its iteration limit"
    NOT_FINITE = "the iteration produced a value that is not finite"
    SINGULAR = "the tangent stiffness could not be factorised"
    LOST_CONTACT = "the pin passed the end of the strip"
    UNDECIDED_CONTACT = "the contact kept changing between open and closed"
    UNBALANCED = "the clamp's reaction does not balance the contact force"
    CUTBACK_FLOOR = "the load step fell below its floor"

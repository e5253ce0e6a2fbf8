"""Outcomes of a solution and of its steps."""

from enum import Enum


class Status(Enum):
    """Outcome of a solution or of one of its steps; the value is the message for the user."""

    COMPLETED = "every load parameter was reached, and every accepted state was checked"
    CONVERGED = "the residual is below its tolerance and the state was checked"
    ITERATION_LIMIT = "Newton's method did not converge within its iteration limit"
    NOT_FINITE = "the iteration produced a value that is not finite"
    SINGULAR = "the tangent stiffness could not be factorised"
    LOST_CONTACT = "the pin passed the end of the strip"
    UNDECIDED_CONTACT = "the contacts kept opening and closing, or sticking and slipping"
    CYCLING = (
        "the contacts returned to a set of open, closed, sticking and slipping ones that was tried before"
    )
    TOO_DEEP = "the penalty leaves a penetration above its limit"
    AUGMENTATION_LIMIT = "augmented Lagrangian steps did not reach the requested penetration"
    INVERTED = "an element is turned inside out"
    UNBALANCED = "the clamps' reactions do not balance the contact forces"
    ILL_CONDITIONED = "the strip is too thin for this mesh in double precision: the round-off of nodal forces exceeds its bending forces"
    CUTBACK_FLOOR = "the load step fell below its floor"
    STEP_LIMIT = "the largest number of load steps was used before the next load parameter was reached"
    ANOTHER_BRANCH = "the converged state is not on the branch of the previous state"
    LIMIT_POINT = "the load parameter has a limit on this branch of the discrete solid: beyond it there is no equilibrium nearby"
    BIFURCATION = "the path bifurcates: beyond this load parameter the followed branch is unstable"
    END_CONTACT = "contact with the end of a strip is not modelled"
    LINE_CONTACT = "the strip is as curved as the round pin: beyond this point they touch along a line"

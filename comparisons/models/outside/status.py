"""Reasons why the run of another program gives no answer."""

from enum import Enum

from comparisons.files import one_line


class ProgramStatus(Enum):
    """How the run of another program failed; the value is the meaning."""

    NOT_STARTED = "the program cannot be started"
    CRASHED = "the program ended with an exit status other than 0, or by a signal"
    TIMED_OUT = "the program ran longer than its limit and was ended"
    OUT_OF_MEMORY = "the program took more memory than its limit and was ended"
    TOO_MUCH_OUTPUT = "the program wrote more than 200 MB and was ended"
    INVALID_JSON = "the output is not JSON, or it is cut off"
    INVALID_RESPONSE = "the output is JSON, but no response to the scene: a key, a name or a shape is wrong"
    NOT_FINITE = "a number of the response is missing or not finite"


class ProgramError(Exception):
    """The run of another program gave no answer.

    Attributes
    ----------
    status : ProgramStatus
        What failed.
    reported_success : bool
        Whether the program stated success all the same.
    """

    def __init__(self, status: ProgramStatus, message: str, *, reported_success: bool = False) -> None:
        super().__init__(one_line(message))
        self.status, self.reported_success = status, reported_success

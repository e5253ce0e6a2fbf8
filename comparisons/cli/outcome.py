"""How a command ends: exit statuses, and the solutions that stopped, by name."""

import sys
from typing import TYPE_CHECKING

from comparisons.files import printable

if TYPE_CHECKING:
    from comparisons.response import Response
    from comparisons.scene import Scene

DONE, WRONG, BAD_INPUT, STOPPED, INTERRUPTED = 0, 1, 2, 3, 130
EPILOG = """exit status: 0 completed and checked, 2 bad input, 3 the solution stopped (the reason is named)"""


def report(line: str) -> None:
    """Report progress on standard error."""
    print(printable(line), file=sys.stderr, flush=True)


def exit_status(scene: "Scene", responses: "list[tuple[str, Response]]") -> int:
    """Name every solution that stopped and what was reached; return the exit status."""
    stopped = [(label, response) for label, response in responses if not response.completed]
    for label, response in stopped:
        reached = f"{len(response.load_parameter)} of {len(scene.times)} load parameters reached"
        report(f"crossval: {label}{response.status}: {response.message}; {reached}")
    return STOPPED if stopped else DONE

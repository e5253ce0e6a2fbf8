"""How solutions end: the statuses of both solvers with their sentences."""

import fem_reference
import tsm
from comparisons.models.outside.status import ProgramStatus
from docs.extensions.markdown import table, text


def page() -> str:
    """Return the statuses of beams, of the solid and of other programs."""
    return (
        "\n\n".join(
            f"### {title}\n\n" + table(("status", "meaning"), [(f"`{s.name}`", text(s.value)) for s in kind])
            for title, kind in (
                ("Beams", tsm.Status),
                ("Solid", fem_reference.Status),
                ("Programs of others", ProgramStatus),
            )
        )
        + "\n"
    )

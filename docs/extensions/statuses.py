"""How solutions end: the statuses of both solvers with their sentences."""

import fem_reference
import tsm
from docs.extensions.markdown import table, text


def page() -> str:
    """Return the statuses of beams and of the solid."""
    return (
        "\n\n".join(
            f"### {title}\n\n" + table(("status", "meaning"), [(f"`{s.name}`", text(s.value)) for s in kind])
            for title, kind in (("Beams", tsm.Status), ("Solid", fem_reference.Status))
        )
        + "\n"
    )

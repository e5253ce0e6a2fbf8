"""Scenes that nobody has drawn before: the date is the seed, ``CROSSVAL_DAY=20261231`` draws those of another day."""

import os
from collections import Counter
from collections.abc import Callable
from datetime import UTC, datetime
from time import process_time

import pytest

from tests.fuzz import world_judge
from tests.fuzz.special import DRAW
from tests.fuzz.world_judge import BEAMS, judged, wrong

NUMBER = 20
"""Scenes of each kind."""
BUDGET = 50.0
"""Processor seconds for each kind; what is not drawn until then is counted."""
LIMIT = 10.0
"""Processor seconds for one solution, and for one certificate."""


# the limit of time may ring inside a callback of the garbage collector, where it is ignored with a warning
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.slow
@pytest.mark.parametrize("kind", ["world", "friction", "special"])
def test_completed_answers_of_the_day_are_right(
    kind: str, record_property: Callable[[str, object], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A completed answer is certified, or the other elements have it too; what else comes out is listed."""
    monkeypatch.setattr(world_judge, "LIMIT", LIMIT)
    day = int(os.environ.get("CROSSVAL_DAY") or f"{datetime.now(UTC):%Y%m%d}")
    began, ends, faults = process_time(), Counter[str](), []
    for number in range(100 * day, 100 * day + NUMBER):
        if process_time() - began > BUDGET:
            ends["not drawn in time"] += 1
            continue
        found = judged(DRAW[kind](number), BEAMS)
        ends.update(f"{row.model} {row.ended}" for row in found.rows)
        left = list(wrong(found))
        ends.update(f"listed: {item.kind} of {number}" for item in found.findings if item not in left)
        if left:
            faults.append(f"CROSSVAL_DAY={day}, {kind} {number}\n{found.report()}")
    record_property(
        "listed", f"CROSSVAL_DAY={day}, {kind}: " + ", ".join(f"{n} {end}" for end, n in sorted(ends.items()))
    )
    assert not faults, f"{len(faults)} of {NUMBER} scenes\n" + "\n\n".join(faults)

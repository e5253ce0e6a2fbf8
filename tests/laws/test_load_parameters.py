"""The last answer of a stage does not depend on how many load parameters are asked for."""

import pytest

from tests.laws.scenes import ELEMENTS, OTHERS, cases, numbered, scene, stated, within
from tests.laws.transform import Readings, apart

NUMBERS = (1, 7)
PATH = ("times", "critical", "events", "kinds")


def last(found: Readings) -> Readings:
    """What is stated at the last load parameter, and of the path what is located."""
    completed, path = found["status"][1][0] == "COMPLETED", (*PATH, "status")
    return {
        name: (kind, values if name.partition(" ")[0] in path else values[-1:])
        for name, (kind, values) in found.items()
        if name != "times" and (completed or name in path)
    }


@pytest.mark.parametrize(("model", "name"), cases(models=(*ELEMENTS, *OTHERS)))
def test_any_number_of_load_parameters_has_the_same_last_answer(model: str, name: str) -> None:
    own = last(stated(scene(name), model))
    for number in NUMBERS:
        other = numbered(scene(name), number)
        off = apart(other, own, last(stated(other, model)))
        assert off[0] <= 100.0 * within(model), (number, off)

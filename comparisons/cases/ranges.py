"""The values that a key of a study takes: one, a list, or a range."""

import math
from typing import Any

from comparisons.scene import rules
from comparisons.scene.rules import FieldError, RecordError, Rule
from comparisons.scene.tables import table_values

LARGEST_COUNT = 10_000
RULES: dict[str, Rule] = {
    "from": rules.number,
    "to": rules.number,
    "count": rules.whole(LARGEST_COUNT),
    "spacing": rules.choice("linear", "log"),
}
"""The keys of a range with the rules of their values."""


def values(key: str, given: object) -> tuple[object, ...]:
    """Return the values that `given` states for `key`: itself, the items of a list, or a range.

    A range has both ends; ``"linear"`` is the default spacing. Between whole ends, a value that is whole but for round-off is made so.

    >>> values("elements", {"from": 5, "to": 40, "count": 4, "spacing": "log"})
    (5, 10, 20, 40)
    """
    if isinstance(given, dict):
        try:
            return _range(given)
        except FieldError as error:
            raise error.within(f"{key}.") from None
    if given == []:
        raise FieldError(key, given, "must not be empty")
    return tuple(given) if isinstance(given, list) else (given,)


def _range(given: dict[str, Any]) -> tuple[float, ...]:
    mistakes = table_values(given, RULES, required=("from", "to", "count"))[1]
    if mistakes:
        raise RecordError(mistakes)
    first, last, count = given["from"], given["to"], given["count"]
    logarithmic = given.get("spacing") == "log"
    if count < 2:
        raise FieldError("count", count, "must be at least 2, a range has two ends")
    if first == last:
        raise FieldError("to", last, "must differ from the range's start")
    for name in ("from", "to"):
        if logarithmic and given[name] <= 0:
            raise FieldError(name, given[name], 'must be positive in a range of spacing = "log"')

    def between(part: float) -> float:
        value: float = first * (last / first) ** part if logarithmic else first + (last - first) * part
        whole = isinstance(first, int) and isinstance(last, int)
        return round(value) if whole and math.isclose(value, round(value), rel_tol=1e-12) else value

    return (first, *(between(k / (count - 1)) for k in range(1, count - 1)), last)

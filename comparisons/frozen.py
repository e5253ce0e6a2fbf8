"""The records of this package: values by name that do not change.

A start makes dozens of such classes. A frozen dataclass compiles six methods for each; these share theirs.
"""

from dataclasses import MISSING, Field, FrozenInstanceError, dataclass, field, fields
from typing import Any, ClassVar, dataclass_transform


@dataclass_transform(kw_only_default=True, frozen_default=True, eq_default=False, field_specifiers=(field,))
class Frozen:
    """Values by name, which `dataclasses.fields` and `dataclasses.replace` know; a record is equal to itself alone."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    _fields: ClassVar[dict[str, Any]]
    _needed: ClassVar[set[str]]

    def __init_subclass__(cls) -> None:
        dataclass(init=False, repr=False, eq=False, match_args=False)(cls)
        cls._fields = {item.name: item for item in fields(cls)}
        cls._needed = {
            k for k, item in cls._fields.items() if item.default is item.default_factory is MISSING
        }

    def __init__(self, /, **given: Any) -> None:
        if not self._needed <= given.keys() <= self._fields.keys():
            names = f"{', '.join(self._fields)}; given are {', '.join(given)}"
            raise TypeError(f"{type(self).__name__} has {names}")
        for name, item in self._fields.items():
            value = given.get(name, item.default)
            # values that are set one by one are read faster than those of an updated dictionary
            object.__setattr__(self, name, item.default_factory() if value is MISSING else value)
        self._settle()

    def _settle(self) -> None:
        """Complete values by others, or refuse them."""

    def __setattr__(self, name: str, value: object) -> None:
        raise FrozenInstanceError(f"cannot assign to field {name!r}")

    def __delattr__(self, name: str) -> None:
        self.__setattr__(name, None)

    def _values(self) -> tuple[Any, ...]:
        return (type(self), *map(vars(self).get, self._fields))

    def __repr__(self) -> str:
        values = (f"{name}={vars(self).get(name)!r}" for name in self._fields)
        return f"{type(self).__name__}({', '.join(values)})"


class Value(Frozen):
    """A record that is equal to another one of its kind with equal values.

    Examples
    --------
    >>> class Step(Value):
    ...     size: float
    ...     parts: int = 1
    >>> Step(size=0.5), Step(size=0.5) == Step(size=0.5, parts=1)
    (Step(size=0.5, parts=1), True)
    """

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Value) and self._values() == other._values()

    def __hash__(self) -> int:
        return hash(self._values())

"""Groups of elements. A group has all elements of a model with the same kind of equations, and the contacts on them."""

from tsm.elements import ClosedForm, ElementType, Integrated
from tsm.model.groups.base import GroupForces, GroupTangent
from tsm.model.groups.closed_form import ClosedFormGroup
from tsm.model.groups.exact import ExactGroup

Group = ClosedFormGroup | ExactGroup
GROUPS: dict[type[ElementType], type[Group]] = {ClosedForm: ClosedFormGroup, Integrated: ExactGroup}
"""Groups by the kind of equations, in the order of assembly."""

__all__ = ["GROUPS", "ClosedFormGroup", "ExactGroup", "Group", "GroupForces", "GroupTangent"]


def __dir__() -> list[str]:
    return sorted(__all__)

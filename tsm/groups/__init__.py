"""Groups of elements: all elements of a model that are stated in the same way, with the contacts on them."""

from tsm.elements import ClosedForm, ElementType, Integrated
from tsm.groups.base import Change, ElementGroup, GroupForces, GroupTangent
from tsm.groups.closed_form import ClosedFormGroup
from tsm.groups.exact import ExactGroup

GROUPS: dict[type[ElementType], type[ElementGroup]] = {ClosedForm: ClosedFormGroup, Integrated: ExactGroup}
"""Groups by the way in which elements are stated, in the order in which they are assembled."""

__all__ = ["GROUPS", "Change", "ClosedFormGroup", "ElementGroup", "ExactGroup", "GroupForces", "GroupTangent"]

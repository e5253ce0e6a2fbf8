"""The problems of the manual, in its order."""

from collections.abc import Callable, Sequence

from comparisons.claims.manual import (
    columns,
    contacts,
    convergence,
    elastica,
    frames,
    friction,
    invariance,
    loads,
    rods,
)
from comparisons.claims.manual.record import Problem
from comparisons.scene import InputError

PROBLEMS: dict[str, Callable[[], Problem]] = {
    "dead-load": loads.dead_load,
    "roll-up": loads.roll_up,
    "euler-column": columns.euler,
    "haringx-column": columns.haringx,
    "post-buckling": columns.post_buckling,
    "clamped-column": columns.clamped_column,
    "pinned-column": columns.pinned_column,
    "lees-frame": frames.lee,
    "williams-toggle": frames.toggle,
    "portal-frame": frames.portal,
    "short-cantilever": rods.short_cantilever,
    "ks-elastica": elastica.ks_elastica,
    "elastica-identity": elastica.identity,
    "force-limit": elastica.force_limit,
    "three-point-bending": elastica.three_point_bending,
    "slip-off": elastica.slip_off,
    "ks-axis": rods.ks_axis,
    "ks-face": rods.ks_face,
    "ks-biot": rods.ks_biot,
    "ks-tied-tip": rods.ks_tied,
    "slip-off-in-shear": rods.slip_off_41,
    "double-beam": rods.double_beam,
    "two-pins": contacts.two_pins,
    "crossed-beams": contacts.crossed_beams,
    "touch-again": contacts.touch_again,
    "ks-friction-elastica": friction.ks_friction_elastica,
    "ks-friction": friction.ks_friction,
    "three-point-friction": friction.three_point_friction,
    "hysteresis": friction.hysteresis,
    "sleeve": friction.sleeve,
    "mixed-order": convergence.mixed_order,
    "timoshenko-order": convergence.paper_order,
    "thin-strips": convergence.thin_strips,
    "penalty-slope": convergence.penalty,
    "locking": convergence.locking,
    "energy-balance": invariance.energy_balance,
    "objectivity": invariance.objectivity,
    "mirror": invariance.mirror,
    "reversal": invariance.reversal,
}
"""The problems by name. Each states one problem, with its exact values computed and its models not yet run."""


def named(names: Sequence[str] | None) -> tuple[Callable[[], Problem], ...]:
    """Return the problems with some names, all where none are given.

    Raises
    ------
    InputError
        For a name that no problem has.
    """
    for name in names or ():
        if name not in PROBLEMS:
            raise InputError("--only", f"{name}: no such problem ({', '.join(PROBLEMS)})")
    return tuple(state for name, state in PROBLEMS.items() if names is None or name in names)

"""The problems of the manual, in its order."""

from collections.abc import Callable

from comparisons.claims.manual import (
    columns,
    contacts,
    convergence,
    elastica,
    frames,
    invariance,
    loads,
    rods,
)
from comparisons.claims.manual.record import Problem

PROBLEMS: tuple[Callable[[], Problem], ...] = (
    loads.dead_load,
    loads.roll_up,
    columns.euler,
    columns.haringx,
    columns.post_buckling,
    columns.clamped_column,
    columns.pinned_column,
    frames.lee,
    frames.toggle,
    frames.portal,
    rods.short_cantilever,
    elastica.ks_elastica,
    elastica.identity,
    elastica.force_limit,
    elastica.three_point_bending,
    elastica.slip_off,
    rods.ks_axis,
    rods.ks_face,
    rods.ks_biot,
    rods.ks_tied,
    rods.slip_off_41,
    rods.double_beam,
    contacts.two_pins,
    contacts.crossed_beams,
    contacts.touch_again,
    convergence.mixed_order,
    convergence.paper_order,
    convergence.thin_strips,
    convergence.penalty,
    convergence.locking,
    invariance.energy_balance,
    invariance.objectivity,
    invariance.mirror,
    invariance.reversal,
)
"""Each states one problem, with its exact values computed and its models not yet run."""

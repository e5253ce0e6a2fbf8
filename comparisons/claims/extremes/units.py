"""Answers in the units of another beam: a mechanical problem has no other lengths and forces than its own."""

from typing import NoReturn

import numpy as np

from comparisons.cases.measure import Measurement
from comparisons.response import ContactHistory, Response, SupportHistory
from comparisons.scene import BeamSpec


def in_units_of(other: BeamSpec, beam: BeamSpec, measured: Measurement) -> Response:
    """Return what was measured on `beam` as the response of `other`, if that is the same up to units.

    Lengths are multiplied by the ratio of the lengths, forces by that of ``EI/L^2``, moments by that of ``EI/L``.
    """
    length = other.length / beam.length
    force = other.EI / beam.EI / length**2
    return Response(
        model="",
        scene="",
        status=measured.status,
        message=measured.message,
        completed=measured.completed,
        load_parameter=measured.load_parameter,
        contacts={
            pair: ContactHistory(
                force=force * values,
                arc_position=length * measured.arc_position[pair],
                gap=np.zeros(len(values)),
            )
            for pair, values in measured.force.items()
        },
        supports={
            name: SupportHistory(force=force * values, moment=force * length * measured.moment[name])
            for name, values in measured.support_force.items()
        },
        tips={name: length * values for name, values in measured.tip.items()},
        newton_iterations=np.zeros(0, dtype=np.int64),
        cutbacks=measured.cutbacks,
        unknowns=measured.unknowns,
        wall_seconds=measured.seconds,
        axis_line=_not_kept,
        grid=_not_kept,
    )


def _not_kept(*_: object) -> NoReturn:
    raise AssertionError("a measurement keeps neither axes nor meshes at every load parameter")

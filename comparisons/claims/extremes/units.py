"""Conversion of a response to the units of a similar beam; mechanics does not depend on the units of length and force."""

from dataclasses import replace

from comparisons.response import Response
from comparisons.scene import BeamSpec


def in_units_of(other: BeamSpec, beam: BeamSpec, response: Response) -> Response:
    """Return the response of `beam` in the units of `other`, a beam that differs in units only. Axes and gaps are not converted.

    Lengths are scaled by the ratio of the lengths L, forces by the ratio of ``EI/L^2``, moments by the ratio of ``EI/L``.
    """
    length = other.length / beam.length
    force = other.EI / beam.EI / length**2
    return replace(
        response,
        contacts={
            pair: replace(one, force=force * one.force, arc_position=length * one.arc_position)
            for pair, one in response.contacts.items()
        },
        supports={
            name: replace(one, force=force * one.force, moment=force * length * one.moment)
            for name, one in response.supports.items()
        },
        tips={name: length * values for name, values in response.tips.items()},
    )

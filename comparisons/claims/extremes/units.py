"""Responses in the units of another beam: a mechanical problem has no other lengths and forces than its own."""

from dataclasses import replace

from comparisons.response import Response
from comparisons.scene import BeamSpec


def in_units_of(other: BeamSpec, beam: BeamSpec, response: Response) -> Response:
    """Return the response of `beam` as that of `other`, if both are the same up to units; axes and gaps are left as they are.

    Lengths are multiplied by the ratio of the lengths, forces by that of ``EI/L^2``, moments by that of ``EI/L``.
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

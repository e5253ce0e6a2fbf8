"""The limit of a series of responses, by extrapolation, and the state at which it carries its last force."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from comparisons.quantities import forces, size
from comparisons.response import Array, Response
from comparisons.response.axis import SampledAxes, sampled_axes

Tables = dict[str, Array]


def extrapolated(responses: Sequence[Response]) -> Response:
    """Return the limit of the last three responses, coarse to fine with a constant ratio of refinement, at the same load parameters.

    With the differences ``d1, d2`` of successive responses, the limit of a quantity is ``q = q3 + d2 / (|d1|/|d2| - 1)`` (Richardson,
    Aitken). The norm is the maximum over the load parameters, so that the order is observed and not assumed. If ``|d2|`` is more than
    nine tenths of ``|d1|``, nothing is added. The last difference ``|d2|`` is the stated uncertainty of the limit. It is larger than the
    error at a constant order, because a local singularity, as under a load on one node, lowers the order on fine meshes.
    """

    def limit(read: Callable[[Response], Tables]) -> Tables:
        coarse, middle, fine = (read(one) for one in responses[-3:])
        last = {name: fine[name] - middle[name] for name in fine}
        factor = _remainder([middle[name] - coarse[name] for name in fine], list(last.values()))
        return {name: values + factor * last[name] for name, values in fine.items()}

    best = responses[-1]
    force, moment = limit(forces), limit(lambda one: {node: s.moment for node, s in one.supports.items()})
    arc = limit(lambda one: {pair: contact.arc_position for pair, contact in one.contacts.items()})
    return replace(
        best,
        contacts={
            pair: replace(contact, force=force[pair], arc_position=arc[pair])
            for pair, contact in best.contacts.items()
        },
        supports={
            # with contacts only their forces are extrapolated
            node: replace(support, force=force.get(node, support.force), moment=moment[node])
            for node, support in best.supports.items()
        },
        material_force=limit(lambda one: dict(one.material_force)),
        tips=limit(lambda one: one.tips),
        axis_line=SampledAxes(
            arc_length=sampled_axes(best).arc_length, position=limit(lambda one: sampled_axes(one).position)
        ),
    )


def _remainder(before: Sequence[Array], last: Sequence[Array]) -> float:
    """Sum of a geometric series after its second term, over that term."""
    d1, d2 = (
        max((float(np.nanmax(np.abs(part), initial=0.0)) for part in parts), default=0.0)
        for parts in (before, last)
    )
    return d2 / (d1 - d2) if 0.0 < 1.1 * d2 < d1 else 0.0


def end_state(reference: Response) -> float:
    """Return the last load parameter at which the reference carries a force."""
    carries = np.any([size(values) > 0.0 for values in forces(reference).values()], axis=0)
    loaded = reference.load_parameter[carries]
    return float(loaded[-1] if len(loaded) else reference.load_parameter[-1])

"""The sections of the solid: section forces, and material forces by the J-integral between clamp and contact."""

from math import nan
from typing import Any

import numpy as np

from comparisons.answer import Array, Sections
from comparisons.answer.material import AWAY, clamped
from comparisons.models.shared import occupied
from comparisons.scene import BeamSpec, Scene

SHARE = 0.25
"""Largest part of the distance between clamp and contact that is left out at either end."""


def section_forces(scene: Scene, result: Any, beam: str, k: int) -> Sections:
    """Return the section forces; a clamped end that nothing else is joined to or acts on has its reaction as section force."""
    import fem_reference

    found = fem_reference.section_forces(result, beam, k)
    taken = occupied(scene)
    table, own = np.stack([found.stations, found.N, found.V, found.M]), scene.beam(beam)
    for support in scene.supports_of(beam):
        motion = scene.prescribed_motions[support.node].at(float(result.load_parameter[k]))
        turn, first = motion[2], support.end == "start"
        if turn is None or support.node in taken:
            continue
        held, sign = result.supports[support.node], 1 - 2 * first
        tangent = complex(*own.tangent(1.0 - first)) * np.exp(1.0j * turn)
        force = sign * complex(*held.force[k]) * tangent.conjugate()
        column = [(1.0 - first) * own.length, force.real, force.imag, sign * held.moment[k]]
        table = np.insert(table, 0 if first else table.shape[1], column, axis=1)
    return Sections(arc=table[0], N=table[1], V=table[2], M=table[3])


def j_integrals(scene: Scene, result: Any) -> dict[str, Array]:
    """Return the J-integrals at the clamps of `comparisons.answer.material.clamped`, shape (s,) by beam [force].

    The J-integral is the same for all sections between the clamp and the nearest contact. Its error changes its sign between
    neighbouring Gauss stations and is largest beside clamp and contact. The value is therefore the mean over the Gauss stations in
    between, without those nearer to clamp or contact than 1.5 heights or a quarter of the distance. It is nan where no station is left.
    The J-integral of a naturally curved beam is not constant, and is left out.
    """
    import fem_reference

    def mean(beam: BeamSpec, clamp: float, k: int) -> float:
        pairs = [contact.pair for contact in scene.contacts if contact.beam == beam.name]
        arcs = np.array([result.contacts[pair].arc_position[k] for pair in pairs])
        free = float(np.fmin.reduce(np.abs(arcs - clamp), initial=beam.length))
        margin = min(AWAY * beam.rectangle_height, SHARE * free)
        sections = fem_reference.section_forces(result, beam.name, k)
        distance = np.abs(sections.stations - clamp)
        inside = (distance > margin) & (distance < free - margin)
        return float(sections.material_force[inside].mean()) if inside.any() else nan

    steps, found = range(len(result.load_parameter)), {}
    for name, support in clamped(scene).items():
        beam = scene.beam(name)
        if not beam.turn:
            clamp = 0.0 if support.end == "start" else beam.length
            found[name] = np.array([mean(beam, clamp, k) for k in steps])
    return found

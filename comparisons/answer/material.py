"""Material force: the sum of the tangential contact forces on a beam, from the reactions at its only clamp.

Along a uniform Reissner rod without distributed load

    H = m^2/2EI + k_0 m + N + N^2/2EA + Q^2/2GA

with the natural curvature k_0 is constant between contacts. A contact force F on the axis changes it by ``H_- - H_+ = F . (r'_- + r'_+)/2``, the tangential force times
a factor that differs from 1 by a strain. At a free end H = 0. At the clamp of a beam with one free end H is therefore the sum of the
tangential contact forces, positive away from the clamp: physical friction or, without friction, an error of the contact's direction.
With the mean g of the tangents at the contact of a beam and the cosine c of the angle from the free tail to the contact force F, which has
neither stretch nor shear,

    F . g = F c + F^2 (c^2/EA + (1 - c^2)/GA)/2 = T |g|,   H = T |g| + (T e)^2/2EI

give c and the tangential force T, of lever e, without further approximation.
"""

import math
from collections import UserDict
from collections.abc import Callable
from functools import cached_property

import numpy as np

from comparisons.answer.record import Array
from comparisons.answer.response import Response
from comparisons.scene import BeamSpec, ContactSpec, Scene, SupportSpec
from comparisons.scene.keys import unstated

UNDEFINED = "no touched beam is held by one clamp alone and loaded by contacts alone"
"""Reason why a scene has no material force."""
AWAY = 1.5
"""Distance from clamp and contact, over the height, within which the stress of a solid is local, so that no rod has it."""
ROUNDS = 30
"""Iterations for the length of g; each one reduces its error by a strain."""


class Deferred(UserDict[str, Array]):
    """A table that takes long and is computed once, when it is first asked for."""

    def __init__(self, compute: Callable[[], dict[str, Array]]) -> None:
        self._compute = compute

    @cached_property
    def data(self) -> dict[str, Array]:  # type: ignore[override]
        """What `UserDict` looks up."""
        return self._compute()


def clamped(scene: Scene) -> dict[str, SupportSpec]:
    """Return the clamps at which the material force is the sum of the tangential contact forces, by beam.

    Such a beam is touched, and it is held by one clamp alone. It has no load, no joint, and no end that touches another beam.
    """
    found: dict[str, SupportSpec] = {}
    if unstated(scene, "the material force", ("turn",)) is not None:
        return found
    acting = {load.beam for load in scene.loads} | {contact.node.split(".")[0] for contact in scene.contacts}
    touched = {contact.beam for contact in scene.contacts} - acting
    for beam in (beam for beam in scene.beams if beam.name in touched):
        supports = scene.supports_of(beam.name)
        alone = not (scene.joined(beam, "start") or scene.joined(beam, "end"))
        if alone and len(supports) == 1 and len(supports[0].held) == 3:
            found[beam.name] = supports[0]
    return found


def material_forces(response: Response, scene: Scene, *, strains: bool = True) -> dict[str, Array]:
    """Return the material force of a rod at the clamps of `clamped`, shape (s,) by beam [force].

    ``response``: response of a model of rods, with the reactions of the clamps. ``scene``: the scene that was
    solved. ``strains``: whether the model has the stretch and the shear of Reissner's rod; without them EA
    and GA are infinite.
    """
    found = {}
    for name, clamp in clamped(scene).items():
        beam, support = scene.beam(name), response.supports.get(clamp.node)
        if support is None:
            continue
        EA, GA = (beam.EA, beam.GA) if strains else (math.inf, math.inf)
        way, at = (-1.0, 0.0) if clamp.end == "start" else (1.0, 1.0)
        turn = math.atan2(*beam.tangent(at)[::-1]) + response.load_parameter * (clamp.motion[2] or 0.0)
        force = way * (support.force @ (1.0, 1.0j)) * np.exp(-1.0j * turn)
        N, Q = force.real, force.imag
        found[name] = support.moment**2 / (2.0 * beam.EI) + N + N**2 / (2.0 * EA) + Q**2 / (2.0 * GA)
        if beam.turn:
            found[name] += beam.curvature * way * support.moment
    return found


def frictions(response: Response) -> dict[str, Array]:
    """Return the material force over the sum of the contact forces on its beam, shape (s,) by beam; nan without contact force."""
    found = {}
    for name, force in response.material_force.items():
        own = [np.abs(one.force) for pair, one in response.contacts.items() if pair.endswith(f"->{name}")]
        pressing = np.sum(own, axis=0)
        found[name] = np.divide(force, pressing, out=np.full(len(force), np.nan), where=pressing > 0.0)
    return found


def rubbing(scene: Scene) -> dict[str, ContactSpec]:
    """Return the contacts with friction whose coefficient the reaction of a clamp shows, by beam.

    A beam with several contacts, whose tangential forces only have a sum, is left out, and so is a beam with natural curvature.
    """
    found = {}
    for name in clamped(scene):
        own = [contact for contact in scene.contacts if contact.beam == name]
        if len(own) == 1 and own[0].friction and not scene.beam(name).turn:
            found[name] = own[0]
    return found


def frictions_found(response: Response, scene: Scene) -> dict[str, Array]:
    """Return the coefficients of friction that the reactions of the clamps show, shape (s,) by beam of `rubbing`.

    They are positive away from the clamp. In slip a coefficient is that of the contact or its negative, in stick it is smaller.
    """
    found = {}
    for name, contact in rubbing(scene).items():
        if name in response.material_force:
            lever, H = scene.offset(contact) - scene.radius(contact), response.material_force[name]
            found[name] = _coefficient(response.contacts[contact.pair].force, H, scene.beam(name), lever)
    return found


def _coefficient(force: Array, H: Array, beam: BeamSpec, lever: float) -> Array:
    """Return T over the normal force, shape (s,); nan where the contact force (s,) is zero."""
    F = np.where(force > 0.0, force, np.nan)
    stretch, shear, curl = F / beam.EA, F / beam.GA, lever**2 / (2.0 * beam.EI)
    size = np.ones_like(F)
    for _ in range(ROUNDS):
        T = 2.0 * H / (size + np.sqrt(size**2 + 4.0 * curl * H))
        rest, unequal = T * size / F - shear / 2.0, stretch - shear
        c = 2.0 * rest / (1.0 + np.sqrt(1.0 + 2.0 * unequal * rest))
        size = np.hypot(1.0 + stretch * c / 2.0, shear / 2.0 * np.sqrt(np.maximum(1.0 - c**2, 0.0)))
    return np.asarray(T / np.sqrt(F**2 - T**2))

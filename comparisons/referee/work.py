"""Work of loads, pins and supports between load parameters, against the change of strain energy."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.state import Equilibrium
from comparisons.scene import Scene

Array = NDArray[np.float64]

_DOUBT = 10.0
"""Jumps are named where they exceed so many times the estimated error of the trapezoidal rule."""
_ROUND_OFF = 1e-9
"""Part of the energies that is round-off."""


def jumps(scene: Scene, path: list[Equilibrium], broken: list[bool]) -> list[tuple[float, float, float]]:
    """Return from where to where energy appears or vanishes, and how much: strain energy less work.

    Parameters
    ----------
    scene : Scene
        Scene.
    path : list of Equilibrium
        All in a row, from the first load parameter on.
    broken : list of bool
        For every interval between them, whether an event is in it, where contacts may open or close with a jump.
    """
    acting = [_actions(scene, exact) for exact in path]
    largest = max((exact.strain_energy for exact in path), default=0.0)
    found = []
    for k, (one, other) in enumerate(pairwise(path)):
        if broken[k] or one.contacts.keys() != other.contacts.keys():
            continue
        force, way = acting[k][0] + acting[k + 1][0], acting[k + 1][1] - acting[k][1]
        rise, work = other.strain_energy - one.strain_energy, float((force * way).sum()) / 2.0
        allowed = _DOUBT * _quadrature(acting, k) + _ROUND_OFF * max(one.strain_energy, other.strain_energy)
        if abs(rise - work) > allowed + _ROUND_OFF * largest:
            found.append((one.load_parameter, other.load_parameter, rise - work))
    return found


def _quadrature(acting: list[tuple[Array, Array]], k: int) -> float:
    """Estimate the trapezoidal rule's error, ``int F du`` over an interval, from second differences of F and u about it.

    Where the neighbours have other contacts, from the first differences.
    """
    shape = acting[k][0].shape
    bends = []
    for which in (0, 1):
        three = [
            [acting[j][which] for j in range(first, first + 3)]
            for first in (k - 1, k)
            if first >= 0
            and first + 2 < len(acting)
            and all(acting[j][0].shape == shape for j in range(first, first + 3))
        ]
        own = np.abs(acting[k + 1][which] - acting[k][which])
        bends.append(np.max([np.abs(a - 2.0 * b + c) for a, b, c in three], axis=0) if three else own)
    force, way = (np.abs(acting[k + 1][which] - acting[k][which]) for which in (0, 1))
    return float((bends[0] * way + force * bends[1]).sum()) / 12.0


def _actions(scene: Scene, exact: Equilibrium) -> tuple[Array, Array]:
    """Forces or moments (m, 3) from outside and the places and rotations (m, 3) that they work on."""
    t, pins = (
        exact.load_parameter,
        [exact.contacts[pair] for pair in sorted(exact.contacts) if "." not in pair],
    )
    rows = [(t * np.array([*load.force, load.moment]), exact.turned(load.node)) for load in scene.loads]
    rows += [(exact.reactions[support.node], exact.turned(support.node)) for support in scene.all_supports]
    rows += [(np.append(item.force, 0.0), np.append(item.point, 0.0)) for item in pins]
    table = np.array(rows).reshape(-1, 2, 3)
    return table[:, 0], table[:, 1]

"""Order of the unknowns with a small bandwidth."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from tsm.model.model import Model


def block_order(model: Model) -> list[int]:
    """Order of the nodes and exact elements with a small bandwidth; along the beams where none are joined."""
    if not model.joined:
        along = []
        for beam in model.beams.values():
            own = np.append(model.block[beam.first : beam.last + 1], -1)
            along.append(np.stack([beam.nodes, own], axis=1).ravel())
        return [block for block in np.concatenate(along).tolist() if block >= 0]
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import reverse_cuthill_mckee

    # an element behind a hinge moves with the joint's node and turns with its own
    nodes = model.dofs[[0, 2, 3, 5]] // 3
    blocks = [*nodes, np.where(model.block < 0, nodes[0], model.block)]
    links = np.array(list(model.joints.items()), dtype=int).reshape(-1, 2).T
    pairs = np.concatenate([*(np.stack(pair) for pair in combinations(blocks, 2)), links], axis=1)
    near = coo_array((np.ones(pairs.shape[1]), tuple(pairs)), shape=(model.dof_count // 3,) * 2)
    order: list[int] = reverse_cuthill_mckee((near + near.T).tocsr(), symmetric_mode=True).tolist()
    return order

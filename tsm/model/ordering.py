"""Order of the unknowns with a small bandwidth."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from tsm.model.mesh import Mesh


def block_order(mesh: Mesh) -> list[int]:
    """Order of the nodes and exact elements with a small bandwidth; along the beams where none are joined."""
    if not mesh.joined:
        along = []
        for beam in mesh.beams.values():
            own = np.append(mesh.block[beam.first : beam.last + 1], -1)
            along.append(np.stack([beam.nodes, own], axis=1).ravel())
        return [block for block in np.concatenate(along).tolist() if block >= 0]
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import reverse_cuthill_mckee

    # an element behind a hinge moves with the joint's node and turns with its own
    nodes = mesh.dofs[[0, 2, 3, 5]] // 3
    blocks = [*nodes, np.where(mesh.block < 0, nodes[0], mesh.block)]
    pairs = np.concatenate([*(np.stack(pair) for pair in combinations(blocks, 2)), mesh.links.T], axis=1)
    near = coo_array((np.ones(pairs.shape[1]), tuple(pairs)), shape=(mesh.dof_count // 3,) * 2)
    order: list[int] = reverse_cuthill_mckee((near + near.T).tocsr(), symmetric_mode=True).tolist()
    return order

"""Array types and the order of array axes in this package.

- Nodal fields: ``(nodes, 2)``. Component ``i`` at node ``n`` is the degree of freedom ``2 n + i``, as in
  scikit-fem's vector-valued fields.
- Fields at quadrature points: tensor axes first, then element, then point; a displacement gradient is
  ``(i, j, e, q)`` and a tangent ``(i, j, k, l, e, q)``.
- Element matrices: element axis first, ``(e, 2 k, 2 k)``, local degree of freedom ``2 a + i``.
- All positions, displacements and forces are in the global frame.
- Only `fem_reference.solid.mesh`, `mesh_file` and `end_section` read scikit-fem's arrays.

Material laws accept complex arrays too, so that tests can check their derivatives by complex steps.
"""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[Any]
Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int64]


def cofactor(A: Array) -> Array:
    """Cofactors of matrices ``(2, 2, ...)``."""
    (a, b), (c, d) = A
    return np.array([[d, -c], [-b, a]])


def determinant(A: Array) -> Array:
    """Determinants of matrices ``(2, 2, ...)``."""
    return A[0, 0] * A[1, 1] - A[0, 1] * A[1, 0]

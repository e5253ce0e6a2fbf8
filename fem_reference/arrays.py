"""Array types and axis order of the package, stated once.

- Nodal fields: ``(nodes, 2)``; the degree of freedom of component ``i`` at node ``n`` is ``2 n + i``, which is
  scikit-fem's own numbering of a vector-valued field.
- Fields at quadrature points: tensor axes first, then element, then point; a displacement gradient is
  ``(i, j, e, q)`` and a tangent ``(i, j, k, l, e, q)``.
- Element matrices: element axis first, ``(e, 2 k, 2 k)``, local degree of freedom ``2 a + i``.
- Displacements are in the frame of their strip, positions of contacts and results in the global one.
- Only `fem_reference.mesh`, `mesh_file` and `sampling` read scikit-fem's arrays.

Kernels accept complex arrays too, so every derivative can be checked by complex steps.
"""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[Any]
Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int64]

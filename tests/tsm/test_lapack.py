"""LAPACK's routines without the rest of SciPy's linear algebra."""

import subprocess
import sys

import pytest

CODE = {
    "alone, and the package imported after it": """
import sys
import numpy as np
from tsm.system.lapack import lapack
A = np.random.default_rng(0).normal(size=(9, 9))
alone = lapack().dgesv(A, A[:, :2])
assert lapack().__name__ == "scipy.linalg._flapack" and "scipy.linalg" not in sys.modules
import scipy.linalg.lapack, scipy.sparse.linalg
for routines in (scipy.linalg.lapack, lapack()):
    assert all(np.array_equal(one, other) for one, other in zip(alone, routines.dgesv(A, A[:, :2])))
""",
    "from the package that is there, or where there is no such file": """
import sys
from tsm.system import lapack
lapack._NAME = "scipy.linalg._elsewhere"
assert lapack.lapack() is sys.modules["scipy.linalg.lapack"]
del sys.modules["tsm.system.lapack"]
from tsm.system.lapack import lapack
assert lapack() is sys.modules["scipy.linalg.lapack"]
""",
}


@pytest.mark.slow_at("alone, and the package imported after it")
@pytest.mark.parametrize("code", CODE.values(), ids=CODE)
def test_the_routines_are_those_of_the_package(code):
    subprocess.run([sys.executable, "-c", code], check=True, timeout=300)

"""LAPACK's routines, as SciPy compiled them.

Importing SciPy's linear algebra takes longer than solving a scene, and the routines are in one of its files:
that file is loaded alone. Where SciPy keeps them elsewhere, or is imported already, they are taken from the
public `scipy.linalg.lapack`: they are the same.
"""

from __future__ import annotations

import sys
from functools import cache
from importlib.machinery import PathFinder
from importlib.util import module_from_spec
from typing import Any

_NAME = "scipy.linalg._flapack"


@cache
def lapack() -> Any:
    """Module of the routines, loaded at the first call."""
    if "scipy.linalg" not in sys.modules:
        import scipy

        spec = PathFinder.find_spec(_NAME, [f"{folder}/linalg" for folder in scipy.__path__])
        if spec is not None and spec.loader is not None:
            module = module_from_spec(spec)
            spec.loader.exec_module(module)
            return module
    from scipy.linalg import lapack as public

    return public

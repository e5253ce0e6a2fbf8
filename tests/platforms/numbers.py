"""Essential numbers of the main scenes against those stored: ``python -m tests.platforms.numbers [--write]``.

They are this program's own, stored at some version: a difference shows that a platform or a change moved them, agreement does not show that they are right.
NumPy, SciPy and scikit-fem suffice.
"""

import argparse
import json
import platform
import sys
from dataclasses import replace
from importlib import metadata
from pathlib import Path

import numpy as np

from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.scene import load_scene

STORED = Path(__file__).parents[1] / "reference" / "numbers.json"
BOUND = 1e-10
"""Largest difference between platforms, relative to the largest value of the history."""
RUNS = {
    "ks-cantilever, rod": ("ks-cantilever", "rod", None),
    "ks-cantilever, elastica": ("ks-cantilever", "elastica", None),
    "ks-cantilever, mixed 10": ("ks-cantilever", "tsm", Options(elements=10)),
    "ks-cantilever, timoshenko 10": ("ks-cantilever", "tsm", Options(elements=10, element="timoshenko")),
    "ks-cantilever, exact": ("ks-cantilever", "tsm", Options(element="exact")),
    "ks-cantilever, solid 50x2": ("ks-cantilever", "solid", Options(mesh=(50, 2))),
    "ks-face, solid 25x2": ("ks-face", "solid", Options(mesh=(25, 2))),
    "double-beam, mixed 10": ("double-beam", "tsm", Options(elements=10)),
    "double-beam, exact": ("double-beam", "tsm", Options(element="exact")),
}
LOAD_PARAMETERS = 10


def computed():
    """Return forces and arc positions of contacts, support moments and tips of every run."""
    found = {}
    for label, (name, model, options) in RUNS.items():
        response = solve(replace(load_scene(name), load_parameters=LOAD_PARAMETERS), model, options)
        assert response.completed, f"{label}: {response.message}"
        histories = {f"tip of {beam}": tip.ravel() for beam, tip in response.tips.items()}
        histories |= {f"moment of {node}": support.moment for node, support in response.supports.items()}
        for pair, contact in response.contacts.items():
            histories |= {f"force of {pair}": contact.force, f"arc position of {pair}": contact.arc_position}
        found[label] = {
            key: [None if np.isnan(value) else float(value) for value in values]
            for key, values in histories.items()
        }
    return found


def differences(numbers, stored):
    """Yield the difference of every history, relative to its largest value, and its name."""
    assert numbers.keys() == stored.keys(), "the runs are not those stored"
    for label, histories in numbers.items():
        for key, values in histories.items():
            one, other = (np.array(row, dtype=float) for row in (values, stored[label][key]))
            same = one.shape == other.shape and np.array_equal(np.isnan(one), np.isnan(other))
            largest = np.nanmax(np.abs(other), initial=0.0) or 1.0
            apart = np.nanmax(np.abs(one - other), initial=0.0) / largest if same else np.inf
            yield float(apart), f"{key}, {label}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="store the numbers")
    given = parser.parse_args()
    libraries = [f"{name} {metadata.version(name)}" for name in ("numpy", "scipy", "scikit-fem")]
    versions = ", ".join([f"python {platform.python_version()}", *libraries, platform.machine()])
    numbers = computed()
    if given.write:
        stated = {"source": f"python -m tests.platforms.numbers --write: {versions}", "numbers": numbers}
        STORED.write_text(json.dumps(stated, allow_nan=False, indent=1) + "\n")
        return 0
    apart, name = max(differences(numbers, json.loads(STORED.read_text())["numbers"]))
    print(f"{versions}: largest difference {apart:.1e} ({name}), bound {BOUND:g}")
    return int(not apart <= BOUND)


if __name__ == "__main__":
    sys.exit(main())

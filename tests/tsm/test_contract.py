"""An element that is registered in one place is right everywhere: alone, in its energy, beside another contact."""

from __future__ import annotations

import os
import pickle
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tsm
from tsm.elements import CLOSED_FORM, ContactLaw, Coupling
from tsm.elements.properties import Properties

SECTION = tsm.Section(EA=2e3, GA=100.0, EI=1.0)
SHARP = tsm.Settings(tolerance=1e-12)


def _soft(p: Properties) -> Properties:
    """Constants of an element whose contacts dent it twice as much."""
    return p._replace(EI=p.EI / 2)


def _soft_law(law: ContactLaw) -> ContactLaw:
    coupling = law.coupling
    assert coupling is not None
    return ContactLaw(
        response=lambda p, *state: law.response(_soft(p), *state),
        energy=lambda p, *state: law.energy(_soft(p), *state),
        coupling=Coupling(
            jet=lambda p, *state: coupling.jet(_soft(p), *state),
            dent=lambda p, *state: coupling.dent(_soft(p), *state),
            crossing=lambda p, *state: coupling.crossing(_soft(p), *state),
        ),
    )


MIXED = CLOSED_FORM["mixed"]
ADDED: dict[str, tsm.elements.ElementType] = {
    "rigid in shear": replace(MIXED, name="rigid in shear", sheared=False),
    "soft contact": replace(MIXED, name="soft contact", contact=_soft_law(MIXED.contact)),
}
WITH_UNKNOWNS = [*ADDED, "mixed", "mixed-no-bow"]


@pytest.fixture(autouse=True)
def registered(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, kind in ADDED.items():
        monkeypatch.setitem(tsm.ELEMENTS, name, kind)


def pressed(
    element: str, *, pins: int = 1, offset: float = 0.0, section: tsm.Section = SECTION, elements: int = 4
) -> Any:
    """A cantilever that one pin, or two on the same element, push up."""
    starts = (0.6, 0.7)[:pins]
    return tsm.Structure(
        beams=(
            tsm.Beam(name="b", start=(0, 0), end=(1, 0), section=section, elements=elements, element=element),
        ),
        supports=(tsm.Support(beam="b", end="start"),),
        pins=tuple(
            tsm.Pin(name=f"p{n}", path=((x, -offset), (x - 0.02, 0.12 * x * x - offset)))
            for n, x in enumerate(starts)
        ),
        contacts=tuple(
            tsm.ContactPair(node=f"p{n}", beam="b", side="right", offset=offset) for n in range(pins)
        ),
    )


@pytest.mark.parametrize("element", [*WITH_UNKNOWNS, "exact", "timoshenko", "euler-bernoulli-simple"])
@pytest.mark.parametrize("offset", [0.0, 0.02])
def test_strain_energy_is_the_work_of_the_pin(element: str, offset: float) -> None:
    """Gauss quadrature of the pin's power over the second half of its way; the paper's elements have an energy only to first order."""
    gauss, weight = np.polynomial.legendre.leggauss(12)
    structure = pressed(element, offset=offset)
    times = np.concatenate([[0.5], 0.75 + gauss / 4, [1.0]])
    result = tsm.solve(structure, times, SHARP)
    power = -result.supports["b.start"].force @ np.array(structure.pins[0].velocity(0.5, 0.5))
    gained = result.strain_energy[-1] - result.strain_energy[0]
    energetic = element in WITH_UNKNOWNS or element == "exact"
    assert gained == pytest.approx(weight @ power[1:-1] / 4, rel=1e-9 if energetic else 5e-3)


def test_shear_does_not_matter_to_an_element_that_is_rigid_in_shear() -> None:
    forces = [
        tsm.solve(pressed("rigid in shear", section=replace(SECTION, GA=GA)), [1.0])
        .contacts["p0->b"]
        .force[0]
        for GA in (1.0, 1e3)
    ]
    assert forces[0] == forces[1]
    stiff = tsm.solve(pressed("mixed", section=replace(SECTION, GA=1e15)), [1.0]).contacts["p0->b"].force[0]
    assert forces[0] == pytest.approx(stiff, rel=1e-10)


@pytest.mark.parametrize("element", ["mixed", "exact"])
def test_a_result_can_be_pickled(element: str) -> None:
    """Processes solve many structures and hand their results back."""
    result = tsm.solve(pressed(element), [0.5, 1.0])
    other = pickle.loads(pickle.dumps(result))  # noqa: S301 - its own
    assert repr(other) == repr(result)
    assert other.shape("b", 1).tolist() == result.shape("b", 1).tolist()


def test_a_softer_contact_carries_less() -> None:
    """Its dent is twice as deep: the pin goes further into the element, by ``C F``."""
    soft, hard = (
        tsm.solve(pressed(name), [1.0]).contacts["p0->b"].force[0] for name in ("soft contact", "mixed")
    )
    assert 0.8 * hard < soft < 0.999 * hard


USE = """
import tsm
beam = tsm.Beam(name="b", start=(0, 0), end=(1, 0), section=tsm.Section(EA=2e3, GA=100.0, EI=1.0), elements=4, element="new")
structure = tsm.Structure(
    beams=(beam,),
    supports=(tsm.Support(beam="b", end="start"),),
    pins=(tsm.Pin(name="p0", path=((0.6, 0.0), (0.58, 0.12 * 0.36))),),
    contacts=(tsm.ContactPair(node="p0", beam="b", side="right"),),
)
print(float(tsm.solve(structure, [1.0]).contacts["p0->b"].force[0]))
"""


def test_a_new_element_is_one_file(tmp_path: Path) -> None:
    package = shutil.copytree(Path(tsm.__file__).parent, tmp_path / "tsm")
    (package / "elements" / "kinds" / "unsheared.py").write_text(
        "from dataclasses import replace\n"
        "from tsm.elements.kinds.mixed import MIXED\n"
        "ELEMENTS = (replace(MIXED, name='new', sheared=False),)\n"
    )
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    run = subprocess.run(
        [sys.executable, "-c", USE], cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
    )
    registered = tsm.solve(pressed("rigid in shear"), [1.0]).contacts["p0->b"].force[0]
    assert [float(force) for force in run.stdout.split()] == pytest.approx([registered], rel=1e-9)

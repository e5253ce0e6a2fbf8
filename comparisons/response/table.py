"""The histories of an answer as columns of equal length, for data frames and CSV files.

``load_parameter``, ``stage``, ``newton_iterations``, ``index``
    Load parameter, stage, Newton iterations since the previous load parameter, index.
``PAIR.force``, ``.force_x``, ``.force_y``
    Contact force, and its components on the beam.
``PAIR.arc_position``, ``.gap``
    Where the contact is, and its gap.
``PAIR.tangential``, ``.normal``, ``.slip``, ``.dissipated``
    With friction: components of the force, sign of the slip rate, dissipated energy.
``BEAM.start.force_x``, ``.force_y``, ``.moment``
    Reactions of the support at the start of the beam.
``BEAM.start.spring_force_x``, ``.spring_force_y``, ``.spring_moment``
    Forces of the springs to the ground at the start of the beam.
``BEAM.tip_x``, ``.tip_y``
    Position of the tip.
``BEAM.bending_moment``, ``.bending_moment_at`` and so on
    The extreme along the beam and its arc position: ``axial_force``, ``shear_force``, ``bending_moment``, ``tensile_stress``,
    ``compressive_stress``, ``displacement``.
``BEAM.material_force``
    Material force.
``work``
    Work of pins, supports and loads.
"""

import csv
import io
from collections.abc import Iterator
from typing import Any

from numpy.typing import NDArray

from comparisons.output import plain
from comparisons.response.along import ALONG, extremes_along
from comparisons.response.record import ContactHistory, Response

_Column = tuple[str, str, NDArray[Any]]
"""Name, kind (an attribute of `comparisons.response.round_off.RoundOff`) and values (s,)."""


def table(response: Response, units: str | None = None) -> dict[str, NDArray[Any]]:
    """Return the histories by name, each of shape (s,): what ``pandas.DataFrame`` takes.

    Parameters
    ----------
    response : Response
        The answer. One that was read from a file states no extremes along its beams.
    units : str, optional
        Units of force and length, as ``"N, m"``; the names then end with their units, as ``strip.start.moment [N m]``.
    """
    named = {} if units is None else unit_names(units)
    return {
        f"{name} [{named[kind]}]" if named.get(kind) else name: values
        for name, kind, values in _columns(response)
    }


def csv_history(response: Response, units: str) -> str:
    """Return `table` as CSV, with a row for each load parameter and units in the names."""
    columns = table(response, units)
    rows = zip(*(values.tolist() for values in columns.values()), strict=True)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([plain(value) for value in row] for row in rows)
    return text.getvalue()


def unit_names(units: str) -> dict[str, str]:
    """Return the unit of each kind of quantity, from the units of force and length."""
    force, length = (unit.strip() for unit in units.split(","))
    moment = f"{force} {length}"
    return {
        "force": force,
        "length": length,
        "moment": moment,
        "energy": moment,
        "stress": f"{force}/{length}^2",
    }


def _columns(response: Response) -> Iterator[_Column]:
    yield "load_parameter", "number", response.load_parameter
    yield "stage", "number", response.stage
    for pair, contact in response.contacts.items():
        yield from _contact(pair, contact)
    for node, support in response.supports.items():
        yield f"{node}.force_x", "force", support.force[:, 0]
        yield f"{node}.force_y", "force", support.force[:, 1]
        yield f"{node}.moment", "moment", support.moment
    for node, spring in response.springs.items():
        yield f"{node}.spring_force_x", "force", spring.force[:, 0]
        yield f"{node}.spring_force_y", "force", spring.force[:, 1]
        yield f"{node}.spring_moment", "moment", spring.moment
    for beam, tip in response.tips.items():
        yield f"{beam}.tip_x", "length", tip[:, 0]
        yield f"{beam}.tip_y", "length", tip[:, 1]
    along = {} if response.definition is None else extremes_along(response, response.definition)
    for beam, extremes in along.items():
        for name, extreme in extremes.items():
            yield f"{beam}.{name}", ALONG[name][0], extreme.value
            yield f"{beam}.{name}_at", "length", extreme.arc_position
    for beam, force in response.material_force.items():
        yield f"{beam}.material_force", "force", force
    if response.work is not None:
        yield "work", "energy", response.work
    if response.index is not None:
        yield "index", "number", response.index
    yield "newton_iterations", "number", response.newton_iterations


def _contact(pair: str, contact: ContactHistory) -> Iterator[_Column]:
    yield f"{pair}.force", "force", contact.force
    if contact.vector is not None:
        yield f"{pair}.force_x", "force", contact.vector[:, 0]
        yield f"{pair}.force_y", "force", contact.vector[:, 1]
    yield f"{pair}.arc_position", "length", contact.arc_position
    yield f"{pair}.gap", "length", contact.gap
    if contact.friction is not None:
        yield f"{pair}.tangential", "force", contact.friction.tangential
        yield f"{pair}.normal", "force", contact.friction.normal
        yield f"{pair}.slip", "number", contact.friction.slip
        yield f"{pair}.dissipated", "energy", contact.friction.dissipated

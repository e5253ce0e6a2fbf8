"""The histories of an answer as columns of equal length, for data frames and CSV files.

``load_parameter``, ``stage``, ``newton_iterations``, ``index``, ``work``
    Load parameter, stage, Newton iterations since the previous load parameter, index, work of pins, supports and loads.
``PAIR.force``, ``.force_x``, ``.force_y``, ``.arc_position``, ``.gap``; with friction ``.tangential``, ``.normal``, ``.slip``, ``.dissipated``
    Contact force and its components on the beam, where the contact is, gap; components along and across the beam, sign of the slip rate,
    dissipated energy.
``BEAM.start.force_x``, ``.force_y``, ``.moment``; ``.spring_force_x``, ``.spring_force_y``, ``.spring_moment``
    Reactions of the support at the start of the beam; forces of the springs to the ground there.
``BEAM.tip_x``, ``.tip_y``, ``.material_force``; ``.bending_moment``, ``.bending_moment_at`` and so on
    Position of the tip, material force; the extreme along the beam and its arc position, by `comparisons.answer.along.ALONG`.
"""

from collections.abc import Iterator
from typing import Any

from numpy.typing import NDArray

from comparisons.answer.along import ALONG, extremes_along
from comparisons.answer.record import Answer
from comparisons.output import csv_text

RUBBING = {"tangential": "force", "normal": "force", "slip": "number", "dissipated": "energy"}
"""What friction of a contact does, with its kind."""


def table(response: Answer, units: str | None = None, *, along: bool = True) -> dict[str, NDArray[Any]]:
    """Return the histories by name, each of shape (s,): what ``pandas.DataFrame`` takes.

    Parameters
    ----------
    response : Answer
        The answer. One that was read from a file states no extremes along its beams.
    units : str, optional
        Units of force and length, as ``"N, m"``; the names then end with their units, as ``strip.start.moment [N m]``.
    along : bool
        Whether the extremes along the beams are wanted, which take long.
    """
    named = {} if units is None else unit_names(units)
    found: dict[str, NDArray[Any]] = {}
    for name, kind, values in _histories(response, along=along):
        unit = f" [{named[kind]}]" if kind in named else ""
        if values is not None and values.ndim == 1:
            found[name + unit] = values
        elif values is not None:
            found |= {f"{name}_{letter}{unit}": values[:, axis] for axis, letter in enumerate("xy")}
    return found


def csv_history(response: Answer, units: str) -> str:
    """Return `table` as CSV, with a row for each load parameter and units in the names."""
    columns = table(response, units)
    rows = zip(*(values.tolist() for values in columns.values()), strict=True)
    return csv_text([dict(zip(columns, row, strict=True)) for row in rows], columns)


def unit_names(units: str) -> dict[str, str]:
    """Return the unit of each kind of quantity, from the units of force and length."""
    force, length = (unit.strip() for unit in units.split(","))
    moment, more = f"{force} {length}", {"stress": f"{force}/{length}^2", "stiffness": f"{force}/{length}"}
    return {"force": force, "length": length, "moment": moment, "energy": moment, **more}


def _histories(response: Answer, *, along: bool) -> Iterator[tuple[str, str, NDArray[Any] | None]]:
    """Yield the histories: name, kind (an attribute of `RoundOff`), and values (s,) or (s, 2), None where the model does not state them."""
    yield "load_parameter", "number", response.load_parameter
    yield "stage", "number", response.stage
    for pair, contact in response.contacts.items():
        yield f"{pair}.force", "force", contact.force
        yield f"{pair}.force", "force", contact.vector
        yield f"{pair}.arc_position", "length", contact.arc_position
        yield f"{pair}.gap", "length", contact.gap
        if (rubs := contact.friction) is not None:
            for name, kind in RUBBING.items():
                yield f"{pair}.{name}", kind, getattr(rubs, name)
    for prefix, held in (("", response.supports), ("spring_", response.springs)):
        for node, one in held.items():
            yield f"{node}.{prefix}force", "force", one.force
            yield f"{node}.{prefix}moment", "moment", one.moment
    for beam, tip in response.tips.items():
        yield f"{beam}.tip", "length", tip
    scene = response.definition if along else None
    for beam, extremes in ({} if scene is None else extremes_along(response, scene)).items():
        for name, extreme in extremes.items():
            yield f"{beam}.{name}", ALONG[name][0], extreme.value
            yield f"{beam}.{name}_at", "length", extreme.arc_position
    for beam, force in response.material_force.items():
        yield f"{beam}.material_force", "force", force
    yield "work", "energy", response.work
    yield "index", "number", response.index
    yield "newton_iterations", "number", response.newton_iterations

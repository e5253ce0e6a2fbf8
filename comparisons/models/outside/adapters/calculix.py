"""CalculiX: a clamped strip of quadratic bricks in plane stress, under a transverse load at its end or a sharp pin on its face.

CalculiX replaces its plane elements by bricks with tied faces. Its input here states the bricks directly, so that nothing is tied.
The bricks fill the half of a thin slab above the middle plane. Nodes on the middle plane are held in the direction of the thickness,
and the upper face is free. The modulus is ``E b / w``, so that the half slab of thickness w carries the forces of the whole strip
of width b.

- With ``NLGEOM``, ``*ELASTIC`` is linear between Green's strain and the second Piola-Kirchhoff stress. This is the law of
  St. Venant and Kirchhoff, to the seven digits that CalculiX prints.
- CalculiX takes a residual force below 1e-6 for zero, whatever the units. Forces are therefore stated in 1e-5 EI/L^2.
- A number has at most twenty characters.
- The contact is a penalty between the pin and the face. CalculiX goes on without contact where the pin slips through the face, and
  reports success.
"""

import re
import tempfile
from collections import defaultdict
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import simpson

from comparisons.models.outside import child
from comparisons.models.outside.adapters.exchange import Histories, StoppedError, Table, refined, serve
from comparisons.models.outside.adapters.strip import axes, foot, one_strip, way
from comparisons.models.outside.child import ProgramError, ProgramStatus

if TYPE_CHECKING:
    from fem_reference import Strip

Array = NDArray[Any]
Tables = defaultdict[tuple[str, str], list[list[list[float]]]]
"""Printed rows of three components, one table for each increment, by ``displacements`` or ``forces`` and the node set."""

ACROSS = 2
"""Elements over the height."""
LOAD_STEPS, PIN_STEPS = 20, 200
"""Least numbers of steps of a load and of a pin's way."""
PENALTY = 7e4
"""Contact stiffness, over EI/L^3."""
THINNESS = 0.01
"""Thickness w of the half slab over the strip's height."""
_BRICK = "000 200 220 020 002 202 222 022 100 210 120 010 102 212 122 012 001 201 221 021"
"""Places of a brick's twenty nodes in CalculiX's order: x, y and z in halves of the brick."""
_FACE = np.array([[-1.0, 4.0, -1.0], [4.0, 0.0, 4.0], [-1.0, 4.0, -1.0]]) / 12
"""Consistent nodal forces of a unit force that is spread evenly over a face with eight nodes."""
DECK = Path(__file__).with_name("calculix.inp.jinja")
"""The input of CalculiX."""
_HEADER = re.compile(r" (displacements|forces) \(.*\) for set (\S+) and time\s+(\S+)")
_SHORT = re.compile(r"(?<=\d)(?=[+-]\d{3}$)")
"""Place of the E that Fortran leaves out before an exponent of three digits."""
MEMORY = 1e5
"""Limit on the memory of CalculiX [MB]."""


def refusal(scene: Table) -> str | None:
    """Return why the deck of bricks cannot state the scene."""
    if (reason := one_strip(scene)) is not None:
        return reason
    if len(scene["loads"]) + len(scene["contacts"]) != 1:
        return "the adapter has one load or one contact"
    for load in scene["loads"]:
        along, _ = axes(scene["beams"][0]) @ load["force"]
        if load["end"] != "end" or load["moment"] or abs(along) > 1e-12 * max(map(abs, load["force"])):
            return "the adapter has a transverse force at the free end"
    for item in scene["contacts"]:
        pin = scene["pins"][0]
        if pin["radius"] or not item["offset"] or item["side"] != "right" or pin["corners"]:
            return "the adapter has a sharp pin on the right face, on a straight path"
    return None


def states(scene: Table, histories: Histories) -> Iterator[float]:
    """Solve and yield every load parameter."""
    from fem_reference import Strip

    beam, frame = scene["beams"][0], axes(scene["beams"][0])
    own = {key: beam[key] for key in ("name", "height", "width", "youngs_modulus")}
    slab = Slab(Strip(
        **own, start=(0.0, 0.0), end=(beam["length"], 0.0),
        poissons_ratio=beam["youngs_modulus"] / (2.0 * beam["shear_modulus"]) - 1.0,
        mesh=(beam["elements"], ACROSS),
    ), seconds=1e5)  # fmt: skip
    penalty = PENALTY * beam["EI"] / beam["length"] ** 3
    increments = refined(scene, LOAD_STEPS if scene["loads"] else PIN_STEPS)
    steps = sum(map(len, increments))
    try:
        if scene["loads"]:
            found = slab.tip_load(float((frame @ scene["loads"][0]["force"])[1]), steps)
        else:
            found = slab.pin(way(beam, scene["pins"][0])[1], steps, penalty)
    except ProgramError as error:
        raise StoppedError(str(error)) from error
    for number, t in enumerate(scene["load_parameters"]):
        k = len(increments[0]) * (number + 1) - 1
        if k >= len(found.load_parameter):
            raise StoppedError(found.stopped or f"no increment at load parameter {t:.6g}")
        line, force = beam["start"] + found.axis[k] @ frame, found.force[k] @ frame
        histories.axis(beam["name"], slab.axis[:, 0].tolist(), line)
        histories.support(scene["supports"][0]["node"], force, found.moment[k])
        for item in scene["contacts"]:
            size, at = float(np.hypot(*force)), foot(line, scene["pins"][0]["positions"][number])
            if size == 0.0:
                histories.open(item["pair"])
            else:
                arc = float(at.shape @ slab.axis[at.first : at.first + 3, 0])
                histories.contact(item["pair"], -force, arc, -size / penalty)
        yield t


class Answer(NamedTuple):
    """Histories over the load increments of CalculiX, in the strip's frame: s increments, a nodes on the axis."""

    load_parameter: Array  #: Part of the load or of the pin's way (s,).
    tip: Array  #: Mean displacement of the free end (s, 2).
    force: Array  #: Force (s, 2) of the clamp on the strip.
    moment: Array  #: Its moment (s,) about the clamped point.
    axis: Array  #: Positions of the nodes on the axis (s, a, 2).
    stopped: str  #: Why CalculiX stopped before the end; empty if it did not.


def tip_load(strip: "Strip", force: float) -> Answer:
    """Return the answer to a transverse dead load [N] at the free end; raise `ProgramError` unless the whole load is reached."""
    answer = Slab(strip).tip_load(force, LOAD_STEPS)
    if answer.stopped:
        raise ProgramError(ProgramStatus.CRASHED, f"CalculiX {answer.stopped}")
    return answer


def pressed(strip: "Strip", path: ArrayLike, steps: int, penalty: float) -> Answer:
    """Return the answer to a sharp pin on the right face, see `Slab.pin`, before it slips through the face or an increment fails."""
    slab = Slab(strip)
    found = slab.pin(path, steps, penalty)
    through = np.flatnonzero(np.hypot(*found.force.T) < slab.unit)
    if not through.size:
        return found
    *histories, _ = found
    return Answer._make([*(one[: through[0]] for one in histories), "lost the pin through the face"])


class Slab:
    """A strip, clamped at its start, as a mesh of bricks in the strip's frame.

    `numbers` and `points` are the numbers of the nodes and the positions on the grid of corners and midpoints, (2 nx + 1, 2 ny + 1, 3);
    the number is 0 at a grid point without a node. `axis` (a, 2) and `clamp` (c, 2) are the nodes there, `unit` is the deck's unit of force.
    """

    def __init__(self, strip: "Strip", seconds: float = 300.0) -> None:
        nx, ny = strip.mesh
        i, j, k = np.indices((2 * nx + 1, 2 * ny + 1, 3))
        there = i % 2 + j % 2 + k % 2 <= 1
        x, y = strip.length * i / (2 * nx), strip.height * (j / (2 * ny) - 0.5)
        self.strip, self.seconds, self.thickness = strip, seconds, THINNESS * strip.height
        self.unit = 1e-5 * strip.bending_stiffness / strip.length**2
        self.numbers = np.where(there, np.cumsum(there).reshape(there.shape), 0)
        self.points = np.stack([x, y, self.thickness * k / 2], axis=-1)
        self.axis, self.clamp = (
            self.points[part][self.numbers[part] > 0][:, :2] for part in (np.s_[:, ny, 0], np.s_[0])
        )

    def tip_load(self, force: float, steps: int) -> Answer:
        """Return the answer to a transverse dead load [N], spread evenly over the free end, in equal steps."""
        ny, end = self.strip.mesh[1], self.numbers[-1]
        loads = np.zeros(end.shape)
        for row in range(ny):
            loads[2 * row : 2 * row + 3] += force / self.unit / ny * _FACE
        return self._answer(steps, loads=zip(end[end > 0], loads[end > 0], strict=True))

    def pin(self, path: ArrayLike, steps: int, penalty: float) -> Answer:
        """Return the answer to a sharp pin that moves along the right face in equal steps, between two points in the strip's frame, `path` (2, 2).

        The pin is a needle across the half slab. Its two nodes are the slaves of a contact with the face. `penalty` [N/m] is the contact
        stiffness. CalculiX multiplies the stated slope of the pressure by half the area of a face for each of the two nodes.
        """
        (nx, ny), (start, end) = self.strip.mesh, np.asarray(path)
        return self._answer(
            steps,
            needle=[(*start, part * self.thickness) for part in (0.25, 0.75)],
            face=range(1, 1 + nx * ny, ny),
            slope=penalty / self.unit / (self.thickness * self.strip.length / nx),
            motion=(*(end - start), 0.0),
        )

    def _answer(self, steps: int, **action: Any) -> Answer:
        """Return the answer up to the last increment that was printed completely; raise `ProgramError` if there is none."""
        from jinja2 import Template

        strip, n, (nx, ny) = self.strip, self.numbers, self.strip.mesh
        x, y, z = np.array([[*map(int, place)] for place in _BRICK.split()]).T
        held = n[0] if strip.clamp == "full" else n[0, ny]  # of the clamp "rod" the edge's middle line alone
        named = {"CLAMP": n[0], "HELD": held, "MIDDLE": n[:, :, 0], "TIP": n[-1, :, 0], "AXIS": n[:, ny, 0]}
        sets = {name: numbers[numbers > 0] for name, numbers in named.items()}
        deck = Template(DECK.read_text(encoding="ascii"), trim_blocks=True, keep_trailing_newline=True)
        text = deck.render(
            nodes=[*zip(n[n > 0], map(tuple, self.points[n > 0]), strict=True)],
            bricks=[n[x + 2 * column, y + 2 * row, z].tolist() for column, row in np.ndindex(nx, ny)],
            sets=sets,
            law=(strip.youngs_modulus * strip.width / self.thickness / self.unit, strip.poissons_ratio),
            steps=steps,
            **action,
        )
        times, tables, stopped = run(text, self.seconds)
        printed = [*product(["displacements"], ["TIP", "AXIS", "CLAMP"]), ("forces", "CLAMP")]
        whole = [[rows for rows in tables[one] if len(rows) == len(sets[one[1]])] for one in printed]
        count = min(map(len, whole))
        if count == 0:
            raise ProgramError(ProgramStatus.CRASHED, f"CalculiX {stopped or 'printed no result'}")
        tip, bent, moved, forces = (np.array(table[:count])[:, :, :2] for table in whole)
        forces = forces * self.unit
        x, y = (self.clamp + moved).transpose(2, 0, 1)
        moment = (x * forces[..., 1] - y * forces[..., 0]).sum(axis=1)
        mean = simpson(tip, dx=0.5 / ny, axis=1)
        return Answer(np.array(times[:count]), mean, forces.sum(axis=1), moment, self.axis + bent, stopped)


def run(deck: str, seconds: float) -> tuple[list[float], Tables, str]:
    """Run ``ccx`` on a deck, on one thread, for at most `seconds`; return what `parse` reads, and why it did not finish, empty if it did."""
    words = reason = ""
    with tempfile.TemporaryDirectory(prefix="calculix-") as folder:
        (Path(folder) / "job.inp").write_text(deck, encoding="ascii")
        try:
            output = child.run(("ccx", "-i", "job"), Path(folder), "", seconds, MEMORY, OMP_NUM_THREADS="1")
            words = " ".join(output.decode(errors="replace").split())
        except ProgramError as error:
            if error.status is ProgramStatus.NOT_STARTED:
                needed = "CalculiX is needed: there is no program ccx on the path (Debian: calculix-ccx)"
                raise ProgramError(error.status, needed) from None
            words = str(error)
            if error.status is ProgramStatus.TIMED_OUT:
                reason = f"did not finish within {seconds:g} s"
        if not reason and "Job finished" not in words:
            where = words.find("*ERROR")
            reason = f"stopped: {words[where:][: child.TAIL] if where >= 0 else words[-child.TAIL :]}"
        found = Path(folder) / "job.dat"
        return *parse(found.read_text(encoding="ascii", errors="replace") if found.exists() else ""), reason


def parse(text: str) -> tuple[list[float], Tables]:
    """Read a ``.dat`` file: the end of every increment that converged, and its tables; an incomplete last line is skipped."""
    tables, times, rows = Tables(list), dict[float, None](), list[list[float]]()
    for line in text[: text.rfind("\n") + 1].splitlines():
        if header := _HEADER.match(line):
            rows = []
            tables[header[1], header[2]].append(rows)
            times[float(header[3])] = None
        elif line.strip():
            rows.append([float(_SHORT.sub("E", value)) for value in line.split()[1:]])
    return list(times), tables


if __name__ == "__main__":
    serve(refusal, states)

"""The page of an answer: status, reactions, contacts, extremes, tips and events, as text and as HTML.

Numbers have six significant digits, fewer where the last ones are round-off; a number below the round-off of its quantity is 0
(`comparisons.answer.round_off`).
"""

from collections.abc import Iterable, Iterator, Sequence
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from comparisons.answer.along import ALONG, FIRST, extremes_along
from comparisons.answer.record import Answer, Array, ContactEvent
from comparisons.answer.round_off import RoundOff, round_off
from comparisons.answer.table import unit_names
from comparisons.output import aligned
from comparisons.scene import Scene

PLACE = 4
"""Significant digits of the place of an extreme, which is not sharp where the extreme is flat."""
OPENED = {"release": "opened", "slip-off": "slipped off"}
"""Events that open a contact, and the state after."""
EVENTS = {
    "touch": "{node} touches {beam} at arc position {arc}",
    "release": "{node} leaves {beam} at arc position {arc}",
    "slip-off": "{node} slips off {beam} at arc position {arc}; contact force before {force}",
    "slip": "{node} begins to slip on {beam} at arc position {arc}; contact force {force}",
    "stick": "{node} comes to stick on {beam} at arc position {arc}; contact force {force}",
    "limit-point": "limit point of the path",
    "bifurcation": "bifurcation of the path",
    "pass-through": "",
}
"""Sentences by kind of event; that a contact passes a node of the mesh is no event of the structure."""

Row = Sequence[str | float]
"""Texts, and numbers whose kind their column states."""


class Block(NamedTuple):
    """A table of a page: title, names of the columns, none in the head of the page, and rows."""

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]


def text(response: Answer, more: Sequence[tuple[str, str]] = (), rule: str = "") -> str:
    """Return the page as text; `more` has labels and texts for the head, `rule` says why the setting of the model was chosen.

    Without the `definition` of the answer the numbers have no units, and no extremes along the beams are stated.
    """
    return "\n\n".join(map(_lines, _blocks(response, more, rule)))


def html(response: Answer, k: int = -1) -> str:
    """Return the page as HTML; reactions, contacts and tips are those at load parameter number k."""
    return "".join(map(_markup, _blocks(response, k=k)))


def _blocks(
    response: Answer, more: Sequence[tuple[str, str]] = (), rule: str = "", k: int = -1
) -> Iterator[Block]:
    yield Block(response.scene, (), [*_head(response, rule), *more])
    if len(response.load_parameter):
        yield from (block for block in _Page(response, k).blocks() if block.rows)


def counted(scene: Scene, least: int = 0) -> str:
    """Return how many beams, pins and contact pairs a scene has, of each at least so many."""
    counts = {"beam": len(scene.beams), "pin": len(scene.pins), "contact pair": len(scene.contacts)}
    parts = (f"{n} {what}{'' if n == 1 else 's'}" for what, n in counts.items() if n >= least)
    return ", ".join(parts)


def _head(response: Answer, rule: str) -> Iterator[tuple[str, str]]:
    scene = response.definition
    if scene is not None:
        yield "scene", f"{counted(scene, 1)}, {len(scene.times)} load parameters, units {scene.units}"
    size = f"{response.unknowns} unknowns" if response.unknowns else ""
    yield "model", ", ".join(filter(None, (response.model, response.setting, size)))
    if rule:
        yield "element", rule
    reached = len(response.load_parameter)
    asked = f" of {len(scene.times)}" if scene is not None else ""
    stage = f" in stage {response.stage[-1]}" if reached and response.stage[-1] > 1 else ""
    last = f", the last {response.load_parameter[-1]:.6g}{stage}" if reached else ""
    yield "status", f"{response.ended} ({reached}{asked} load parameters{last})"
    yield "stability", stability(response)
    judged = response.certificate
    yield "certificate", "not judged; crossval certify judges it" if judged is None else judged.line()


def stability(response: Answer) -> str:
    """Say in a few words where a response is stable."""
    if response.index is None:
        return "not stated by this model"
    unstable, unknown = response.index > 0, response.index < 0
    parts = []
    if unstable.any():
        first = response.load_parameter[np.argmax(unstable)]
        parts.append(f"UNSTABLE from load parameter {first:.6g} on, index up to {response.index.max()}")
    elif not unknown.all():
        parts.append("stable")
    if unknown.any():
        rubbed = any(contact.friction is not None for contact in response.contacts.values())
        what = "not judged, since a contact has friction," if rubbed else "index not defined"
        parts.append(f"{what} at {int(unknown.sum())} of {len(unknown)} load parameters")
    return "; ".join(parts)


class _Page:
    """The tables of an answer that reached a load parameter, now number k."""

    def __init__(self, response: Answer, k: int) -> None:
        scene = response.definition
        self.response, self.scene, self.k = response, scene, k
        self.round_off = RoundOff() if scene is None else round_off(response, scene)
        self.units = {} if scene is None else unit_names(scene.units)
        self.t = float(response.load_parameter[k])

    def blocks(self) -> Iterator[Block]:
        """Yield the tables, which may have no rows."""
        now, forces = f"at load parameter {self.t:.6g}", {"x": "force", "y": "force"}
        columns = {"support": "", "holds": "", **forces, "moment": "moment"}
        yield self.block(f"Reactions on the beams {now}", columns, self.reactions())
        columns = {"contact": "", "state": "", "force": "force", **forces, "arc position": "length"}
        yield self.block(f"Contact forces on the beams {now}", columns, self.contacts())
        columns = {"contact": "", "tangential": "force", "normal": "force", "dissipated": "energy"}
        yield self.block(f"Friction on the beams {now}", columns, self.friction())
        moved = () if self.scene is None else ("displacement x", "displacement y")
        columns = {"tip": "", **dict.fromkeys(("x", "y", *moved), "length")}
        yield self.block(f"Tips {now}", columns, self.tips())
        columns = dict.fromkeys(("quantity", "value", "load parameter", "place"), "")
        yield self.block("Extremes over the load parameters", columns, self.extremes())
        staged = int(self.response.stage[-1] > 1)
        columns = dict.fromkeys(("load parameter", *["stage"] * staged, ""), "")
        yield self.block("Events", columns, self.events(staged))

    def with_unit(self, value: float, kind: str) -> str:
        return f"{self.round_off.text(value, kind)} {self.units.get(kind, '')}".rstrip()

    def block(self, title: str, columns: dict[str, str], rows: Iterable[Row]) -> Block:
        """Return a table whose columns have the kinds of their numbers by name, empty for texts."""

        def cell(value: str | float, kind: str) -> str:
            return value if isinstance(value, str) else self.round_off.text(value, kind)

        units = {kind: f" [{unit}]" for kind, unit in self.units.items()}
        names = [name + units.get(kind, "") for name, kind in columns.items()]
        return Block(title, names, [[*map(cell, row, columns.values())] for row in rows])

    def reactions(self) -> Iterator[Row]:
        scene, response, acting = self.scene, self.response, list[Array]()
        for what, reactions, specs in (
            ("", response.supports, scene and scene.all_supports),
            (", spring", response.springs, scene and scene.springs),
        ):
            held = {spec.node: ", ".join(spec.held) for spec in specs or ()}
            for node, one in reactions.items():
                acting.append(one.force[self.k])
                yield f"{node}{what}", held.get(node, ""), *acting[-1], one.moment[self.k]
        if len(acting) > 1:
            yield "sum", "", *np.sum(acting, axis=0), ""

    def contacts(self) -> Iterator[Row]:
        for pair, contact in self.response.contacts.items():
            vector = (np.nan, np.nan) if contact.vector is None else contact.vector[self.k]
            yield pair, self._state(pair), contact.force[self.k], *vector, contact.arc_position[self.k]

    def friction(self) -> Iterator[Row]:
        for pair, contact in self.response.contacts.items():
            if (one := contact.friction) is not None:
                yield pair, one.tangential[self.k], one.normal[self.k], one.dissipated[self.k]

    def _state(self, pair: str) -> str:
        contact = self.response.contacts[pair]
        if contact.force[self.k] != 0.0 or np.isfinite(contact.arc_position[self.k]):
            return "closed" if contact.friction is None else contact.friction.states(contact.force)[self.k]
        for event in reversed(self.response.events or ()):
            if event.pair == pair and event.kind in OPENED and event.load_parameter <= self.t:
                return f"{OPENED[event.kind]} at {event.load_parameter:.6g}"
        if contact.slip_off <= self.t:
            return f"slipped off at {contact.slip_off:.6g}"
        forces = self._forces(pair)
        before = [t for t, *_ in forces if t <= self.t]
        return f"open after {before[-1]:.6g}" if before else "not touched yet" if forces else "never touched"

    def _forces(self, pair: str) -> list[tuple[float, float, float]]:
        """Return load parameter, force and arc position of a contact where it pushes: at the load parameters and before the events."""
        contact, events = self.response.contacts[pair], self.response.events or ()
        found = [(one.load_parameter, one.force, one.arc_position) for one in events if one.pair == pair]
        found += zip(self.response.load_parameter, contact.force, contact.arc_position, strict=True)
        return sorted((one for one in found if one[1] > 0.0), key=itemgetter(0))

    def tips(self) -> Iterator[Row]:
        for beam, tip in self.response.tips.items():
            end = beam if self.scene is None else f"{beam}.{self.scene.tip(beam)}"
            moved = () if self.scene is None else tip[self.k] - self.scene.place(end)
            yield end, *tip[self.k], *moved

    def extremes(self) -> Iterator[Row]:
        for pair in self.response.contacts:
            yield from self._contact_forces(pair)
        yield from self._along()

    def _contact_forces(self, pair: str) -> Iterator[Row]:
        """Yield the first largest contact force, and the last one of a contact that is open again."""
        forces = self._forces(pair)
        if not forces:
            return
        least = (1.0 - FIRST) * max(force for _, force, _ in forces)
        found = {"largest": next(one for one in forces if one[1] >= least)}
        if self.response.contacts[pair].force[-1] == 0.0:
            same = found["largest"] == forces[-1]
            found = {"largest and last": forces[-1]} if same else {**found, "last": forces[-1]}
        for which, (t, force, arc) in found.items():
            place = f"arc position {self.with_unit(arc, 'length')}"
            yield f"contact force {pair}, {which}", self.with_unit(force, "force"), f"{t:.6g}", place

    def _along(self) -> Iterator[Row]:
        along = {} if self.scene is None else extremes_along(self.response, self.scene, every=False)
        for name, (kind, words) in ALONG.items():
            own = {beam: extremes[name] for beam, extremes in along.items() if name in extremes}
            if not own:
                continue
            values = np.array([extreme.value for extreme in own.values()])
            sizes = np.abs(values)
            k, b = np.argwhere((sizes >= (1.0 - FIRST) * sizes.max()).T)[0]
            beam, value = list(own)[b], values[b, k]
            at, place = f"{self.response.load_parameter[k]:.6g}", self._place(beam, own[beam].arc_position[k])
            resolved = abs(value) > getattr(self.round_off, kind)
            yield words, self.with_unit(value, kind), at if resolved else "", place if resolved else ""

    def _place(self, beam: str, arc: float) -> str:
        assert self.scene is not None, "extremes along a beam are those of a scene"
        length = self.scene.beam(beam).length
        if min(arc, length - arc) < FIRST * length:
            return f"{beam}.{'start' if arc < length / 2 else 'end'}"
        return f"{beam}, arc position {arc:.{PLACE}g} {self.units['length']}"

    def events(self, staged: int) -> Iterator[Row]:
        for event in self.response.events or ():
            if words := self._said(event):
                yield f"{event.load_parameter:.6g}", *[str(event.stage)] * staged, words

    def _said(self, event: ContactEvent) -> str:
        """Return an event in words; empty for one that changes nothing but the element in contact."""
        node, _, beam = event.pair.partition("->")
        arc, force = self.with_unit(event.arc_position, "length"), self.with_unit(event.force, "force")
        words = EVENTS.get(event.kind, f"{event.kind} {event.pair}")
        words = words.format(node=node, beam=beam, arc=arc, force=force)
        if words and event.released:
            words += f"; {self.with_unit(event.released, 'energy')} released"
        return words


def _lines(block: Block) -> str:
    """Return a table as lines: columns of numbers, with or without units, and dashes to the right, the others to the left."""
    rows = [block.columns, *block.rows] if block.columns else block.rows
    columns = zip(*block.rows, strict=True)
    right = [all(not cell or cell[0] in "-0123456789" for cell in column) for column in columns]
    return "\n  ".join([block.title, *aligned(rows, right, 2)])


def _markup(block: Block) -> str:
    from html import escape

    def row(tag: str, cells: Sequence[str]) -> str:
        return f"<tr>{''.join(f'<{tag}>{escape(cell)}</{tag}>' for cell in cells)}</tr>"

    head = f"<thead>{row('th', block.columns)}</thead>" if block.columns else ""
    body = "".join(row("td", cells) for cells in block.rows)
    return f"<h4>{escape(block.title)}</h4><table>{head}<tbody>{body}</tbody></table>"

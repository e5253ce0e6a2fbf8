"""The page of an answer: status, reactions, contacts, extremes, tips and events, as text and as HTML.

Numbers have six significant digits, fewer where the last ones are round-off; a number below the round-off of its quantity is 0
(`comparisons.response.round_off`).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from comparisons.output import aligned
from comparisons.response.along import ALONG, FIRST, Extreme, extremes_along
from comparisons.response.events import SLIP_OFF, event_words, last_force, opening, peak_force
from comparisons.response.record import ContactHistory, Response
from comparisons.response.round_off import RoundOff, round_off
from comparisons.response.table import unit_names
from comparisons.scene import SpringSpec, SupportSpec

PLAIN = dict.fromkeys(("force", "length", "moment", "energy", "stress"), "")
WORDS = {
    "axial_force": "axial force",
    "shear_force": "shear force",
    "bending_moment": "bending moment",
    "tensile_stress": "nominal axial stress, tension",
    "compressive_stress": "nominal axial stress, compression",
    "displacement": "displacement of the axis",
}
assert WORDS.keys() == ALONG.keys(), "every quantity along a beam has its words"
PLACE = 4
"""Significant digits of the place of an extreme, which is not sharp where the extreme is flat."""
NOT_JUDGED = "not judged; crossval certify judges it"

Row = tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Block:
    """A table of a page: title, names of the columns and rows. The head of the page has neither title nor names."""

    title: str = ""
    columns: Row = ()
    rows: Sequence[Row]


def text(response: Response, more: Sequence[tuple[str, str]] = (), rule: str = "") -> str:
    """Return the page as text.

    Parameters
    ----------
    response : Response
        The answer. Without its `definition` the numbers have no units, and no extremes along the beams are stated.
    more : sequence of (str, str)
        Labels and texts that are added to the head.
    rule : str
        Why the setting of the model was chosen.
    """
    return "\n\n".join(_lines(block, response.scene) for block in blocks(response, more, rule))


def html(response: Response) -> str:
    """Return the page as HTML."""
    return "".join(_markup(block, response.scene) for block in blocks(response))


def blocks(response: Response, more: Sequence[tuple[str, str]] = (), rule: str = "") -> Iterator[Block]:
    """Yield the tables of the page; see `text`."""
    yield Block(rows=[*_head(response, rule), *more])
    if not len(response.load_parameter):
        return
    page = _Page(response)
    for block in (page.reactions(), page.contacts(), page.tips(), page.extremes(), page.events()):
        if block.rows:
            yield block


def _head(response: Response, rule: str) -> Iterator[Row]:
    scene = response.definition
    if scene is not None:
        counts = ((len(scene.beams), "beam"), (len(scene.pins), "pin"), (len(scene.contacts), "contact pair"))
        parts = [f"{count} {what}{'' if count == 1 else 's'}" for count, what in counts if count]
        yield "scene", f"{', '.join(parts)}, {len(scene.times)} load parameters, units {scene.units}"
    size = f"{response.unknowns} unknowns" if response.unknowns else ""
    yield "model", ", ".join(filter(None, (response.model, response.setting, size)))
    if rule:
        yield "element", rule
    reached = len(response.load_parameter)
    asked = f" of {len(scene.times)}" if scene is not None else ""
    stage = f" in stage {response.stage[-1]}" if reached and response.stage[-1] > 1 else ""
    last = f", the last {response.load_parameter[-1]:.6g}{stage}" if reached else ""
    yield "status", f"{response.status}: {response.message} ({reached}{asked} load parameters{last})"
    yield "stability", stability(response)
    yield "certificate", _certificate(response)


def stability(response: Response) -> str:
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


def _certificate(response: Response) -> str:
    found = response.certificate
    return NOT_JUDGED if found is None else found.line()


class _Page:
    """The tables of an answer that reached a load parameter."""

    def __init__(self, response: Response) -> None:
        scene = response.definition
        self.response, self.scene = response, scene
        self.round_off = RoundOff() if scene is None else round_off(response, scene)
        self.units = PLAIN if scene is None else unit_names(scene.units)
        self.now = f"at load parameter {response.load_parameter[-1]:.6g}"
        self.staged = bool(response.stage[-1] > 1)

    def number(self, value: float, kind: str) -> str:
        return self.round_off.text(float(value), kind)

    def named(self, name: str, kind: str) -> str:
        """Return the name of a column with its unit."""
        return f"{name} [{self.units[kind]}]" if self.units[kind] else name

    def with_unit(self, value: float, kind: str) -> str:
        return f"{self.number(value, kind)} {self.units[kind]}".rstrip()

    def numbers(self, kind: str, *values: float) -> Row:
        return tuple(self.number(value, kind) for value in values)

    def columns(self, kind: str, *names: str) -> Row:
        return tuple(self.named(name, kind) for name in names)

    def reactions(self) -> Block:
        items: list[SupportSpec | SpringSpec] = []
        if self.scene is not None:
            items += [*self.scene.all_supports, *self.scene.springs]
        held = {(item.node, type(item)): ", ".join(item.held) for item in items}
        rows, whole = [], np.zeros(2)
        sides = (
            ("", SupportSpec, self.response.supports),
            (", spring", SpringSpec, self.response.springs),
        )
        for what, kind, reactions in sides:
            for node, one in reactions.items():
                numbers = (*self.numbers("force", *one.force[-1]), *self.numbers("moment", one.moment[-1]))
                rows.append((f"{node}{what}", held.get((node, kind), ""), *numbers))
                whole += one.force[-1]
        if len(rows) > 1:
            rows.append(("sum", "", *self.numbers("force", *whole), ""))
        columns = ("support", "holds", *self.columns("force", "x", "y"), self.named("moment", "moment"))
        return Block(title=f"Reactions on the beams {self.now}", columns=columns, rows=rows)

    def contacts(self) -> Block:
        contacts = self.response.contacts
        rubbed = any(contact.friction is not None for contact in contacts.values())
        columns = ("contact", "state", *self.columns("force", "force", "x", "y"))
        columns += self.columns("length", "arc position")
        if rubbed:
            columns += (*self.columns("force", "tangential", "normal"), *self.columns("energy", "dissipated"))
        rows = [self._contact(pair, contact, rubbed=rubbed) for pair, contact in contacts.items()]
        return Block(title=f"Contact forces on the beams {self.now}", columns=columns, rows=rows)

    def _contact(self, pair: str, contact: ContactHistory, *, rubbed: bool) -> Row:
        x, y = (np.nan, np.nan) if contact.vector is None else contact.vector[-1]
        row = (pair, self._state(pair, contact), *self.numbers("force", contact.force[-1], x, y))
        row += self.numbers("length", contact.arc_position[-1])
        friction = contact.friction
        if friction is None:
            return row + ("", "", "") * rubbed
        row += self.numbers("force", friction.tangential[-1], friction.normal[-1])
        return row + self.numbers("energy", friction.dissipated[-1])

    def _state(self, pair: str, contact: ContactHistory) -> str:
        if contact.force[-1] != 0.0 or np.isfinite(contact.arc_position[-1]):
            return "closed" if contact.friction is None else contact.friction.states(contact.force)[-1]
        opened = opening(self.response, pair)
        if opened is not None:
            return f"{'slipped off' if opened.kind == SLIP_OFF else 'opened'} at {opened.load_parameter:.6g}"
        if np.isfinite(contact.slip_off):
            return f"slipped off at {contact.slip_off:.6g}"
        last = last_force(self.response, pair)
        return "never touched" if last is None else f"open after {last.load_parameter:.6g}"

    def tips(self) -> Block:
        rows, names = [], ["x", "y"]
        for beam, tip in self.response.tips.items():
            name, numbers = beam, tip[-1]
            if self.scene is not None:
                name = f"{beam}.{self.scene.tip(beam)}"
                numbers = np.append(tip[-1], tip[-1] - self.scene.place(name))
            rows.append((name, *self.numbers("length", *numbers)))
        if self.scene is not None:
            names += ["displacement x", "displacement y"]
        columns = ("tip", *self.columns("length", *names))
        return Block(title=f"Tips {self.now}", columns=columns, rows=rows)

    def extremes(self) -> Block:
        rows = [row for pair in self.response.contacts for row in self._contact_forces(pair)]
        if self.scene is not None:
            rows += self._along(extremes_along(self.response, self.scene))
        columns = ("quantity", "value", "load parameter", "place")
        return Block(title="Extremes over the load parameters", columns=columns, rows=rows)

    def _contact_forces(self, pair: str) -> Iterator[Row]:
        """Yield the largest contact force, and the last one of a contact that is open again."""
        peak, last = peak_force(self.response, pair), last_force(self.response, pair)
        found = {"largest": peak}
        if self.response.contacts[pair].force[-1] == 0.0:
            found = {"largest and last": peak} if peak == last else {**found, "last": last}
        for which, here in found.items():
            if here is not None:
                arc = f"arc position {self.with_unit(here.arc_position, 'length')}"
                what = f"contact force {pair}, {which}"
                yield what, self.with_unit(here.force, "force"), f"{here.load_parameter:.6g}", arc

    def _along(self, along: dict[str, dict[str, Extreme]]) -> Iterator[Row]:
        for name, kind in ALONG.items():
            own = {beam: extremes[name] for beam, extremes in along.items() if name in extremes}
            if not own:
                continue
            values = np.array([extreme.value for extreme in own.values()])
            sizes = np.abs(values)
            k, b = np.argwhere((sizes >= (1.0 - FIRST) * sizes.max()).T)[0]
            beam = list(own)[b]
            place = self._place(beam, float(own[beam].arc_position[k]))
            at = f"{self.response.load_parameter[k]:.6g}"
            value = self.with_unit(values[b, k], kind)
            resolved = abs(values[b, k]) > getattr(self.round_off, kind)
            yield (WORDS[name], value, at, place) if resolved else (WORDS[name], value, "", "")

    def _place(self, beam: str, arc: float) -> str:
        assert self.scene is not None, "extremes along a beam are those of a scene"
        length = self.scene.beam(beam).length
        if min(arc, length - arc) < FIRST * length:
            return f"{beam}.{'start' if arc < length / 2 else 'end'}"
        return f"{beam}, arc position {arc:.{PLACE}g} {self.units['length']}"

    def events(self) -> Block:
        rows = []
        for event in self.response.events or ():
            words = event_words(event, self.with_unit)
            if words:
                stage = (f"{event.stage}",) * self.staged
                rows.append((f"{event.load_parameter:.6g}", *stage, words))
        columns = ("load parameter", *("stage",) * self.staged, "")
        return Block(title="Events", columns=columns, rows=rows)


def _lines(block: Block, scene: str) -> str:
    """Return a table as lines: columns of numbers to the right, the others to the left."""
    rows = [block.columns, *block.rows] if block.columns else block.rows
    lines = aligned(rows, [_numeric(column) for column in zip(*block.rows, strict=True)])
    return "\n".join([block.title or scene, *(f"  {line}" for line in lines)])


def _numeric(cells: Sequence[str]) -> bool:
    """Whether a column has nothing but numbers, with or without units, and dashes."""
    return all(not cell or cell[0] in "-0123456789" for cell in cells)


def _markup(block: Block, scene: str) -> str:
    from html import escape

    heading = f"<h4>{escape(block.title or scene)}</h4>"
    head = "".join(f"<th>{escape(name)}</th>" for name in block.columns)
    body = "".join(f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in row)}</tr>" for row in block.rows)
    names = f"<thead><tr>{head}</tr></thead>" if head else ""
    return f"{heading}<table>{names}<tbody>{body}</tbody></table>"

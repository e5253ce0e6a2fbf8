"""A response as JSON and as a few readable lines."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from comparisons.output import json_text
from comparisons.response import (
    ContactEvent,
    ContactHistory,
    FrictionHistory,
    Response,
    SupportHistory,
)
from comparisons.response.axis import sampled_axes
from comparisons.version import versions

CRITICAL = ("limit-point", "bifurcation")
"""Events that belong to the path and to no contact."""


def as_json(response: Response, **more: Any) -> str:
    """Return the response and the tables `more` as JSON text; a value that is not a number is null."""
    return json_text({**as_dict(response), "versions": versions(), **more})


def as_dict(response: Response) -> dict[str, Any]:
    """Return what a response states, by the names of the JSON file.

    ``supports.{node}`` holds moment and force of the support of a beam's end, ``supports.column.start``. ``events`` is null for a
    model that does not locate events. ``axes.{beam}`` holds the arc lengths of points of the axis and their positions at every
    load parameter. `comparisons.response.from_json.restated` reads all tables except the certificate.
    """
    axes = sampled_axes(response)
    return {
        "status": response.status,
        "message": response.message,
        "reported_success": response.reported_success,
        "model": response.model,
        "continuum": response.continuum,
        "outside": response.outside,
        "scene": response.scene,
        "load_parameter": response.load_parameter,
        "stage": response.stage,
        "contacts": {
            pair: {
                "force": contact.force,
                "vector": contact.vector,
                "arc_position": contact.arc_position,
                "gap": contact.gap,
                "slip_off": contact.slip_off,
                **({} if contact.friction is None else {"friction": vars(contact.friction)}),
            }
            for pair, contact in response.contacts.items()
        },
        "supports": _holds(response.supports),
        **({"springs": _holds(response.springs)} if response.springs else {}),
        "material_force": response.material_force,
        "tips": response.tips,
        "axes": {
            beam: {"arc_length": arc, "position": axes.position[beam]}
            for beam, arc in axes.arc_length.items()
        },
        "events": None if response.events is None else [asdict(event) for event in response.events],
        **({} if response.work is None else {"work": response.work}),
        "index": response.index,
        "critical": [
            {"kind": point.kind, "load_parameter": point.load_parameter, "mode": point.mode}
            for point in response.critical
        ],
        "certificate": None if response.certificate is None else response.certificate.as_dict(),
        "newton_iterations": response.newton_iterations,
        "cutbacks": response.cutbacks,
        "unknowns": response.unknowns,
        "wall_seconds": response.wall_seconds,
    }


def _holds(holds: dict[str, SupportHistory]) -> dict[str, Any]:
    return {node: {"moment": hold.moment, "force": hold.force} for node, hold in holds.items()}


def summary(response: Response, units: str, more: Sequence[tuple[str, str]] = ()) -> str:
    """Return a few lines for a reader: the status, the last state reached, and the lines `more`."""
    force, length = (unit.strip() for unit in units.split(","))
    rows = [("status", f"{response.status}: {response.message}")]
    if len(response.load_parameter):
        stage = f", stage {response.stage[-1]}" if response.stage[-1] > 1 else ""
        rows.append(("load parameter", f"{response.load_parameter[-1]:.6g}{stage}"))
        for pair, contact in response.contacts.items():
            rows.append((f"{pair} force", f"{contact.force[-1]:.9g} {force}"))
            if np.isfinite(contact.arc_position[-1]):
                rows.append((f"{pair} arc position", f"{contact.arc_position[-1]:.9g} {length}"))
            if contact.friction is not None:
                rows += _friction_rows(pair, contact, contact.friction, (force, length))
        for what, holds in (("support", response.supports), ("spring", response.springs)):
            for node, hold in holds.items():
                x, y = hold.force[-1]
                rows.append((f"{node} {what} force", f"({x:.9g}, {y:.9g}) {force}"))
                rows.append((f"{node} {what} moment", f"{hold.moment[-1]:.9g} {force} {length}"))
        rows += [
            (f"{beam} tip", f"({tip[-1, 0]:.9g}, {tip[-1, 1]:.9g}) {length}")
            for beam, tip in response.tips.items()
        ]
    rows += _event_rows(response.events or (), force, length)
    rows += [
        ("stability", stability(response)),
        *([("certificate", response.certificate.line())] if response.certificate else []),
        ("unknowns", f"{response.unknowns}"),
        ("Newton iterations", f"{response.iterations}, cut-backs {response.cutbacks}"),
        ("seconds", f"{response.wall_seconds:.3f}"),
        *more,
    ]
    width = max(len(label) for label, _ in rows)
    return "\n".join(
        [f"{response.scene}, model {response.model}", *(f"  {a:<{width}}  {b}" for a, b in rows)]
    )


def _friction_rows(
    pair: str, contact: ContactHistory, friction: FrictionHistory, units: tuple[str, str]
) -> list[tuple[str, str]]:
    """Return the last state of a contact with friction."""
    force, length = units
    state = friction.states(contact.force)[-1]
    return [
        (f"{pair} friction", f"{friction.tangential[-1]:.9g} {force} along the beam, {state}"),
        (f"{pair} dissipated", f"{friction.dissipated[-1]:.9g} {force} {length}"),
    ]


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
        what = "not judged where a contact slips," if rubbed else "index not defined"
        parts.append(f"{what} at {int(unknown.sum())} of {len(unknown)} load parameters")
    return "; ".join(parts)


def _event_rows(events: Sequence[ContactEvent], force: str, length: str) -> list[tuple[str, str]]:
    """Count the events, and list those that change which contacts are closed."""
    counts = Counter(event.kind for event in events)
    rows = [("events", ", ".join(f"{kind} {count}" for kind, count in counts.items()))] if counts else []
    for event in events:
        stage = f" in stage {event.stage}" if event.stage > 1 else ""
        if event.kind in CRITICAL:
            jump = f", {event.released:.6g} {force} {length} released" if event.released else ""
            rows.append((f"  {event.kind}", f"at {event.load_parameter:.9g}{stage}{jump}"))
        elif event.kind != "pass-through":
            place = f"arc position {event.arc_position:.6g} {length}"
            text = f"{event.pair} at {event.load_parameter:.6g}{stage}: {place}"
            jump = f", {event.released:.6g} {force} {length} released" if event.released else ""
            rows.append((f"  {event.kind}", f"{text}, {event.force:.6g} {force}{jump}"))
    return rows

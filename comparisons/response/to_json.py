"""A response as JSON."""

from dataclasses import asdict
from typing import Any

from comparisons.output import json_text
from comparisons.response import (
    Response,
    SupportHistory,
)
from comparisons.response.axis import sampled_axes
from comparisons.version import versions


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

"""What all adapters share: they read the resolved scene, state the reason of a refusal, and write the response."""

import json
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from time import perf_counter
from typing import Any

Table = dict[str, Any]
Points = Sequence[Sequence[float]]


class RefusedError(Exception):
    """The program cannot state the scene; the message is the reason."""


class StoppedError(Exception):
    """The program stopped before the last load parameter; the message is the reason."""


class Histories:
    """The histories of an answer to a resolved scene, one state after the other."""

    def __init__(self, scene: Table) -> None:
        self.axes: Table = {beam["name"]: {"arc_length": [], "position": []} for beam in scene["beams"]}
        contact, support = ("force", "vector", "arc_position", "gap"), ("force", "moment")
        self.contacts: Table = {item["pair"]: {key: [] for key in contact} for item in scene["contacts"]}
        self.supports: Table = {item["node"]: {key: [] for key in support} for item in scene["supports"]}
        self.load_parameter: list[float] = []

    def axis(self, beam: str, arcs: Sequence[float], points: Points) -> None:
        """Add the deformed axis of a beam: arc lengths (m,) and positions (m, 2)."""
        self.axes[beam]["arc_length"] = list(arcs)
        self.axes[beam]["position"].append([[float(x), float(y)] for x, y in points])

    def support(self, node: str, force: Sequence[float], moment: float = 0.0) -> None:
        """Add force and moment of a support on its beam."""
        self.supports[node]["force"].append([float(force[0]), float(force[1])])
        self.supports[node]["moment"].append(float(moment))

    def open(self, pair: str) -> None:
        """Add an open contact."""
        self.contact(pair, (0.0, 0.0), None, None)

    def contact(self, pair: str, vector: Sequence[float], arc: float | None, gap: float | None) -> None:
        """Add a contact: its force on the beam, arc position and gap; both None where the pair is open."""
        x, y = float(vector[0]), float(vector[1])
        for key, value in zip(self.contacts[pair], ((x * x + y * y) ** 0.5, [x, y], arc, gap), strict=True):
            self.contacts[pair][key].append(value)


Refusal = Callable[[Table], str | None]
States = Callable[[Table, Histories], Iterator[float]]


def serve(refusal: Refusal, states: States) -> None:
    """Answer the scene on standard input.

    ``refusal(scene)`` says why the program cannot state the scene, None if it can. ``states(scene, histories)`` adds the states to
    `histories` and yields the load parameter of each; it raises `StoppedError` where the program stops.
    """
    with os.fdopen(os.dup(1), "w", encoding="utf-8") as answer:
        sys.stdout.flush()
        os.dup2(2, 1)  # what the program prints goes to standard error
        scene = json.load(sys.stdin) | ({"steps": int(sys.argv[1])} if sys.argv[1:] else {})
        json.dump(answered(scene, refusal, states), answer)


def answered(scene: Table, refusal: Refusal | None, states: States) -> Table:
    """Return the tables of the response to a scene, see `serve`."""
    if (reason := refusal and refusal(scene)) is not None:
        return {"status": "REFUSED", "message": reason}
    histories, began = Histories(scene), perf_counter()
    status, message = "COMPLETED", "the program reports success"
    try:
        for load_parameter in states(scene, histories) if scene["load_parameters"] else ():
            histories.load_parameter.append(load_parameter)
    except RefusedError as error:
        return {"status": "REFUSED", "message": str(error)}
    except StoppedError as error:
        status, message = "STOPPED", str(error)
    seconds = perf_counter() - began
    return {"status": status, "message": message, "wall_seconds": seconds, **vars(histories)}


def named(scene: Table, kind: str, name: str) -> Table:
    """Return the record of a kind, as ``beams``, by its name."""
    found: Table = next(item for item in scene[kind] if item["name"] == name)
    return found


def rough(scene: Table) -> str | None:
    """Return why a program whose contacts are frictionless cannot state a scene; None if the scene has no friction."""
    pairs = [item["pair"] for item in scene["contacts"] if item["friction"]]
    return f"the adapter has frictionless contacts, the scene has friction at {pairs[0]}" if pairs else None


def points_along(beam: Table, count: int) -> tuple[list[float], list[tuple[float, float]]]:
    """Return arc lengths and undeformed positions of `count` equal parts of a beam's axis, ends included."""
    (x, y), (c, s), length = beam["start"], beam["direction"], beam["length"]
    arcs = [length * k / count for k in range(count + 1)]
    return arcs, [(x + c * arc, y + s * arc) for arc in arcs]


def refined(scene: Table, steps: int) -> list[list[float]]:
    """Return equal load steps to each load parameter, at least `steps` in all; an argument of the program replaces that number."""
    times = [0.0, *scene["load_parameters"]]
    inner = max(1, -(-scene.get("steps", steps) // (len(times) - 1)))
    return [
        [before + (t - before) * k / inner for k in range(1, inner)] + [t] for before, t in pairwise(times)
    ]

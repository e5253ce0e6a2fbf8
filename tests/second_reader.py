"""A second reader of scene files, which imports nothing of the packages: the numbers that all models take from a scene, by name.

All models and the referee read a scene by `comparisons.scene`; a file that it misreads is solved wrongly by all of them and certified.
This reader is written from the documentation of the scene file alone. It judges no rule: the file is right.
"""

import cmath
import math
import tomllib
from itertools import accumulate, pairwise
from typing import Any

Table = dict[str, Any]
Numbers = dict[str, tuple[float, ...]]
PLACES = (0.0, 0.3, 0.5, 1.0)
"""Fractions of a beam's length at which what varies along it is stated."""
HELD = {"clamped": "xyr", "pinned": "xy", "roller x": "y", "roller y": "x"}


def read(text: str) -> Numbers:
    """Return the numbers of a scene; every name is ``record quantity``, a value that varies is a tuple over places or load parameters."""
    file = tomllib.loads(text)
    beams = {beam["name"]: beam for beam in file["beam"]}
    stages: list[Table] = [{**file, **file["scene"]}, *file.get("stage", [])]
    counts = [stage["load_parameters"] for stage in stages]
    times = [k + step / count for k, count in enumerate(counts) for step in range(1, count + 1)]
    found: Numbers = {"load parameters": tuple(times)}
    for name, beam in beams.items():
        found |= {f"{name} {what}": value for what, value in _beam(beam).items()}
    gravity = [stage.get("gravity") or (0.0, 0.0) for stage in stages]
    found["gravity"] = _histories(gravity, times)
    found |= _supports(file, stages, beams, times) | _loads(stages, times)
    radii = {pin["name"]: pin.get("radius", 0.0) for pin in file.get("pin", [])}
    for pin in file.get("pin", []):
        found[f"{pin['name']} positions"] = _positions(pin, stages, times)
        found[f"{pin['name']} radius"] = (radii[pin["name"]],)
    for contact in file.get("contact", []):
        pair, radius = f"{contact['node']}->{contact['beam']}", radii.get(contact["node"], 0.0)
        heights = _along(beams[contact["beam"]].get("height", 0.0))
        half = 0.5 if contact.get("surface") == "face" else 0.0
        found[f"{pair} offset"] = tuple(radius + half * height for height in heights)
        found[f"{pair} friction"] = (contact.get("friction", 0.0),)
        found[f"{pair} side"] = (1.0 if contact["side"] == "left" else -1.0,)
    for hinge in file.get("hinge", []):
        found[f"{hinge['beam']}.{hinge['end']} hinge"] = (hinge.get("stiffness", 0.0),)
    for spring in file.get("spring", []):
        stiffness = (*spring.get("stiffness", (0.0, 0.0)), spring.get("rotation", 0.0))
        found[f"{spring['beam']}.{spring['end']} spring"] = stiffness
    return found


def _along(value: Any) -> list[float]:
    """Values at `PLACES` of a number, or of two that stand for the start and the end."""
    first, last = value if isinstance(value, list) else (value, value)
    return [first * (1.0 - part) + last * part for part in PLACES]


def _beam(beam: Table) -> Numbers:
    """Axis, stiffnesses and mass of a beam; an arc is a curve of unit speed whose direction turns evenly, in the complex plane."""
    start, end, turn = complex(*beam["start"]), complex(*beam["end"]), beam.get("turn", 0.0)
    chord = end - start
    length = abs(chord) if turn == 0.0 else abs(chord) * turn / (2.0 * math.sin(turn / 2.0))
    first = chord / abs(chord) * cmath.exp(-0.5j * turn)
    centre = 0.0 if turn == 0.0 else start + 1j * first * length / turn
    tangents = [first * cmath.exp(1j * turn * part) for part in PLACES]
    if turn == 0.0:
        axis = [start + part * chord for part in PLACES]
    else:
        axis = [centre - 1j * tangent * length / turn for tangent in tangents]
    E = beam["youngs_modulus"]
    G = beam["shear_modulus"] if "shear_modulus" in beam else E / (2.0 + 2.0 * beam["poissons_ratio"])
    heights = _along(beam.get("height", 0.0))
    if "width" in beam:
        widths = _along(beam["width"])
        A = [b * h for b, h in zip(widths, heights, strict=True)]
        inertia = [b * h * h * h / 12.0 for b, h in zip(widths, heights, strict=True)]
        sheared = [beam.get("shear_area", area / 1.2) for area in A]
    else:
        A, inertia = _along(beam["area"]), _along(beam["second_moment"])
        sheared = [beam.get("shear_area", area) for area in A]
    density = beam.get("density", 0.0)
    # Gauss's rule of three points integrates the area exactly
    rule = ((0.5 - math.sqrt(0.15), 5 / 18), (0.5, 8 / 18), (0.5 + math.sqrt(0.15), 5 / 18))
    mass = density * length * sum(weight * _area(beam, part) for part, weight in rule)
    return {
        "length": (length,),
        "axis": tuple(value for point in axis for value in (point.real, point.imag)),
        "tangents": tuple(value for tangent in tangents for value in (tangent.real, tangent.imag)),
        "EA": tuple(E * area for area in A),
        "GA": tuple(G * area for area in sheared),
        "EI": tuple(E * second for second in inertia),
        "mass": (mass,),
        "mass per length": tuple(density * area for area in A),
    }


def _area(beam: Table, part: float) -> float:
    """Area of the section at a fraction of the length."""
    if "area" in beam:
        return float(beam["area"])
    first, last = (_along(beam[key])[:: len(PLACES) - 1] for key in ("width", "height"))
    return (first[0] + part * (first[1] - first[0])) * (last[0] + part * (last[1] - last[0]))


def _histories(increments: list[Any], times: list[float]) -> tuple[float, ...]:
    """Values at all load parameters of quantities that start at zero and change by an increment, evenly, in every stage."""
    rows = []
    for t in times:
        parts = [min(max(t - k, 0.0), 1.0) for k in range(len(increments))]
        for column in zip(*increments, strict=True):
            rows += [math.fsum(part * inc for part, inc in zip(parts, column, strict=True))]
    return tuple(rows)


def _supports(file: Table, stages: list[Table], beams: dict[str, Table], times: list[float]) -> Numbers:
    """Motions x, y and rotation of the supported ends; NaN where free. A later motion may name any beam's end at the same place."""
    found, clamped = {}, [(name, end) for name, beam in beams.items() for end in beam.get("clamped", [])]
    own = [{"beam": name, "end": end, "kind": "clamped"} for name, end in clamped] + file.get("support", [])
    for support in own:
        kind = " ".join(support[key] for key in ("kind", "free") if key in support)
        held = HELD[kind] if kind else [component[0] for component in support["fixed"]]
        place = beams[support["beam"]][support["end"]]
        moves = [support]
        for stage in stages[1:]:
            here = [move for move in stage.get("support", []) if beams[move["beam"]][move["end"]] == place]
            moves.append(here[0] if here else {})
        increments = [(*move.get("displacement", (0.0, 0.0)), move.get("rotation", 0.0)) for move in moves]
        free = [component not in held for component in "xyr"]
        values = _histories(increments, times)
        motion = tuple(math.nan if free[k % 3] else value for k, value in enumerate(values))
        found[f"{support['beam']}.{support['end']} motion"] = motion
    return found


def _loads(stages: list[Table], times: list[float]) -> Numbers:
    """Force and moment, or force per length and zero, at every place that some stage loads."""
    amounts: dict[str, list[tuple[float, ...]]] = {}
    for k, stage in enumerate(stages):
        for load in stage.get("load", []):
            where = load["end"] if "end" in load else f"at {load.get('at')}"
            amount = (*load.get("force", (0.0, 0.0)), load.get("moment", 0.0))
            if "force_per_length" in load:
                where = "from {} to {}".format(*map(float, load.get("part", (0.0, 1.0))))
                amount = (*load["force_per_length"], 0.0)
            history = amounts.setdefault(f"{load['beam']} {where} load", [(0.0,) * 3] * len(stages))
            history[k] = amount
    return {name: _histories(history, times) for name, history in amounts.items()}


def _positions(pin: Table, stages: list[Table], times: list[float]) -> tuple[float, ...]:
    """Positions of a pin, which goes along the path of every stage at constant speed."""
    ways: list[list[complex]] = []
    for stage in stages:
        moves = [pin] if not ways else [move for move in stage.get("pin", []) if move["name"] == pin["name"]]
        here = ways[-1][-1] if ways else complex(*(pin["start"] if "start" in pin else pin["path"][0]))
        move = moves[0] if moves else {}
        onward = [complex(*point) for point in move.get("path", [])][0 if ways else 1 :]
        ways.append([here, *(onward or [here + complex(*move.get("displacement", (0.0, 0.0)))])])
    found = []
    for t in times:
        k = min(math.ceil(t) - 1, len(stages) - 1)
        reached = list(accumulate((abs(b - a) for a, b in pairwise(ways[k])), initial=0.0))
        ahead = (t - k) * reached[-1]
        leg = next(i for i in range(len(reached) - 1) if ahead <= reached[i + 1] or i == len(reached) - 2)
        size = reached[leg + 1] - reached[leg]
        a, b = ways[k][leg : leg + 2]
        place = a if size == 0.0 else a + (ahead - reached[leg]) / size * (b - a)
        found += [place.real, place.imag]
    return tuple(found)

"""A cantilever under end loads, or lifted by a frictionless pin, by shooting. Usage: python shooting.py > mine.json."""

import json
from math import atan2, cos, hypot, sin
from pathlib import Path

HERE = Path(__file__).parents[1]
MINE = ("ks-cantilever", "ks-face", "straightened-arc", "clamped-column")
FORCES, MOVED = ("force_x", "force_y"), ("displacement_x", "displacement_y")


def ahead(z, h, rate):
    return [p + h * q for p, q in zip(z, rate)]


def rates(beam, z):
    c, d, (m, nx, ny) = cos(z[2]), sin(z[2]), z[3:]
    along, across = 1 + (nx * c + ny * d) / beam["EA"], (ny * c - nx * d) / beam["GA"]
    dx, dy = along * c - across * d, along * d + across * c
    return dx, dy, beam["curvature"] + m / beam["EI"], dy * nx - dx * ny, 0, 0


def runge_kutta(beam, z, length, n=100):
    for h in [length / n] * n:
        a = rates(beam, z)
        b = rates(beam, ahead(z, h / 2, a))
        c = rates(beam, ahead(z, h / 2, b))
        d = rates(beam, ahead(z, h, c))
        z = ahead(z, h / 6, [p + 2 * q + 2 * r + s for p, q, r, s in zip(a, b, c, d)])
    return z


def newton(f, z, sizes):
    for _ in range(5):
        r, columns = f(z), []
        for k, h in enumerate(1e-7 * size for size in sizes):
            columns.append([(v - w) / h for v, w in zip(f([*z[:k], z[k] + h, *z[k + 1 :]]), r)])
        A = [[*row, -v] for *row, v in zip(*columns, r)]
        for k in range(len(A)):
            A[k:] = sorted(A[k:], key=lambda row: -abs(row[k]))
            A = [row if i == k else ahead(row, -row[k] / A[k][k], A[k]) for i, row in enumerate(A)]
        z = [v + row[-1] / row[k] for k, (v, row) in enumerate(zip(z, A))]
    return z


def shot(scene, beam, t, q):
    """What must vanish for force and moment at the clamp, and force and place of the pin; and the tip."""
    z, s, off = [*beam["start"], atan2(*beam["direction"][::-1]), q[2], *q[:2]], 0, []
    x, y, moment = next(([*one["force"], one["moment"]] for one in scene["loads"]), (0, 0, 0))
    for pin, contact in zip(scene["pins"], scene["contacts"]):
        ((_, *p), (_, *r)), F, s, before = pin["path"], q[3:5], q[5], runge_kutta(beam, z, q[5])
        z, far = ahead(before, -1, [0, 0, 0, 0, *F]), contact["distance"] and contact["distance"] / hypot(*F)
        off = ahead(ahead(before[:2], -far, F), -1, ahead(p, t, ahead(r, -1, p)))
        off.append(sum(f * (v + w) for f, v, w in zip(F, rates(beam, before), rates(beam, z))))
    z = runge_kutta(beam, z, beam["length"] - s)
    return [z[4] - t * x, z[5] - t * y, z[3] - t * moment, *off], z


def answered(scene):
    """Answers by end or contact, what, and place of the load parameter."""
    beam, times = scene["beams"][0], scene["load_parameters"]
    unit, start, end = beam["EI"] / beam["length"] ** 2, f"{beam['name']}.start", f"{beam['name']}.end"
    sizes = [unit, unit, unit * beam["length"], unit, unit, beam["length"]]
    q = [0.0, 0.0, 0.0, *(v for pin in scene["pins"] for v in (0.0, 1e-3 * unit, pin["path"][0][1]))]
    for k, (begin, goal) in enumerate(zip([0.0, *times], times)):
        for t in (begin + (goal - begin) * step / 20 for step in range(1, 21)):
            q = newton(lambda z, t=t: shot(scene, beam, t, z)[0], q, sizes[: len(q)])
        z = shot(scene, beam, goal, q)[1]
        yield from (((start, what, k), -v) for what, v in zip((*FORCES, "moment"), q))
        yield from (((end, what, k), v - at) for what, v, at in zip(MOVED, z, beam["end"]))
        for one in scene["contacts"]:
            yield from (((one["pair"], what, k), v) for what, v in zip((*FORCES, "arc_position"), q[3:]))


asked, scenes = (json.loads((HERE / f"{name}.json").read_text()) for name in ("queries", "scenes"))
found = {one["name"]: dict(answered(one)) for one in scenes["scenes"] if one["name"] in MINE}
refused = {one["name"]: "not tried" for one in scenes["scenes"] if one["name"] not in MINE}
rows = [one for one in asked["queries"] if one["scene"] in MINE]
rows = [{**one, "value": found[one["scene"]][one["of"], one["what"], one["at"]]} for one in rows]
print(json.dumps({"set": asked["set"], "program": "shooting", "refused": refused, "answers": rows}, indent=1))

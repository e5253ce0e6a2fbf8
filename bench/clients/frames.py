"""Frames and columns without contact by OpenSees. Usage, with openseespy: python frames.py > mine.json."""

import json
from itertools import pairwise
from pathlib import Path

import openseespy.opensees as ops

HERE = Path(__file__).parents[1]
MINE = ("heavy-strip", "clamped-column", "pinned-column", "portal-frame")
ELEMENTS, STEPS = 80, 10


def built(scene):
    """State nodes, elements, supports and loads; return the nodes of the ends and of the beams."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.geomTransf("Corotational", 1)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    places, ends, beams = {}, {}, {}
    for number, beam in enumerate(scene["beams"], 1):
        (x, y), (v, w), EA, parts = beam["start"], beam["end"], beam["EA"], range(ELEMENTS + 1)
        points = [(x + (v - x) * k / ELEMENTS, y + (w - y) * k / ELEMENTS) for k in parts]
        nodes = beams[beam["name"]] = [places.setdefault(p, len(places) + 1) for p in points]
        for node, point in zip(nodes, points):
            if node not in ops.getNodeTags():
                ops.node(node, *point)
        ends.update({f"{beam['name']}.start": nodes[0], f"{beam['name']}.end": nodes[-1]})
        ops.section("Elastic", number, 1.0, EA, beam["EI"], 1.0, beam["GA"] / EA)
        ops.beamIntegration("Lobatto", number, number, 3)
        for pair in pairwise(nodes):
            ops.element("forceBeamColumn", len(ops.getEleTags()) + 1, *pair, 1, number)
    for one in scene["supports"]:
        for component, value in enumerate((one["x"], one["y"], one["rotation"]), 1):
            if value is not None:
                ops.sp(ends[one["end"]], component, value)
    for one in scene["loads"]:
        if "end" in one:
            ops.load(ends[one["end"]], *one["force"], one["moment"])
        else:
            nodes, length = beams[one["beam"]], scene["beams"][0]["length"]
            for node in nodes:
                share = length / ELEMENTS / (2 if node in (nodes[0], nodes[-1]) else 1)
                ops.load(node, *(share * q for q in one["force_per_length"]), 0.0)
    return ends


def answered(scene):
    """Answers by end, what, and place of the load parameter."""
    ends = built(scene)
    ops.constraints("Transformation")
    ops.system("BandGeneral")
    ops.test("NormDispIncr", 1e-10 * scene["beams"][0]["length"], 50)
    ops.algorithm("Newton")
    for k, t in enumerate(scene["load_parameters"]):
        ops.integrator("LoadControl", (t - ops.getTime()) / STEPS)
        ops.analysis("Static", "-noWarnings")
        if ops.analyze(STEPS):
            return
        ops.reactions()
        for end, node in ends.items():
            found = dict(zip(("displacement_x", "displacement_y"), ops.nodeDisp(node)))
            found.update(zip(("force_x", "force_y", "moment"), ops.nodeReaction(node)))
            yield from (((end, what, k), value) for what, value in found.items())


asked, scenes = (json.loads((HERE / f"{name}.json").read_text()) for name in ("queries", "scenes"))
found = {one["name"]: dict(answered(one)) for one in scenes["scenes"] if one["name"] in MINE}
refused = {one["name"]: "not tried" for one in scenes["scenes"] if one["name"] not in MINE}
rows = [one for one in asked["queries"] if one["scene"] in MINE]
for row in rows:
    value = found[row["scene"]].get((row["of"], row["what"], row["at"]))
    row.update({"refused": "Newton's method stops"} if value is None else {"value": value})
print(
    json.dumps(
        {"set": asked["set"], "program": "OpenSees, 80 elements a beam", "refused": refused, "answers": rows}
    )
)

"""``crossval certify``: what an answer is worth, by the exact equilibrium next to it."""

import sys
from argparse import Namespace
from pathlib import Path

from comparisons.answer import Response
from comparisons.answer.file import read_response
from comparisons.cli.command import DONE, STOPPED, WRONG, report
from comparisons.cli.options import STANDARD, outputs, write
from comparisons.cli.screen import watching
from comparisons.files import OutputError
from comparisons.models import TSM, certified, restored, solve
from comparisons.models.model import ModelError
from comparisons.output import json_text
from comparisons.referee import Judgement, Verdict, certify
from comparisons.scene import load_scene


def run(given: Namespace) -> int:
    """Read or solve, judge, and print the certificate."""
    stored = given.answer.endswith(".json")
    if stored and Path(given.answer).resolve() in (Path(name).resolve() for name in given.out):
        raise OutputError(f"{given.answer}: is the answer to be judged, choose another name")
    files = outputs(given.out, ".json")
    if stored:
        response, scene = read_response(given.answer, given.scene)
        response = restored(response, scene)
    elif given.scene is not None:
        raise ModelError("--scene: belongs to a response in JSON")
    else:
        scene = load_scene(given.answer)
        with watching(TSM.name) as watch:
            response = solve(scene, TSM.name, watch=watch)
    status = response.status
    response = certified(response, scene, "all", allowance=given.allowance)
    found = response.certificate or certify(response, scene)
    for _, path in files:
        write(path, json_text({"scene": scene.name, "model": response.model, **found.as_dict()}))
    if (".json", STANDARD) not in files:
        body = ", a two-dimensional body" if response.outside and response.continuum else ""
        report(f"{scene.name}, model {response.named}{body}, {status}", sys.stdout)
        unjudged = f"not judged: {', '.join(_unjudged(response))}"
        for line in (found.line(), *map(_row, found.judged), *found.path, unjudged):
            report(f"  {line}", sys.stdout, indent=4)
    if found.verdict is Verdict.NOT_JUDGED:
        return STOPPED
    return DONE if found.certified else WRONG


def _unjudged(response: Response) -> list[str]:
    """Return what an answer states, or leaves out, and no certificate judges."""
    rubbed = any(contact.friction is not None for contact in response.contacts.values())
    missing = {
        "section forces": response.sections is None,
        "events": response.events is None,
        "stability": response.index is None or rubbed,
        "critical points": bool(response.critical),
        "energy released in jumps": any(event.released for event in response.events or ()),
    }
    return [name for name, no in missing.items() if no] + ["times", "numbers of iterations and unknowns"]


def _row(item: Judgement) -> str:
    """Return what was found at a load parameter."""
    text = f"at {item.load_parameter:.6g}: "
    if item.distance is None:
        return f"{text}{item.verdict.name}, {item.reason}"
    text += f"{item.verdict.name}, " * (item.verdict.name != "CERTIFIED")
    apart = {name: size for name, size in item.distance.sizes.items() if name in item.distance.where}
    sizes = ", ".join(f"{name.replace('_', ' ')} {size:.2g}" for name, size in apart.items())
    stable = "stability not judged (friction)" if item.index < 0 else f"index {item.index}"
    return f"{text}off by: {sizes}; {stable}, residual {item.residual:.1g}"

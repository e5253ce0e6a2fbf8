"""``crossval certify``: what an answer is worth, by the exact equilibrium next to it."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.cli import values
from comparisons.cli.options import ModelNames, add_options, chosen
from comparisons.cli.outcome import DONE, STOPPED, WRONG
from comparisons.files import OutputError, result_file, write_text
from comparisons.models import TSM
from comparisons.models.options import ModelError
from comparisons.scene import load_scene

if TYPE_CHECKING:
    import argparse

    from comparisons.cli.outcome import Commands
    from comparisons.referee import Certificate, Judgement
    from comparisons.response import Response

EPILOG = """exit status: 0 certified, 1 a wrong answer (UNSTABLE, INADMISSIBLE, NOT_AN_EQUILIBRIUM), 2 bad input, 3 not judged"""


def add_to(commands: "Commands") -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "certify",
        help="judge an answer by the exact equilibrium next to it",
        description="The exact equilibrium of the scene's rods next to an answer is found by another discretisation than any "
        "model's; the answer is certified where it is near, stable and admissible.",
        epilog=EPILOG,
    )
    parser.add_argument(
        "answer", metavar="RESPONSE.json|SCENE", help="what solve --json wrote, or a scene to solve and judge"
    )
    parser.add_argument("--scene", metavar="SCENE", help="of a response, where it is not a built-in one")
    parser.add_argument("--model", choices=ModelNames(), help="of a scene: the model that answers (tsm)")
    add_options(parser, "elements", "element", "mesh")
    parser.add_argument(
        "--few",
        action="store_true",
        help="judge the load parameters that solve judges, not all: the last of every stage, those beside events, the largest force",
    )
    parser.add_argument(
        "--allowance",
        type=values.part,
        metavar="X",
        help="largest relative distance from the exact equilibrium (.05)",
    )
    parser.add_argument("--json", metavar="FILE", help="write the certificate as JSON; - is standard output")
    parser.set_defaults(run=run)


def run(given: "argparse.Namespace") -> int:
    """Read or solve, judge, and print the certificate."""
    file = None if given.json in (None, "-") else result_file(Path(given.json))
    from comparisons.models import certified, restored
    from comparisons.output import json_text
    from comparisons.referee import Verdict, certify
    from comparisons.response.file import read_response

    stored = given.answer.endswith(".json")
    if stored and file == Path(given.answer).resolve():
        raise OutputError(f"--json {given.json}: is the answer to be judged, choose another name")
    if stored:
        for option in ("model", "elements", "element", "mesh"):
            if getattr(given, option) is not None:
                raise ModelError(f"--{option}: belongs to a scene, {given.answer} is a response")
        response, scene = read_response(given.answer, given.scene)
        response = restored(response, scene)
    else:
        if given.scene is not None:
            raise ModelError("--scene: belongs to a response in JSON")
        from comparisons.models import solve

        scene = load_scene(given.answer)
        response = solve(scene, given.model or TSM.name, chosen(given))
    status = response.status
    response = certified(response, scene, "last" if given.few else "all", allowance=given.allowance)
    found = response.certificate or certify(response, scene)
    text = json_text({"scene": scene.name, "model": response.model, **found.as_dict()})
    if given.json == "-":
        sys.stdout.write(text)
    else:
        if file is not None:
            write_text(file, text)
        print(f"{scene.name}, model {response.model}, {status}")
        for line in lines(found):
            print(f"  {line}")
        print(f"  not judged: {', '.join(unjudged(response))}")
    if found.verdict is Verdict.NOT_JUDGED:
        return STOPPED
    return DONE if found.certified else WRONG


def unjudged(response: "Response") -> list[str]:
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


def lines(found: "Certificate") -> list[str]:
    """Return a certificate as a verdict, a line for each load parameter that was judged, and what is wrong between them."""
    rows = [found.line()]
    rows += [_row(item) for item in found.judged]
    rows += list(found.path)
    return rows


def _row(item: "Judgement") -> str:
    text = f"at {item.load_parameter:.6g}: "
    if item.distance is None:
        return f"{text}{item.verdict.name}, {item.reason}"
    text += f"{item.verdict.name}, " * (item.verdict.name != "CERTIFIED")
    apart = {name: size for name, size in item.distance.sizes.items() if name in item.distance.where}
    sizes = ", ".join(f"{name.replace('_', ' ')} {size:.2g}" for name, size in apart.items())
    stable = "stability not judged (friction)" if item.index < 0 else f"index {item.index}"
    return f"{text}off by: {sizes}; {stable}, residual {item.residual:.1g}"

"""Score answers to the set: python score.py [options] MINE.json [MORE.json ...]

  --digits D         what has fewer digits is wrong (4)
  --every            print every query, not only what is wrong
  --junit FILE.xml   write every query as a test case
  --results FILE.md  write a table of all files, scene by scene

Exit status: 0 all that is answered is right, 1 something is wrong or missing, 2 a file cannot be scored.
Needs Python >= 3.9 and answers.json beside this file, nothing else.
"""

import json
import math
import sys
from argparse import ArgumentParser
from pathlib import Path
from statistics import median
from xml.sax.saxutils import quoteattr

RIGHT, REFUSED = "right", "refused"
UNITS = {**{10.0**k: f"10^{k}" for k in range(-12, 13) if k}, 180.0 / math.pi: "degrees for radians"}
KEYS = ("scene", "of", "what", "at", "number")


def key(row):
    """What a row asks or answers."""
    return tuple(row.get(name) for name in KEYS)


def words(query):
    """A query as text."""
    scene, of, what, at, number = query
    return f"{scene}: {of} {what} " + (f"at {at}" if number is None else f"number {number}")


def lie(query, value, true, scale, allowed, exact):
    """The name of what is wrong with a number that is too far from the true one."""
    scene, of, what, at, number = query

    def like(other):
        return abs(value - other) <= allowed * scale < abs(true - other)

    if value == 0.0:
        return "zero"
    if like(-true):
        return "wrong sign"
    if what[-2:] in ("_x", "_y"):
        other = exact.get((scene, of, what[:-1] + "yx"[what[-1] == "y"], at, number))
        if other and (like(other["value"]) or like(-other["value"])):
            return "x and y are swapped"
    for q, row in exact.items():
        if q[:3] == query[:3] and q != query and like(row["value"]):
            return f"the value of load parameter {q[3]}" if number is None else f"the value of event {q[4]}"
    if what == "arc_position" and like(scale - true):
        return "measured from the other end"
    for factor, name in UNITS.items():
        if true and abs(value / (factor * true) - 1.0) <= 1e-3:
            return f"wrong unit: {name}"
    return f"off by {abs(value - true) / scale:.1e}"


def judged(text, right, digits):
    """Program, and verdict, error and digits by query; a `ValueError` if the file cannot be scored."""
    given = json.loads(text)
    if not isinstance(given, dict) or not isinstance(given.get("answers"), list):
        raise ValueError("must be a table with a list of answers")
    if given.get("set") != right["set"]:
        raise ValueError(f"stale: it answers the set {given.get('set')!r}, this is {right['set']!r}")
    exact, rows, found = {key(row): row for row in right["answers"]}, {}, {}
    allowed, refused = 10.0**-digits, given.get("refused") or {}
    for row in given["answers"]:
        if not isinstance(row, dict) or key(row) not in exact:
            raise ValueError(f"not asked: {json.dumps(row)[:200]}")
        if key(row) in rows:
            raise ValueError(f"answered twice: {words(key(row))}")
        rows[key(row)] = row
    for query, true in exact.items():
        row, error, reached = rows.get(query), math.nan, math.nan
        value = None if row is None else row.get("value")
        if (row is None and query[0] in refused) or (row is not None and value is None and row.get(REFUSED)):
            verdict = REFUSED
        elif row is None:
            verdict = "missing"
        elif isinstance(value, bool) or not isinstance(value, (int, float)):
            verdict = f"not a number: {json.dumps(value)[:40]}"
        elif not math.isfinite(value):
            verdict = "not a finite number"
        else:
            error = abs(value - true["value"]) / true["scale"]
            reached = min(true["digits"], -math.log10(error)) if error else true["digits"]
            close = error <= max(allowed, 10.0 ** -true["digits"])
            verdict = RIGHT if close else lie(query, value, true["value"], true["scale"], allowed, exact)
            reached = max(reached, 0.0)
        found[query] = verdict, error, reached
    return str(given.get("program", "no name")), found


def scenes(found):
    """Verdicts of each scene."""
    parts = {}
    for query, one in found.items():
        parts.setdefault(query[0], []).append(one)
    return parts


def table(found):
    """A line for each scene, and one for all."""
    yield f"{'scene':24}{'queries':>8}{'right':>7}{'refused':>9}{'wrong':>7}{'median':>10}{'worst':>10}{'digits':>14}"
    for scene, rows in {**scenes(found), "all": list(found.values())}.items():
        right, refused = (sum(verdict == kind for verdict, *_ in rows) for kind in (RIGHT, REFUSED))
        errors = [error for _, error, _ in rows if not math.isnan(error)]
        ends = (
            f"{median(errors):10.1e}{max(errors):10.1e}{summary(rows):>14}"
            if errors
            else f"{'-':>10}{'-':>10}{'-':>14}"
        )
        yield f"{scene:24}{len(rows):8}{right:7}{refused:9}{len(rows) - right - refused:7}{ends}"


def summary(rows):
    """Digits of the median and the worst answer."""
    reached = [digits for *_, digits in rows if not math.isnan(digits)]
    return f"{median(reached):.1f} / {min(reached):.1f}" if reached else "-"


def junit(programs):
    """All verdicts as JUnit XML."""
    yield '<?xml version="1.0" encoding="UTF-8"?>\n<testsuites>'
    for program, found in programs:
        bad = sum(verdict not in (RIGHT, REFUSED) for verdict, *_ in found.values())
        out = sum(verdict == REFUSED for verdict, *_ in found.values())
        yield f'<testsuite name={quoteattr(program)} tests="{len(found)}" failures="{bad}" skipped="{out}">'
        for query, (verdict, *_) in found.items():
            name = (
                f"<testcase classname={quoteattr(query[0])} name={quoteattr(words(query).partition(': ')[2])}"
            )
            inside = "<skipped/>" if verdict == REFUSED else f"<failure message={quoteattr(verdict)}/>"
            yield f"{name}/>" if verdict == RIGHT else f"{name}>{inside}</testcase>"
        yield "</testsuite>"
    yield "</testsuites>"


def results(programs, right):
    """All programs as a Markdown table."""
    yield f"# Results of {right['benchmark']} {right['version']}\n"
    yield "Digits of the median / of the worst answer to a scene, over the largest force, moment or displacement, or the length; at most"
    yield "the certain ones. (n of m): so many queries are answered. -: refused. Made by `score.py --results`.\n"
    yield (
        "| scene | "
        + " | ".join(program for program, _ in programs)
        + " |\n"
        + "| --- " * (len(programs) + 1)
        + "|"
    )
    parts = [scenes(found) for _, found in programs]
    for scene in parts[0]:
        cells = []
        for part in parts:
            count = sum(not math.isnan(error) for _, error, _ in part[scene])
            cells.append(
                summary(part[scene])
                + (f" ({count} of {len(part[scene])})" if 0 < count < len(part[scene]) else "")
            )
        yield f"| {scene} | " + " | ".join(cells) + " |"


def main():
    """Score files; return the exit status."""
    parser = ArgumentParser(usage="\n".join(__doc__.splitlines()[:6]))
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--digits", type=float, default=4.0)
    parser.add_argument("--every", action="store_true")
    parser.add_argument("--junit", type=Path)
    parser.add_argument("--results", type=Path)
    given = parser.parse_args()
    right = json.loads(Path(__file__).with_name("answers.json").read_text(encoding="utf-8"))
    programs = []
    for file in given.files:
        try:
            programs.append(judged(file.read_text(encoding="utf-8"), right, given.digits))
        except (ValueError, OSError) as error:
            print(f"{file}: {error}", file=sys.stderr)
            return 2
        program, found = programs[-1]
        print(
            f"{program}: {right['benchmark']} {right['version']}, wrong below {given.digits:g} digits",
            *table(found),
            sep="\n",
        )
        for query, (verdict, error, digits) in found.items():
            if given.every or verdict not in (RIGHT, REFUSED):
                print(
                    f"{words(query):70} {verdict}" + (f"  {error:.1e}  {digits:.1f}" if given.every else "")
                )
    for path, text in ((given.junit, junit(programs)), (given.results, results(programs, right))):
        if path:
            path.write_text("\n".join(text) + "\n", encoding="utf-8")
    return int(
        any(verdict not in (RIGHT, REFUSED) for _, found in programs for verdict, *_ in found.values())
    )


if __name__ == "__main__":
    sys.exit(main())

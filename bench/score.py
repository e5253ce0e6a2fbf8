"""Score answers to the set. Usage: python score.py [options] MINE.json [MORE.json ...].

  --digits D         what has fewer digits is wrong (4)
  --every            print every query, not only what is wrong
  --junit FILE.xml   write every query as a test case
  --results FILE.md  write a table of all files, scene by scene

Exit status: 0 all that is answered is right, 1 something is wrong or missing, 2 a file cannot be scored.
Needs Python 3.9 or later and answers.json beside this file, nothing else.
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


def key(row):
    """What a row asks or answers."""
    return tuple(row.get(name) for name in ("scene", "of", "what", "at", "number"))


def words(query):
    """A query as text."""
    scene, of, what, at, number = query
    return f"{scene}: {of} {what} " + (f"at {at}" if number is None else f"number {number}")


def lie(query, value, true, allowed, exact):
    """The name of what is wrong with a number that is too far from the true one."""
    (scene, of, what, at, number), scale, true = query, true["scale"], true["value"]

    def like(other):
        return abs(value - other) <= min(allowed, 1e-3) * scale < abs(true - other) / 10.0

    turned = exact.get((scene, of, what[:-1] + {"x": "y", "y": "x"}.get(what[-1], ""), at, number))
    others = {q: row["value"] for q, row in exact.items() if q[:3] == query[:3] and q != query}
    elsewhere = next((q for q, other in others.items() if like(other)), None)
    unit = next((n for f, n in UNITS.items() if true and abs(value / (f * true) - 1.0) <= 1e-3), None)
    names = {
        "zero": value == 0.0,
        "wrong sign": like(-true),
        "x and y are swapped": turned and (like(turned["value"]) or like(-turned["value"])),
        f"the value of {words(elsewhere or query)}": elsewhere,
        "measured from the other end": what == "arc_position" and like(scale - true),
        f"wrong unit: {unit}": unit,
        f"off by {abs(value - true) / scale:.1e}": True,
    }
    return next(name for name, so in names.items() if so)


def judged(text, right, digits):
    """Program, and verdict, error and digits by query; a `ValueError` if the file cannot be scored."""
    given = json.loads(text)
    given = given if isinstance(given, dict) else {}
    if not isinstance(given.get("answers"), list):
        raise ValueError("must have a list of answers")  # noqa: TRY004 - a file of the user
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
        row, error, reached = rows.get(query, {}), math.nan, math.nan
        value = row.get("value")
        if value is None and (row.get(REFUSED) or (not row and query[0] in refused)):
            verdict = REFUSED
        elif not row:
            verdict = "missing"
        elif isinstance(value, bool) or not isinstance(value, (int, float)):
            verdict = f"not a number: {json.dumps(value)[:40]}"
        elif not abs(value) < 1e300:
            verdict = "not a finite number"
        else:
            error = abs(value - true["value"]) / true["scale"]
            reached = max(0.0, min(true["digits"], -math.log10(error or 1e-99)))
            close = error <= max(allowed, 10.0 ** -true["digits"])
            verdict = RIGHT if close else lie(query, value, true, allowed, exact)
        found[query] = verdict, error, reached
    return str(given.get("program", "no name")), found


def scenes(found):
    """Verdicts, errors and digits of each scene."""
    parts = {query[0]: [] for query in found}
    for query, one in found.items():
        parts[query[0]].append(one)
    return parts


def numbers(column):
    """What of a column is a number; nan for none."""
    return [one for one in column if not math.isnan(one)] or [math.nan]


def table(found):
    """A line for each scene, and one for all."""
    line = "{:24}{:>8}{:>7}{:>9}{:>7}{:>10}{:>10}{:>14}"
    yield line.format("scene", "queries", "right", "refused", "wrong", "median", "worst", "digits")
    for scene, rows in {**scenes(found), "all": list(found.values())}.items():
        verdicts, errors, reached = zip(*rows)
        right, refused, errors = verdicts.count(RIGHT), verdicts.count(REFUSED), numbers(errors)
        ends = f"{median(errors):.1e}", f"{max(errors):.1e}", summary(reached)
        counts = len(rows), right, refused, len(rows) - right - refused
        yield line.format(scene, *counts, *ends).replace("nan", "  -")


def summary(reached):
    """Digits of the median and the worst answer."""
    return f"{median(numbers(reached)):.1f} / {min(numbers(reached)):.1f}".replace("nan / nan", "-")


def junit(programs):
    """All verdicts as JUnit XML."""
    yield '<?xml version="1.0" encoding="UTF-8"?>\n<testsuites>'
    for program, found in programs:
        yield f'<testsuite name={quoteattr(program)} tests="{len(found)}">'
        for query, (verdict, *_) in found.items():
            inside = {RIGHT: "", REFUSED: "<skipped/>"}.get(
                verdict, f"<failure message={quoteattr(verdict)}/>"
            )
            name = words(query).partition(": ")[2]
            yield f"<testcase classname={quoteattr(query[0])} name={quoteattr(name)}>{inside}</testcase>"
        yield "</testsuite>"
    yield "</testsuites>"


def results(programs, right):
    """All programs as a Markdown table."""
    yield f"# Results of {right['benchmark']} {right['version']}\n"
    yield "Digits of the median and of the worst answer to a scene, over its largest force, moment or"
    yield "displacement, or the beam's length, and not more than are certain. [n] queries of the scene are"
    yield "not answered; - is a scene that is refused, or stopped. Made by `score.py --results`.\n"
    yield "| " + " | ".join(["scene", *(program for program, _ in programs)]) + " |"
    yield "| --- " * (len(programs) + 1) + "|"
    parts = [scenes(found) for _, found in programs]
    for scene in parts[0]:
        reached = [[digits for *_, digits in part[scene]] for part in parts]
        left = [sum(map(math.isnan, column)) for column in reached]
        cells = [
            summary(column) + (f" [{n}]" if 0 < n < len(column) else "") for column, n in zip(reached, left)
        ]
        yield "| " + " | ".join([scene, *cells]) + " |"


def main():
    """Score files; return the exit status."""
    parser = ArgumentParser(usage=__doc__)
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--digits", type=float, default=4.0)
    parser.add_argument("--every", action="store_true")
    parser.add_argument("--junit", type=Path)
    parser.add_argument("--results", type=Path)
    given, programs = parser.parse_args(), []
    right = json.loads(Path(__file__).with_name("answers.json").read_text(encoding="utf-8"))
    for file in given.files:
        try:
            programs.append(judged(file.read_text(encoding="utf-8"), right, given.digits))
        except (ValueError, OSError) as error:
            print(f"{file}: {error}", file=sys.stderr)
            return 2
        program, found = programs[-1]
        print(f"{program}: {right['benchmark']} {right['version']}, wrong below {given.digits:g} digits")
        print(*table(found), sep="\n")
        for query, (verdict, error, digits) in found.items():
            if given.every or verdict not in (RIGHT, REFUSED):
                print(f"{words(query):64} {error:8.1e} {digits:5.1f}  {verdict}")
    for path, text in ((given.junit, junit(programs)), (given.results, results(programs, right))):
        if path:
            path.write_text("\n".join(text) + "\n", encoding="utf-8")
    return int(any(one[0] not in (RIGHT, REFUSED) for _, found in programs for one in found.values()))


if __name__ == "__main__":
    sys.exit(main())

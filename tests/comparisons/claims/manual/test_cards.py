"""Benchmark cards: the standard library alone reads them, and the scene of each gives its values again."""

import json
import math
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from comparisons.claims.manual import Problem
from comparisons.claims.manual.cards import write_cards
from comparisons.claims.manual.columns import clamped_column
from comparisons.claims.manual.contacts import touch_again, two_pins
from comparisons.claims.manual.invariance import mirror
from comparisons.claims.manual.loads import roll_up
from comparisons.claims.manual.problems import PROBLEMS
from comparisons.cli import main
from comparisons.scene import read_scene

READER = """
import json, sys
for name in sys.argv[1:]:
    with open(name, encoding="utf-8") as file:
        card = json.load(file)
    lines = []
    for kind, tables in card["scene"].items():
        for table in tables if isinstance(tables, list) else [tables]:
            lines.append(f"[[{kind}]]" if isinstance(tables, list) else f"[{kind}]")
            lines += [f"{key} = {json.dumps(value)}" for key, value in table.items()]
    with open(name.removesuffix("json") + "toml", "w", encoding="utf-8") as file:
        file.write("\\n".join(lines))
    for quantity in card["quantities"]:
        assert quantity["uncertainty"] >= 0.0 and 0 < quantity["digits"] <= 15
        print(card["name"], repr(quantity["value"]), quantity["uncertainty"])
"""
"""Reads cards by the standard library alone, writes their scenes as TOML, and prints the values with their uncertainties."""
FAST = (roll_up, clamped_column, two_pins, touch_again, mirror)


def written(folder: Path, states: "tuple[Callable[[], Problem], ...]") -> list[Path]:
    """Write the cards of some problems; return them without the schema, which they keep."""
    *cards, schema = write_cards(folder, lambda _: None, states)
    validator = Draft202012Validator(json.loads(schema.read_text()))
    for path in cards:
        validator.validate(json.loads(path.read_text()))
    return cards


def found_again(state: Callable[[], Problem], folder: Path) -> None:
    """The scene of a card is the problem's, and the first model finds the card's values on it within its allowance."""
    (path,) = written(folder, (state,))
    reader = [sys.executable, "-I", "-S", "-c", READER, str(path)]
    done = subprocess.run(reader, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    rows = [line.split() for line in done.stdout.splitlines()]
    problem = state()
    assert {row[0] for row in rows} == {problem.name}
    scene = read_scene(path.with_suffix(".toml").read_text(), path.stem)
    assert scene == problem.scene
    trial = problem.trials[0]
    for row, quantity, value in zip(rows, problem.quantities, trial.measure(scene).values, strict=True):
        exact, uncertainty = float(row[1]), float(row[2])
        allowed = trial.allowance.error * (abs(exact) if quantity.scale is None else quantity.scale)
        assert uncertainty < allowed
        assert abs(value - exact) <= allowed


@pytest.mark.parametrize("state", FAST, ids=lambda state: str(state.__name__))
def test_the_scene_of_a_card_gives_its_values(state: Callable[[], Problem], tmp_path: Path) -> None:
    found_again(state, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("name", PROBLEMS)
def test_the_scene_of_every_card_gives_its_values(name: str, tmp_path: Path) -> None:
    found_again(PROBLEMS[name], tmp_path)


def test_digits_follow_from_the_uncertainty(tmp_path: Path) -> None:
    """Of a value they are significant ones, of zero decimals of the scale."""
    (path,) = written(tmp_path, (roll_up,))
    quarter, _, whole = json.loads(path.read_text())["quantities"]
    assert quarter["value"] == pytest.approx(2.0 / math.pi, rel=1e-15)
    assert quarter["uncertainty"] == pytest.approx(1e-14 * quarter["value"])
    assert (quarter["digits"], whole["digits"], whole["value"]) == (14, 14, 0.0)


@pytest.mark.parametrize(
    "change",
    [
        {"purpose": ""},
        {"scene": {"scene": {"name": "a", "load_parameters": 1}}},
        {"quantities": []},
        {"quantities": [{"name": "F", "value": "1", "digits": 3, "uncertainty": 0.1}]},
        {"remark": "one more"},
    ],
)
def test_the_schema_refuses_what_is_no_card(change: dict[str, object], tmp_path: Path) -> None:
    (path,) = written(tmp_path, (roll_up,))
    schema = Draft202012Validator(json.loads((tmp_path / "card.schema.json").read_text()))
    assert not schema.is_valid(json.loads(path.read_text()) | change)


def test_the_command_writes_cards_and_solves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["manual", "--cards", "cards", "--only", "locking", "roll-up"]) == 0
    reported = capsys.readouterr()
    assert reported.out == "2 cards and their schema in cards\n"
    assert reported.err == "roll-up: 3 quantities\nlocking: 2 quantities\n"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["cards"]
    assert sorted(path.name for path in Path("cards").iterdir()) == [
        ".crossval",
        "card.schema.json",
        "locking.json",
        "roll-up.json",
    ]
    Path("file").write_text("kept")
    assert main(["manual", "--cards", "file/below"]) == 2
    assert Path("file").read_text() == "kept"

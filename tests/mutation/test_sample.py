"""The modules and tests that ``pyproject.toml`` lists for mutmut are there: mutmut itself passes over a name that is not."""

import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[2]
CONFIGURATION = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]


def test_every_module_and_test_is_there() -> None:
    listed = CONFIGURATION["mutmut"]
    for pattern in listed["only_mutate"]:
        assert list(ROOT.glob(pattern)), pattern
    for path in listed["pytest_add_cli_args_test_selection"]:
        assert (ROOT / path).exists(), path


def test_mutants_are_put_where_branches_are_covered() -> None:
    covered = CONFIGURATION["coverage"]["report"]["include"]
    assert set(covered) <= set(CONFIGURATION["mutmut"]["only_mutate"])

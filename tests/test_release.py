"""What is said of the package in its files for others agrees: version, systems, Pythons, description."""

import ast
import re
import tomllib
from importlib import metadata
from pathlib import Path

import yaml
from markdown_it import MarkdownIt

from docs.extensions.description import description

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
SYSTEMS = {"ubuntu": "POSIX :: Linux", "macos": "MacOS", "windows": "Microsoft :: Windows"}


def classified(kind: str) -> set[str]:
    return {line.removeprefix(kind) for line in PROJECT["classifiers"] if line.startswith(kind)}


def pythons() -> list[str]:
    """Return the versions of Python that the package is for, the oldest first."""
    found = {item for item in classified("Programming Language :: Python :: ") if "." in item}
    return sorted(found, key=lambda version: int(version.partition(".")[2]))


def workflow(name: str) -> dict:
    return yaml.safe_load((ROOT / ".github" / "workflows" / name).read_text())


def test_the_version_is_one():
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text())["version"]
    released = re.search(r"^## (\d\S*)", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    assert released is not None
    assert cited == released[1] == PROJECT["version"] == metadata.version("tsm-crossval")


def test_every_system_and_the_oldest_and_newest_python_are_tried():
    oldest, *_, newest = pythons()
    assert PROJECT["requires-python"] == f">={oldest}"
    for job in ("wheel", "fast"):
        matrix = workflow("tests.yml")["jobs"][job]["strategy"]["matrix"]
        assert matrix["python"] == [oldest, newest]
        assert {SYSTEMS[system.partition("-")[0]] for system in matrix["os"]} == classified(
            "Operating System :: "
        )
    assert yaml.safe_load((ROOT / ".readthedocs.yaml").read_text())["build"]["tools"]["python"] in pythons()
    platforms = ast.parse((ROOT / "tests" / "platforms" / "noxfile.py").read_text())
    [compared] = [
        ast.literal_eval(node.value)
        for node in platforms.body
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "PYTHONS"
    ]
    assert compared == pythons()


def test_a_workflow_runs_what_there_is():
    runs = [
        step["run"]
        for name in ("tests.yml", "docs.yml")
        for job in workflow(name)["jobs"].values()
        for step in job["steps"]
        if "run" in step
    ]
    targets = set(re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    assert {line.split()[1] for line in runs if line.startswith("make ")} <= targets
    assert ".ci/run" in runs
    assert (ROOT / ".ci" / "run").is_file()


def test_the_description_is_whole_without_the_repository():
    readme = (ROOT / "README.md").read_text()
    text = description(readme)
    tokens = [
        part for token in MarkdownIt("commonmark").parse(text) for part in (token, *(token.children or ()))
    ]
    assert not [part for part in tokens if part.type in {"image", "html_inline", "html_block"}]
    links = [str(part.attrs["href"]) for part in tokens if part.type == "link_open"]
    assert [link for link in links if not link.startswith("https://")] == []
    headings = re.findall(r"^#+ .*", readme, re.MULTILINE)
    assert re.findall(r"^#+ .*", text, re.MULTILINE) == headings
    code = re.findall(r"```.*?```", readme, re.DOTALL)
    assert re.findall(r"```.*?```", text, re.DOTALL) == code

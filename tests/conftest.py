"""What every test can rely on."""

import os
import signal
from collections.abc import Callable, Generator
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from tests.stated import MEASURED, check, left, record

CI = os.environ.get("CI") == "true"
LEFT: list[str] = []
"""What a whole run says of the pages' numbers; it stands last, where a log is read first."""


def pytest_configure() -> None:
    """Let children be interrupted: a shell that starts the tests in the background has them ignore SIGINT, and children inherit that."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option that writes measured numbers."""
    parser.addoption("--write-results", action="store_true", help="write measured numbers into the pages")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave parameters to the slow tier, and begin the long tests first, so that none is left to one worker at the end.

    Only the tests of measured numbers are kept if these are to be written.
    """
    _leave_to_the_slow_tier(items, whole=config.args_source is pytest.Config.ArgsSource.TESTPATHS)
    items.sort(key=lambda item: item.get_closest_marker("long") is None)
    if config.getoption("write_results"):
        items[:] = [item for item in items if "stated" in getattr(item, "fixturenames", ())]


def _leave_to_the_slow_tier(items: list[pytest.Item], *, whole: bool) -> None:
    """Mark the parameters as slow that a test's marks ``slow_at`` name by their ids; of the whole suite, every id must be there."""
    left: dict[str, set[str]] = {}
    for item in items:
        named = {name for mark in item.iter_markers("slow_at") for name in mark.args}
        if isinstance(item, pytest.Function) and named:
            rest = left.setdefault(item.nodeid.partition("[")[0], set(named))
            rest.discard(item.callspec.id)
            if item.callspec.id in named:
                item.add_marker(pytest.mark.slow)
    unknown = {test: names for test, names in left.items() if names}
    if whole and unknown:
        raise pytest.UsageError(f"slow_at: no such parameters: {unknown}")


@pytest.fixture(scope="session")
def stated(request: pytest.FixtureRequest) -> Callable[..., None]:
    """``stated(name, *values)`` judges what a test measures against the pages, see `tests.stated.check`."""
    return partial(check, write=request.config.getoption("write_results"))


@pytest.fixture
def in_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder, which is the current one."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Let a test fail that is skipped where continuous integration runs: there everything that tests need is there."""
    report = yield
    if CI and report.skipped:
        report.outcome = "failed"
        report.longrepr = f"{item.nodeid} must not be skipped where CI=true: {report.longrepr}"
    return report


@pytest.hookimpl(trylast=True)
def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Print what tests have recorded to be listed, whether they pass or not."""
    for reports in terminalreporter.stats.values():
        for report in reports:
            for name, line in getattr(report, "user_properties", ()):
                if name == "listed" and report.when == "call":
                    terminalreporter.write_line(str(line))
    for line in LEFT:
        terminalreporter.write_line(line)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any) -> None:
    """Take what a worker has measured."""
    for name, (bound, values) in getattr(node, "workeroutput", {}).get("measured", {}).items():
        record(name, bound, values)


def pytest_sessionfinish(session: pytest.Session) -> None:
    """After a run of all tests judge the numbers of the pages that many tests measure, or none; where programs may be missing, the latter are listed."""
    config = session.config
    if hasattr(config, "workeroutput"):
        config.workeroutput["measured"] = MEASURED
    elif config.args_source is pytest.Config.ArgsSource.TESTPATHS and not (
        config.option.markexpr or config.option.keyword or config.option.collectonly or session.exitstatus
    ):
        LEFT.extend(left(write=config.getoption("write_results")))
        if any("measured it" not in line or CI for line in LEFT):
            session.exitstatus = pytest.ExitCode.TESTS_FAILED

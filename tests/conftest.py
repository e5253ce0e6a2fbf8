"""What every test can rely on."""

import signal
from collections.abc import Callable
from functools import partial

import pytest

from tests.stated import check


def pytest_configure() -> None:
    """Let children be interrupted: a shell that starts the tests in the background has them ignore SIGINT, and children inherit that."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option of `make results`."""
    parser.addoption("--write-results", action="store_true", help="write measured numbers into the pages")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Begin the long tests first, so that none is left to one worker at the end; keep those of measured numbers if these are to be written."""
    items.sort(key=lambda item: item.get_closest_marker("long") is None)
    if config.getoption("write_results"):
        items[:] = [item for item in items if "stated" in getattr(item, "fixturenames", ())]


@pytest.fixture(scope="session")
def stated(request: pytest.FixtureRequest) -> Callable[..., None]:
    """``stated(name, *values)`` judges what a test measures against the pages, see `tests.stated.check`."""
    return partial(check, write=request.config.getoption("write_results"))

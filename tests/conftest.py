"""What every test can rely on."""

import signal


def pytest_configure() -> None:
    """Let children be interrupted: a shell that starts the tests in the background has them ignore SIGINT, and children inherit that."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)

"""Settings of all tests."""

import signal

import pytest


@pytest.fixture(autouse=True, scope="session")
def _interrupts() -> None:
    """Lets Ctrl-C raise KeyboardInterrupt, as in a terminal: a shell starts background jobs with SIGINT ignored."""
    signal.signal(signal.SIGINT, signal.default_int_handler)

"""The page with a robot that is made up, and the browser that shows it."""

import pytest


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    """One server, whose robot the cases change."""
    from page_states import Served  # the programs of the console, optional

    return Served(tmp_path_factory.mktemp("runs"))


@pytest.fixture(scope="module")
def browser():
    """One browser; its first page is the console's with its token."""
    from bench.console.browser import Browser

    made = Browser(1300, 900)
    yield made
    made.end()

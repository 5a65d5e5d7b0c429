"""A run and its page, which tests of pages share."""

from __future__ import annotations

import pytest
from ran import transport

from mdlgen.report.html.page import page
from mdlgen.results.result import Result


@pytest.fixture(scope="module")
def result() -> Result:
    return transport()


@pytest.fixture(scope="module")
def text(result: Result) -> str:
    return page([result])

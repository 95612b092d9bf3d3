"""Servers and browsers that tests need for real. Where one is not here a test skips and says why; with
ULNA_REQUIRE=all in the environment, as in CI, that is a failure."""

from __future__ import annotations

import os
from typing import NoReturn

import pytest


def lacking(what: str) -> NoReturn:
    """Ends a test that needs it."""
    if os.environ.get("ULNA_REQUIRE") == "all":
        pytest.fail(f"{what} is not here, and ULNA_REQUIRE=all asks for it: tools/real_parts.sh installs it")
    pytest.skip(f"{what} is not here: tools/real_parts.sh installs it")

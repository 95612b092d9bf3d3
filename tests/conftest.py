"""What all tests share: where things are, real readings where they are at hand, and reproducible random search."""

import os
from pathlib import Path

import pytest
from hypothesis import settings

# Pictures are drawn without a screen; set before anybody imports matplotlib.
os.environ["MPLBACKEND"] = "Agg"

# The same examples in every run: a failure seen in CI is a failure at home.
settings.register_profile("house", derandomize=True, deadline=None)
settings.load_profile("house")

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="session")
def root() -> Path:
    """The repository's top folder."""
    return ROOT


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """The folder of real readings measured by others; the test skips where it is not at hand."""
    folder = ROOT.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip(f"real readings are not at hand: {folder} is not there")
    return folder

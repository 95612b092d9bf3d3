"""The examples run, print what the docs show of them, and their data are what their generator makes."""

import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.showing import same

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("[0-9][0-9]_*.py"))
SKIPPED = 77


def output_of(example: Path) -> str:
    """What an example prints; skips where it says that it must."""
    environment = os.environ | {"PYTHONWARNINGS": "error"}
    done = subprocess.run(
        [sys.executable, str(example)], capture_output=True, text=True, check=False, cwd=ROOT, env=environment
    )
    if done.returncode == SKIPPED:
        pytest.skip(done.stderr.strip())
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_example_prints_what_the_docs_show(example):
    shown = ROOT / "docs" / "examples" / "output" / f"{example.stem}.txt"
    printed = output_of(example)
    assert same(shown.read_text(encoding="utf-8"), printed) == [], "run `make docs-output` and look at the difference"


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_example_is_in_the_docs(example):
    page = (ROOT / "docs" / "examples" / f"{example.stem}.md").read_text(encoding="utf-8")
    assert f"examples/{example.name}" in page
    assert f"output/{example.stem}.txt" in page
    assert example.read_text(encoding="utf-8").startswith('"""')


def test_examples_are_numbered_without_gaps():
    assert [int(path.name[:2]) for path in EXAMPLES] == list(range(1, len(EXAMPLES) + 1))


def test_example_readings_are_what_the_generator_makes():
    path = ROOT / "examples" / "platinum" / "generate.py"
    spec = importlib.util.spec_from_file_location("platinum_generator", path)
    assert spec is not None
    assert spec.loader is not None
    generator = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(generator)
    for name, made in generator.generate().items():
        there = pl.read_csv(path.parent / name)
        assert there.columns == made.columns
        labels = [column for column in made.columns if not re.fullmatch(r"q\d", column)]
        assert there.select(labels).equals(made.select(labels))
        angles = [column for column in made.columns if column not in labels]
        # Kernels of other instruction sets may round the last digit otherwise.
        assert np.max(np.abs(there.select(angles).to_numpy() - made.select(angles).to_numpy())) < 1e-9

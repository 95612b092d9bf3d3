"""Running `ulna` as a reader of the docs does: in a folder with a copy of examples/, in a plain terminal."""

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


@contextmanager
def reader_folder() -> Iterator[Path]:
    """A temporary folder with a copy of examples/, as a reader has it."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copytree(ROOT / "examples", folder / "examples", ignore=shutil.ignore_patterns("__pycache__"))
        yield folder


def ulna(arguments: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """`ulna ARGUMENTS` as in a plain terminal of 80 columns."""
    environment = os.environ | {"COLUMNS": "80", "NO_COLOR": "1", "TERM": "dumb"}
    command = [sys.executable, "-m", "ulna", *arguments]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)

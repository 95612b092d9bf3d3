"""A folder in which commands have what they read."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

EXAMPLE = Path(__file__).parents[2] / "examples" / "platinum"


def prepared(folder: Path) -> Path:
    """The example of a platinum arm, its result `done`, and `arms` of two studies."""
    for path in EXAMPLE.iterdir():
        if path.is_file():
            shutil.copy(path, folder)
    for name in ("one", "two"):
        (folder / "arms" / name).mkdir(parents=True)
        for needed in ("study.toml", "platinum.toml", "bars.csv"):
            shutil.copy(EXAMPLE / needed, folder / "arms" / name)
    words = ["calibrate", "study.toml", "-o", "done"]
    subprocess.run([sys.executable, "-m", "ulna", *words], cwd=folder, capture_output=True, check=True)
    return folder

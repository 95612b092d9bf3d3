"""Running `ulna` as a reader of the docs does: in a folder with a copy of examples/, in a plain terminal."""

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import chdir, contextmanager
from dataclasses import dataclass
from pathlib import Path

from typer.testing import CliRunner

from ulna.cli import app

ROOT = Path(__file__).resolve().parents[1]


@contextmanager
def reader_folder() -> Iterator[Path]:
    """A temporary folder with a copy of examples/, as a reader has it."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copytree(ROOT / "examples", folder / "examples", ignore=shutil.ignore_patterns("__pycache__"))
        yield folder


@dataclass(frozen=True)
class Done:
    """What a command printed, and how it ended."""

    returncode: int
    stdout: str
    stderr: str


def ulna(arguments: list[str], folder: Path) -> Done:
    """`ulna ARGUMENTS` in a folder, as in a plain terminal of 80 columns; in this process, which is much quicker."""
    with chdir(folder):
        done = CliRunner(env={"COLUMNS": "80", "NO_COLOR": "1", "TERM": "dumb"}).invoke(app, arguments)
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    return Done(done.exit_code, done.stdout, done.stderr)

"""Files of the desk, laid into the folder of a session, so that it holds all that its command needs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from shutil import copyfile, rmtree
from typing import Any

from ulna.arm.conditions import TEMPERATURE
from ulna.arm.given import as_arm
from ulna.formats.toml import read_toml
from ulna.ground.errors import UlnaInputError
from ulna.live.by_list import ByList, touches_of
from ulna.live.ending import JOURNAL, begin
from ulna.live.figures import Calibrated
from ulna.live.stream import Stream
from ulna.serve.beside import named_in, usable
from ulna.serve.desk import Desk
from ulna.verification.to_touch import WorkList


@contextmanager
def folder_of(folder: Path) -> Iterator[Path]:
    """A session's folder: one that is new goes again where it cannot begin."""
    new = not folder.exists()
    folder.mkdir(parents=True, exist_ok=True)
    try:
        yield folder
    except UlnaInputError:
        if new:
            rmtree(folder, ignore_errors=True)
        raise


def laid(desk: Desk, digest: str, beside: Sequence[str], folder: Path) -> Path:
    """A file, and those that it names as far as they are there: given with it or, where a session left it, from there.
    Raises UlnaInputError."""
    path = usable(desk, digest)
    given = {desk.info(each).name: desk.path(each) for each in beside}
    document, _ = read_toml(path, "a file of Ulna (TOML)")
    for _, name in named_in(document):
        found = given.get(name) or (None if desk.brought(path) else path.parent / name)
        if found is not None and found.is_file() and Path(name).name == name:
            copyfile(found, folder / name)
    copyfile(path, folder / path.name)
    return folder / path.name


def calibrated(path: Path, probe: str | None, temperature_c: float | None, payload: str | None) -> Calibrated:
    """An arm, as a file says that it is used. Raises UlnaInputError."""
    warm = temperature_c if TEMPERATURE in as_arm(path).needs else None
    return Calibrated(path, probe, temperature_c=warm, payload=payload)


def touched_list(
    stream: Stream, arm: Calibrated, work: WorkList, folder: Path, by: str, head: Callable[[], dict[str, Any]]
) -> ByList:
    """A list with its journal: a new one, or one that goes on. Raises UlnaInputError."""
    found = ByList(stream, arm, work, by_itself=by == "still")
    known = touches_of(folder / JOURNAL) if (folder / JOURNAL).exists() else None
    if known is not None:
        found.go_on(*known)
    found.journal, _, _ = begin(folder, stream.source.hello, **head())
    return found

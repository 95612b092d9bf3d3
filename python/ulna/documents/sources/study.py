"""The study that a result was made from: named and then it must be the one, or found by its path and believed by its
SHA-256."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ulna.calibration.result import Result
from ulna.documents.languages.said import Said
from ulna.documents.sources.source import Calibration, Source, take
from ulna.formats.toml import read_bytes, sha256
from ulna.ground.errors import InputWarning, UlnaInputError
from ulna.study.given import StudyLike, as_study, study_path
from ulna.study.study import Study
from ulna.uncertainties.uncertainty import check_same


@dataclass(frozen=True)
class FileRow:
    """A file that the result was made from."""

    path: str
    sha256: str
    rows: int
    state: str
    """"same", "changed", "absent" or "not-compared" (the study was not found)."""


@dataclass(frozen=True)
class FoundStudy:
    """The study, or what to say where there is none, and the files of the result with their state."""

    study: Study | None
    files: list[FileRow]
    missing: Said | None


def _read(path: Path, calibration: Calibration) -> tuple[Study, str]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)  # the result has them: they were told when it was made
        study = Study.load(path, calibration.result.provenance.get("rows", "fit"))
    return study, sha256(read_bytes(path, "a study"))


def _remarks(study: Study, path: Path, calibration: Calibration) -> list[Said]:
    """Another study than that of the result is refused."""
    check_same(study, calibration.result.provenance, calibration.file.path)
    check_rows(study, calibration.result, path)
    return []


STUDY = Source("study", "ulna-study", _read, _remarks)


def find_study(calibration: Calibration, given: StudyLike | None, look: bool = True) -> FoundStudy:
    """given: the study that the user named, or has in memory. Without it that which the result knows, or the path in it
    is looked for, as it stands and beside the result, unless `look` is False; a study that has changed since is told
    and not used. Raises UlnaInputError."""
    made = calibration.result.provenance
    own = calibration.result.study if given is None else given
    if own is not None and not isinstance(own, str | os.PathLike):
        study = as_study(own)
        _remarks(study, Path(study.label), calibration)
        # where files have been left alone since, they are what the study in memory holds
        return FoundStudy(study, _rows(made, lambda file: _state(Path(str(file["path"])), str(file["sha256"]))), None)
    if isinstance(given, str | os.PathLike):
        given = study_path(given)
        return FoundStudy(take(STUDY, given, calibration).value, _rows(made, lambda _: "same"), None)
    name = made.get("study")
    if name is None:
        return FoundStudy(None, _rows(made, lambda _: "not-compared"), Said("study.in-memory"))
    # the paths of a result are as seen from where it was made; the root in which the study is found is that place
    roots = (Path(), calibration.file.path.parent) if look else ()
    root = next((root for root in roots if (root / name).is_file()), None)
    if root is None:
        return FoundStudy(None, _rows(made, lambda _: "not-compared"), Said("study.absent", {"study": name}))
    files = _rows(made, lambda file: _state(root / str(file["path"]), str(file["sha256"])))
    changed = [file.path for file in files if file.state != "same"]
    if changed:
        return FoundStudy(None, files, Said("study.changed", {"study": name, "files": ", ".join(changed)}))
    study, _ = _read(root / name, calibration)
    if [file.sha256 for file in study.files] != [file.sha256 for file in files]:
        return FoundStudy(None, files, Said("study.changed", {"study": name, "files": name}))
    check_rows(study, calibration.result, root / name)
    return FoundStudy(study, files, None)


def check_rows(study: Study, result: Result, path: Path) -> None:
    """Whether residuals and readings belong together row by row. Raises UlnaInputError."""
    rows = np.concatenate([group.row for group in study.readings])
    names = [name for group in study.readings for name in [group.artefact.name] * len(group)]
    theirs = result.residuals
    if len(theirs) != len(rows) or (theirs["row"].to_numpy() != rows).any() or theirs["artefact"].to_list() != names:
        raise UlnaInputError(
            f"{path}: its readings are not those of the result's residuals, row by row. The result was changed, or "
            "comes of another version: calibrate again."
        )


def _state(path: Path, digest: str) -> str:
    if not path.is_file():
        return "absent"
    return "same" if sha256(read_bytes(path, "a file of the study")) == digest else "changed"


def _rows(made: Mapping[str, Any], state: Callable[[Mapping[str, Any]], str]) -> list[FileRow]:
    return [
        FileRow(str(file["path"]), str(file["sha256"]), int(file.get("rows", 0)), state(file))
        for file in made.get("files", [])
    ]

"""The study that a result was made from: found by its path, believed by its SHA-256."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ulna.calibration.result import Result
from ulna.documents.content import FileRow, Said
from ulna.formats.toml import read_bytes, sha256
from ulna.ground.errors import InputWarning, UlnaInputError
from ulna.study.study import Study
from ulna.uncertainties.uncertainty import check_same


def find_study(result: Result, path: Path, given: Path | None) -> tuple[Study | None, list[FileRow], Said | None]:
    """The study, the files with their state, and what to say where there is no study.

    given: the study that the user named: it must be the one. Without it the path in the result is looked for, as it
    stands and beside the result; a study that has changed since is told and not used. Raises UlnaInputError.
    """
    made = result.provenance
    if given is not None:
        study = _load(given, made)
        check_same(study, made, path)
        _check_rows(study, result, given)
        return study, _rows(made, lambda _: "same"), None
    name = made.get("study")
    if name is None:
        return None, _rows(made, lambda _: "not-compared"), Said("study.in-memory")
    roots = [Path(), path.parent]
    found = next((root / name for root in roots if (root / name).is_file()), None)
    if found is None:
        return None, _rows(made, lambda _: "not-compared"), Said("study.absent", {"study": name})
    # the paths of a result are as seen from where it was made; the root in which the study is found is that place
    root = next(root for root in roots if (root / name).is_file())
    files = _rows(made, lambda file: _state(root / str(file["path"]), str(file["sha256"])))
    changed = [file.path for file in files if file.state != "same"]
    if changed:
        return None, files, Said("study.changed", {"study": name, "files": ", ".join(changed)})
    study = _load(found, made)
    if [file.sha256 for file in study.files] != [file.sha256 for file in files]:
        return None, files, Said("study.changed", {"study": name, "files": name})
    _check_rows(study, result, found)
    return study, files, None


def _load(path: Path, made: Mapping[str, Any]) -> Study:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)  # the result has them: they were told when it was made
        return Study.load(path, made.get("rows", "fit"))


def _check_rows(study: Study, result: Result, path: Path) -> None:
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


def _rows(made: Mapping[str, Any], state: Any) -> list[FileRow]:
    return [
        FileRow(str(file["path"]), str(file["sha256"]), int(file.get("rows", 0)), state(file))
        for file in made.get("files", [])
    ]

"""Batch: many studies calibrated one after the other or at once, each by itself; what is done is not done again."""

from __future__ import annotations

import dataclasses
import json
import os
import re
import warnings
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, Literal

from ulna.calibration.calibrate import calibrate
from ulna.calibration.provenance import provenance
from ulna.calibration.result import FILES, RESIDUALS, Result
from ulna.formats.claimed import claimed
from ulna.formats.names import as_text
from ulna.formats.output import refuse_inputs, write_file
from ulna.formats.toml import read_json
from ulna.ground.arrays import Progress
from ulna.ground.digits import figure_mm
from ulna.ground.errors import InputWarning, UlnaInputError, cannot_be_read
from ulna.ground.faults import fault
from ulna.ground.shown import About, Shown, Table
from ulna.study.study import Study
from ulna.work.pieces import Threads, Workers

Status = Literal["converged", "not-converged", "refused"]

FORMAT = "ulna-batch/1"
LIST = "batch.json"


@dataclass(frozen=True)
class Calibrated:
    """One of the studies."""

    name: str
    """The study's path in the folder, without its ending; the result's folder is called so."""
    status: Status
    message: str | None
    """Of a study that was refused: what is wrong with it."""
    readings: int
    parameters: int
    determined: int
    rms_mm: float | None
    """Of the readings' residuals, after."""
    chi2_per_dof: float | None
    outliers: int
    done_before: bool
    """The result was there already, made by this version from the same files in the same way."""


@dataclass(frozen=True, repr=False)
class Batch(Shown):
    """All of them, by name."""

    studies: list[Calibrated]

    @property
    def converged(self) -> bool:
        """Whether every study was calibrated and its fit ended well."""
        return all(study.status == "converged" for study in self.studies)

    def as_dict(self) -> dict[str, Any]:
        """`batch.json`: JSON types only."""
        return {"format": FORMAT, "studies": [dataclasses.asdict(study) for study in self.studies]}

    def about(self) -> About:
        """A row for each study."""
        rows = [
            [each.name, each.status, str(each.readings), "–" if each.rms_mm is None else figure_mm(each.rms_mm)]
            for each in self.studies
        ]
        good = sum(study.status == "converged" for study in self.studies)
        table = Table(["study", "status", "readings", "rms / mm"], rows, texts=2)
        return About(f"Batch of {len(rows)} studies: {good} converged", {}, [table])


def studies_in(folder: Path, only: str = "*") -> dict[str, Path]:
    """Name → study file of every study in a folder, at any depth, sorted by name.

    only: a shell-style pattern over the names. Raises UlnaInputError where there is none.
    """
    if not folder.is_dir():
        raise UlnaInputError(f"{folder}: is no folder; expected one with studies in it, at any depth.")
    found = {}
    for path in sorted(folder.rglob("*.toml")):
        if path.is_file() and _is_study(path):
            found[as_text(path.relative_to(folder).with_suffix("").as_posix())] = path
    if not found:
        raise UlnaInputError(
            f'{folder}: has no study in it; expected files with format = "ulna-study/1", at any depth.'
        )
    chosen = {name: path for name, path in found.items() if fnmatchcase(name, only)}
    if not chosen:
        raise UlnaInputError(
            f"{folder}: no study's name matches '{only}'; there are {len(found)}, such as {next(iter(found))}. Correct "
            "the pattern."
        )
    return chosen


def _is_study(path: Path) -> bool:
    """By what its format says; whether it can be read is another question."""
    try:
        content = path.read_bytes()
    except OSError:
        return True  # the message comes with its turn
    return re.search(rb"^\s*format\s*=\s*[\"']ulna-study/", content, re.MULTILINE) is not None


def batch(
    folder: str | Path,
    out: str | Path,
    *,
    only: str = "*",
    workers: Workers | None = None,
    force: bool = False,
    progress: Progress | None = None,
) -> Batch:
    """Calibrate every study in a folder; each result goes into a folder of its own below `out`, whole or not at all.

    only: a shell-style pattern over the studies' names. A study that cannot be calibrated stops no other: its message
    is in the answer. What `out` has already, made by this version from the same files with the same options, is kept
    and not done again; other results there are refused unless `force` is given. Raises UlnaInputError where nothing can
    be done at all, or another batch is writing into `out`; KeyboardInterrupt.
    """
    folder, out = Path(folder), Path(out)
    named = studies_in(folder, only)
    listed = out / LIST
    done: dict[str, Calibrated] = {}
    told = progress if progress is not None else lambda *_: None
    told("studies", 0, len(named))
    names = list(named)
    with claimed(out, "batch"):
        earlier = _earlier_list(listed, force)
        for number, answer in (workers or Threads()).each(_calibrate, _Turns(named, out, force)):
            name = names[number]
            done[name] = _kept(name, answer, out / name, force)
            told("studies", len(done), len(named))
        found = Batch([done[name] for name in named])
        text = json.dumps(found.as_dict(), indent=1, ensure_ascii=False, allow_nan=False)
        write_file(listed, text + "\n", force, instead_of=earlier)
    return found


def _earlier_list(listed: Path, force: bool) -> str | None:
    """The SHA-256 of an earlier list of a batch, which is replaced as nothing else is; asked before the work. Raises
    UlnaInputError."""
    if (force and not listed.is_symlink()) or not os.path.lexists(listed):
        return None
    if listed.is_file() and not listed.is_symlink():
        with suppress(UlnaInputError):
            earlier, stands = read_json(listed, "a list of a batch")
            if earlier.get("format") == FORMAT:
                return stands
    raise UlnaInputError(
        f"{listed}: is no list of an earlier batch, and is not overwritten. Name another folder with -o"
        + (", or remove the link." if listed.is_symlink() else ", or give --force.")
    )


@dataclass(frozen=True)
class _Done:
    """A result that was there already."""

    result: Result


class _Turns(Sequence[Any]):
    """Each study when its turn comes, so that few are in memory: a study, what was done before, or a message."""

    def __init__(self, named: dict[str, Path], out: Path, force: bool) -> None:
        self._named, self._out, self._force = list(named.items()), out, force

    def __len__(self) -> int:
        return len(self._named)

    def __getitem__(self, number: Any) -> Any:
        name, path = self._named[number]
        folder = self._out / name
        return _answer_of(lambda: self._turn(path, folder))

    def _turn(self, path: Path, folder: Path) -> Study | _Done:
        study = _load(path)
        refuse_inputs((folder / file for file in (*FILES, LIST)), (file.path for file in study.files))
        before = _done_before(study, folder, self._force)
        return study if before is None else _Done(before)


def _answer_of(work: Callable[[], Any]) -> Any:
    """What comes of one study; a message where something is wrong with it, whatever that is."""
    try:
        return work()
    except UlnaInputError as error:
        return str(error)
    except OSError as error:
        return cannot_be_read(error)
    except Exception as error:
        return fault(error)


def _load(path: Path) -> Study:
    with warnings.catch_warnings():
        # its result has them; of many studies they would drown what matters
        warnings.simplefilter("ignore", InputWarning)
        return Study.load(path)


def _calibrate(study: Study | _Done | str) -> Result | _Done | str:
    """The result, or what is wrong with the study: a message is data here, so that it passes between processes."""
    if not isinstance(study, Study):
        return study
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        found: Result | str = _answer_of(lambda: calibrate(study))
        return found


def _kept(name: str, answer: Result | _Done | str, folder: Path, force: bool) -> Calibrated:
    """What became of a study; its result is written."""
    if isinstance(answer, _Done):
        return _calibrated(name, answer.result, done_before=True)
    if isinstance(answer, str):
        return _refused(name, answer)
    result = answer

    def save() -> Calibrated:
        result.save(folder, force=force)
        return _calibrated(name, result, done_before=False)

    saved = _answer_of(save)
    return _refused(name, saved) if isinstance(saved, str) else saved


def _done_before(study: Study, folder: Path, force: bool) -> Result | None:
    """The result that is there already, if it is this study's. Raises UlnaInputError for another's without `force`."""
    if not any((folder / name).exists() for name in FILES):
        return None
    if force:
        return None
    lacking = next((name for name in ("result.json", "arm.toml") if not (folder / name).is_file()), None)
    if lacking is None and not any((folder / name).is_file() for name in ("residuals.csv", RESIDUALS)):
        lacking = "residuals.csv"
    if lacking is not None:
        raise UlnaInputError(
            f"{folder / lacking}: is missing, which belongs to the result that is there; it is not taken as done. Give "
            "--force to make it anew, or name another folder."
        )
    before = Result.load(folder)
    made = before.provenance
    asked = json.loads(json.dumps(provenance(study, datetime.now(UTC))))
    same = all(made.get(key) == asked[key] for key in ("version", "options", "noise"))
    same &= [file.get("sha256") for file in made.get("files", [])] == [file["sha256"] for file in asked["files"]]
    if not same:
        raise UlnaInputError(
            f"{folder}: holds a result of other files, options or another version, and is not overwritten. Name "
            "another folder, or give --force."
        )
    return before


def _refused(name: str, message: str) -> Calibrated:
    return Calibrated(name, "refused", message, 0, 0, 0, None, None, 0, False)


def _calibrated(name: str, result: Result, done_before: bool) -> Calibrated:
    return Calibrated(
        name=name,
        status="converged" if result.fit.converged else "not-converged",
        message=None,
        readings=result.fit.readings,
        parameters=result.identifiability.parameters,
        determined=result.identifiability.determined,
        rms_mm=result.fit.rms_mm,
        chi2_per_dof=result.fit.chi2_per_dof,
        outliers=len(result.outliers),
        done_before=done_before,
    )

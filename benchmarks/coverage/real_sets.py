"""Readings that others measured, parted into what is fitted and what is held out: a row each of `SETS`.

The data are not part of the project (docs/real-readings.md says where they are from).
"""

import tempfile
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import ulna
from ulna.exchange.importers.ipa import import_ipa_ur10
from ulna.exchange.importers.mukca import import_mukca

FITTED = 300
"""Rows of the tracked robot's Series B, spread over the file."""


@dataclass(frozen=True)
class Fold:
    """One fit, and what it has not seen."""

    fitted: ulna.Study
    held_out: dict[str, ulna.Readings]
    """By the row of the table that they count for."""


def tracked(data: Path) -> list[Fold]:
    """A UR10 and a laser tracker, which stood elsewhere for each series."""
    folder = data / "ipa_ur10"
    with tempfile.TemporaryDirectory() as name:
        out = Path(name)
        import_ipa_ur10(_series(folder, "B"), out / "B", fit=FITTED, spread=True)
        held_out = {"UR10, Series B": _study(out / "B" / "held-out.toml")}
        for other in "ACD":
            import_ipa_ur10(_series(folder, other), out / other)
            held_out[f"UR10, Series {other} by B"] = _study(out / other / "study.toml")
        fitted = _study(out / "B" / "study.toml")
    return [Fold(fitted, {row: study.readings[0] for row, study in held_out.items()})]


def sockets(data: Path, robot: str, words: str) -> list[Fold]:
    """Two sockets 50 mm apart in several places, each left out once. That they are printed, and their distance known
    to 0.1 mm, does not matter here: the arm that is judged was fitted to the same two."""
    with tempfile.TemporaryDirectory() as name:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ulna.InputWarning)  # rows that stand there twice
            import_mukca(data / "mukca" / robot, Path(name) / "study", drop_copies=True)
        study = _study(Path(name) / "study" / "study.toml")
    (group,) = study.readings
    code = group.placement_code
    return [
        Fold(study.subset([code != place]), {words: group.select(code == place)})
        for place in range(int(code.max()) + 1)
    ]


def _series(folder: Path, name: str) -> Path:
    return next((folder / f"Series_{name}").glob("measurements_*.csv"))


def _study(path: Path) -> ulna.Study:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ulna.InputWarning)
        return replace(ulna.Study.load(path), path=None)  # the folder is gone when messages would name it


SETS: dict[str, tuple[str, Callable[[Path], list[Fold]]]] = {
    "ur10": ("ipa_ur10", tracked),
    "panda_1": ("mukca/panda_1", lambda data: sockets(data, "panda_1", "Panda 1, places left out")),
    "panda_2": ("mukca/panda_2_clean", lambda data: sockets(data, "panda_2_clean", "Panda 2, places left out")),
    "kuka": ("mukca/kuka_14", lambda data: sockets(data, "kuka_14", "KUKA, places left out")),
    "kinova": ("mukca/dinova_1", lambda data: sockets(data, "dinova_1", "Kinova, places left out")),
}
"""Name → the folder of the data that it is made of, and how."""


def stated_mm(group: ulna.Readings) -> np.ndarray:
    """(N, 3) where the touched features are in their artefact's own frame, mm."""
    return np.array(list(group.artefact.features.values()))[group.feature]

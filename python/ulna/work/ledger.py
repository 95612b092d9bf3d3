"""Finished pieces of a job, kept in a folder: interrupted work goes on where it stopped."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ulna.ground.errors import UlnaInputError

FORMAT = "ulna-job/1"
JOB = "job.json"


class Ledger:
    """A folder with what the job is and one file for each finished piece. Files appear whole or not at all."""

    def __init__(self, folder: Path, job: Mapping[str, Any]) -> None:
        """job: JSON types only, everything that the numbers depend on.

        Raises UlnaInputError for a folder that is another job's, or cannot be written.
        """
        self._folder = folder
        asked = {"format": FORMAT, **job}
        try:
            if (folder / JOB).exists():
                self._check(json.loads((folder / JOB).read_text(encoding="utf-8")), asked)
                return
            folder.mkdir(parents=True, exist_ok=True)
            if any(folder.iterdir()):
                raise UlnaInputError(
                    f"{folder}: holds other files, and no {JOB}; expected an empty folder, or one of this job. Name "
                    "another."
                )
            self._write(JOB, (json.dumps(asked, indent=1, ensure_ascii=False) + "\n").encode())
        except (OSError, ValueError) as error:
            raise UlnaInputError(f"{folder}: cannot be used to keep finished work ({error}). Name another.") from None

    def _check(self, found: Any, asked: Mapping[str, Any]) -> None:
        other = [key for key in asked if not isinstance(found, dict) or found.get(key) != asked[key]]
        if other:
            raise UlnaInputError(
                f"{self._folder}: keeps another job's work; {', '.join(other)} {'is' if len(other) == 1 else 'are'} "
                "not what is asked now. Name another folder, or remove this one."
            )

    def _write(self, name: str, content: bytes) -> None:
        part = self._folder / f"{name}.part"
        part.write_bytes(content)
        part.replace(self._folder / name)

    def _path(self, piece: int) -> Path:
        return self._folder / f"piece-{piece}.npz"

    def keep(self, piece: int, arrays: Mapping[str, NDArray[Any]]) -> None:
        """A finished piece. Raises UlnaInputError where it cannot be written."""
        path = self._path(piece)
        part = path.with_suffix(".part")
        try:
            with part.open("wb") as file:
                np.savez(file, allow_pickle=False, **arrays)
            part.replace(path)
        except OSError as error:
            raise UlnaInputError(f"{path}: cannot be written ({error}). Free space, or name another folder.") from None

    def kept(self, piece: int) -> dict[str, NDArray[Any]] | None:
        """What was kept of a piece; None where it is not finished, or its file is damaged."""
        try:
            with self._path(piece).open("rb") as file, np.load(file, allow_pickle=False) as found:
                return dict(found)
        except (OSError, ValueError, EOFError, zipfile.BadZipFile):
            return None

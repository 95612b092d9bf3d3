"""Finished pieces of a job, kept in a folder: interrupted work goes on where it stopped."""

from __future__ import annotations

import errno
import json
import os
import secrets
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
                self._check(asked)
                return
            folder.mkdir(parents=True, exist_ok=True)
            if any(folder.iterdir()):
                raise UlnaInputError(
                    f"{folder}: holds other files, and no {JOB}; expected an empty folder, or one of this job. Name "
                    "another."
                )
            self._begin((json.dumps(asked, indent=1, ensure_ascii=False) + "\n").encode())
            self._check(asked)
        except (OSError, ValueError) as error:
            raise UlnaInputError(f"{folder}: cannot be used to keep finished work ({error}). Name another.") from None

    def _check(self, asked: Mapping[str, Any]) -> None:
        found: Any = json.loads((self._folder / JOB).read_text(encoding="utf-8"))
        other = [key for key in asked if not isinstance(found, dict) or found.get(key) != asked[key]]
        if other:
            raise UlnaInputError(
                f"{self._folder}: keeps another job's work; {', '.join(other)} {'is' if len(other) == 1 else 'are'} "
                "not what is asked now. Name another folder, or remove this one."
            )

    def _begin(self, content: bytes) -> None:
        """What the job is, where nobody has said it meanwhile. Raises OSError."""
        part = self._part(JOB)
        try:
            part.write_bytes(content)
            os.link(part, self._folder / JOB)
        except FileExistsError:
            pass
        except OSError as error:
            if error.errno not in (errno.EPERM, errno.ENOTSUP, errno.ENOSYS):
                raise
            part.replace(self._folder / JOB)  # a disk without links
        finally:
            part.unlink(missing_ok=True)

    def _part(self, name: str) -> Path:
        """Of nobody else: two runs of one job may keep their work in one folder."""
        return self._folder / f"{name}-{secrets.token_hex(6)}.part"

    def _path(self, piece: int) -> Path:
        return self._folder / f"piece-{piece}.npz"

    def keep(self, piece: int, arrays: Mapping[str, NDArray[Any]]) -> None:
        """A finished piece. Raises UlnaInputError where it cannot be written."""
        path = self._path(piece)
        part = self._part(path.name)
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

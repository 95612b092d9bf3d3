"""What a server serves: one bench folder with its record, its desk, its sessions, its jobs."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from ulna.ground.errors import UlnaInputError
from ulna.records.place import BENCH
from ulna.records.records import Records
from ulna.serve.activities.hall import Hall
from ulna.serve.desk import Desk
from ulna.serve.hub import Hub
from ulna.serve.issuing import issued
from ulna.serve.jobs import Jobs
from ulna.serve.proposals import Proposals
from ulna.serve.sources import Allowed, allow_all

DESK, SESSIONS, JOBS, PROPOSALS = "desk", "sessions", "jobs", "proposals"
"""In a bench folder, beside what is of the record."""


class Workshop:
    """One bench."""

    def __init__(self, folder: Path, by: str | None = None, allowed: Allowed = allow_all) -> None:
        """A bench folder; a new record is made in one that is not there, or is empty. allowed: which sources may be
        opened. Raises UlnaInputError."""
        folder = folder.absolute()
        there = folder.is_dir() and any(folder.iterdir())
        if there and not (folder / BENCH).is_file():
            raise UlnaInputError(
                f"{folder}: no bench folder ({BENCH} is not in it), and not empty; expected one, or a folder that is "
                "not there yet. Name another."
            )
        self.folder = folder
        self.records = Records.open(folder, by) if there else Records.init(folder, by=by)
        for name in (DESK, SESSIONS, JOBS, PROPOSALS):
            (folder / name).mkdir(exist_ok=True)
        self.hub = Hub()
        self.desk = Desk(folder / DESK, folder / SESSIONS, folder / JOBS)
        self.allowed = allowed
        self.hall = Hall(folder / SESSIONS, self.desk, self.records.bench, self.hub, allowed)
        self.jobs = Jobs(self.hub, self.desk.take)
        self.proposals = Proposals(folder / PROPOSALS, partial(issued, self.desk))

    @property
    def jobs_folder(self) -> Path:
        """Where jobs write, a folder each."""
        return self.folder / JOBS

    def close(self) -> None:
        """Nothing goes on; what was interrupted can go on later."""
        self.hall.close()
        self.jobs.close()

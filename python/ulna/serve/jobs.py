"""Long work: one thread that does one job after another; each can be watched and cancelled."""

from __future__ import annotations

import queue
import secrets
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import kept, recalled, templates, worded
from ulna.serve.contract import jobs as wire
from ulna.serve.contract.files import FileInfo
from ulna.serve.contract.live import JobEvent
from ulna.serve.contract.model import Problem, shortened
from ulna.serve.hub import Hub
from ulna.serve.problems import FAULT, NotThereError, problem, status_of

KEPT = 100
TOLD_S = 0.1
"""How often it is told how far one is: whoever listens is not flooded."""

State = Literal["waiting", "running", "done", "failed", "cancelled"]
Progress = Callable[[str, int, int], None]

STAGES = templates(
    "search",
    "fit",
    "plan",
    "monte carlo",
    "calibrations",
    "certificate",
    "check",
    "choosing a model",
    "convergence",
    "evaluating",
    "gathering",
    "groups left out",
    "judging extras",
    "measure",
    "trials",
    "verify",
)
"""How far long work is, as rooms and core call it."""


@dataclass(frozen=True)
class Made:
    """What a job made."""

    files: list[tuple[str, Path]]
    """By their role."""
    said: list[str] = field(default_factory=list)
    """What is to be known of it."""


Work = Callable[[Progress], Made]
"""Does it, calling back with (stage, done, total)."""
Planned = tuple[str, Work]
"""A title, and the work."""


class CancelledError(Exception):
    """Somebody wants it no more."""


@dataclass
class _Job:
    name: str
    kind: str
    title: str
    who: str
    work: Work
    state: State = "waiting"
    stage: str = ""
    done: int = 0
    total: int = 0
    made: list[wire.Made] = field(default_factory=list)
    sentences: list[str] = field(default_factory=list)
    problem: Problem | None = None
    cancelled: threading.Event = field(default_factory=threading.Event)

    def said(self) -> wire.Job:
        return wire.Job(
            id=self.name,
            kind=self.kind,
            title=self.title,
            who=self.who,
            state=self.state,
            stage=recalled(self.stage, STAGES),
            done=self.done,
            total=self.total,
            made=list(self.made),
            said=[shortened(said) for said in self.sentences],
            problem=self.problem,
        )


class Jobs:
    """All of them. keep: puts a file that was made onto the desk."""

    def __init__(self, hub: Hub, keep: Callable[[Path], FileInfo]) -> None:
        self._hub, self._keep = hub, keep
        self._lock = threading.Lock()
        self._jobs: dict[str, _Job] = {}
        self._waiting: queue.SimpleQueue[_Job | None] = queue.SimpleQueue()
        threading.Thread(target=self._run, name="jobs", daemon=True).start()

    def begin(self, kind: str, title: str, work: Work, who: str) -> wire.Job:
        """One more. who: wants it."""
        job = _Job(secrets.token_hex(6), kind, title, who, work)
        with self._lock:
            self._jobs[job.name] = job
            for old in [each for each in self._jobs.values() if each.state not in ("waiting", "running")][:-KEPT]:
                del self._jobs[old.name]
        self._waiting.put(job)
        return job.said()

    def job(self, name: str) -> wire.Job:
        """Raises NotThereError."""
        return self._of(name).said()

    def cancel(self, name: str) -> wire.Job:
        """It stops where it next says how far it is; nothing half written stays. Raises NotThereError."""
        job = self._of(name)
        job.cancelled.set()
        return job.said()

    def all(self) -> wire.Jobs:
        """The newest first."""
        with self._lock:
            return wire.Jobs(jobs=[each.said() for each in reversed(self._jobs.values())])

    def close(self) -> None:
        """The server ends."""
        with self._lock:
            for each in self._jobs.values():
                each.cancelled.set()
        self._waiting.put(None)

    def _of(self, name: str) -> _Job:
        with self._lock:
            found = self._jobs.get(name)
        if found is None:
            raise NotThereError(f"job '{name[:80]}': there is none. Begin one.")
        return found

    def _run(self) -> None:
        while (job := self._waiting.get()) is not None:
            self._do(job)

    def _do(self, job: _Job) -> None:
        told_s = 0.0

        def progress(stage: str, done: int, total: int) -> None:
            nonlocal told_s
            if job.cancelled.is_set():
                raise CancelledError
            job.stage, job.done, job.total = stage, done, total
            now_s = time.monotonic()
            if now_s - told_s >= TOLD_S:
                told_s = now_s
                self._tell(job)

        try:
            if job.cancelled.is_set():
                raise CancelledError
            job.state = "running"
            self._tell(job)
            made = job.work(progress)
            job.sentences = list(made.said)
            for role, path in made.files:
                info = self._keep(path)
                job.made.append(wire.Made(role=role, sha256=info.sha256, name=info.name))
            job.state = "done"
        except CancelledError:
            job.state = "cancelled"
        except UlnaInputError as error:
            job.state, job.problem = "failed", problem(status_of(error), kept(error))
        except Exception as error:  # a fault of ours is told, and the next job is done all the same
            job.state, job.problem = (
                "failed",
                problem(
                    500, worded("{fault} ({kind}: {what})", fault=FAULT, kind=type(error).__name__, what=str(error))
                ),
            )
        self._tell(job)

    def _tell(self, job: _Job) -> None:
        self._hub.tell(JobEvent(job=job.said()))

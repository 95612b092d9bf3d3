"""All activities: begun, found by their names, and sessions that were interrupted."""

from __future__ import annotations

import json
import secrets
import threading
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

from pydantic import Field, TypeAdapter, ValidationError

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.ending import JOURNAL, RESULT, touches_in
from ulna.records.bench import Bench
from ulna.serve.activities.beginning import ABOUT, Kept, Place
from ulna.serve.activities.checking import CHECK
from ulna.serve.activities.running import Running
from ulna.serve.activities.testing import FOLDER as TESTED
from ulna.serve.contract import activities as wire
from ulna.serve.contract.activities import Begin, BeginTouch
from ulna.serve.contract.guided import BeginCheckTouches, BeginTestTouches
from ulna.serve.contract.words import Do
from ulna.serve.desk import Desk
from ulna.serve.hub import Hub
from ulna.serve.problems import NotNowError, NotThereError
from ulna.serve.sources import Allowed

KEPT = 20
"""Activities that are over and still can be looked at."""


LEFT = (RESULT, "study.toml", CHECK, TESTED)
"""In the folder of a session that is over."""
_KEPT: TypeAdapter[Kept] = TypeAdapter(Annotated[Kept, Field(discriminator="kind")])


def _kept_in(folder: Path) -> tuple[Kept, str]:
    """How a session was asked for, and when it began."""
    document = json.loads((folder / ABOUT).read_text(encoding="utf-8"))
    return _KEPT.validate_json(json.dumps(document["asked"])), str(document.get("begun", ""))


def _plan_of(asked: Kept) -> str:
    match asked:
        case BeginTouch():
            return asked.plan
        case BeginCheckTouches():
            return asked.protocol
        case BeginTestTouches():
            return asked.test
    raise AssertionError(asked)


class Hall:
    """Of one bench."""

    def __init__(self, folder: Path, desk: Desk, bench: Bench, hub: Hub, allowed: Allowed) -> None:
        """folder: of the sessions, one each. allowed: which sources may be opened."""
        self._folder, self._desk, self._bench, self._hub, self._allowed = folder, desk, bench, hub, allowed
        self._lock = threading.Lock()
        self._activities: dict[str, Running] = {}

    def begin(self, asked: Begin, who: str) -> wire.Activity:
        """A new one, or an interrupted session that goes on. who: begins it. Raises UlnaInputError."""
        name, asked = self._name(asked), self._as_kept(asked)
        with self._lock:
            busy = next((each for each in self._activities.values() if each.running), None)
            if busy is not None:
                raise NotNowError(worded("'{session}' is still going on. End it first.", session=busy.name))
            place = Place(self._desk, self._bench, self._folder / name, who, self._allowed)
            running = Running(name, asked, place, self._hub)
            self._activities.pop(name, None)
            self._activities[name] = running
            for old in list(self._activities)[:-KEPT]:
                del self._activities[old]
        return running.activity()

    def say(self, name: str, asked: Do) -> wire.Activity:
        """Raises UlnaInputError."""
        return self._of(name).say(asked)

    def activity(self, name: str) -> wire.Activity:
        """Raises NotThereError."""
        return self._of(name).activity()

    def all(self) -> wire.Activities:
        """What runs, and what was interrupted."""
        with self._lock:
            running = [each for each in self._activities.values() if each.running]
        busy = {each.name for each in running}
        return wire.Activities(
            running=[each.activity() for each in running],
            unfinished=[each for each in self._interrupted() if each.id not in busy],
        )

    def close(self) -> None:
        """The server ends: sessions stay as they are."""
        with self._lock:
            for each in self._activities.values():
                if each.running:
                    each.stop()

    def _of(self, name: str) -> Running:
        with self._lock:
            found = self._activities.get(name)
        if found is None:
            raise NotThereError(f"activity '{name[:80]}': there is none. Begin one.")
        return found

    def _name(self, asked: Begin) -> str:
        if isinstance(asked, Kept) and asked.go_on is not None:
            if asked.go_on not in {each.id for each in self._interrupted()}:
                raise NotThereError(f"session '{asked.go_on[:80]}': none that can go on. Begin another.")
            return asked.go_on
        return f"{datetime.now(UTC):%Y-%m-%d-%H%M%S}-{secrets.token_hex(2)}"

    def _as_kept(self, asked: Begin) -> Begin:
        """A list that goes on is the one that it was: only where readings come from may be another."""
        if not isinstance(asked, BeginCheckTouches | BeginTestTouches) or asked.go_on is None:
            return asked
        kept, _ = _kept_in(self._folder / asked.go_on)
        if not isinstance(kept, type(asked)):
            raise NotThereError(f"session '{asked.go_on[:80]}': it is none of '{asked.kind}'. Begin another.")
        return kept.model_copy(update={"go_on": asked.go_on, "source": asked.source, "by": asked.by})

    def _interrupted(self) -> list[wire.Unfinished]:
        found = []
        for about in sorted(self._folder.glob(f"*/{ABOUT}"), reverse=True):
            folder = about.parent
            over = any((folder / name).exists() for name in LEFT)
            if over or not (folder / JOURNAL).exists():
                continue
            try:
                asked, begun = _kept_in(folder)
                touches = len(touches_in(folder / JOURNAL))
            except (OSError, ValueError, KeyError, TypeError, ValidationError, UlnaInputError):
                continue  # nobody can go on with it; its journal stays where it is
            found.append(
                wire.Unfinished(
                    id=folder.name,
                    kind=asked.kind,
                    touches=touches,
                    begun=begun,
                    arm=asked.arm,
                    plan=_plan_of(asked),
                    source=asked.source,
                )
            )
        return found

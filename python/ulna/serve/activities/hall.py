"""All activities: begun, found by their names, and sessions that were interrupted."""

from __future__ import annotations

import json
import secrets
import threading
from datetime import UTC, datetime
from pathlib import Path

from pydantic import ValidationError

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.ending import JOURNAL, RESULT, touches_in
from ulna.serve.activities.beginning import ABOUT, Place
from ulna.serve.activities.running import Running
from ulna.serve.contract import activities as wire
from ulna.serve.contract.activities import Begin, BeginTouch
from ulna.serve.contract.words import Do
from ulna.serve.desk import Desk
from ulna.serve.hub import Hub
from ulna.serve.problems import NotNowError, NotThereError

KEPT = 20
"""Activities that are over and still can be looked at."""


class Hall:
    """Of one bench."""

    def __init__(self, folder: Path, desk: Desk, hub: Hub) -> None:
        """folder: of the sessions, one each."""
        self._folder, self._desk, self._hub = folder, desk, hub
        self._lock = threading.Lock()
        self._activities: dict[str, Running] = {}

    def begin(self, asked: Begin) -> wire.Activity:
        """A new one, or an interrupted session that goes on. Raises UlnaInputError."""
        name = self._name(asked)
        with self._lock:
            busy = next((each for each in self._activities.values() if each.running), None)
            if busy is not None:
                raise NotNowError(worded("'{session}' is still going on. End it first.", session=busy.name))
            running = Running(name, asked, Place(self._desk, self._folder / name), self._hub)
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
        if isinstance(asked, BeginTouch) and asked.go_on is not None:
            if asked.go_on not in {each.id for each in self._interrupted()}:
                raise NotThereError(f"session '{asked.go_on[:80]}': none that can go on. Begin another.")
            return asked.go_on
        return f"{datetime.now(UTC):%Y-%m-%d-%H%M%S}-{secrets.token_hex(2)}"

    def _interrupted(self) -> list[wire.Unfinished]:
        found = []
        for about in sorted(self._folder.glob(f"*/{ABOUT}"), reverse=True):
            folder = about.parent
            if (folder / RESULT).exists() or (folder / "study.toml").exists() or not (folder / JOURNAL).exists():
                continue
            try:
                document = json.loads(about.read_text(encoding="utf-8"))
                asked = BeginTouch.model_validate_json(json.dumps(document["asked"]))
                touches = len(touches_in(folder / JOURNAL))
            except (OSError, ValueError, KeyError, TypeError, ValidationError, UlnaInputError):
                continue  # nobody can go on with it; its journal stays where it is
            found.append(
                wire.Unfinished(
                    id=folder.name,
                    kind=asked.kind,
                    touches=touches,
                    begun=str(document.get("begun", "")),
                    arm=asked.arm,
                    plan=asked.plan,
                    source=asked.source,
                )
            )
        return found

"""How people of a laboratory come in: by name and password, or from their provider; and in which roles they are."""

from __future__ import annotations

import logging
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ulna.ground.errors import UlnaInputError, for_people
from ulna.ground.worded import worded
from ulna.records.records import Records
from ulna.serve.contract.about import Login, LoginPassword, LoginToken
from ulna.serve.entrance import Way
from ulna.serve.laboratory.accounts import Accounts
from ulna.serve.laboratory.settings_file import Settings
from ulna.serve.laboratory.throttle import Throttle
from ulna.serve.people import Person
from ulna.serve.problems import NotLetInError, TooOftenError

if TYPE_CHECKING:
    from ulna.serve.laboratory.provider import Provider

LOG = logging.getLogger("ulna.workbench")
"""Who came in, who was not let in, and from where: a line each."""
FRESH_S = 2.0
"""How long what the record said of somebody counts."""


class LaboratoryEntrance:
    """Of one bench."""

    closed = worded("Sign in.")

    def __init__(self, records: Records, settings: Settings) -> None:
        self._records, self._passwords = records, settings.file.sign_in.passwords
        self.accounts = Accounts(records.bench.folder)
        self.throttle = Throttle()
        stated = settings.file.provider
        self.provider: Provider | None = None
        if stated is not None:
            from ulna.serve.laboratory.provider import Provider

            self.provider = Provider(stated, settings.secret, settings.origin)
        ways: dict[Way, bool] = {"password": self._passwords, "provider": stated is not None}
        self.ways: Sequence[Way] = [way for way, there in ways.items() if there]
        self._known: dict[str, tuple[float, Person | None]] = {}

    def enter(self, asked: Login, address: str) -> str:
        """By a password."""
        match asked:
            case LoginToken():
                raise NotLetInError(worded("way: got 'token'; expected a name and a password. Sign in."))
            case LoginPassword():
                return self._by_password(asked.name, asked.password, address)

    def from_provider(self, sign_in: str, address: str) -> str:
        """Whom the provider calls so. Raises NotLetInError."""
        name = self.accounts.named(sign_in)
        if name is None or self.person(name) is None:
            _log("refused", sign_in, address, "nobody of the record")
            raise NotLetInError(
                worded(
                    "'{name}': nobody of this record. An admin adds them: ulna record account NAME --sign-in …",
                    name=for_people(sign_in)[:80],
                )
            )
        _log("in", name, address, "by the provider")
        return name

    def person(self, name: str) -> Person | None:
        """By the record, which may be two seconds old; None: gone, or without an account."""
        now_s = time.monotonic()
        at_s, found = self._known.get(name, (-FRESH_S, None))
        if now_s - at_s >= FRESH_S:
            found = self._asked(name)
            if len(self._known) > 1000:
                self._known.clear()
            self._known[name] = now_s, found
        return found

    def has_password(self, name: str) -> bool:
        """Whether a password of theirs counts here."""
        account = self.accounts.all().get(name)
        return self._passwords and account is not None and account.password is not None

    def change_password(self, name: str, now: str, new: str, address: str) -> None:
        """By whoever knows the one that counts. Raises UlnaInputError."""
        self._by_password(name, now, address)
        self.accounts.set_password(name, new)
        _log("changed", name, address, "another password")

    def forget(self) -> None:
        """What was known of people: somebody changed it."""
        self._known.clear()

    def _asked(self, name: str) -> Person | None:
        roles = self._records.people().get(name)
        return Person(name, frozenset(roles)) if roles and name in self.accounts.all() else None

    def _by_password(self, name: str, password: str, address: str) -> str:
        if not self._passwords:
            raise NotLetInError(worded("way: got 'password'; expected the provider. Sign in there."))
        wait_s = self.throttle.wait_s(name, address)
        if wait_s > 0.0:
            _log("refused", name, address, f"must wait {wait_s:.0f} s")
            raise TooOftenError(worded("password: wrong too often. Try again in {wait} s.", wait=f"{wait_s:.0f}"))
        self.throttle.failed(name, address)  # counts while it is looked at, whoever tries many at a time
        try:
            good = self.accounts.right(name, password) and self.person(name) is not None
        except UlnaInputError:
            self.throttle.good(name, address)
            raise
        if not good:
            _log("refused", name, address, "wrong name or password")
            raise NotLetInError(
                worded("name and password: they do not go together, or nobody has that name. Try again.")
            )
        self.throttle.good(name, address)
        _log("in", name, address, "by a password")
        return name


def _log(what: str, name: str, address: str, how: str) -> None:
    LOG.info("sign-in %s: %s from %s, %s", what, for_people(name)[:80], address, how)

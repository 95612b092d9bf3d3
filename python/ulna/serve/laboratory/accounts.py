"""How people sign in: hashes of their passwords (argon2id, RFC 9106), and what a provider calls them.

They stand in a file of the bench folder that its owner alone may read, beside the record and not in it: an export of
the record, which others get, has none of it. Who may do what is the record's, and is not here.
"""

from __future__ import annotations

import json
import os
import secrets
import threading
from contextlib import suppress
from pathlib import Path
from typing import Literal

from pydantic import ValidationError

from ulna.formats.models import Strict
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded

ACCOUNTS = "accounts.json"
"""In a bench folder."""
FORMAT: Literal["ulna-accounts/1"] = "ulna-accounts/1"
SHORTEST, LONGEST = 12, 1000
"""Letters of a password."""
_AT_ONCE = 2
"""Passwords that are hashed at a time: each takes 64 MiB."""


class Account(Strict):
    """Of one name; what is None is not a way in."""

    password: str | None = None
    """Its hash, with how it was made."""
    sign_in: str | None = None
    """As the provider has it: an address, a name."""


class AccountsFile(Strict):
    """All of them."""

    format: Literal["ulna-accounts/1"]
    accounts: dict[str, Account]


class Accounts:
    """Of a bench folder. Every method raises UlnaInputError where the file cannot be used."""

    def __init__(self, folder: Path) -> None:
        from argon2 import PasswordHasher

        self._path = folder / ACCOUNTS
        self._hasher = PasswordHasher()
        self._room = threading.BoundedSemaphore(_AT_ONCE)
        self._writing = threading.Lock()
        self._read: tuple[tuple[int, int], dict[str, Account]] | None = None
        self._nobody = ""

    def all(self) -> dict[str, Account]:
        """By name. Read anew where the file is another one."""
        try:
            about = self._path.stat()
        except FileNotFoundError:
            return {}
        stamp = about.st_mtime_ns, about.st_ino
        read = self._read
        if read is None or read[0] != stamp:
            self._read = read = stamp, self._parsed()
        return read[1]

    def set_password(self, name: str, password: str) -> None:
        """Another one from now on."""
        if not SHORTEST <= len(password) <= LONGEST:
            raise UlnaInputError(
                worded(
                    "password: got {count} letters; expected {least} to {most}. Three or four words do.",
                    count=len(password),
                    least=SHORTEST,
                    most=LONGEST,
                )
            )
        if password.casefold().strip() == name.casefold():
            raise UlnaInputError(
                worded("password: it is the name; expected something that nobody guesses. Choose another.")
            )
        with self._room:
            made = self._hasher.hash(password)
        self._change(name, password=made)

    def set_sign_in(self, name: str, sign_in: str | None) -> None:
        """What the provider calls somebody; None: nothing any more."""
        if sign_in is not None:
            other = self.named(sign_in)
            if other not in (None, name):
                raise UlnaInputError(f"sign-in '{sign_in[:80]}': is {other}'s; expected one of its own. Correct it.")
        self._change(name, sign_in=sign_in)

    def remove(self, name: str) -> None:
        """Somebody signs in no more, in no way."""
        with self._writing:
            accounts = dict(self.all())
            if accounts.pop(name, None) is None:
                raise UlnaInputError(f"account '{name[:80]}': there is none; expected one. Correct the name.")
            self._write(accounts)

    def right(self, name: str, password: str) -> bool:
        """Whether it is theirs. It takes as long for a name that nobody has."""
        from argon2.exceptions import InvalidHashError, VerificationError

        account = self.all().get(name)
        stands = None if account is None else account.password
        with self._room:
            if not self._nobody:
                self._nobody = self._hasher.hash(secrets.token_urlsafe())
            try:
                self._hasher.verify(stands or self._nobody, password[: LONGEST + 1])
            except (VerificationError, InvalidHashError):
                return False
        if stands is not None and self._hasher.check_needs_rehash(stands) and len(password) >= SHORTEST:
            self.set_password(name, password)
        return stands is not None

    def named(self, sign_in: str) -> str | None:
        """Whom the provider calls so."""
        return next((name for name, each in self.all().items() if each.sign_in == sign_in), None)

    def _change(self, name: str, **what: str | None) -> None:
        with self._writing:
            accounts = dict(self.all())
            accounts[name] = accounts.get(name, Account()).model_copy(update=what)
            self._write(accounts)

    def _parsed(self) -> dict[str, Account]:
        try:
            return AccountsFile.model_validate_json(self._path.read_bytes()).accounts
        except (OSError, ValidationError):
            raise UlnaInputError(
                f"{self._path}: cannot be read as accounts ({FORMAT}); expected what ulna record account wrote. Put "
                "back a copy, or take it away and set passwords anew."
            ) from None

    def _write(self, accounts: dict[str, Account]) -> None:
        content = {
            "format": FORMAT,
            "accounts": {name: each.model_dump(exclude_none=True) for name, each in sorted(accounts.items())},
        }
        beside = self._path.with_name(f".{ACCOUNTS}.{secrets.token_hex(4)}")
        try:
            handle = os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
            with os.fdopen(handle, "wb") as file:
                file.write(json.dumps(content, indent=1, ensure_ascii=False).encode() + b"\n")
                file.flush()
                os.fsync(file.fileno())
            beside.replace(self._path)
        except OSError as error:
            with suppress(OSError):
                beside.unlink(missing_ok=True)
            raise UlnaInputError(f"{self._path}: cannot be written ({error.strerror}). Nothing was changed.") from None

"""What an admin should know of a laboratory's server before it serves."""

from __future__ import annotations

from collections.abc import Iterator

from ulna.ground.errors import UlnaInputError
from ulna.serve.laboratory.accounts import Accounts
from ulna.serve.laboratory.settings_file import Settings
from ulna.serve.workshop import Workshop


def remarks(workshop: Workshop, settings: Settings) -> Iterator[str]:
    """Sentences. Raises UlnaInputError where nobody could sign in."""
    record, file = workshop.records, settings.file
    accounts = Accounts(record.bench.folder).all()
    people = {name: roles for name, roles in record.people().items() if roles}
    able = [
        name
        for name, each in accounts.items()
        if name in people
        and ((file.sign_in.passwords and each.password) or (file.provider is not None and each.sign_in))
    ]
    if not able:
        raise UlnaInputError(
            f"{record.bench.folder}: nobody could sign in; expected one with a role and an account. For each: "
            "ulna record person NAME --role admin, ulna record account NAME."
        )
    if not any("admin" in people[name] for name in able):
        yield f"{record.bench.folder}: no admin can sign in. For one: ulna record person NAME --role admin."
    without = sorted(set(people) - set(able))
    if without:
        yield f"{record.bench.folder}: cannot sign in: {', '.join(without)}."
    if record.settings()["four-eyes"] != "yes":
        yield "Certificates need no second person here; for two: ulna record set four-eyes yes."

"""What a work reports beside what we find, and tables of it for a terminal of 80 columns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rich.table import Table

from ulna.ground.terminal import plain_table

FORMAT = "ulna-reproduction/1"


@dataclass(frozen=True)
class Claim:
    """A number of a work beside ours."""

    what: str
    paper: str
    """What the work reports, or that we do not know it."""
    ours: str
    agrees: bool | None
    """None: not asked. The work reports a limit of its own method, or nothing that we know of."""


def agrees(claim: Claim) -> str:
    """In a word; a dash where it is not asked."""
    return "–" if claim.agrees is None else "yes" if claim.agrees else "NO"


def claims_table(title: str, claims: Sequence[Claim], theirs: str = "the paper") -> Table:
    """What was asked, what the work reports, what we find, whether they agree."""
    table = plain_table(title)
    table.width = 80
    for head, share in (("what", 8), (theirs, 6), ("ours", 9)):
        table.add_column(head, ratio=share)
    table.add_column("agrees", no_wrap=True)
    for claim in claims:
        table.add_row(claim.what, claim.paper, claim.ours, agrees(claim))
    return table

"""What a profile asks to be touched, and the list that an operator follows."""

from __future__ import annotations

from ulna.verification.kinds.registry import kind_of
from ulna.verification.kinds.steps import Step
from ulna.verification.kinds.wanted import Wanted
from ulna.verification.profile_tables import ProfileFile


def steps_of(profile: ProfileFile) -> list[Step]:
    """Every touch, in order."""
    return [step for name, table in profile.test.items() for step in kind_of(table.kind).listed(name, table)]


def artefacts_of(profile: ProfileFile) -> list[Wanted]:
    """Everything that is touched, each once, balls before lengths."""
    wanted = {each.name: each for table in profile.test.values() for each in kind_of(table.kind).artefacts(table)}
    return sorted(wanted.values(), key=lambda each: each.RANK)

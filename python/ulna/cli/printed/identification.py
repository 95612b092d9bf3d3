"""What readings determine, in words: lost and weak directions with cause and remedy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import RenderableType
from rich.padding import Padding
from rich.text import Text

from ulna.arm.arm import Arm
from ulna.arm.directions import combination, sentence
from ulna.calibration.identify import Identification
from ulna.cli.printed.tables import heading, listed
from ulna.ground.digits import uncertainty


def identification_report(found: Identification, arm: Arm) -> list[RenderableType]:
    """All of `ulna identify`."""
    return [Text(f"{arm.name}, {arm.n} joints: {determined_in_words(found)}"), *directions(found)]


def determined_in_words(found: Identification) -> str:
    """One sentence with the counts."""
    if found.determined == found.parameters:
        return f"the readings determine all {found.parameters} free parameters."
    lost = found.parameters - found.determined
    return (
        f"the readings determine {found.determined} of {found.parameters} free parameters; "
        f"{lost} combination{' is' if lost == 1 else 's are'} lost."
    )


def directions(found: Identification) -> list[RenderableType]:
    """Lost directions, then weak ones; nothing where there are none."""
    parts: list[RenderableType] = []
    if found.lost:
        parts += ["", heading("Not determined")]
        parts.append(listed(_lost(direction) for direction in found.lost))
    if found.weak:
        parts += ["", heading("Determined, but worse than an arm is known from its drawing")]
        parts.append(listed(_weak(direction) for direction in found.weak))
    if found.from_prior:
        parts += ["", heading("Known from their priors; the readings say next to nothing of them")]
        parts.append(Padding(Text(", ".join(found.from_prior)), (0, 0, 0, 1)))
    return parts


def _lost(direction: Mapping[str, Any]) -> Sequence[str]:
    cause = cause_in_words(str(direction.get("cause", "")))
    frame = " No length or shape depends on it." if direction.get("frame") else ""
    return (
        f"{combination(direction['combination'])}{f'   ({cause})' if cause else ''}",
        f"Why: {sentence(direction['because'])}{frame}",
        f"Remedy: {sentence(direction['remedy'])}",
    )


def cause_in_words(key: str) -> str:
    """In the words of reports; a cause that a later core found has none yet."""
    from ulna.documents.languages.text import plain  # most arms lack nothing, and are not told why
    from ulna.documents.languages.words import Words

    english = Words("en")
    return plain(english(f"cause.{key}")) if key and english.has(f"cause.{key}") else key


def _weak(direction: Mapping[str, Any]) -> Sequence[str]:
    return (
        f"{combination(direction['combination'])}   (u = {uncertainty(direction['u'])} {direction['unit']})",
        f"Why: {sentence(direction['because'])}",
        f"Remedy: {sentence(direction['remedy'])}",
    )

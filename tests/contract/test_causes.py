"""What the core says of causes and remedies is known in Python, sentence by sentence, so that a page can say it."""

from __future__ import annotations

import re
from pathlib import Path

from ulna.arm.causes import SENTENCES, said_of
from ulna.ground.worded import Worded

SAID = re.compile(r'(?:because|remedy):\s*(?:format!\(\s*)?"((?:[^"\\]|\\.|\\\n)*)"')


def sentences_of_the_core(root: Path) -> set[str]:
    """As their sources have them, a hole for each value."""
    core = root / "crates" / "ulna" / "src"
    found = set()
    for path in (core / "identify" / "causes.rs", *sorted((core / "arm" / "effects").glob("*.rs"))):
        for text in SAID.findall(path.read_text(encoding="utf-8")):
            found.add(with_holes(re.sub(r"\\\n\s*", "", text).replace('\\"', '"')))
    return found


def with_holes(text: str) -> str:
    return re.sub(r"\{[^}]*\}", "{}", text)


def test_every_sentence_of_the_core_is_known(root: Path) -> None:
    core = sentences_of_the_core(root)
    known = {with_holes(each) for each in SENTENCES}
    assert len(core) > 20
    assert sorted(core - known) == []
    assert sorted(known - core) == []


def test_a_cause_of_the_core_has_its_values_again() -> None:
    found = said_of("take readings with joint 6 turned over its whole travel, or hold these parameters")
    assert isinstance(found, Worded)
    assert dict(found.values) == {"joint": "6"}
    twice = said_of(
        "take readings with probe bent (32 poses in one seat are enough once the arm is known), or hold probe.bent.*"
    )
    assert isinstance(twice, Worded)
    assert dict(twice.values) == {"probe": "bent"}
    assert said_of("whatever a later core says") == "whatever a later core says"

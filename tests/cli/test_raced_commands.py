"""Two processes write to one place at once: one wins, the other says so; with --force what stands is one's, whole.

ULNA_RACES: how many of each command, with and without --force; `python -m tests.cli.raced_commands` counts them.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator

import pytest
from tests.cli.raced_commands import RACED, Forks, Races, folder_for, raced

RACES = int(os.environ.get("ULNA_RACES", "3"))

pytestmark = pytest.mark.skipif(not hasattr(os, "fork") or sys.platform == "darwin", reason="forks processes")


@pytest.fixture(scope="module")
def forks(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Forks]:
    with Forks(folder_for(tmp_path_factory.mktemp("raced"))) as forks:
        yield forks


@pytest.mark.parametrize("force", [False, True], ids=["", "--force"])
@pytest.mark.parametrize("name", RACED)
def test_one_wins_and_the_other_says_so(forks: Forks, name: str, force: bool) -> None:
    found = raced(forks, name, force, RACES)
    assert found.wrong == []
    assert found.races == RACES


def test_what_is_lost_without_a_word_is_seen() -> None:
    races = object.__new__(Races)
    races.alone = [{"a": b"1", "b": b"1"}, {"a": b"2", "b": b"2"}]
    said = "error: out/a: exists already and is not overwritten."
    one, mixed = races.alone[0], {"a": b"1", "b": b"2"}
    for force, ends, standing, expected in (
        (False, [(0, ""), (2, said)], one, ""),
        (False, [(0, ""), (0, "")], one, "the other does not say so"),
        (False, [(0, ""), (2, "error: no memory")], one, "the other does not say so"),
        (False, [(2, said), (0, "")], one, "the winner was refused"),
        (False, [(0, ""), (2, said)], mixed, "['a', 'b'] is nobody's, or not whole"),
        (False, [(0, ""), (2, said)], {"a": b"1"}, "['a'] is nobody's, or not whole"),
        (True, [(0, ""), (0, "")], one, ""),
        (True, [(0, ""), (2, said)], one, "with --force both write"),
        (True, [(0, ""), (0, "")], mixed, "['a', 'b'] is nobody's, or not whole"),
    ):
        races.force, races.command = force, RACED["calibrate"]
        assert races._judged(ends, standing, {})[1] == expected
        assert races._judged(ends, standing, {"notes.txt": b""})[1] == "others' files are not as they were"

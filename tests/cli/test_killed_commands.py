"""Whole commands, killed for real before, at and after the call that brings a result to its place.

`python -m tests.cli.killed_commands` goes through every call of every command.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.cli import killed_commands
from tests.cli.faults import prepared
from tests.cli.killed_commands import COMMANDS, Bench, Target
from tests.real_parts import lacking

MOVES = ("rename", "renameat", "renameat2", "link", "linkat")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    if killed_commands.lacking_strace():
        lacking("strace that may look at other processes")
    return prepared(tmp_path_factory.mktemp("killed"))


def decisive(bench: Bench) -> list[Target]:
    """The last call that names both a staging place and the output, the one before it and the one after."""
    moves = [
        number
        for number, target in enumerate(bench.targets)
        if target.call in MOVES and f"/{bench.command.out}" in target.paths
    ]
    return bench.targets[moves[-1] - 1 : moves[-1] + 2]


@pytest.mark.long
@pytest.mark.parametrize("force", [False, True], ids=["", "--force"])
@pytest.mark.parametrize("name", ["calibrate", "certificate"])
def test_old_until_it_is_moved_and_new_from_then_on(folder: Path, name: str, force: bool) -> None:
    bench = Bench(folder, COMMANDS[name], force)
    assert [bench.kill(target) for target in decisive(bench)] == [("old", ""), ("old", ""), ("new", "")]


def test_what_is_neither_old_nor_new_is_seen() -> None:
    bench = object.__new__(Bench)
    bench.command = COMMANDS["batch"]
    bench.new = dict.fromkeys(("one/study/result.json", "one/study/arm.toml", "two/study/arm.toml", "batch.json"), b"2")
    old = dict.fromkeys(bench.new, b"1") | {"notes.txt": b"mine"}
    first = {name: b"2" for name in bench.new if name.startswith("one")}
    for standing, said in (
        (old, "old"),
        (old | bench.new, "new"),
        (old | first, "partly"),
        (old | {"one/study/arm.toml": b"2"}, "wrong"),
        (old | {"batch.json": b"2"}, "wrong"),
        (old | {"notes.txt": b""}, "wrong"),
        ({name: each for name, each in old.items() if name != "one/study/arm.toml"}, "wrong"),
        (old | {"left over": b""}, "wrong"),
    ):
        assert bench._judged(old, standing)[0] == said, standing

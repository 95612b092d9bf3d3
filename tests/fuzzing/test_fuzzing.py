"""A short run of the fuzzer, what it found before, and that it finds what is wrong."""

from __future__ import annotations

import datetime
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
from fuzzing.doors.json_files import JsonDoor
from fuzzing.doors.registry import DOORS
from fuzzing.doors.texts import TextDoor
from fuzzing.doors.toml_files import TomlDoor
from fuzzing.judging import judge
from fuzzing.room import Room, make_room
from fuzzing.trial import Trial
from fuzzing.watching import Worker, spread

from ulna.formats.tables.registry import FORMATS

FOSSILS = sorted((Path(__file__).parent / "fossils").glob("*.json"))
SEED = 1


@pytest.fixture(scope="module")
def room(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Room]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COLUMNS", "80")
        patch.setenv("TERM", "dumb")
        yield Room(make_room(tmp_path_factory.mktemp("fuzzing") / "room"))


@pytest.mark.parametrize("door", DOORS)
def test_a_short_run(door: str, room: Room, tmp_path: Path) -> None:
    """Whatever comes in is used, or refused in words."""
    found = {}
    for number in range(DOORS[door].short):
        wrong = judge(DOORS[door].trial(room, SEED, number), room, tmp_path, DOORS[door].seconds)
        if wrong is not None and not wrong.startswith("took"):  # no test is timed: make fuzz says it
            found[number] = wrong
    assert found == {}, f'python -m fuzzing --door "{door}" --seed {SEED} --only {next(iter(found))} shows it'


@pytest.mark.parametrize("path", FOSSILS, ids=[path.stem for path in FOSSILS])
def test_what_was_found_is_mended(path: Path, room: Room, tmp_path: Path) -> None:
    assert judge(Trial.from_json(path), room, tmp_path, 60.0) is None


def test_every_table_format_has_a_door() -> None:
    assert {f"table {each.name}" for each in FORMATS} <= set(DOORS)


def test_every_schema_has_a_door(root: Path, room: Room) -> None:
    """By the documents that doors begin with: each format is some document's."""
    begun = [name for door in DOORS.values() for name in getattr(door.make, "documents", ())]
    texts = b"".join(room.read(name)[:4000] for name in begun).decode("utf-8", "replace")
    formats = [path.stem for path in (root / "schemas").glob("*.json")]
    missing = [name for name in formats if f'"{name[:-2]}/{name[-1]}"' not in texts]
    assert missing == []


def test_inputs_are_the_same_for_a_seed(room: Room) -> None:
    for door in DOORS.values():
        assert door.trial(room, 5, 3) == door.trial(room, 5, 3)
        assert any(door.trial(room, 5, k) != door.trial(room, 6, k) for k in range(5)), door.name


def test_inputs_are_the_same_in_another_year(room: Room, monkeypatch: pytest.MonkeyPatch) -> None:
    """Libraries that write tables write the moment too."""
    doors = [door for name, door in DOORS.items() if name.startswith("table")]
    before = [[door.trial(room, 5, k) for k in range(12)] for door in doors]
    then = datetime.datetime(2031, 5, 6, 7, 8, 9, tzinfo=datetime.UTC)
    clock = SimpleNamespace(now=lambda tz=None: then)
    told = SimpleNamespace(datetime=clock, timezone=datetime.timezone)
    monkeypatch.setattr("openpyxl.writer.excel.datetime", told)
    monkeypatch.setattr("openpyxl.packaging.core.datetime", told)
    monkeypatch.setattr(time, "asctime", lambda *_: "Tue May  6 07:08:09 2031")
    monkeypatch.setattr(time, "localtime", lambda *_: then.timetuple())
    assert [[door.trial(room, 5, k) for k in range(12)] for door in doors] == before


def test_a_door_begins_with_what_is_good(room: Room, tmp_path: Path) -> None:
    """Each command takes one of the documents that it is given spoilt: else hostile inputs never get past the first
    check."""
    for name, door in DOORS.items():
        if not isinstance(door.make, TomlDoor | JsonDoor | TextDoor) or door.seconds > 60:
            continue
        for command in door.make.commands:
            ends = {}
            for document in dict.fromkeys(door.make.documents):
                words = [word.replace("{file}", document) for word in command.split()]
                ends[document] = judge(Trial(words), room, tmp_path, endings=(0, 1))
            assert None in ends.values(), (name, command, ends)


@pytest.mark.parametrize(
    ("body", "told"),
    [
        ("raise KeyError('x')", "exit 3: error: this is a fault of Ulna's"),
        ("raise ulna.ground.errors.UlnaInputError('polars says no')", "another's words ('polars')"),
        ("raise SystemExit(7)", "exit 7"),
        ("print('x: nan'); raise SystemExit(0)", "nan in what is printed"),
        ("import sys; print('\\x1b[31m', file=sys.stderr); raise SystemExit(0)", "control character"),
    ],
)
def test_what_is_wrong_is_seen(
    body: str, told: str, room: Room, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import ulna.calibration.identify
    import ulna.ground.errors

    def spoilt(*_: object) -> None:
        exec(body, {"ulna": ulna})

    monkeypatch.setattr(ulna.calibration.identify, "identify", spoilt)
    found = judge(Trial(["identify", "made/study.toml"]), room, tmp_path)
    assert found is not None
    assert told in found


def test_a_fossil_is_read_as_it_was_written(tmp_path: Path) -> None:
    trial = Trial(["measure", "é"], {"a.csv": b"q1\n\xff", "b.toml": "ä = 1".encode()})
    (tmp_path / "x.json").write_text(trial.to_json("table CSV", "nothing"))
    assert Trial.from_json(tmp_path / "x.json") == trial


def test_a_room_is_as_it_was(room: Room, tmp_path: Path) -> None:
    before = {path: path.read_bytes() for path in room.folder.rglob("*") if path.is_file()}
    for door in ("arm", "result kept by batch", "table CSV", "study calibrated"):
        judge(DOORS[door].trial(room, 2, 1), room, tmp_path)
    assert {path: path.read_bytes() for path in room.folder.rglob("*") if path.is_file()} == before


def test_a_worker_that_dies_is_made_anew(room: Room, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FUZZING_KILLS", "arm 1")
    worker = Worker(room.folder, SEED)
    try:
        assert worker.put("arm", 0) is None
        assert worker.put("arm", 1) == "killed by SIGSEGV"
        assert worker.put("arm", 2) is None
    finally:
        worker.close()


def test_doors_take_turns() -> None:
    taken = list(spread({"a": 10, "b": 4}, 5, 12))
    assert taken[:11] == [*(("a", k) for k in range(5, 15)), ("b", 5)]
    assert len(taken) == len(set(taken)) == 24

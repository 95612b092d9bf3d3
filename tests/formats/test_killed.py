"""Whoever writes is killed at every change of the disk, or meets another who writes.

What stands is whole, and nobody's work is gone without a word.
"""

from __future__ import annotations

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from ulna.formats import arriving, moving
from ulna.formats.output import new_file, output_folder, write_file
from ulna.formats.toml import sha256
from ulna.ground.errors import UlnaInputError

NAMES = ("result.json", "arm.toml", "residuals.csv")
KILLED = Path(__file__).with_name("killed.py")
MOST = 60
"""Changes of the disk of which one run certainly has fewer."""


def run(number: int, place: Path, content: str, *more: str) -> bool:
    """Whether it was killed at this change."""
    done = subprocess.run(
        [sys.executable, str(KILLED), str(number), str(place), content, *more],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == -9 or done.stdout == "done\n", done.stderr
    return done.returncode == -9


def standing(folder: Path) -> dict[str, str]:
    """What a reader sees: hidden staging places apart."""
    if not folder.is_dir():
        return {}
    return {path.name: path.read_text()[:1] for path in folder.iterdir() if not path.name.startswith(".")}


@pytest.mark.parametrize("beside", [{}, {"notes.txt": "m"}], ids=["alone", "beside a file"])
@pytest.mark.parametrize("before", [False, True], ids=["new", "over an earlier one"])
def test_killed_at_any_change_the_old_or_the_new_stands_whole(
    tmp_path: Path, before: bool, beside: dict[str, str]
) -> None:
    for number in range(1, MOST):
        out = tmp_path / str(number) / "out"
        out.parent.mkdir()
        for name, text in beside.items():
            out.mkdir(exist_ok=True)
            (out / name).write_text(text)
        if before:
            with output_folder(out, NAMES) as staging:
                for name in NAMES:
                    (staging / name).write_text("1" * 1000)
        old = standing(out)
        killed = run(number, out, "2", *(["--force"] if before else []))
        new = dict.fromkeys(NAMES, "2") | beside
        assert standing(out) in (old, new), number
        for name in NAMES:
            assert not (out / name).exists() or len((out / name).read_text()) == 1000
        if not killed:
            assert standing(out) == new
            assert number >= 6
            return
    pytest.fail("it never came to its end")


@pytest.mark.parametrize("before", [False, True], ids=["new", "over an earlier one"])
def test_of_one_file_too(tmp_path: Path, before: bool) -> None:
    for number in range(1, MOST):
        path = tmp_path / str(number) / "points.csv"
        path.parent.mkdir()
        if before:
            path.write_text("1" * 1000)
        killed = run(number, path, "2", "--file", *(["--force"] if before else []))
        there = path.read_text() if path.exists() else ""
        assert there in ("1" * 1000 if before else "", "2" * 1000)
        if not killed:
            assert there == "2" * 1000
            return
    pytest.fail("it never came to its end")


def test_of_two_writers_to_one_place_one_wins_and_the_other_says_so(tmp_path: Path) -> None:
    """Threads that all begin before any ends; nobody says --force."""

    def folder(name: str, place: Path) -> str:
        try:
            with output_folder(place, NAMES) as staging:
                for each in NAMES:
                    (staging / each).write_text(name)
        except UlnaInputError as error:
            return "refused" if "exists already and is not overwritten" in str(error) else str(error)
        return name

    def file(name: str, place: Path) -> str:
        try:
            write_file(place, name)
        except UlnaInputError as error:
            return "refused" if "exists already and is not overwritten" in str(error) else str(error)
        return name

    with ThreadPoolExecutor(4) as pool:
        for number in range(250):
            place = tmp_path / f"f{number}"
            if number % 2:  # a folder that is there already, with somebody's notes in it
                place.mkdir()
                (place / "notes.txt").write_text("m")
            said = [each for each in pool.map(folder, "abcd", [place] * 4) if each != "refused"]
            assert len(said) == 1
            assert {(place / name).read_text() for name in NAMES} == set(said)
            assert not number % 2 or (place / "notes.txt").read_text() == "m"
            path = tmp_path / f"p{number}"
            said = [each for each in pool.map(file, "abcd", [path] * 4) if each != "refused"]
            assert said == [path.read_text()]


def test_what_somebody_writes_meanwhile_is_not_overwritten(tmp_path: Path) -> None:
    out = tmp_path / "out"

    def write_late() -> None:
        with output_folder(out, NAMES) as staging:
            for name in NAMES:
                (staging / name).write_text("2")
            out.mkdir(exist_ok=True)
            (out / "arm.toml").write_text("theirs")

    for _ in range(2):  # a folder that was not there, and one that was
        with pytest.raises(UlnaInputError, match="another program wrote it meanwhile"):
            write_late()
        assert standing(out) == {"arm.toml": "t"}
        (out / "arm.toml").unlink()


def test_what_somebody_writes_beside_it_meanwhile_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As editors do it: a new file takes the old one's name, just before the folders change places."""
    out = tmp_path / "out"
    out.mkdir()
    (out / "notes.txt").write_text("old")
    swap = arriving.swap

    def late(one: Path, other: Path) -> bool:
        (tmp_path / "edited").write_text("new")
        (tmp_path / "edited").replace(out / "notes.txt")
        (out / "more.txt").write_text("more")
        return swap(one, other)

    monkeypatch.setattr(arriving, "swap", late)
    with output_folder(out, NAMES) as staging:
        for name in NAMES:
            (staging / name).write_text("2")
    assert standing(out) == dict.fromkeys(NAMES, "2") | {"notes.txt": "n", "more.txt": "m"}


@pytest.mark.parametrize("swaps", [True, False])
@pytest.mark.parametrize("meanwhile", ["rewritten", "a link", "gone", "nothing"])
def test_only_what_was_known_is_replaced(
    tmp_path: Path, meanwhile: str, swaps: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not swaps:
        monkeypatch.setattr(moving, "_call", lambda: None)
    path, other = tmp_path / "list.json", tmp_path / "other"
    path.write_text("1")
    other.write_text("1")

    def write() -> None:
        with new_file(path, instead_of=sha256(b"1")) as staged:
            staged.write_text("2")
            if meanwhile == "rewritten":
                path.write_text("theirs")
            if meanwhile in ("a link", "gone"):
                path.unlink()
            if meanwhile == "a link":
                path.symlink_to(other)

    if meanwhile in ("gone", "nothing"):
        write()
        assert path.read_text() == "2"
    else:
        with pytest.raises(UlnaInputError, match="another program wrote it meanwhile"):
            write()
        assert path.read_text() == ("theirs" if meanwhile == "rewritten" else "1")
        assert path.is_symlink() == (meanwhile == "a link")
    assert other.read_text() == "1"
    assert {each.name for each in tmp_path.iterdir()} == {"list.json", "other"}


def test_nobody_waits_for_ever_for_a_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Somebody else's lock stays taken."""
    monkeypatch.setattr(moving, "PATIENCE_S", 0.05)
    with moving.alone(tmp_path):
        write_file(tmp_path / "a.txt", "1")
    assert (tmp_path / "a.txt").read_text() == "1"


def test_where_nobody_may_write_beside_a_folder_it_is_written_into_it(tmp_path: Path) -> None:
    """A mount point, a folder in another's: the staging place is inside."""
    out = tmp_path / "theirs" / "out"
    (out / "kept").mkdir(parents=True)
    link = tmp_path / "link"
    link.symlink_to(out)
    for place in (out, link):
        with output_folder(place, NAMES, force=True) as staging:
            for name in NAMES:
                (staging / name).write_text("2")
        assert standing_files(out) == dict.fromkeys(NAMES, "2")
        assert (out / "kept").is_dir()
        assert link.is_symlink()


def standing_files(folder: Path) -> dict[str, str]:
    return {path.name: path.read_text()[:1] for path in folder.iterdir() if path.is_file()}

"""An output folder is written whole or not at all, and nothing is overwritten unasked."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from ulna import UlnaInputError
from ulna.formats import arriving
from ulna.formats.output import check_output, new_file, output_folder, write_file

NAMES = ("result.json", "arm.toml")


def _write(folder: Path, text: str, force: bool = False) -> None:
    with output_folder(folder, NAMES, force=force) as staging:
        for name in NAMES:
            (staging / name).write_text(text)


def _all(folder: Path) -> dict[str, str]:
    return {str(path.relative_to(folder)): path.read_text() for path in folder.rglob("*") if path.is_file()}


def test_a_new_folder_appears_with_everything(tmp_path: Path) -> None:
    _write(tmp_path / "a" / "out", "1")
    assert _all(tmp_path) == {"a/out/result.json": "1", "a/out/arm.toml": "1"}
    assert (tmp_path / "a" / "out").stat().st_mode & 0o777 == 0o777 & ~_umask()


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


@pytest.mark.parametrize("stop", [RuntimeError, KeyboardInterrupt, UlnaInputError])
def test_what_stops_half_way_leaves_nothing(tmp_path: Path, stop: type[BaseException]) -> None:
    def interrupted() -> None:
        with output_folder(tmp_path / "out", NAMES) as staging:
            (staging / "arm.toml").write_text("half")
            raise stop

    with pytest.raises(stop):
        interrupted()
    assert list(tmp_path.iterdir()) == []


def test_a_forgotten_file_is_noticed(tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match=r"result\.json"), output_folder(tmp_path / "out", NAMES) as staging:
        (staging / "arm.toml").write_text("1")
    assert list(tmp_path.iterdir()) == []


def test_results_are_not_overwritten_without_force_and_other_files_stay(tmp_path: Path) -> None:
    out = tmp_path / "out"
    _write(out, "1")
    (out / "notes.txt").write_text("mine")
    with pytest.raises(UlnaInputError, match=r"result.json: exists already and is not overwritten.*--force"):
        _write(out, "2")
    assert _all(out) == {"result.json": "1", "arm.toml": "1", "notes.txt": "mine"}
    _write(out, "2", force=True)
    assert _all(out) == {"result.json": "2", "arm.toml": "2", "notes.txt": "mine"}
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_a_failed_move_brings_back_what_was_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = tmp_path / "out"
    _write(out, "1")
    move = Path.replace

    def full(source: Path, target: Path) -> Path:
        if source.name == "arm.toml" and target.parent == out and source.read_text() == "2":
            raise OSError(28, "No space left on device")
        return move(source, target)

    monkeypatch.setattr(Path, "replace", full)
    monkeypatch.setattr(arriving, "swap", lambda *_: False)  # a disk that cannot: files go one by one
    with pytest.raises(UlnaInputError, match=r"cannot be written \(No space left on device\)"):
        _write(out, "2", force=True)
    assert _all(tmp_path) == {"out/result.json": "1", "out/arm.toml": "1"}


@pytest.mark.parametrize("name", ["../result.json", "a/b", "/etc/passwd", "..", ""])
def test_a_result_name_must_stay_in_its_folder(tmp_path: Path, name: str) -> None:
    with pytest.raises(UlnaInputError, match="leaves the folder"):
        check_output(tmp_path / "out", [name])


def test_a_file_where_a_folder_goes_and_the_reverse(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    with pytest.raises(UlnaInputError, match="this is a file; expected an output folder"):
        _write(tmp_path / "file", "1")
    with pytest.raises(UlnaInputError, match="cannot be written"):
        _write(tmp_path / "file" / "out", "1")
    (tmp_path / "out" / "arm.toml").mkdir(parents=True)
    with pytest.raises(UlnaInputError, match="a folder stands where a result goes"):
        _write(tmp_path / "out", "1", force=True)
    with pytest.raises(UlnaInputError, match="this is a folder"):
        write_file(tmp_path / "out", "1")


def test_one_file(tmp_path: Path) -> None:
    path = tmp_path / "new" / "points.csv"
    write_file(path, "1")
    with pytest.raises(UlnaInputError, match=r"points\.csv: exists already"):
        write_file(path, "2")
    with pytest.raises(KeyboardInterrupt), new_file(path, force=True) as staged:  # noqa: PT012
        staged.write_text("half")
        raise KeyboardInterrupt
    assert _all(tmp_path) == {"new/points.csv": "1"}
    write_file(path, b"2", force=True)
    assert _all(tmp_path) == {"new/points.csv": "2"}

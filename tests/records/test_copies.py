"""What comes from elsewhere is looked at whole before anything is made of it; nothing leaves its folder."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest
from sqlalchemy import select

from ulna import UlnaInputError
from ulna.records.records import Records
from ulna.records.tables import FILE


@pytest.fixture
def archive(tmp_path: Path) -> Path:
    """An export of a small record."""
    records = Records.init(tmp_path / "bench", by="Jan")
    records.register("P7")
    (tmp_path / "note.txt").write_text("a note")
    records.add(tmp_path / "note.txt", arm="P7")
    return records.export(tmp_path / "bench.zip").path


def members(path: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(path) as opened:
        return {name: opened.read(name) for name in opened.namelist()}


def written(path: Path, content: dict[str, bytes]) -> Path:
    with zipfile.ZipFile(path, "w") as made:
        for name, each in content.items():
            made.writestr(name, each)
    return path


def refused(path: Path, folder: Path, match: str) -> None:
    with pytest.raises(UlnaInputError, match=match):
        Records.from_export(path, folder)
    assert not folder.exists()


@pytest.mark.parametrize(
    "name",
    [
        "../escaped",
        "/etc/escaped",
        "objects/../../escaped",
        "objects/ab/../../../escaped",
        "C:\\escaped",
        "objects/ab/ab",
    ],
)
def test_names_that_climb_are_refused(archive: Path, tmp_path: Path, name: str) -> None:
    content = members(archive) | {name: b"x"}
    refused(written(tmp_path / "bad.zip", content), tmp_path / "new", "none of a record")
    assert not list(tmp_path.rglob("escaped"))


def test_any_changed_byte_is_refused(archive: Path, tmp_path: Path) -> None:
    for name, content in members(archive).items():
        if name != "manifest.json":
            bad = members(archive) | {name: content[:-1] + bytes([content[-1] ^ 1])}
            refused(written(tmp_path / "bad.zip", bad), tmp_path / "new", "not what its name says")


def test_any_missing_member_is_refused(archive: Path, tmp_path: Path) -> None:
    for name in members(archive):
        bad = members(archive)
        del bad[name]
        refused(written(tmp_path / "bad.zip", bad), tmp_path / "new", "not in it|not there|not end|no manifest")


@pytest.mark.parametrize("content", [b"", b"no zip", b"PK\x03\x04" + b"\0" * 100])
def test_what_is_no_zip_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "bad.zip").write_bytes(content)
    refused(tmp_path / "bad.zip", tmp_path / "new", "no zip of a record")


def test_a_bomb_is_refused(archive: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "bomb.zip", "w", zipfile.ZIP_DEFLATED) as made:
        for name, each in members(archive).items():
            made.writestr(name, each)
        made.writestr(f"objects/00/00{'0' * 62}", b"\0" * (200 << 20))
    refused(tmp_path / "bomb.zip", tmp_path / "new", "would take")


def test_a_place_with_something_in_it_is_refused(archive: Path, tmp_path: Path) -> None:
    (tmp_path / "new").mkdir()
    (tmp_path / "new" / "mine").write_text("mine")
    with pytest.raises(UlnaInputError, match="there is something already"):
        Records.from_export(archive, tmp_path / "new")
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["mine"]


def test_nothing_is_imported_into_a_record(archive: Path, tmp_path: Path) -> None:
    records = Records.init(tmp_path / "here", by="Jan")
    records.register("P7")
    before = records.verify()
    with pytest.raises(UlnaInputError, match=r"here: is a record already; .*joins none.* ulna record add FILE"):
        Records.from_export(archive, tmp_path / "here")
    assert records.verify() == before


def test_what_one_record_lacks_is_written_out_of_another(archive: Path, tmp_path: Path) -> None:
    """As the docs say it."""
    theirs = Records.from_export(archive, tmp_path / "theirs")
    ours = Records.init(tmp_path / "ours", by="Erika")
    ours.register("P7")
    with theirs.bench.reading() as connection:
        (sha256,) = connection.scalars(select(FILE.c.sha256))
    (tmp_path / "again.txt").write_bytes(theirs.content(sha256))
    assert ours.add(tmp_path / "again.txt", arm="P7")[0].sha256 == sha256


def test_a_backup_is_made_once_and_read_again(tmp_path: Path) -> None:
    records = Records.init(tmp_path / "bench", by="Jan")
    records.register("P7")
    first = records.backup(tmp_path / "backups")
    assert records.backup(tmp_path / "backups") == first
    records.register("P8")
    assert records.backup(tmp_path / "backups").path != first.path
    first.path.write_bytes(first.path.read_bytes()[:-40])
    assert Records.from_export(records.backup(tmp_path / "backups").path, tmp_path / "new").verify().good

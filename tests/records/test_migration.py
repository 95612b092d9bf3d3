"""A record of any released schema opens, migrates and is whole; a migration keeps triggers, and is done or not done."""

from __future__ import annotations

import os
import random
import shutil
import signal
import time
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from sqlalchemy import inspect
from tests.records.benches import ROOT

from ulna import UlnaInputError
from ulna.records import schema, triggers
from ulna.records.bench import Bench
from ulna.records.rebuild import index_anew
from ulna.records.records import Records
from ulna.records.schema import NEWEST, schema_of, upgrade
from ulna.records.tables import METADATA

FOSSILS = sorted((ROOT / "tests" / "data" / "fossils").glob("record-r*.zip"))
NEXT = '''"""A next schema, as a migration of SQLite would be: the table is copied."""
import sqlalchemy as sa
from alembic import op
revision = "r9999"
down_revision = "r0001"
branch_labels = None
depends_on = None
def upgrade():
    for table in ("figure", "entry", "event"):
        with op.batch_alter_table(table, recreate="always") as batch:
            batch.add_column(sa.Column("later", sa.Text()))
'''


@pytest.fixture
def versions(tmp_path: Path) -> Path:
    """Today's migrations, and one of tomorrow."""
    folder = tmp_path / "versions"
    folder.mkdir()
    for path in (ROOT / "python/ulna/records/migrations/versions").glob("r*.py"):
        shutil.copy(path, folder)
    (folder / "r9999_next.py").write_text(NEXT)
    return folder


def test_there_is_a_fossil_of_every_schema() -> None:
    made = {path.name.split("_")[0] for path in (ROOT / "python/ulna/records/migrations/versions").glob("r*.py")}
    assert {path.stem.removeprefix("record-") for path in FOSSILS} == made
    assert max(made) == NEWEST


@pytest.mark.parametrize("fossil", FOSSILS, ids=lambda path: path.stem)
def test_a_fossil_migrates_and_is_whole(fossil: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(fossil) as archive:
        archive.extractall(tmp_path / "bench")
    records = Records(Bench(tmp_path / "bench"))
    copied = records.migrate(tmp_path / "backups")
    assert (copied is None) == (fossil.stem == f"record-{NEWEST}")
    found = records.verify()
    assert found.wrong == []
    assert records.history("fossil")
    again = Records.from_export(records.export(tmp_path / "out.zip").path, tmp_path / "again")
    assert again.verify().head == found.head


def test_the_models_are_what_the_migrations_make(records: Records) -> None:
    with records.bench.reading() as connection:
        looked = inspect(connection)
        for table in METADATA.sorted_tables:
            found = {column["name"]: column["nullable"] for column in looked.get_columns(table.name)}
            keys = set(table.primary_key.columns.keys())
            assert set(found) == set(table.columns.keys())
            assert {n: null for n, null in found.items() if n not in keys} == {
                column.name: column.nullable for column in table.columns if column.name not in keys
            }
            made = {tuple(index["column_names"]) for index in looked.get_indexes(table.name)}
            assert {tuple(index.columns.keys()) for index in table.indexes} <= made


def test_a_migration_keeps_triggers(records: Records, versions: Path) -> None:
    with records.bench.database.writing() as connection:
        upgrade(connection, versions)
        assert schema_of(connection) == "r9999"
        assert triggers.missing(connection, METADATA.tables) == []


def test_another_schema_is_refused_and_named(
    records: Records, versions: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(schema, "NEWEST", "r9999")
    with pytest.raises(UlnaInputError, match=r"has schema r0001.*ulna record migrate"):
        Records.open(records.bench.folder)
    monkeypatch.setattr(schema, "NEWEST", "r0000")
    with pytest.raises(UlnaInputError, match="which this Ulna does not know"):
        Records.open(records.bench.folder)
    with pytest.raises(UlnaInputError, match="which this Ulna does not know"):
        Records(records.bench).migrate(tmp_path / "backups")


@pytest.mark.slow
def test_killed_while_it_migrates(tmp_path: Path, database: Callable[[], str | None], versions: Path) -> None:
    """A program of its own for the kills, as the tests' own process has threads."""
    import subprocess
    import sys

    times = int(os.environ.get("ULNA_KILLS", "4"))
    rng = random.Random(5)
    for k in range(times):
        records = Records.init(tmp_path / f"bench {k}", database(), by="Jan")
        for number in range(10):
            records.register(f"P{number}")
        before = records.verify()
        child = subprocess.Popen(
            [sys.executable, "-m", "tests.records.migrating", str(records.bench.folder), str(versions)],
            cwd=ROOT,
            stdout=subprocess.PIPE,
        )
        assert child.stdout is not None
        child.stdout.readline()  # it is about to begin
        time.sleep(rng.uniform(0.0, 0.15))
        child.send_signal(signal.SIGKILL)
        child.wait()
        child.stdout.close()
        bench = records.bench
        with bench.database.writing() as connection:
            assert schema_of(connection) in (NEWEST, "r9999")
            assert triggers.missing(connection, METADATA.tables) == []
            if schema_of(connection) == NEWEST:
                upgrade(connection, versions)
            index_anew(connection, bench.files)
        assert records.rebuild() == before.entries
        assert records.verify() == before

"""Whoever changes a record behind Ulna's back is found out: any row, any file, any link."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import Boolean, Connection, Double, Integer, Table, delete, insert, select, text, update
from sqlalchemy.exc import DBAPIError
from tests.records.benches import verification

from ulna.records import triggers
from ulna.records.chain import row_of
from ulna.records.entry import Entry
from ulna.records.records import Records
from ulna.records.tables import ENTRY, FIGURE, INDEX, METADATA


@pytest.fixture
def full(records: Records, tmp_path: Path) -> Records:
    """With a row in every table that has any so far."""
    records.register("probe 1", "probe", part_of="P7")
    records.person("Erika", ["reviewer"])
    records.set("four-eyes", "yes")
    records.add(verification(tmp_path / "v.json", 1.0, "pass"), arm="P7")
    return records


class Tamperer:
    """An administrator, who can take triggers away and put them back."""

    def __init__(self, records: Records) -> None:
        self.records = records

    def do(self, *statements: Any) -> None:
        """Behind Ulna's back."""
        tables = list(METADATA.tables)
        with self.records.bench.database.writing() as connection:
            triggers.unguard(connection, tables)
            for statement in statements:
                connection.execute(statement)
            triggers.guard(connection, tables)

    def wrong(self) -> list[str]:
        """What verify says."""
        return self.records.verify().wrong


def some_row(table: Table) -> dict[str, Any]:
    """A row that a table takes."""
    values = {Integer: 9999, Double: 1.0, Boolean: True}
    return {
        column.name: next((value for kind, value in values.items() if isinstance(column.type, kind)), "x")
        for column in table.columns
    }


def test_the_database_itself_refuses(full: Records) -> None:
    for table in METADATA.sorted_tables:
        column = next(iter(table.columns))
        for change in (update(table).values({column.name: 99}), delete(table)):
            with full.bench.database.engine.connect() as connection:
                connection.execute(text("BEGIN"))
                connection.execute(insert(table).values(some_row(table)))
                with pytest.raises(DBAPIError, match="only grows"):
                    connection.execute(change)
                connection.execute(text("ROLLBACK"))


def changed(row: dict[str, Any], table: Table, name: str) -> Any:
    """Another value of the same kind."""
    kind, value = table.columns[name].type, row[name]
    if isinstance(kind, Boolean):
        return not value
    if isinstance(kind, Double | Integer):
        return 1.0 if value is None else value * (1 + 1e-15) + 1e-300 if value != value * (1 + 1e-15) else value + 1
    return f"{value or ''}'"


def first_rows(records: Records) -> dict[Table, dict[str, Any]]:
    """Of every table that has rows."""
    with records.bench.reading() as connection:
        found = {table: connection.execute(select(table)).first() for table in INDEX}
    return {table: dict(row._mapping) for table, row in found.items() if row is not None}


def here(table: Table, row: dict[str, Any]) -> Any:
    return (table.c.seq == row["seq"]) & (table.c.line == row["line"])


def test_any_changed_value_of_any_table_is_named(full: Records) -> None:
    tamperer, rows = Tamperer(full), first_rows(full)
    columns = {table: [name for name in row if name not in ("seq", "line")] for table, row in rows.items()}
    for k in range(max(map(len, columns.values()))):
        hit = {table: names[k] for table, names in columns.items() if k < len(names)}
        tamperer.do(
            *(
                update(table).where(here(table, rows[table])).values({name: changed(rows[table], table, name)})
                for table, name in hit.items()
            )
        )
        wrong = tamperer.wrong()
        assert len(wrong) == len(hit)
        for table, name in hit.items():
            row = rows[table]
            start = f"table {table.name}, row {row['seq']}.{row['line']} was changed: {name} not"
            assert any(each.startswith(start) for each in wrong), (start, wrong)
        tamperer.do(
            *(
                update(table).where(here(table, rows[table])).values({name: rows[table][name]})
                for table, name in hit.items()
            )
        )
    assert tamperer.wrong() == []


def test_any_deleted_row_is_named(full: Records) -> None:
    rows = first_rows(full)
    Tamperer(full).do(*(delete(table).where(here(table, row)) for table, row in rows.items()))
    wrong = Tamperer(full).wrong()
    assert len(wrong) == len(rows)
    for table, row in rows.items():
        assert f"table {table.name}, row {row['seq']}.{row['line']} is not there: it was deleted" in wrong


def test_an_added_row_is_named(full: Records) -> None:
    with full.bench.reading() as connection:
        row = dict(connection.execute(select(FIGURE)).first()._mapping)  # type: ignore[union-attr]
    Tamperer(full).do(insert(FIGURE).values(row | {"line": 999}))
    (said,) = Tamperer(full).wrong()
    assert "row" in said
    assert "was added" in said


def test_a_missing_trigger_is_named(full: Records) -> None:
    with full.bench.database.writing() as connection:
        triggers.unguard(connection, ["figure"])
    assert [each.split(":")[0] for each in full.verify().wrong] == [
        "trigger figure_no_update is not there",
        "trigger figure_no_delete is not there",
    ]


def main_file(records: Records) -> Path:
    return records.bench.files.place(records.calibrations("P7")[0]["sha256"])


def test_a_changed_file_is_named(full: Records) -> None:
    place = main_file(full)
    place.chmod(0o644)
    place.write_bytes(place.read_bytes().replace(b"0", b"1", 1))
    assert any(place.name in each and "was changed" in each for each in full.verify().wrong)


def test_swapped_files_are_named(full: Records) -> None:
    one, other = (full.bench.files.place(name) for name in list(full.bench.files.names())[:2])
    content = one.read_bytes()
    one.unlink()
    one.write_bytes(other.read_bytes())
    other.unlink()
    other.write_bytes(content)
    wrong = full.verify().wrong
    assert any(one.name in each for each in wrong)
    assert any(other.name in each for each in wrong)


def test_a_lost_file_is_named(full: Records) -> None:
    place = main_file(full)
    place.unlink()
    assert any(place.name in each and "is not there" in each for each in full.verify().wrong)


def entries(connection: Connection) -> list[Entry]:
    return [Entry.of_text(said) for said in connection.scalars(select(ENTRY.c.text).order_by(ENTRY.c.seq))]


def test_a_changed_entry_is_named(full: Records) -> None:
    tamperer = Tamperer(full)
    for column in ("at", "actor", "act", "subject", "previous", "sha256", "text"):
        with full.bench.reading() as connection:
            before = connection.scalar(select(ENTRY.c[column]).where(ENTRY.c.seq == 4))
        tamperer.do(update(ENTRY).where(ENTRY.c.seq == 4).values({column: f"{before}'"}))
        assert any(each.startswith("entry 4 ") for each in tamperer.wrong()), column
        tamperer.do(update(ENTRY).where(ENTRY.c.seq == 4).values({column: before}))
    assert tamperer.wrong() == []


def test_a_deleted_entry_is_named(full: Records) -> None:
    Tamperer(full).do(delete(ENTRY).where(ENTRY.c.seq == 4))
    wrong = Tamperer(full).wrong()
    assert any(each.startswith("entry 4 is not there") for each in wrong)
    assert any("is of no entry in the chain (entry 4: event P7" in each for each in wrong)


def relinked(records: Records, without: int) -> list[Entry]:
    """The chain without one entry, every hash after it made anew."""
    with records.bench.reading() as connection:
        kept = [entry for entry in entries(connection) if entry.seq != without]
    made: list[Entry] = []
    for seq, entry in enumerate(kept, start=1):
        previous = made[-1].sha256 if made else ""
        made.append(Entry(seq, entry.at, entry.actor, entry.act, entry.subject, entry.stated, entry.files, previous))
    return made


def test_a_chain_that_was_cut_and_linked_anew_is_named(full: Records) -> None:
    """Its entry, rows and links all made to agree: the files of the old entries tell; where these were taken away too,
    a head that was noted elsewhere does."""
    noted = full.verify().head
    chain = relinked(full, without=4)
    tamperer, bench = Tamperer(full), full.bench
    with bench.reading() as connection:
        old = entries(connection)
    tamperer.do(
        *(delete(table) for table in METADATA.sorted_tables),
        *(insert(ENTRY).values(row_of(entry)) for entry in chain),
    )
    from ulna.records.rebuild import index_anew

    with bench.database.writing() as connection:
        index_anew(connection, bench.files)
    for entry in chain:
        bench.links.put(entry.text.encode())
    assert any("is of no entry in the chain (entry 4: event P7" in each for each in tamperer.wrong())
    for entry in old[3:]:
        bench.links.place(entry.sha256).unlink()
    assert full.verify().good  # nothing within the bench tells any more
    (said,) = full.verify([noted]).wrong
    assert said.startswith(f"head {noted[:20]}")


def test_an_entry_that_was_dated_back_is_named(full: Records) -> None:
    with full.bench.reading() as connection:
        seq, previous = len(entries(connection)), entries(connection)[-1].sha256
    forged = Entry(seq + 1, "2020-01-01T00:00:00+00:00", "x", "person", "x", {"roles": []}, {}, previous)
    from ulna.records.chain import take

    with full.bench.database.writing() as connection:
        take(connection, full.bench.files, forged)
    full.bench.links.put(forged.text.encode())
    (said,) = full.verify().wrong
    assert "is dated 2020-01-01" in said


def links_of(records: Records) -> list[Path]:
    """The files of the entries, in order."""
    with records.bench.reading() as connection:
        return [records.bench.links.place(entry.sha256) for entry in entries(connection)]


def test_files_of_the_newest_entries_may_lack_after_a_cut_and_are_made(full: Records) -> None:
    full.event("P7", "quarantine", "two entries in one write")
    *_, last_but_one, last = links_of(full)
    for each in (last_but_one, last):
        each.unlink()
    found = full.verify()
    assert found.wrong == []
    assert any(each.startswith("2 of the newest entries without a file") for each in found.remarks)
    full.event("P7", "release", "the next write")
    assert full.verify().remarks == []
    assert last_but_one.exists()


def test_any_other_file_of_an_entry_that_lacks_is_named(full: Records) -> None:
    links = links_of(full)
    links[2].unlink()
    assert full.verify().wrong == ["entry 3 has no file in the chain's folder"]
    for each in links:
        each.unlink(missing_ok=True)
    assert len(full.verify().wrong) == len(links)

"""A file is brought: a workbook in German as somebody keeps it becomes a study, the same that `ulna new` writes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from tests.cli_runs import run
from tests.home_built import COUNTS, GERMAN, LENGTH_MM, ROWS, Kept, measured, text, workbook
from tests.serve.servers import Client, Threaded

ARM = {"reach_mm": 1000.0, "parallel": ["none"], "counts_per_turn": [COUNTS]}
BAR = {"kind": "bar", "length_mm": LENGTH_MM}


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Kept:
    return measured(tmp_path_factory.mktemp("kept"), seed=2)


@pytest.fixture(scope="module")
def book(client: Client, kept: Kept, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    path = tmp_path_factory.mktemp("book") / "Messung.xlsx"
    workbook(kept, path)
    return client.bring(path), path


def looked(client: Client, *files: str, **more: object) -> dict[str, Any]:
    found: dict[str, Any] = client.post("/tables/look", {"files": list(files), **more})
    return found


def test_a_workbook_as_it_stands_and_what_is_asked(client: Client, book: tuple[str, Path]) -> None:
    found = looked(client, book[0])
    assert found["proposal"] is None
    assert found["wrong"] is None
    assert [each["field"] for each in found["questions"]] == ["artefact", "drawing", "counts_per_turn"]
    assert "bar" in found["questions"][0]["choices"]
    (table,) = found["tables"]
    assert (table["rows"], len(table["first"])) == (ROWS, 20)
    names = [each["name"] for each in table["columns"]]
    assert {"Messung", "Ende", "Bemerkung", "Achse 1"} <= set(names)
    assert all(len(row["cells"]) == len(names) for row in table["first"])
    assert table["first"][0]["cells"][names.index("Ende")] in GERMAN["ends"]
    assert table["first"][0]["at"] != table["first"][1]["at"]
    assert any("axis" in each["why"]["text"] or "angle" in each["why"]["text"] for each in table["columns"])


def test_a_study_as_ulna_new_writes_it(
    client: Client, server: Threaded, book: tuple[str, Path], tmp_path: Path
) -> None:
    asked = {"files": [book[0]], "touched": [BAR], "arm": ARM}
    found = looked(client, book[0], touched=[BAR], arm=ARM)
    assert found["questions"] == []
    taken = {each["taken_for"] for each in found["tables"][0]["columns"]}
    assert {"q1", "q6", "placement", "feature", ""} <= taken
    assert found["proposal"]["search"]
    made = client.post("/studies", asked)
    assert made["proposal"] == found["proposal"]
    assert (made["study"]["kind"], made["arm"]["kind"]) == ("study", "arm")
    study = server.workshop.desk.path(made["study"]["sha256"])
    assert study.parent.parent == server.workshop.folder / "sessions"
    options = ["--artefact", "bar", "--length", str(LENGTH_MM), "--reach", "1000", "--parallel", "none"]
    done = run("new", "--readings", book[1], *options, "--counts-per-turn", str(COUNTS), "-o", tmp_path / "new")
    assert done.returncode == 0, done.stderr
    theirs = (tmp_path / "new" / "study.toml").read_text().splitlines()
    ours = study.read_text().splitlines()
    assert [line for line in ours if not line.startswith("file")] == [
        line for line in theirs if not line.startswith("file")
    ]
    assert (study.parent / "arm.toml").read_bytes() == (tmp_path / "new" / "arm.toml").read_bytes()


@pytest.mark.slow
def test_what_was_brought_is_calibrated(client: Client, kept: Kept, tmp_path: Path) -> None:
    text(kept, tmp_path / "out.csv", GERMAN, "utf-8", kept.q_rad, ",", ".")
    arm = {"reach_mm": 1000.0, "parallel": ["none"]}
    made = client.post("/studies", {"files": [client.bring(tmp_path / "out.csv")], "touched": [BAR], "arm": arm})
    job = client.done({"kind": "calibrate", "study": made["study"]["sha256"]})
    assert job["state"] == "done", job
    assert client.get(f"/results/{job['made'][0]['sha256']}")["converged"]


NOWHERE = [{"ours": "q1", "theirs": "no-such"}]


def test_what_is_wrong_with_which_cell(client: Client, kept: Kept, tmp_path: Path) -> None:
    path = tmp_path / "out.csv"
    text(kept, path, GERMAN, "utf-8", kept.q_rad, ",", ".")
    lines = path.read_text(encoding="utf-8").splitlines()
    cells = lines[10].split(",")
    index = next(k for k, cell in enumerate(cells) if "." in cell)
    cells[index] = "Fehler"
    path.write_text("\n".join([*lines[:10], ",".join(cells), *lines[11:]]), encoding="utf-8")
    arm = {"reach_mm": 1000.0, "parallel": ["none"]}
    found = looked(client, client.bring(path), touched=[BAR], arm=arm)
    assert [each["field"] for each in found["questions"]] == ["skip_bad"]
    assert "Fehler" in found["questions"][0]["asks"]["text"]
    bad = [each for column in found["tables"][0]["columns"] for each in column["bad"]]
    assert len(bad) == 1
    assert "line 11" in bad[0]
    asked = {"files": [found["tables"][0]["file"]["sha256"]], "touched": [BAR], "arm": arm}
    assert "left out" in client.refused(400, "POST", "/studies", json=asked)
    assert client.post("/studies", {**asked, "skip_bad": True})["proposal"]["rows"] == ROWS


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("a.csv", b"", ""),
        ("a.csv", b"\x00\x01\x02", ""),
        ("a.xlsx", b"PK\x03\x04broken", ""),
        ("a.parquet", b"PAR1", ""),
        ("<script>.csv", b"q1,q2\n1,2.5\n", "script"),
    ],
)
def test_what_is_no_table(client: Client, name: str, content: bytes, said: str) -> None:
    sha256 = client.ask("POST", "/files", params={"name": name}, content=content).json()["sha256"]
    answer = client.ask("POST", "/tables/look", json={"files": [sha256]})
    assert answer.status_code in (200, 400), answer.text
    assert said in answer.text
    assert client.ask("POST", "/studies", json={"files": [sha256]}).status_code == 400


def test_words_that_do_not_fit(client: Client, book: tuple[str, Path]) -> None:
    both = {**BAR, "diameter_mm": 3.0}
    assert "one of them" in client.refused(400, "POST", "/studies", json={"files": [book[0]], "touched": [both]})
    wrong = looked(client, book[0], touched=[{"kind": "no-such"}])["wrong"]["text"]
    assert "kind of artefact" in wrong
    wrong = looked(client, book[0], touched=[BAR], arm=ARM, columns=NOWHERE)["wrong"]["text"]
    assert "no-such" in wrong
    assert "/desk/" not in wrong

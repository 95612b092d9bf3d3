"""The record through the page: equipment, what is filed, what is due; the same that `ulna record` says."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import quote

import pytest
from tests.cli_runs import run
from tests.records.benches import RESULT, evaluation, verification
from tests.serve.servers import Client, Threaded, apart

from ulna.records.records import Records

LABORATORY = Path(__file__).resolve().parents[2] / "examples" / "platinum" / "laboratory.toml"
DAYS = ("2025-01-10", "2025-04-10", "2025-07-10", "2025-10-10", "2026-01-10", "2026-04-10")


@pytest.fixture(scope="module")
def own(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Client, Threaded]]:
    """A bench of its own: what is entered is never taken out."""
    with apart(tmp_path_factory.mktemp("records")) as both:
        yield both


@pytest.fixture(scope="module")
def client(own: tuple[Client, Threaded]) -> Client:
    return own[0]


@pytest.fixture(scope="module")
def filled(own: tuple[Client, Threaded], tmp_path_factory: pytest.TempPathFactory) -> Records:
    """An arm with a calibration, six evaluations that creep, two tests, a knock."""
    client, server = own
    folder = tmp_path_factory.mktemp("files")
    client.post("/records/equipment", {"name": "P7", "kind": "arm", "maker": "Example Arms", "serial": "P07"})
    made = client.post("/records/add", {"files": [client.bring(RESULT)], "arm": "P7", "at": "2025-01-01"})
    assert [each["kind"] for each in made["filed"]] == ["calibration"]
    for k, day in enumerate(DAYS):
        file = client.bring(evaluation(folder / f"e{k}.json", 0.030 + 0.002 * k, f"{day}T12:00:00+00:00"))
        client.post("/records/add", {"files": [file], "arm": "P7"})
    for verdict, day in (("pass", "2025-02-01"), ("fail", "2025-11-01")):
        file = client.bring(verification(folder / f"{verdict}.json", 0.02, verdict))
        client.post("/records/add", {"files": [file], "arm": "P7", "at": day})
    client.post("/records/equipment/P7/events", {"kind": "knock", "text": "fell <b>hard</b>", "at": "2025-08-01"})
    return server.workshop.records


def test_equipment_and_what_became_of_it(client: Client, filled: Records) -> None:
    (row,) = client.get("/records/equipment", kind="arm")["equipment"]
    assert (row["name"], row["maker"], row["state"]) == ("P7", "Example Arms", "in use")
    whole = client.get("/records/equipment/P7")
    said = [(each.at, each.what, each.text) for each in reversed(filled.history("P7"))]
    assert [(each["at"], each["what"]["text"], each["text"]["text"]) for each in whole["history"]] == said
    assert ("knock", "fell <b>hard</b>") in {(each["what"]["text"], each["text"]["text"]) for each in whole["history"]}
    assert [(each["figure"], each["count"]) for each in whole["series"]] == [
        (each.name, each.count) for each in filled.series("P7")
    ]
    assert whole["calibrations"][0]["on_desk"]
    assert client.get(f"/results/{whole['calibrations'][0]['sha256']}")["arm"]
    (card,) = client.get("/bench")["cards"]
    assert (card["name"], card["calibration"]) == ("P7", whole["calibrations"][0]["sha256"])
    client.refused(404, "GET", "/records/equipment/no-such")
    client.refused(404, "GET", f"/records/equipment/{quote('<script>')}")


def test_figures_and_trend_as_the_command_says_them(client: Client, filled: Records) -> None:
    figure = next(each for each in filled.series("P7") if each.count == len(DAYS))
    asked = {"figure": figure.name, "state": figure.state, "limit": 0.06}
    found = client.get("/records/equipment/P7/trend", **asked)
    options = [figure.name, "--state", figure.state, "--limit", "0.06"]
    done = run("record", "trend", "P7", *options, "--json", "--records", str(filled.bench.folder))
    assert done.returncode == 0, done.stderr
    theirs = json.loads(done.stdout)
    assert [each["value"]["value"] for each in found["points"]] == [each["value"] for each in theirs["points"]]
    assert found["interval_days"] == theirs["until"]["days"]
    assert theirs["until"]["reason"] in [each["text"] for each in found["sentences"]]
    for key in ("centre", "lower", "upper", "in_control", "baseline"):
        assert found[key] == theirs["chart"][key]
    points = client.get("/records/equipment/P7/figures", figure=figure.name, state=figure.state)["points"]
    assert [each["value"] for each in points] == [each["value"] for each in found["points"]]
    assert "no figure" in client.refused(400, "GET", "/records/equipment/P7/trend", params={"figure": "no-such"})
    advice = client.get("/records/equipment/P7/advice", **{key: asked[key] for key in ("figure", "limit")})["advice"]
    assert [each["method"] for each in advice] == ["staircase", "NCSLI RP-1 A3", "drift to the limit"]
    assert advice[0]["reason"]["text"] == filled.advise("P7", "staircase").reason


def test_due_and_impact(client: Client, filled: Records) -> None:
    client.post("/records/equipment/P7/interval", {"days": 365.0, "why": "as the customer asks"})
    (due,) = [each for each in client.get("/records/due", on="2026-11-30")["due"] if each["name"] == "P7"]
    assert (due["due_on"], due["days"]) == ("2027-04-10", 131)
    found = client.get("/records/equipment/P7/impact")
    assert found["good"].startswith("2025-02-01")
    assert found["bad"].startswith("2025-11-01")
    assert "knock" in {each["what"]["text"] for each in found["touched"]}


def test_artefacts_and_their_certificates(client: Client, filled: Records) -> None:
    values = [{"quantity": "length", "value_mm": 443.172, "u_mm": 0.001}]
    first = {"artefact": "KB-443", "values": values, "number": "C-1", "valid_to": "2025-01-01"}
    client.post("/records/certify", first)
    values = [{"quantity": "length", "value_mm": 443.1731, "u_mm": 0.0005}]
    client.post("/records/certify", {**first, "values": values, "number": "C-2", "valid_to": "2099-01-01"})
    whole = client.get("/records/equipment/KB-443")
    assert whole["equipment"]["kind"] == "artefact"
    assert [(each["number"], each["newest"]) for each in whole["values"]] == [("C-2", True), ("C-1", False)]
    assert (whole["values"][0]["value"]["text"], whole["values"][0]["value"]["u"]) == ("443.1731", 0.0005)
    wrong = {**first, "valid_from": "2027-01-01"}
    assert "Turn them" in client.refused(400, "POST", "/records/certify", json=wrong)
    assert "registered as artefact" in client.refused(
        400, "POST", "/records/equipment", json={"name": "KB-443", "kind": "arm"}
    )


def test_a_result_is_filed_in_one_go(client: Client, filled: Records, tmp_path: Path) -> None:
    """Of an arm that nobody registered: both, or nothing of it."""
    document = json.loads(RESULT.read_text())
    document["arm"]["name"] = "New one"
    (tmp_path / "result.json").write_text(json.dumps(document))
    sha256 = client.bring(tmp_path / "result.json")
    assert "not registered" in client.refused(400, "POST", "/records/add", json={"files": [sha256]})
    broken = client.ask("POST", "/files", params={"name": "result.json"}, content=b'{"format": "ulna-result/1"}').json()
    both = {"files": [sha256, broken["sha256"]], "register_arm": True}
    client.refused(400, "POST", "/records/add", json=both)
    assert "New one" not in {each["name"] for each in client.get("/records/equipment")["equipment"]}
    (filed,) = client.post("/records/add", {"files": [sha256], "register_arm": True})["filed"]
    assert (filed["arm"], filed["new"]) == ("New one", True)
    assert not client.post("/records/add", {"files": [sha256]})["filed"][0]["new"]
    client.post("/records/withdraw", {"subject": sha256, "reason": "wrong arm"})
    assert client.get("/records/equipment/New one")["calibrations"] == []
    assert "withdrawn" in client.refused(400, "POST", "/records/add", json={"files": [sha256]})


def test_the_record_is_what_was_written(client: Client, filled: Records) -> None:
    found = client.get("/records/verify")
    theirs = filled.verify()
    assert (found["good"], found["entries"], found["head"]) == (True, theirs.entries, theirs.head)


@pytest.mark.parametrize(
    ("path", "body"),
    [
        ("/records/equipment", {"name": "a\nb", "kind": "arm"}),
        ("/records/equipment/P7/events", {"kind": "note", "text": "\x1b[2J"}),
        ("/records/equipment/P7/events", {"kind": "note", "text": "x", "at": "yesterday"}),
        ("/records/equipment/no-such/events", {"kind": "note", "text": "x"}),
        ("/records/withdraw", {"subject": "0" * 64, "reason": "x"}),
        ("/records/withdraw", {"subject": "%' OR 1=1 --", "reason": "x"}),
        ("/records/add", {"files": ["0" * 64]}),
    ],
)
def test_what_cannot_be_entered_is_not(client: Client, filled: Records, path: str, body: dict[str, Any]) -> None:
    before = filled.verify().entries
    assert client.ask("POST", path, json=body).status_code in (400, 404)
    assert filled.verify().entries == before

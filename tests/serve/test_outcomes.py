"""Checks, acceptance tests and certificates as jobs: the same as the commands find, from files that were brought."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.cli_runs import run
from tests.pdf_reading import Pdf, holds
from tests.serve.servers import Client, Threaded, apart, untold

ROOT = Path(__file__).resolve().parents[2]
PLATINUM = ROOT / "examples" / "platinum"
FOSSILS = ROOT / "tests" / "data" / "fossils"
MORNINGS = [PLATINUM / f"morning-11-{day}.csv" for day in ("02", "04", "06", "09", "11")]


@pytest.fixture(scope="module")
def own(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Client, Threaded]]:
    """A bench of its own: what is entered is never taken out."""
    with apart(tmp_path_factory.mktemp("outcomes")) as both:
        yield both


@pytest.fixture(scope="module")
def client(own: tuple[Client, Threaded]) -> Client:
    return own[0]


@pytest.fixture(scope="module")
def server(own: tuple[Client, Threaded]) -> Threaded:
    return own[1]


@pytest.fixture(scope="module")
def protocol(client: Client) -> dict[str, object]:
    """Of the example, with the arm that it names."""
    brought = client.bring(PLATINUM / "protocol.toml")
    return {"kind": "check", "protocol": brought, "beside": [client.bring(PLATINUM / "truth.toml")]}


@pytest.fixture(scope="module")
def calibrated(client: Client) -> str:
    """The example, brought file by file and calibrated."""
    beside = [client.bring(PLATINUM / name) for name in ("platinum.toml", "bars.csv", "seat.csv")]
    study = client.bring(PLATINUM / "study.toml")
    lonely = client.done({"kind": "calibrate", "study": study})
    assert lonely["state"] == "failed"
    return client.made({"kind": "calibrate", "study": study, "beside": beside})["result"]


def test_a_check_and_its_history(client: Client, protocol: dict[str, object], tmp_path: Path) -> None:
    earlier: list[str] = []
    for k, morning in enumerate(MORNINGS):
        date = f"2026-11-{k + 1:02}T08:00:00+00:00"
        body = {**protocol, "readings": client.bring(morning), "date": date, "operator": "Ann"}
        earlier.append(client.made({**body, **({"history": list(earlier)} if k else {})})["check"])
    checks, out = tmp_path / "checks", tmp_path / "last.json"
    checks.mkdir()
    for k, sha256 in enumerate(earlier[:-1]):
        (checks / f"{k}.json").write_bytes(client.ask("GET", f"/files/{sha256}/content").content)
    options = ["--history", checks, "--date", date, "-o", out]
    done = run("check", PLATINUM / "protocol.toml", MORNINGS[-1], *options)
    assert done.returncode in (0, 1), done.stderr
    found, theirs = client.get(f"/checks/{earlier[-1]}"), json.loads(out.read_text())
    assert (found["verdict"], found["in_control"]) == (theirs["verdict"], theirs["in_control"])
    assert found["operator"] == "Ann"
    for ours, figure in zip(found["figures"], theirs["figures"], strict=True):
        assert (ours["key"], ours["value"]["value"], ours["verdict"]) == (
            figure["key"], figure["value"], figure["verdict"],
        )  # fmt: skip
        assert ours["centre_mm"] == figure["history"]["centre"]
    assert [[step["text"] for step in each["steps"]] for each in found["advice"]] == [
        each["steps"] for each in theirs["advice"]
    ]
    assert untold(found) == []
    assert client.get(f"/files/{earlier[0]}")["kind"] == "check"


def test_a_check_by_another_arm_and_the_records_history(
    client: Client, protocol: dict[str, object], calibrated: str
) -> None:
    body = {"kind": "check", "protocol": protocol["protocol"], "arm": calibrated, "of": "P7"}
    client.post("/records/equipment", {"name": "P7", "kind": "arm"})
    first = client.made({**body, "readings": client.bring(MORNINGS[0]), "date": "2026-11-02"})["check"]
    client.post("/records/add", {"files": [first], "arm": "P7"})
    second = client.made({**body, "readings": client.bring(MORNINGS[1]), "date": "2026-11-04"})["check"]
    assert "1" in client.get(f"/checks/{second}")["figures"][0]["history"]["text"]
    assert client.get("/records/equipment/P7")["series"]
    wrong = {**body, "of": "no-such", "readings": first}
    assert "not registered" in client.refused(400, "POST", "/jobs", json=wrong)


def test_an_acceptance_test(client: Client, tmp_path: Path) -> None:
    beside = [client.bring(FOSSILS / name) for name in ("profile-1.toml", "verify-1.csv")]
    test = client.bring(FOSSILS / "verify-1.toml")
    made = client.made({"kind": "verify", "test": test, "beside": beside})
    found = client.get(f"/verifications/{made['verification']}")
    done = run("verify", FOSSILS / "verify-1.toml", "-o", tmp_path / "out")
    assert done.returncode in (0, 1), done.stderr
    theirs = json.loads((tmp_path / "out" / "verification.json").read_text())
    assert found["verdict"] == theirs["verdict"]
    ours = [figure["value"]["value"] for test in found["states"][0]["tests"] for figure in test["figures"]]
    assert ours == [figure["value"] for test in theirs["states"][0]["tests"] for figure in test["figures"]]
    assert client.get(f"/files/{test}")["kind"] == "test"
    failed = client.done({"kind": "verify", "test": test})
    assert (failed["state"], failed["problem"]["status"]) == ("failed", 400)
    assert "/desk/" not in failed["problem"]["detail"]


@pytest.mark.slow
def test_a_draft_and_a_certificate(client: Client, calibrated: str) -> None:
    laboratory = client.bring(PLATINUM / "laboratory.toml")
    body = {"kind": "certificate", "result": calibrated, "laboratory": laboratory}
    draft = client.ask("GET", f"/files/{client.made(body)['certificate']}/content").content
    assert "DRAFT" in Pdf(draft).all_text.upper()
    xml = client.made({**body, "form": "dcc"})["certificate"]
    assert b"digitalCalibrationCertificate" in client.ask("GET", f"/files/{xml}/content").content
    asked = {"result": calibrated, "laboratory": laboratory, "form": "dcc"}
    assert "no file" in client.refused(400, "POST", "/records/issue", json=asked)
    arm = client.post("/records/add", {"files": [calibrated], "register_arm": True})["filed"][0]["arm"]
    first = client.post("/records/issue", asked)
    again = {**asked, "supersedes": first["number"]}
    assert "Give --reason" in client.refused(400, "POST", "/records/issue", json=again)
    second = client.post("/records/issue", {**again, "reason": "the customer moved", "form": "pdf"})
    paper = Pdf(client.ask("GET", f"/files/{second['sha256']}/content").content)
    holds(paper, second["number"], second["head"])
    stated = (PLATINUM / "laboratory.toml").read_text().replace("[laboratory]", '[laboratory]\nlogo = "lab-1.svg"')
    drawn = client.ask("POST", "/files", params={"name": "lab.toml"}, content=stated.encode()).json()["sha256"]
    lonely = {**asked, "laboratory": drawn, "form": "pdf"}
    assert "lab-1.svg" in client.refused(400, "POST", "/records/issue", json=lonely)
    third = client.post("/records/issue", {**lonely, "beside": [client.bring(FOSSILS / "lab-1.svg")]})
    client.post("/records/withdraw", {"subject": third["number"], "reason": "tried"})
    client.post("/records/withdraw", {"subject": second["number"], "reason": "wrong serial"})
    listed = client.get("/records/certificates", arm=arm)["certificates"]
    assert [(each["number"], each["state"]) for each in listed] == [
        (third["number"], "withdrawn"),
        (second["number"], "withdrawn"),
        (first["number"], "superseded"),
    ]
    assert client.get("/records/verify")["good"]


@pytest.mark.parametrize("place", ["/etc/passwd", "../../bench.toml", "C:/x.csv", "..\\\\..\\\\x.csv", "//host/share"])
def test_no_file_that_was_brought_names_a_place(client: Client, calibrated: str, place: str) -> None:
    def brought(name: str, text: str) -> str:
        return str(client.ask("POST", "/files", params={"name": name}, content=text.encode()).json()["sha256"])

    study = brought("s.toml", f'format = "ulna-study/1"\narm = "{place}"\n')
    assert "a place of its own" in client.refused(400, "POST", "/jobs", json={"kind": "calibrate", "study": study})
    inner = brought("t.toml", f'format = "ulna-verify/1"\n[[readings]]\nfile = "{place}"\n')
    assert "a place of its own" in client.refused(400, "POST", "/jobs", json={"kind": "verify", "test": inner})
    plan = brought("p.toml", f'format = "ulna-plan/1"\n[plan]\ntaken = "{place}"\n')
    body = {"kind": "plan", "arm": calibrated, "plan": plan}
    assert "a place of its own" in client.refused(400, "POST", "/jobs", json=body)
    client.refused(400, "GET", f"/plans/{plan}", params={"arm": calibrated})


def test_a_source_that_was_brought_opens_no_file(client: Client) -> None:
    text = b'format = "ulna-source/1"\nurl = "file:/etc/passwd"\n'
    source = client.ask("POST", "/files", params={"name": "s.toml"}, content=text).json()["sha256"]
    body = {"kind": "watch", "source": source, "arm": None}
    assert "expected a stream" in client.refused(400, "POST", "/activities", json=body)
    client.refused(400, "POST", "/sources/guess", json={"source": source, "seconds": 0.2})

"""A certificate that needs two people: proposed by one, looked at and issued by another, each signed in themselves."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.pdf_reading import Pdf, holds
from tests.records.benches import RESULT
from tests.serve.laboratories import Laboratory, laboratory
from tests.serve.servers import Client

STATED = Path(__file__).resolve().parents[2] / "examples" / "platinum" / "laboratory.toml"


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Laboratory]:
    with laboratory(tmp_path_factory.mktemp("proposals")) as one:
        yield one


@pytest.fixture(scope="module")
def people(lab: Laboratory) -> dict[str, Client]:
    return {name: lab.of(name) for name in ("Ann", "Otto", "Rita", "Lea")}


@pytest.fixture(scope="module")
def asked(people: dict[str, Client]) -> dict[str, Any]:
    """A certificate of what Otto measured and filed."""
    otto = people["Otto"]
    otto.post("/records/equipment", {"name": "P7", "kind": "arm"})
    otto.post("/records/add", {"files": [otto.bring(RESULT)], "arm": "P7", "at": "2026-01-01"})
    people["Ann"].post("/settings", {"four_eyes": True, "numbers": "AB-{year}-{n:04}"})
    return {"result": "P7", "laboratory": otto.bring(STATED)}


def test_one_proposes_and_another_issues(people: dict[str, Client], asked: dict[str, Any]) -> None:
    otto, rita = people["Otto"], people["Rita"]
    proposal = otto.post("/records/proposals", asked)
    assert (proposal["by"], proposal["state"], proposal["mine"]) == ("Otto", "waiting", True)
    path = f"/records/proposals/{proposal['id']}"
    otto.refused(403, "POST", f"{path}/approve")
    people["Lea"].refused(403, "POST", f"{path}/approve")
    (seen,) = rita.get("/records/proposals")["proposals"]
    assert (seen["id"], seen["mine"]) == (proposal["id"], False)
    done = rita.post(f"{path}/approve")
    assert (done["state"], done["decided_by"]) == ("issued", "Rita")
    assert done["number"].startswith("AB-")
    (issued,) = rita.get("/records/certificates")["certificates"]
    assert (issued["issued_by"], issued["approved_by"]) == ("Otto", "Rita")
    holds(Pdf(rita.ask("GET", f"/files/{done['sha256']}/content").content), "Otto", "Rita")
    for word, body in (("approve", None), ("decline", {"reason": "too late"})):
        assert "issued by Rita" in rita.refused(409, "POST", f"{path}/{word}", json=body)
    assert len(rita.get("/records/certificates")["certificates"]) == 1


def test_nobody_approves_their_own(people: dict[str, Client], asked: dict[str, Any]) -> None:
    rita, ann = people["Rita"], people["Ann"]
    path = f"/records/proposals/{rita.post('/records/proposals', asked)['id']}/approve"
    assert "four eyes" in rita.refused(400, "POST", path)
    assert ann.post(path)["state"] == "issued"


def test_nor_what_they_measured(people: dict[str, Client], asked: dict[str, Any], tmp_path: Path) -> None:
    """Otto becomes a reviewer: what he filed others must approve, also where others propose it."""
    ann, otto = people["Ann"], people["Otto"]
    ann.post("/people", {"name": "Otto", "roles": ["operator", "reviewer"]})
    path = f"/records/proposals/{people['Rita'].post('/records/proposals', asked)['id']}/approve"
    assert "filed what is to be certified" in otto.refused(400, "POST", path)
    assert ann.post(path)["state"] == "issued"


def test_a_name_that_is_typed_approves_nothing(people: dict[str, Client], asked: dict[str, Any]) -> None:
    said = people["Rita"].refused(403, "POST", "/records/issue", json={**asked, "approved_by": "Ann"})
    assert "Propose it" in said
    assert "another person" in people["Rita"].refused(400, "POST", "/records/issue", json=asked)
    people["Otto"].post("/records/proposals", {**asked, "approved_by": "Ann"})
    assert people["Otto"].get("/records/proposals")["proposals"][0]["asked"]["approved_by"] is None


def test_it_can_be_declined_with_a_reason(people: dict[str, Client], asked: dict[str, Any]) -> None:
    before = len(people["Ann"].get("/records/certificates")["certificates"])
    proposal = people["Rita"].post("/records/proposals", asked)
    path = f"/records/proposals/{proposal['id']}"
    people["Ann"].refused(422, "POST", f"{path}/decline", json={"reason": ""})
    said = people["Ann"].post(f"{path}/decline", {"reason": "of another arm"})
    assert (said["state"], said["reason"], said["number"]) == ("declined", "of another arm", None)
    assert "declined by Ann" in people["Ann"].refused(409, "POST", f"{path}/approve")
    assert len(people["Ann"].get("/records/certificates")["certificates"]) == before
    people["Ann"].refused(404, "POST", "/records/proposals/no-such/approve")
    people["Ann"].refused(405, "POST", "/records/proposals/..%2f..%2fbench/approve")


def test_where_one_pair_is_enough_a_reviewer_issues_alone(people: dict[str, Client], asked: dict[str, Any]) -> None:
    ann, rita = people["Ann"], people["Rita"]
    ann.post("/settings", {"four_eyes": False})
    assert ann.get("/settings")["four_eyes"] is False
    rita.post("/records/issue", asked)
    alone = rita.post(f"/records/proposals/{rita.post('/records/proposals', asked)['id']}/approve")
    assert (alone["state"], alone["by"], alone["decided_by"]) == ("issued", "Rita", "Rita")
    assert "{n}" in ann.refused(400, "POST", "/settings", json={"numbers": "AB"})
    assert ann.get("/records/verify")["good"]

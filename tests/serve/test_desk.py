"""Files that are brought: kept by what is in them, known for what they are, and never by a path."""

from __future__ import annotations

import json
import os
from hashlib import sha256
from pathlib import Path

import pytest
from tests.serve.servers import Client, Threaded

from ulna.serve.desk import Desk
from ulna.serve.problems import NotThereError


def desk_of(folder: Path) -> Desk:
    for name in ("desk", "sessions", "jobs"):
        (folder / name).mkdir(exist_ok=True)
    return Desk(folder / "desk", folder / "sessions", folder / "jobs")


SCRIPT = '<script>alert("x")</script>'


def test_a_file_is_there_once_under_its_hash(client: Client, server: Threaded) -> None:
    content = b"q1,q2\n1,2\n"
    first = client.ask("POST", "/files", params={"name": "one.csv"}, content=content).json()
    again = client.ask("POST", "/files", params={"name": "two.csv"}, content=content).json()
    assert first == again
    assert first["sha256"] == sha256(content).hexdigest()
    assert (first["name"], first["kind"], first["size"]) == ("one.csv", "table", len(content))
    assert client.get(f"/files/{first['sha256']}") == first
    back = client.ask("GET", f"/files/{first['sha256']}/content")
    assert back.content == content
    assert back.headers["etag"] == f'"{first["sha256"]}"'
    assert len(list((server.workshop.folder / "desk" / first["sha256"]).iterdir())) == 1


def test_what_a_file_is(client: Client, root: Path, play: dict[str, str]) -> None:
    kinds = {each["sha256"]: each for each in client.get("/files")["files"]}
    assert (kinds[play["arm"]]["kind"], kinds[play["plan"]]["kind"]) == ("arm", "plan")
    assert "7 joints" in kinds[play["arm"]]["what"]["text"]
    fossils = root / "tests" / "data" / "fossils"
    for name, kind in {"result-1.json": "result", "arm-1.toml": "arm", "study-1.toml": "study"}.items():
        found = sorted(fossils.rglob(name)) or sorted(fossils.rglob(name.replace("-1", "")))
        if found:
            assert client.get(f"/files/{client.bring(found[0])}")["kind"] == kind
    assert [each["kind"] for each in client.get("/files", kind="plan")["files"]].count("plan") >= 1


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("arm.toml", b'format = "ulna-arm/1"\n'),
        ("arm.toml", b"\xff\xfe\x00"),
        ("result.json", b'{"format": "ulna-result/1"}'),
        ("result.json", b"[" * 100_000),
        ("a.toml", b'format = "ulna-future/9"\n'),
        ("a.json", b'{"format": ["ulna-arm/1"]}'),
        ("empty.toml", b""),
        (f"{SCRIPT}.toml", f"format = '{SCRIPT}'".encode()),
    ],
)
def test_what_cannot_be_used_says_why(client: Client, name: str, content: bytes) -> None:
    made = client.ask("POST", "/files", params={"name": name}, content=content).json()
    assert made["kind"] == "other"
    assert made["what"]["text"]
    assert client.ask("GET", "/arms").status_code == 200


def test_an_arm_and_its_picture(client: Client, play: dict[str, str]) -> None:
    whole = client.get(f"/arms/{play['arm']}")
    assert [joint["number"] for joint in whole["arm"]["joints"]] == list(range(1, 8))
    assert whole["arm"]["calibration"] is None
    assert {each["status"] for each in whole["parameters"]} == {"drawing"}
    assert len(whole["scene"]["bodies"]["bodies"]) == 8
    turned = client.post(f"/arms/{play['arm']}/bodies", {"q_deg": whole["scene"]["q_deg"]})
    assert turned == whole["scene"]["bodies"]
    assert "q_deg" in client.refused(400, "POST", f"/arms/{play['arm']}/bodies", json={"q_deg": [1.0]})
    assert client.refused(400, "GET", f"/arms/{play['plan']}")
    client.refused(400, "GET", f"/arms/{play['arm']}", params={"probe": SCRIPT})


@pytest.mark.parametrize(
    ("keys", "value"),
    [(("arm", "name"), "x" * 300), (("arm", "name"), ""), (("fit", "termination"), "y" * 5000),
     (("residuals", 0, "row"), None), (("provenance", "time"), 7), (("fit", "readings"), [])],
)  # fmt: skip
def test_a_result_that_somebody_spoilt_spoils_nothing_else(
    client: Client, root: Path, keys: tuple[str | int, ...], value: object
) -> None:
    document = json.loads((root / "tests" / "data" / "fossils" / "result-1.json").read_text())
    place = document
    for key in keys[:-1]:
        place = place[key]
    place[keys[-1]] = value
    content = json.dumps(document).encode()
    sha256 = client.ask("POST", "/files", params={"name": "result.json"}, content=content).json()["sha256"]
    assert client.ask("GET", "/arms").status_code == 200
    for path in (f"/arms/{sha256}", f"/results/{sha256}"):
        assert client.ask("GET", path).status_code in (200, 400)


def test_a_report_that_was_brought_is_never_shown(client: Client) -> None:
    made = client.ask("POST", "/files", params={"name": "report.html"}, content=SCRIPT.encode()).json()
    client.refused(404, "GET", f"/files/{made['sha256']}/report")
    kept = client.ask("GET", f"/files/{made['sha256']}/content")
    assert kept.headers["content-type"] == "application/octet-stream"
    assert kept.headers["content-disposition"].startswith("attachment")


def test_a_file_that_was_changed_is_not_given_for_what_it_was(tmp_path: Path) -> None:
    (tmp_path / "sessions" / "one").mkdir(parents=True)
    (tmp_path / "sessions" / "one" / "study.toml").write_text('format = "ulna-study/1"\n')
    desk = desk_of(tmp_path)
    (found,) = desk.all()
    path = desk.path(found.sha256)
    path.write_text('format = "ulna-study/2"\n')
    with pytest.raises(NotThereError, match="was changed"):
        desk.path(found.sha256)
    path.unlink()
    with pytest.raises(NotThereError, match="Bring it once more"):
        desk.path(found.sha256)
    assert desk.put("study.toml", b'format = "ulna-study/1"\n').sha256 == found.sha256
    assert desk.path(found.sha256).parent.parent == tmp_path / "desk"


def test_what_is_on_the_desk_is_there_after_a_restart(tmp_path: Path) -> None:
    first = desk_of(tmp_path).put("a b.csv", b"1\n")
    os.mkfifo(tmp_path / "sessions" / "pipe.toml")  # whoever put it there: nobody waits for it
    (tmp_path / "sessions" / "loop").symlink_to(tmp_path)
    (tmp_path / "jobs" / "a1").mkdir()
    (tmp_path / "jobs" / "a1" / "report.html").write_text("made here")
    (tmp_path / "jobs" / "a1" / ".half.html").write_text("made hal")
    assert {each.name for each in desk_of(tmp_path).all()} == {"a b.csv", "report.html"}
    assert first in desk_of(tmp_path).all()

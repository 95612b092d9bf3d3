"""Long work: done in turn, watched, cancelled; what goes wrong is said."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest
from tests.serve.servers import Client, Threaded, events, wait_for

from ulna.calibration.result import Result
from ulna.ground.errors import UlnaInputError
from ulna.serve.jobs import Made, Progress


def test_calibrate_and_report(client: Client, server: Threaded, touched: dict[str, str]) -> None:
    with client.socket() as socket:
        job = client.post("/jobs", {"kind": "calibrate", "study": touched["study"]})
        told = events(socket, lambda event: event["event"] == "job" and event["job"]["state"] == "done")
    assert {"running", "done"} <= {each["job"]["state"] for each in told if each["event"] == "job"}
    made = {each["role"]: each["sha256"] for each in client.get(f"/jobs/{job['id']}")["made"]}
    ours, first = (Result.load(server.workshop.desk.path(each)) for each in (made["result"], touched["result"]))
    assert ours.arm.core.parameters.tolist() == first.arm.core.parameters.tolist()
    report = client.made({"kind": "report", "result": made["result"], "language": "zh"})["report"]
    shown = client.ask("GET", f"/files/{report}/report")
    assert shown.headers["content-type"].startswith("text/html")
    assert "sandbox" in shown.headers["content-security-policy"]
    assert "</html>" in shown.text


def test_what_goes_wrong_is_said_in_the_commands_words(client: Client, play: dict[str, str], bench: Path) -> None:
    job = client.done({"kind": "calibrate", "study": play["arm"]})
    assert (job["state"], job["problem"]["status"]) == ("failed", 400)
    assert "ulna-study" in job["problem"]["detail"]
    assert job["made"] == []
    assert "not on this desk" in client.refused(404, "POST", "/jobs", json={"kind": "calibrate", "study": "0" * 64})
    client.refused(404, "GET", "/jobs/no-such")
    client.refused(404, "POST", "/jobs/no-such/cancel")
    assert not [path for path in (bench / "jobs").rglob("*") if path.is_file() and path.name.startswith(".")]


def test_cancelled(server: Threaded, client: Client) -> None:
    jobs, going, go_on = server.workshop.jobs, threading.Event(), threading.Event()

    def work(progress: Progress) -> Made:
        going.set()
        assert go_on.wait(60)
        progress("further", 1, 2)
        raise AssertionError("it should have stopped")

    first = jobs.begin("calibrate", "one", work, "Ann")
    second = jobs.begin("calibrate", "two", lambda progress: Made([]), "Ann")
    assert going.wait(60)
    assert client.get(f"/jobs/{second.id}")["state"] == "waiting"
    client.post(f"/jobs/{second.id}/cancel")
    client.post(f"/jobs/{first.id}/cancel")
    go_on.set()
    assert [client.waited(each.id)["state"] for each in (first, second)] == ["cancelled", "cancelled"]
    assert [each["id"] for each in client.get("/jobs")["jobs"][:2]] == [second.id, first.id]


@pytest.mark.parametrize(
    ("error", "status", "said"),
    [(UlnaInputError("x.csv: wrong. Mend it."), 400, "Mend it"), (ZeroDivisionError("oh"), 500, "fault of Ulna's")],
)
def test_one_that_fails_stops_no_other(
    server: Threaded, client: Client, error: Exception, status: int, said: str
) -> None:
    def work(progress: Progress) -> Made:
        raise error

    failed = server.workshop.jobs.begin("calibrate", "bad", work, "Ann")
    after = server.workshop.jobs.begin("calibrate", "good", lambda progress: Made([]), "Ann")
    assert client.waited(after.id)["state"] == "done"
    job = client.get(f"/jobs/{failed.id}")
    assert (job["state"], job["problem"]["status"]) == ("failed", status)
    assert said in job["problem"]["detail"]
    wait_for(lambda: client.get("/jobs")["jobs"][0]["state"] == "done", "the last")


def test_one_that_says_much_floods_nobody(server: Threaded, client: Client) -> None:
    def work(progress: Progress) -> Made:
        for k in range(5000):
            progress("counting", k + 1, 5000)
        return Made([], ["done counting"])

    with client.socket() as socket:
        job = server.workshop.jobs.begin("calibrate", "counts", work, "Ann")
        told = events(
            socket,
            lambda event: event["event"] == "job" and event["job"]["id"] == job.id and event["job"]["done"] == 5000,
        )
    assert len(told) < 1000
    assert client.waited(job.id)["said"] == [{"text": "done counting", "template": None, "values": {}}]

"""What a server says goes out with its template, so that a page in another language can say it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.serve.conftest import begin_touch
from tests.serve.servers import Client, events, untold
from tests.serve.test_commission import COUNTS, FAST, answerable, counting, state, turn
from tests.serve.test_guided import a_check, a_test, do, done, ready

from ulna.ground.errors import for_people
from ulna.ground.worded import Worded, in_a_row, kept, listed, recalled, worded
from ulna.serve.contract.live import RefusedEvent
from ulna.serve.contract.model import LONGEST
from ulna.serve.problems import NotNowError, problem


def test_a_sentence_is_its_english_text_and_keeps_what_it_is_made_of() -> None:
    reason = worded("moved {moved} mm while touching: hold still", moved="0.062")
    whole = worded("Not taken: {reason}.", reason=reason)
    assert whole == "Not taken: moved 0.062 mm while touching: hold still."
    assert json.loads(json.dumps(whole)) == whole
    event = RefusedEvent(sentence=for_people(whole))
    assert isinstance(event.sentence, Worded)
    assert event.model_dump(mode="json")["sentence"] == {
        "text": str(whole),
        "template": "Not taken: {reason}.",
        "values": {"reason": {"text": str(reason), "template": reason.template, "values": {"moved": "0.062"}}},
    }
    assert kept(NotNowError(whole)) is whole
    plain = RefusedEvent(sentence="plain {x}").model_dump(mode="json")["sentence"]
    assert plain == {"text": "plain {x}", "template": None, "values": {}}
    with pytest.raises(ValueError, match=str(LONGEST)):
        RefusedEvent(sentence="x" * (LONGEST + 1))


def test_joined_sentences_keep_their_parts() -> None:
    three = listed([worded("elbow up"), "b", worded("probe from left")])
    assert three == "elbow up, b, probe from left"
    assert isinstance(three, Worded)
    assert isinstance(three.values["first"], Worded)
    assert listed([]) == ""
    assert listed(["a"]) == "a"
    assert in_a_row(["A.", "B."]) == "A. B."


def test_a_plain_sentence_is_known_again_by_what_makes_exactly_it() -> None:
    known = ("{what}: {found}; the profile counts {expected}.", "points on the ball", "{name} of {name}")
    found = recalled("points on the ball: 7; the profile counts 25.", known)
    assert isinstance(found, Worded)
    assert (found.values["what"], found.values["found"]) == ("points on the ball", "7")
    assert isinstance(found.values["what"], Worded)
    assert isinstance(recalled("a of a", known), Worded)
    for other in ("a of b", "points on the ball.", "points", ""):
        assert type(recalled(other, known)) is str


def test_a_problem_names_no_place_and_keeps_its_template() -> None:
    place = f"/srv/bench/desk/{'a' * 64}/study.toml"
    told = problem(400, worded("{file}: there is none.", file=place))
    assert (told.detail, told.said.text) == ("study.toml: there is none.",) * 2
    assert told.said.values == {"file": "study.toml"}


def test_a_whole_session_is_told_with_templates(client: Client, play: dict[str, str], idle: None) -> None:
    asked: Any = begin_touch(play, goal_mm=0.2)
    name = client.post("/activities", asked)["id"]

    def do(word: str, **more: object) -> Any:
        return client.post(f"/activities/{name}/do", {"word": word, **more})

    with client.socket(name) as socket:
        do("touch")
        do("touch")  # in the same pose
        do("follow", follows=True)
        told = events(socket, lambda event: event["event"] == "known" and event["meter"]["reached"])
        do("follow", follows=False)
        do("withdraw", number=2, reason="tried")
        do("hold-out", places=2)
        do("follow", follows=True)
        told += events(socket, lambda event: event["event"] == "touch" and event["touch"]["held_out"])
        do("trust")
        ended = do("end")
        told += events(socket, lambda event: event["event"] == "ended")
    kinds = {event["event"] for event in told}
    assert {"touch", "refused", "known", "said", "ended"} <= kinds
    assert untold(told) == []
    assert untold(ended) == []


def test_a_commissioning_is_told_with_templates(client: Client, idle: None, tmp_path: Path) -> None:
    drawing, true = (client.bring(path) for path in counting(tmp_path))
    asked = {"kind": "commission", "source": f"virtual:{true}?{FAST}", "arm": drawing, "zeros": "known"}
    name = client.post("/activities", {**asked, "counts_per_turn": COUNTS})["id"]
    at, seen = np.zeros(7), []
    for _ in range(4):
        question = state(client, name)["question"]
        turn(client, name, at, question)
        seen += [question, answerable(client, name)]
        client.post(f"/activities/{name}/do", {"word": "answer", "answer": "yes"})
    assert untold(seen) == []
    assert any(question["found"] for question in seen)


def test_a_read_out_is_told_with_templates(
    client: Client, play: dict[str, str], touched: dict[str, str], idle: None
) -> None:
    asked = {"kind": "measure", "source": play["source"], "arm": touched["result"], "by": "key"}
    name = client.post("/activities", asked)["id"]
    with client.socket(name) as socket:
        for q_deg in ([0.0, 40.0, 0.0, 60.0, 0.0, 30.0, 0.0], [20.0, 40.0, 0.0, 60.0, 0.0, 30.0, 0.0]):
            client.post(f"/activities/{name}/do", {"word": "go", "q_deg": q_deg})
            client.post(f"/activities/{name}/do", {"word": "touch"})
        ended = client.post(f"/activities/{name}/do", {"word": "end"})
        told = events(socket, lambda event: event["event"] == "ended")
    assert untold(told) == []
    assert untold(ended) == []


@pytest.mark.parametrize("begin", [a_check, a_test], ids=["check", "test"])
def test_what_is_touched_step_by_step_is_told_with_templates(
    client: Client, idle: None, begin: Callable[..., dict[str, object]]
) -> None:
    given = ready(client)
    name = client.post("/activities", begin(given))["id"]
    seen = []
    with client.socket(name) as socket:
        do(client, name, "follow", follows=True)
        seen += events(socket, done(3))
        do(client, name, "follow", follows=False)
        do(client, name, "touch")  # in the same pose
        do(client, name, "take-back")
        do(client, name, "trust")
        seen += [do(client, name, "end"), *events(socket, lambda event: event["event"] == "ended")]
    kinds = {event.get("event") for event in seen}
    assert {"touch", "refused", "state", "said", "ended"} <= kinds
    name = client.post("/activities", begin(given, go_on=name))["id"]
    with client.socket(name) as socket:
        do(client, name, "follow", follows=True)
        seen += events(socket, done())
        ended = do(client, name, "end")
        seen += [ended, *events(socket, lambda event: event["event"] == "ended")]
    assert untold(seen) == []
    found = {each["role"]: each["sha256"] for each in ended["left"]}
    path = f"/checks/{found['check']}" if "check" in found else f"/verifications/{found['verification']}"
    assert untold(client.get(path)) == []


def test_how_a_test_is_made_is_told_with_templates(client: Client) -> None:
    given = ready(client)
    for profile in ("asme-b89-4-22", "iso-10360-12", "vdi-2617-9", given["beside"][0]):
        assert untold(client.get("/tests/wants", profile=profile, arm=given["arm"])) == []
        made = client.post("/tests", {"profile": profile, "arm": given["arm"]})
        assert made["lacks"]
        assert untold(made) == []


def test_a_check_is_told_with_templates(client: Client, root: Path) -> None:
    platinum = root / "examples" / "platinum"
    protocol, truth = client.bring(platinum / "protocol.toml"), client.bring(platinum / "truth.toml")
    body = {"kind": "check", "protocol": protocol, "beside": [truth]}
    job = client.done({**body, "readings": client.bring(platinum / "morning-11-11.csv")})
    found = client.get(f"/checks/{job['made'][0]['sha256']}")
    assert untold(job) == []
    assert untold(found) == []

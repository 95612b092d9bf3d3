"""The contract: committed as it is, whole, and kept by the server whatever it is asked."""

from __future__ import annotations

import itertools
import json
import re
import typing
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, seed, settings
from schemathesis.checks import not_a_server_error
from schemathesis.specs.openapi.checks import response_schema_conformance
from tests.serve.servers import Client
from tools import openapi

from ulna.serve.activities.beginning import BEGINNINGS
from ulna.serve.contract import live
from ulna.serve.contract.activities import Begin
from ulna.serve.contract.jobs import BeginJob
from ulna.serve.work import WORKS

EXAMPLES = 8


def kinds(union: Any) -> tuple[type, ...]:
    return typing.get_args(typing.get_args(union)[0])


def test_the_committed_schema_is_fresh(root: Path) -> None:
    kept = (root / "page" / "openapi.json").read_text(encoding="utf-8")
    assert kept == openapi.text(), "python tools/openapi.py"


def test_every_live_event_is_in_the_schema() -> None:
    schemas = json.loads(openapi.text())["components"]["schemas"]
    names = {model.__name__ for model in kinds(live.LiveEvent)}
    assert names == {name for name in vars(live) if name.endswith("Event") and name != "LiveEvent"}
    assert names <= set(schemas)
    assert {each["$ref"].rpartition("/")[2] for each in schemas["LiveEvent"]["oneOf"]} == names
    assert set(schemas["LiveEvent"]["discriminator"]["mapping"]) == {
        model.model_fields["event"].default for model in kinds(live.LiveEvent)
    }


def test_every_kind_that_may_be_asked_for_is_done_by_somebody() -> None:
    assert set(kinds(BeginJob)) == set(WORKS)
    assert set(kinds(Begin)) == set(BEGINNINGS)


def test_the_page_is_told_by_which_contract(client: Client) -> None:
    served = client.get("/openapi.json")
    committed = json.loads(openapi.text())
    assert {**served, "info": {}} == {**committed, "info": {}}


DOCUMENT = json.loads(openapi.text())
SCHEMA = schemathesis.openapi.from_dict(DOCUMENT)
LEFT_OUT = {("/api/v1/logout", "post")}
"""It would end the session of all that follow."""
ASKED = [(path, method) for path, one in DOCUMENT["paths"].items() for method in one if (path, method) not in LEFT_OUT]


@pytest.mark.parametrize(("path", "method"), ASKED)
@pytest.mark.usefixtures("touched")
def test_whatever_is_asked_no_fault_is_ours(client: Client, path: str, method: str) -> None:
    """Requests made from the schema, what it allows and what not: no answer is a fault of the server, and all are of
    the kind that the schema says."""
    headers = {"Origin": client.base, "Cookie": client.cookie}
    there = itertools.cycle(each["sha256"] for each in client.get("/files")["files"])

    @seed(20261130)
    @settings(
        max_examples=EXAMPLES,
        deadline=None,
        database=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(case=SCHEMA[path][method.upper()].as_strategy())
    def ask(case: Any) -> None:
        case.path_parameters = on_the_desk(case.path_parameters, there)
        case.body = on_the_desk(case.body, there)
        answer = case.call(base_url=client.base, headers=headers)
        case.validate_response(answer, checks=[not_a_server_error, response_schema_conformance])
        for each in client.get("/activities")["running"]:
            client.post(f"/activities/{each['id']}/do", {"word": "end"})
        for each in client.get("/jobs")["jobs"]:
            client.post(f"/jobs/{each['id']}/cancel")

    ask()


def on_the_desk(value: Any, there: Iterator[str]) -> Any:
    """The same with hashes of files that are there: those that chance makes are never."""
    if isinstance(value, dict):
        return {key: on_the_desk(each, there) for key, each in value.items()}
    if isinstance(value, list):
        return [on_the_desk(each, there) for each in value]
    return next(there) if isinstance(value, str) and re.fullmatch("[0-9a-f]{64}", value) else value

"""What lower rooms name and higher rooms do: each is there, stands above, and nobody names what nobody does."""

import ast
import inspect
import re
from pathlib import Path

import pytest
from tests.house.test_imports import FLOORS, modules, room_of

from ulna.ground import provided as registry
from ulna.ground.provided import provided


def asked(root: Path) -> dict[str, str]:
    """Name of the work → the module that asks for it."""
    found = {}
    for name, path in modules(root).items():
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "provided":
                assert isinstance(node.args[0], ast.Constant), f"{name}: the work is not named where it is asked for"
                found[str(node.args[0].value)] = name
    return found


def test_what_is_asked_for_is_provided_and_what_is_provided_is_asked_for(root: Path) -> None:
    assert set(asked(root)) == set(registry._WHERE)


def test_every_provider_is_there_and_stands_above_who_asks(root: Path) -> None:
    for work, asker in asked(root).items():
        doer = provided(work)
        assert callable(doer)
        assert inspect.getdoc(doer), work
        assert FLOORS[room_of(doer.__module__)] > FLOORS[room_of(asker)], f"{work}: import it, it is not above"


def test_only_the_face_says_where(root: Path) -> None:
    for name, path in modules(root).items():
        if name not in ("ulna", "ulna.ground.provided"):
            assert not re.search(r"\bprovide\(", path.read_text(encoding="utf-8")), name


def test_what_nobody_provides_is_a_mistake_of_ours() -> None:
    with pytest.raises(LookupError, match="nobody provides 'nothing'"):
        provided("nothing")

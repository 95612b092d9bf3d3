"""The JSON Schemas are generated files: committed, and never stale."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import pytest
from tests.small_study import ARM, STUDY
from tools.schemas import MODELS, schemas

FOLDER = Path(__file__).parents[2] / "schemas"
FOSSILS = Path(__file__).parents[1] / "data" / "fossils"


@pytest.mark.parametrize("name", [f"{name}.json" for name in MODELS])
def test_a_committed_schema_is_what_the_models_say(name: str) -> None:
    fresh = json.loads(schemas()[name])
    committed = json.loads((FOLDER / name).read_text(encoding="utf-8"))
    assert committed == fresh, f"schemas/{name} is stale: run make schemas"


def test_no_schema_is_left_over() -> None:
    assert {path.name for path in FOLDER.iterdir()} == set(schemas())


def _known(schema: dict[str, Any], at: dict[str, Any], document: Any, where: str) -> list[str]:
    """Keys of a document that its schema does not know: a small check of ours, independent of the models."""
    if "$ref" in at:
        return _known(schema, schema["$defs"][at["$ref"].split("/")[-1]], document, where)
    for key in ("oneOf", "anyOf"):
        if key in at:
            return min((_known(schema, each, document, where) for each in at[key]), key=len)
    if isinstance(document, dict):
        inner = at.get("properties", {})
        rest = at.get("additionalProperties", {})
        unknown = [f"{where}.{key}" for key in document if key not in inner and rest is False]
        missing = [f"{where}.{key}" for key in at.get("required", []) if key not in document]
        into = {key: inner.get(key, rest) for key in document if key in inner or isinstance(rest, dict)}
        below = [_known(schema, each, document[key], f"{where}.{key}") for key, each in into.items()]
        return unknown + missing + [each for some in below for each in some]
    if isinstance(document, list):
        return [each for value in document for each in _known(schema, at.get("items", {}), value, where)]
    if "enum" in at or "const" in at:
        return [] if document in at.get("enum", [at.get("const")]) else [where]
    kinds: dict[str, Any] = {"string": str, "number": (int, float), "integer": int, "boolean": bool, "null": type(None)}
    return [] if "type" not in at or isinstance(document, kinds.get(at["type"], ())) else [where]


@pytest.mark.parametrize("kind", ["result", "evaluation", "cross-validation"])
def test_results_fit_their_schemas(kind: str) -> None:
    schema = json.loads((FOLDER / f"ulna-{kind}-1.json").read_text(encoding="utf-8"))
    document = json.loads((FOSSILS / f"{kind}-1.json").read_text(encoding="utf-8"))
    assert _known(schema, schema, document, "") == []
    del document["format"]
    assert _known(schema, schema, document, "") == [".format"]


@pytest.mark.parametrize(("name", "text"), [("ulna-arm-1", ARM), ("ulna-study-1", STUDY)])
def test_a_good_file_fits_its_schema_and_a_bad_one_does_not(name: str, text: str) -> None:
    schema = json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))
    document = tomllib.loads(text)
    assert _known(schema, schema, document, "") == []
    assert _known(schema, schema, document | {"nmae": "x"}, "") == [".nmae"]
    assert _known(schema, schema, {**document, "units": {"length": "mm"}}, "") == [".units.angle"]
    assert _known(schema, schema, {**document, "units": {"length": "yd", "angle": "rad"}}, "") == [".units.length"]

"""Documents as typed models: what is wrong is told with its key, value, what was expected and what to do."""

from __future__ import annotations

import json
import re
import typing
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from operator import or_
from pathlib import Path
from typing import Annotated, Any, TypeVar

from pydantic import BaseModel, ConfigDict, Discriminator, GetCoreSchemaHandler, Tag, ValidationError
from pydantic_core import CoreSchema, ErrorDetails

from ulna.ground.errors import UlnaInputError, nearest


class Strict(BaseModel):
    """A table of a hand-written file: no unknown key, no silent conversion, no NaN or infinity."""

    model_config = ConfigDict(
        strict=True,
        extra="forbid",
        frozen=True,
        allow_inf_nan=False,
        defer_build=True,  # a run validates one or two documents, not all that there are
    )


class Open(BaseModel):
    """A table of a file that Ulna writes: later versions may add keys."""

    model_config = ConfigDict(strict=True, extra="allow", allow_inf_nan=False, defer_build=True)


@dataclass(frozen=True, eq=False)  # hashed by what it is, as annotations must be
class OneOf:
    """Note of an annotation: the tables of a registry, told apart by their key `kind`.

    `Annotated[TheirCommonTable, OneOf({"bar": BarTable, "seat": SeatTable})]` is read, and described by JSON Schema, as
    a union of these tables written by hand would be.
    """

    tables: Mapping[str, type[BaseModel]]

    @property
    def union(self) -> Any:
        """The same as an annotation."""
        tagged: list[Any] = [Annotated[table, Tag(f"<{kind}>")] for kind, table in self.tables.items()]
        return Annotated[reduce(or_, tagged), Discriminator(_kind)]

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """What stands in place of the annotated type."""
        return handler.generate_schema(self.union)


def _kind(table: Any) -> str:
    kind = table.get("kind") if isinstance(table, dict) else getattr(table, "kind", None)
    return f"<{kind}>"


def table_or_plain(value: Any) -> str:
    """Which of two tags, `<table>` and `<plain>`: a discriminator of what may be a table, or one plain value for it."""
    return "<table>" if isinstance(value, dict | BaseModel) else "<plain>"


Model = TypeVar("Model", bound=BaseModel)


def fill(model: type[Model], document: Any, path: Path) -> Model:
    """A document as a typed model. Raises UlnaInputError with one message for the first thing that is wrong."""
    return _filled(model, path, lambda: model.model_validate(document))


def fill_json(model: type[Model], document: Any, path: Path) -> Model:
    """The same of a model that has dataclasses in it: from Python's objects a strict model takes only their instances,
    from JSON the tables that they are made of."""
    text = json.dumps(document, ensure_ascii=False)
    return _filled(model, path, lambda: model.model_validate_json(text))


def _filled(model: type[Model], path: Path, validate: Callable[[], Model]) -> Model:
    try:
        return validate()
    except ValidationError as error:
        details = error.errors(include_url=False)
        # An unknown key explains a missing one: 'alhpa' first, then 'alpha'.
        first = min(details, key=lambda detail: detail["type"] != "extra_forbidden")
        count = len(details) - 1
        more = f" {count} more problem{'s follow' if count > 1 else ' follows'}." if count else ""
        raise UlnaInputError(f"{path}: {_explain(first, model)}{more}") from None


def fill_or_list(model: type[Model], document: Any) -> tuple[Model | None, list[str]]:
    """A document as a typed model, or all that is wrong with it, each in words, unknown keys first."""
    try:
        return model.model_validate(document), []
    except ValidationError as error:
        details = sorted(error.errors(include_url=False), key=lambda detail: detail["type"] != "extra_forbidden")
        return None, [_explain(detail, model) for detail in details]


def listed(path: Path, problems: Sequence[str]) -> UlnaInputError:
    """One message for all that is wrong with a file, problem by problem."""
    if len(problems) == 1:
        return UlnaInputError(f"{path}: {problems[0]}")
    return UlnaInputError(f"{path}: {len(problems)} problems:" + "".join(f"\n- {each}" for each in problems))


def check_kind(table: Any, key: str, known: Sequence[str], path: Path) -> None:
    """What kind a table is of, before its other keys are looked at. Raises UlnaInputError where none knows it."""
    if not isinstance(table, dict):
        return
    kind = table.get("kind")
    expected = f"{', '.join(known[:-1])} or {known[-1]}"
    if kind is None:
        raise UlnaInputError(f"{path}: key '{key}.kind' is missing; expected {expected}. Add it.")
    if kind not in known:
        hint = nearest(str(kind), known)
        raise UlnaInputError(
            f"{path}: key '{key}.kind': got {kind!r}, expected {expected}."
            + (hint if "Did you mean" in hint else " Correct it.")
        )


def _explain(detail: ErrorDetails, model: type[BaseModel]) -> str:
    kind, location = detail["type"], detail["loc"]
    key = key_name(location, model)
    value = detail["input"]
    if kind == "extra_forbidden":
        owner = _at(model, location[:-1])
        known = [name for cls in owner for name in cls.model_fields]
        return f"unknown key '{key}'.{nearest(str(location[-1]), known)} Remove or correct it."
    if kind == "missing":
        if key == "units" or key.startswith("units."):
            return (
                f"key '{key}' is missing; units are never guessed. "
                'Add units = { length = "mm", angle = "rad" } (length: mm, m or in; angle: rad or deg).'
            )
        return f"key '{key}' is missing. Add it."
    if kind == "list_type" and isinstance(value, dict):
        return f"key '{key}': got one table [{key}], expected a list of tables. Write [[{key}]], with two brackets."
    shown = f"{str(value)[:60]!r}" if isinstance(value, str) else str(value)[:60]
    return f"key '{key}': got {shown}, expected {_expected(detail)}. Correct it."


def _expected(detail: ErrorDetails) -> str:
    kind, context = detail["type"], detail.get("ctx", {})
    value = detail["input"]
    if kind in ("float_type", "float_parsing"):
        comma = isinstance(value, str) and re.fullmatch(r"\s*[+-]?\d+,\d+\s*", value)
        return "a number without quotes" + (" and with a decimal point, not a comma" if comma else "")
    known = {
        "int_type": "a whole number",
        "finite_number": "a finite number",
        "string_type": "a text in quotes",
        "bool_type": "true or false",
        "list_type": "a list [...]",
        "dict_type": "a table",
        "model_type": "a table",
        "model_attributes_type": "a table",
        "dataclass_type": "a table",
        "dataclass_exact_type": "a table",
    }
    if kind in known:
        return known[kind]
    if kind == "literal_error":
        return str(context["expected"])
    if kind == "too_short":
        return f"at least {context['min_length']} entries (there are {context['actual_length']})"
    if kind == "too_long":
        return f"at most {context['max_length']} entries (there are {context['actual_length']})"
    if kind == "greater_than":
        return f"a number greater than {context['gt']:g}"
    if kind == "greater_than_equal":
        return f"a number of at least {context['ge']:g}"
    if kind == "less_than_equal":
        return f"a number of at most {context['le']}"
    # what the library says, in no voice of its own
    said = re.sub(r"^(Input should be |Value error, )(a valid )?", "", detail["msg"])
    return re.sub(r", unable to .*| or instance of \w+| found using .*", "", said)


def key_name(location: tuple[int | str, ...], model: type[BaseModel]) -> str:
    """A path of keys as a user counts: ``joint.2.alpha`` is of the second joint. Tags of a union are no keys."""
    parts: list[str] = []
    annotations: list[Any] = [model]
    for step in location:
        if isinstance(step, int):
            parts.append(str(step + 1))
        elif step.startswith("<"):
            continue
        else:
            parts.append(step)
        annotations = [inner for each in annotations for inner in _step(each, step)]
    return ".".join(parts)


def _at(model: type[BaseModel], location: tuple[int | str, ...]) -> list[type[BaseModel]]:
    """The models that may stand at a path of keys."""
    found: list[Any] = [model]
    for step in location:
        if isinstance(step, str) and step.startswith("<"):
            found = [inner for each in found for inner in _tagged(each, step)]
        else:
            found = [inner for each in found for inner in _step(each, step)]
    return [each for each in _plain(found) if isinstance(each, type) and issubclass(each, BaseModel)]


def _step(annotation: Any, step: int | str) -> list[Any]:
    inner: list[Any] = []
    for each in _plain([annotation]):
        if isinstance(each, type) and issubclass(each, BaseModel):
            if step in each.model_fields:
                inner.append(each.model_fields[str(step)].annotation)
        elif typing.get_origin(each) in (list, dict):
            inner.append(typing.get_args(each)[-1])
    return inner


def _tagged(annotation: Any, tag: str) -> list[Any]:
    """The members of a union that bear a tag."""
    if typing.get_origin(annotation) is typing.Annotated:
        inner, *notes = typing.get_args(annotation)
        registered = [note.tables[tag[1:-1]] for note in notes if isinstance(note, OneOf) and tag[1:-1] in note.tables]
        if registered or Tag(tag) not in notes:
            return registered or _tagged(inner, tag)
        others = [note for note in notes if note != Tag(tag)]
        return [typing.Annotated[(inner, *others)] if others else inner]
    if typing.get_origin(annotation) in (list, dict):
        return []
    return [inner for each in typing.get_args(annotation) for inner in _tagged(each, tag)]


def _plain(annotations: list[Any]) -> list[Any]:
    """Unions and Annotated taken apart."""
    plain: list[Any] = []
    for each in annotations:
        if typing.get_origin(each) in (list, dict) or not typing.get_args(each):
            plain.append(each)
        elif typing.get_origin(each) is typing.Annotated:
            inner, *notes = typing.get_args(each)
            tables = [table for note in notes if isinstance(note, OneOf) for table in note.tables.values()]
            plain += tables or _plain([inner])
        else:
            plain += _plain([arg for arg in typing.get_args(each) if not isinstance(arg, str | int)])
    return plain

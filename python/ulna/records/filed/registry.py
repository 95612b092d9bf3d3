"""Which kinds of files there are, one row each, and which of them a file is."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path

from ulna.ground.errors import UlnaInputError
from ulna.records.filed.arm import ArmKind
from ulna.records.filed.check import CheckKind
from ulna.records.filed.cross_validation import CrossValidationKind
from ulna.records.filed.evaluation import EvaluationKind
from ulna.records.filed.kind import FiledKind
from ulna.records.filed.other import OtherKind
from ulna.records.filed.result import ResultKind
from ulna.records.filed.verification import VerificationKind

OTHER = OtherKind()
KINDS: tuple[FiledKind, ...] = (
    ResultKind(),
    EvaluationKind(),
    CrossValidationKind(),
    VerificationKind(),
    CheckKind(),
    ArmKind(),
    OTHER,
)
_FORMAT = re.compile(r"ulna-[a-z-]+/\d+")


def kind_named(name: str) -> FiledKind:
    """By the name that the chain has. Raises UlnaInputError for one of a later Ulna."""
    for kind in KINDS:
        if kind.name == name:
            return kind
    raise UlnaInputError(f"record: a file of kind '{name}', which this Ulna does not know. Use a newer Ulna.")


def kind_of(format_said: str | None) -> FiledKind:
    """By the `format` that a file says. What no kind knows, such as a study, is kept as it is."""
    began = None if format_said is None else format_said.split("/")[0]
    return next((kind for kind in KINDS if kind.format is not None and kind.format == began), OTHER)


def format_of(path: Path, content: bytes) -> str | None:
    """What a file says its format is; None of one of no format of ours. A file that says so and cannot be read is
    looked at by its reader, which knows what is wrong."""
    try:
        if path.suffix.lower() == ".json":
            said = json.loads(content).get("format")
        elif path.suffix.lower() == ".toml":
            said = tomllib.loads(content.decode("utf-8-sig")).get("format")
        else:
            return None
    except (ValueError, AttributeError, RecursionError):
        found = _FORMAT.search(content[:2000].decode(errors="replace"))
        return None if found is None else found[0]
    return said if isinstance(said, str) and _FORMAT.fullmatch(said) else None

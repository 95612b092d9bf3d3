"""What raw bytes may be: separator, fields, which of them are a clock, a button, angles, each with the reason. A
proposal, for somebody to look at; nothing is taken because it was guessed.
"""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.worded import worded
from ulna.live.decode.fields import SECONDS

TURNS = (1024, 2000, 2048, 2400, 4000, 4096, 8192, 10000, 16384, 20000, 32768, 65536, 131072, 262144, 1048576)
"""Counts per turn of encoders that are sold."""
SEPARATORS = {",": worded("commas"), ";": worded("semicolons"), "\t": worded("tabs"), " ": worded("blanks")}
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_SHARE = 0.8
"""Of the lines that must be of one kind."""


@dataclass
class Field:
    """One number of a line or a message."""

    name: str
    values: F64
    """(N,)"""
    role: str = "channel"
    """channel, clock, button, counter or constant."""
    why: str = ""


@dataclass
class Proposal:
    """What it may be."""

    kind: str
    """fields, json, or nothing that is known."""
    reasons: list[str]
    """Each a sentence."""
    fields: list[Field] = field(default_factory=list)
    decode: dict[str, Any] = field(default_factory=dict)
    map: dict[str, Any] = field(default_factory=dict)

    def toml(self, url: str) -> str:
        """A source file, to be read by somebody and put right."""
        lines = ['format = "ulna-source/1"', f"url = {json.dumps(url)}", "", "[decode]"]
        lines += [f"{key} = {json.dumps(value, ensure_ascii=False)}" for key, value in self.decode.items()]
        lines += ["", "[map]"]
        lines += [f"{key} = {json.dumps(value, ensure_ascii=False)}" for key, value in self.map.items()]
        return "\n".join(lines) + "\n"


def guess(pieces: Sequence[tuple[float, bytes]], messages: bool) -> Proposal:
    """From pieces of bytes with the times at which they came, s; messages: whether each is one of its own."""
    lines = _lines(pieces, messages)
    if not lines:
        return Proposal("nothing", [worded("Nothing came that ends a line. Is it sending? Is the speed (baud) right?")])
    texts = [(t, text) for t, line in lines if (text := _text(line)) is not None]
    if len(texts) < _SHARE * len(lines):
        said = worded(
            "Most of it is no text: packets, or another speed (baud). For packets see the maker's description."
        )
        return Proposal("binary", [said])
    documents = [(t, document) for t, text in texts if isinstance(document := _json(text), dict)]
    if len(documents) >= _SHARE * len(texts):
        return _of_json(documents)
    return _of_fields(texts)


def _lines(pieces: Sequence[tuple[float, bytes]], messages: bool) -> list[tuple[float, bytes]]:
    if messages:
        return [(t, piece.strip()) for t, piece in pieces if piece.strip()]
    found, left = [], b""
    for t, piece in pieces:
        *whole, left = re.split(rb"[\r\n]+", left + piece)
        found += [(t, line) for line in whole if line.strip()]
    return found[1:] if len(found) > 1 else found  # the first may have begun before


def _text(line: bytes) -> str | None:
    try:
        text = line.decode("ascii").strip()
    except UnicodeDecodeError:
        return None
    return text if text.isprintable() or "\t" in text else None


def _json(text: str) -> Any:
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return None


def _of_fields(texts: list[tuple[float, str]]) -> Proposal:
    separator, share = max(
        ((each, _steady([text.count(each) for _, text in texts])) for each in SEPARATORS),
        key=lambda found: found[1],
    )
    if separator == " " and share >= _SHARE:
        split = [(t, text.split()) for t, text in texts]
    elif share >= _SHARE:
        split = [(t, [cell.strip() for cell in text.split(separator)]) for t, text in texts]
    else:
        split = [(t, [text]) for t, text in texts]
    first, many = Counter(cells[0] for _, cells in split).most_common(1)[0]
    prefix = first if not _NUMBER.fullmatch(first) and many >= 2 and many >= 0.2 * len(split) else None
    rows = [(t, cells[1:] if prefix else cells) for t, cells in split if prefix is None or cells[0] == prefix]
    rows = [(t, cells) for t, cells in rows if cells and all(_NUMBER.fullmatch(cell) for cell in cells)]
    if not rows:
        some = worded("Such as: {line}", line=texts[-1][1][:60])
        return Proposal("nothing", [worded("Lines of text, but none of numbers alone."), some])
    width = Counter(len(cells) for _, cells in rows).most_common(1)[0][0]
    rows = [(t, cells) for t, cells in rows if len(cells) == width]
    if width > 1:
        between = SEPARATORS[separator]
        reasons = [worded("Lines of {count} numbers, with {separator} between.", count=width, separator=between)]
    else:
        reasons = [worded("Lines of 1 numbers.")]
    if prefix:
        reasons.append(worded("They begin with '{prefix}'.", prefix=prefix))
    if len(rows) < len(texts):
        others = len(texts) - len(rows)
        reasons.append(worded("{count} of {all} lines are something else.", count=others, all=len(texts)))
    values = np.array([[float(cell) for cell in cells] for _, cells in rows])
    fields = [Field(f"c{k + 1}", values[:, k]) for k in range(width)]
    decode: dict[str, Any] = {"kind": "fields"}
    if width > 1 and separator != " ":
        decode["separator"] = separator
    if prefix:
        decode["prefix"] = prefix
    return _judged("fields", reasons, fields, decode, np.array([t for t, _ in rows]))


def _steady(counts: list[int]) -> float:
    """Which share of lines has the most common number of separators; 0 where that is none."""
    count, many = Counter(counts).most_common(1)[0]
    some = sum(1 for each in counts if each)
    return many / len(counts) if count else 0.5 * some / len(counts)


def _of_json(documents: list[tuple[float, dict[str, Any]]]) -> Proposal:
    leaves = _leaves(documents[0][1], "")
    lists = {path: value for path, value in leaves.items() if isinstance(value, list) and value}
    numbers = {path: value for path, value in lists.items() if all(_is_number(each) for each in value)}
    names = {path: value for path, value in lists.items() if all(isinstance(each, str) for each in value)}
    reasons = [worded("JSON objects.")]
    decode: dict[str, Any] = {"kind": "json"}
    if numbers:
        path = max(numbers, key=lambda each: len(numbers[each]))
        decode["values"] = [path]
        joints = next((each for each, value in names.items() if len(value) == len(numbers[path])), None)
        reasons.append(worded("'{path}' is a list of {count} numbers.", path=path, count=len(numbers[path])))
        if joints is not None:
            decode["joints"] = joints
            reasons.append(worded("'{path}' is as long and names them.", path=joints))
        labels = [str(each) for each in names[joints]] if joints else [f"c{k + 1}" for k in range(len(numbers[path]))]
        columns = [(t, found) for t, document in documents if len(found := _at(document, path)) == len(labels)]
    else:
        single = [path for path, value in leaves.items() if _is_number(value)]
        if not single:
            return Proposal("nothing", [worded("JSON objects, but no number in them.")])
        decode["values"] = labels = single
        reasons.append(worded("Numbers at {paths}.", paths=", ".join(single)))
        columns = [(t, [_at(document, path) for path in single]) for t, document in documents]
    columns = [(t, row) for t, row in columns if all(_is_number(each) for each in row)]
    values = np.array([row for _, row in columns], dtype=float).reshape(len(columns), len(labels))
    fields = [Field(name, values[:, k]) for k, name in enumerate(labels)]
    found = _judged("json", reasons, fields, decode, np.array([t for t, _ in columns]))
    if not numbers:  # paths are told apart: clock and button are no values
        found.decode["values"] = [each.name for each in fields if each.role == "channel"] or labels
    return found


def _leaves(document: Any, path: str) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in document.items():
        here = f"{path}.{name}" if path else str(name)
        if isinstance(value, dict) and here.count(".") < 8:
            found |= _leaves(value, here)
        else:
            found[here] = value
    return found


def _at(document: Any, path: str) -> Any:
    for step in path.split("."):
        document = document.get(step) if isinstance(document, dict) else None
    return document if document is not None else []


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _judged(kind: str, reasons: list[str], fields: list[Field], decode: dict[str, Any], t_host_s: F64) -> Proposal:
    """What each field is, and the unit of the channels."""
    for each in fields:
        each.role, each.why = role_of(each.values, t_host_s)
    clock = next((each for each in fields if each.role == "clock"), None)
    button = next((each for each in fields if each.role == "button"), None)
    channels = [each for each in fields if each.role == "channel"]
    if kind == "fields":
        decode["names"] = [each.name if each.role in ("channel", "clock", "button") else "-" for each in fields]
    if clock is not None and (kind == "fields" or "joints" not in decode):
        clock_unit = clock.why.split()[0]
        decode |= {"time": clock.name, "time_unit": clock_unit}
    if button is not None and kind == "fields":
        decode["button"] = button.name
    unit, why, counts = _unit([each.values for each in channels])
    reasons.append(why)
    mapped: dict[str, Any] = {"channels": [each.name for each in channels] or ["?"]}
    if unit is not None:
        mapped["unit"] = unit
    if counts is not None:
        mapped["counts_per_turn"] = counts
    return Proposal(kind, reasons, fields, decode, mapped)


def role_of(values: F64, t_host_s: F64) -> tuple[str, str]:
    """What a field is, and why; a clock's reason begins with its unit."""
    steps = np.diff(values)
    took_s = float(t_host_s[-1] - t_host_s[0]) if len(t_host_s) else 0.0
    if len(values) > 5 and (steps >= 0).all() and values[-1] > values[0] and took_s > 0.1:
        rate = float(values[-1] - values[0]) / took_s
        for unit, seconds in SECONDS.items():
            if abs(rate * seconds - 1.0) < 0.1:
                said = worded(
                    "{unit} : it grows by {rate} a second, as a clock in {unit} does", unit=unit, rate=f"{rate:.4g}"
                )
                return "clock", said
        if len(set(steps.tolist())) == 1 and steps[0] == 1.0:
            return "counter", worded("it grows by 1 with every line")
    if len(values) > 1 and not steps.any():
        if abs(values[0]) > 1.0:
            return "channel", worded("it did not move")
        return "channel", worded("it did not move: turn it to see")
    if set(np.unique(values).tolist()) <= {0.0, 1.0}:
        return "button", worded("it is 0 or 1")
    return "channel", worded("it moved by {much}", much=f"{np.ptp(values):.4g}")


def _unit(channels: list[F64]) -> tuple[str | None, str, float | None]:
    """deg, rad or counts of the channels together, why, and counts per turn."""
    if not channels:
        return None, worded("No channel of angles was found."), None
    every = np.concatenate(channels)
    return unit_of(bool((every == np.round(every)).all()), float(np.abs(every).max()))


def unit_of(whole: bool, size: float) -> tuple[str | None, str, float | None]:
    """deg, rad or counts of numbers up to a size, why, and counts per turn; whole: whether all are whole numbers."""
    if whole:
        if size <= 1.0:
            return None, worded("All numbers are 0 or 1: turn the arm to see what they are."), None
        turn = next((float(each) for each in TURNS if size < each), None)
        if turn is None:
            said = worded("Whole numbers up to {size}: counts; say counts_per_turn yourself.", size=f"{size:.0f}")
            return "counts", said, None
        return (
            "counts",
            worded(
                "Whole numbers up to {size}: counts, perhaps of {turn} a turn: look it up, or turn one joint once.",
                size=f"{size:.0f}",
                turn=f"{turn:.0f}",
            ),
            turn,
        )
    if size <= 2 * math.pi + 0.1:
        return (
            "rad",
            worded(
                "Decimals up to {size}, within a turn in rad (6.28): rad, or small angles in deg. Turn to see.",
                size=f"{size:.4g}",
            ),
            None,
        )
    if size <= 720.0:
        return "deg", worded("Decimals up to {size}, more than a turn in rad: deg.", size=f"{size:.4g}"), None
    return None, worded("Decimals up to {size}: no angles in deg or rad.", size=f"{size:.4g}"), None

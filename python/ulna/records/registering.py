"""What is registered by hand: equipment, certified values, events, people, settings."""

from __future__ import annotations

import math
import stat
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from sqlalchemy import Connection

from ulna.formats.names import check_path
from ulna.formats.toml import read_bytes
from ulna.ground.errors import UlnaInputError, nearest
from ulna.records import asked, chain
from ulna.records.acts import equipment as of_equipment
from ulna.records.acts import event as of_event
from ulna.records.acts import person as of_person
from ulna.records.acts import setting as of_setting
from ulna.records.bench import Bench, Writing, checked_text
from ulna.records.entry import Entry
from ulna.records.filed.kind import in_utc
from ulna.records.tables import EQUIPMENT

LARGEST = 256 * 2**20
"""Bytes of a file that is kept."""


@dataclass(frozen=True)
class Value:
    """Of an artefact's certificate."""

    quantity: str
    """As studies call it: "length", "diameter"."""
    value: float
    u: float
    """Standard uncertainty."""
    unit: str = "mm"


def chosen(what: str, value: str, known: Sequence[str]) -> str:
    """Raises UlnaInputError for a word that is none of those."""
    if value not in known:
        hint = nearest(value, known)
        near = hint if "Did you mean" in hint else " Correct it."
        raise UlnaInputError(f"{what}: got '{value[:60]}', expected one of {', '.join(known)}.{near}")
    return value


def keep(bench: Bench, path: Path | None) -> str | None:
    """A file's content in the store; its SHA-256. Raises UlnaInputError for one that cannot be read."""
    if path is None:
        return None
    return bench.files.put(content_of(path))


def content_of(path: Path) -> bytes:
    """Raises UlnaInputError for what is no file, such as a pipe, which another reading would find otherwise; for one
    that is too large, and for one that cannot be read."""
    check_path(path)
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError):
        mode = stat.S_IFREG  # whoever reads it says what is wrong
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        raise UlnaInputError(
            f"{path}: a pipe or a device; expected a file, which is the same when it is read once more. Write it to a "
            "file first."
        )
    content = read_bytes(path, "a file to keep", LARGEST + 1)
    if len(content) > LARGEST:
        raise UlnaInputError(f"{path}: has more than {LARGEST // 2**20} MB; expected less in one file. Leave it out.")
    return content


def file_name(path: Path) -> str:
    """As the record keeps it. Raises UlnaInputError for one with letters that lists cannot show."""
    if not path.name.isprintable():
        raise UlnaInputError(
            f"{str(path)!r}: its name has letters that cannot be printed, such as a line break; expected others. "
            "Rename it."
        )
    return path.name


def register(bench: Bench, name: str, kind: str, state: str | None, details: Mapping[str, str | None]) -> Entry:
    """Equipment: new, or as it is from now on. What is not said stays as it was. Raises UlnaInputError."""
    name = checked_text(name, "name")
    chosen("kind", kind, of_equipment.KINDS)
    if state is not None:
        chosen("state", state, of_equipment.STATES)
    said = {key: checked_text(value, key) for key, value in details.items() if value is not None}
    with bench.writing() as doing:
        return registered(doing, name, kind, state, said)


def registered(
    doing: Writing, name: str, kind: str, state: str | None = None, said: Mapping[str, str] = MappingProxyType({})
) -> Entry:
    """The same, of what was looked at, in the middle of writing. Raises UlnaInputError."""
    before = asked.last_of(doing.connection, EQUIPMENT, "name", name)
    if before is not None and before["kind"] != kind:
        raise UlnaInputError(f"record: '{name}' is registered as {before['kind']}, not {kind}. Choose another name.")
    if said.get("part_of"):
        asked.equipment(doing.connection, said["part_of"], ("arm", "robot"))
    kept = {key: before[key] for key in of_equipment.DETAILS if before[key] is not None} if before else {}
    stated = {"kind": kind, "state": state or (before["state"] if before else "in use"), **kept, **said}
    return doing.add("equipment", name, stated)


def certify(
    bench: Bench,
    artefact: str,
    values: Sequence[Value],
    certificate: Path | None = None,
    number: str | None = None,
    by: str | None = None,
    valid_from: str | None = None,
    valid_to: str | None = None,
    temperature_c: float | None = None,
    expansion_per_k: float | None = None,
    expansion_u_per_k: float | None = None,
    anew: Mapping[str, str | None] | None = None,
) -> Entry:
    """What a certificate says of an artefact. anew: it is registered as well, with these details and its "state"; both
    or nothing. Raises UlnaInputError."""
    if not values:
        raise UlnaInputError(
            f"record: no value of '{artefact}' is given; expected one, such as length 443.172, u 0.001 mm."
        )
    for each in values:
        if not (math.isfinite(each.value) and each.value > 0 and math.isfinite(each.u) and each.u >= 0):
            raise UlnaInputError(
                f"record: {each.quantity} of '{artefact}': got {each.value:g} with u {each.u:g}; expected a size "
                "above 0 and u not below 0. Correct it."
            )
    days = {
        key: None if day is None else in_utc(day, key)[:10]
        for key, day in (("valid_from", valid_from), ("valid_to", valid_to))
    }
    if days["valid_from"] and days["valid_to"] and days["valid_from"] > days["valid_to"]:
        raise UlnaInputError(f"record: certificate of '{artefact}': valid from {valid_from} to {valid_to}. Turn them.")
    texts = {"number": number, "by": by}
    numbers = {
        "temperature_c": temperature_c,
        "expansion_per_k": expansion_per_k,
        "expansion_u_per_k": expansion_u_per_k,
    }
    for key, number_said in numbers.items():
        if number_said is not None and not math.isfinite(number_said):
            raise UlnaInputError(f"record: {key} of '{artefact}': got {number_said}, expected a number. Correct it.")
    stated = {
        "values": [{"quantity": v.quantity, "unit": v.unit, "value": v.value, "u": v.u} for v in values],
        **{key: day for key, day in days.items() if day},
        **{key: checked_text(text, key) for key, text in texts.items() if text},
        **{key: float(value) for key, value in numbers.items() if value is not None},
    }
    said = {key: checked_text(value, key) for key, value in (anew or {}).items() if value is not None}
    state = said.pop("state", None)
    if state is not None:
        chosen("state", state, of_equipment.STATES)
    if anew is not None:
        artefact = checked_text(artefact, "name")
    named = _named(stated, certificate)
    sha256 = keep(bench, certificate)
    with bench.writing() as doing:
        if anew is not None:
            registered(doing, artefact, "artefact", state, said)
        name = asked.equipment(doing.connection, artefact, ("artefact",))["name"]
        return doing.add("certified", name, named, {"certificate": sha256} if sha256 else {})


def happened(
    bench: Bench, name: str, kind: str, text: str, at: str | None = None, file: Path | None = None
) -> list[Entry]:
    """An event of equipment; a quarantine, or its end, changes whether it may be used. Raises UlnaInputError."""
    chosen("kind of event", kind, of_event.KINDS)
    text = checked_text(text, "text of an event", 2000)
    when = in_utc(at, "option --at") if at is not None else chain.now()
    stated = _named({"kind": kind, "at": when, "text": text}, file, "file")
    sha256 = keep(bench, file)
    with bench.writing() as doing:
        row = asked.equipment(doing.connection, name)
        made = [doing.add("event", row["name"], stated, {"file": sha256} if sha256 else {})]
        state = of_event.STATE_AFTER.get(kind)
        if state is not None:
            details = {key: row[key] for key in ("kind", *of_equipment.DETAILS) if row[key] is not None}
            made.append(doing.add("equipment", row["name"], {**details, "state": state}))
        return made


def person(bench: Bench, name: str, roles: Sequence[str]) -> Entry:
    """Somebody, in which roles from now on. Raises UlnaInputError."""
    for role in roles:
        chosen("role", role, of_person.ROLES)
    with bench.writing() as doing:
        return doing.add("person", checked_text(name, "name"), {"roles": sorted(set(roles))})


def set_to(bench: Bench, name: str, value: str) -> Entry:
    """A setting. Raises UlnaInputError."""
    chosen("setting", name, tuple(of_setting.NAMES))
    of_setting.check(name, value)
    with bench.writing() as doing:
        return doing.add("setting", name, {"value": value})


def may(connection: Connection, name: str, role: str) -> bool:
    """Whether somebody is registered in a role."""
    from ulna.records.tables import PERSON

    row = asked.last_of(connection, PERSON, "name", name)
    return row is not None and role in row["roles"].split()


def _named(stated: dict[str, object], path: Path | None, role: str = "certificate") -> dict[str, object]:
    return stated if path is None else {**stated, "names": {role: file_name(path)}}

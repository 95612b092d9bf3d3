"""`ulna new`: tables as people keep them, with what is said of them."""

from __future__ import annotations

from random import Random

from fuzzing.cells import spoilt_table
from fuzzing.doors.csv_files import csv_bytes
from fuzzing.room import Room
from fuzzing.trial import Trial
from fuzzing.values import NUMBERS, TEXTS

_SAID = (
    (
        "--artefact",
        (
            "bar:200",
            "seat",
            "sphere:25",
            "plane",
            "points:plate.csv",
            "length",
            "bar",
            "bar:200:0.001",
            "bar:0",
            "x=bar:1",
        ),
    ),
    ("--length", ("200", "443.172")),
    ("--diameter", ("25",)),
    ("--features", ("plate.csv", "fossils/plate-1.csv")),
    ("--u", ("0.001",)),
    ("--reach", ("900", "0", "1e9")),
    ("--parallel", ("none", "1", "2", "4")),
    ("--dh", ("dh.csv",)),
    ("--urdf", ("robot.urdf",)),
    ("--arm", ("arm.toml", "out/result.json")),
    ("--zeros", ("known", "unknown")),
    ("--signs", ("known", "unknown")),
    ("--counts-per-turn", ("4096", "0", "1")),
    ("--angle", ("rad", "deg", "counts")),
    ("--convention", ("dh", "modified-dh")),
    ("--angle-unit", ("rad", "deg")),
    ("--length-unit", ("mm", "m", "in")),
    ("--column", ("q1=q2", "q1=Achse 1", "feature=placement", "placement=feature")),
    ("--name", ("feature.A=B", "feature.A=links", "artefact.bar=x")),
    ("--header", ("1", "2", "99")),
    ("--separator", (";", "tab", " ")),
    ("--decimal", (",", ".")),
    ("--comment", ("#",)),
)
_HEADINGS = (
    "Achse 1",
    "Achse 2",
    "J3",
    "J4 [deg]",
    "关节1",
    "Temperatur",
    "Stab",
    "Ende",
    "Lage",
    "X [mm]",
    "Encoder 1",
    "axis_2",
)
_FLAGS = ("--skip-bad", "--one-standing", "--units-row", "--no-units-row", "--force")


def new_trial(_room: Room, source: Random) -> Trial:
    """A proposal."""
    table = spoilt_table(source)
    for k in range(len(table.names)):
        if source.random() < 0.15:
            table.names[k] = source.choice(_HEADINGS)
    words = ["new", "--readings", "kept.csv"]
    if source.random() < 0.5:
        words += ["--artefact", "bar:200", "--arm", "arm.toml", "--angle", "counts"]
    for _ in range(source.choice([0, 1, 2, 4])):
        name, values = source.choice(_SAID)
        value = source.choice(values) if source.random() < 0.7 else str(source.choice([*NUMBERS, *TEXTS]))
        words += [name, "".join(sign for sign in value if sign != "\0" and not 0xD800 <= ord(sign) <= 0xDFFF)[:200]]
    if source.random() < 0.2:
        words.append(source.choice(_FLAGS))
    return Trial(words, {"kept.csv": csv_bytes(table, source)})

"""A small, good study on disk for the tests of files and bad input: each test spoils one thing in it."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

from ulna import Arm, InputWarning, Study, UlnaInputError

ARM = """\
format = "ulna-arm/1"
name = "three axes"
units = { length = "mm", angle = "rad" }

[[joint]]
name = "shoulder"
theta0 = 0.1
alpha = -1.5708
a = 40.0
d = 250.0
limits = [-3.0, 3.0]
counts_per_turn = 4096

[[joint]]
theta0 = 0.2
alpha = 1.5708
a = -40.0
d = 1.5
counts_per_turn = 4096

[[joint]]
name = "wrist roll"
counts_per_turn = 4096

[probe.bent]
tip = { theta0 = 0.4, r = 39.0, h = 223.0 }
ball = 6.0

[probe.straight]
tip = { x = 0.0, y = 0.0, z = 238.0 }
"""

#: how a study of arm.toml begins
MM_RAD, MM_DEG = (
    f'format = "ulna-study/1"\narm = "arm.toml"\nunits = {{ length = "mm", angle = "{angle}" }}\n\n'
    for angle in ("rad", "deg")
)
STUDY = (
    MM_RAD
    + """\
[[readings]]
file = "bars.csv"
angle = "rad"
artefact = "bar"
probe = "bent"

[artefact.bar]
kind = "bar"
length = 443.172
u = 0.001

[noise]
encoder = 5e-6
seat = 0.005

[fit]
hold = ["joint.1.theta0"]
"""
)

#: two standings of the bar, each touched twice at A and twice at B
BARS = "q1,q2,q3,placement,feature\n" + "".join(
    f"{q1!r},{q2!r},{q3!r},{1 + row // 4},{'AABB'[row % 4]}\n"
    for row, (q1, q2, q3) in enumerate(np.random.default_rng(7).uniform(-2, 2, (8, 3)).round(6).tolist())
)

PLATE = "feature,x,y,z\ns1,0,0,0\ns2,100,0,0\ns3,0,100,0\n"


class SmallStudy:
    """arm.toml, study.toml, bars.csv and plate.csv in a folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.path = folder / "study.toml"
        for name, text in (("arm.toml", ARM), ("study.toml", STUDY), ("bars.csv", BARS), ("plate.csv", PLATE)):
            self.write(name, text)

    def write(self, name: str, content: str | bytes) -> None:
        """One file anew."""
        (self.folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())

    def swap(self, name: str, old: str, new: str) -> None:
        """The first `old` in a file becomes `new`."""
        text = (self.folder / name).read_bytes().decode()
        assert old in text, f"{name} has no {old!r}"
        self.write(name, text.replace(old, new, 1))

    def cell(self, row: int, column: str, value: str) -> None:
        """One cell of bars.csv; rows from 1."""
        lines = (self.folder / "bars.csv").read_text().splitlines()
        cells = lines[row].split(",")
        cells[lines[0].split(",").index(column)] = value
        lines[row] = ",".join(cells)
        self.write("bars.csv", "\n".join(lines) + "\n")

    def load(self) -> tuple[Study, list[str]]:
        """The study, and what was warned of."""
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            study = Study.load(self.path)
        assert all(issubclass(warning.category, InputWarning) for warning in caught)
        return study, [str(warning.message) for warning in caught]

    def error(self) -> str:
        """The message with which loading fails."""
        with pytest.raises(UlnaInputError) as caught:
            self.load()
        return str(caught.value)

    def refuses(self) -> bool:
        """Whether loading fails, with a message; warnings are nobody's affair."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                Study.load(self.path)
            except UlnaInputError as error:
                says(str(error), str(self.folder))
                return True
        return False


def arm_error(path: Path, content: str | bytes) -> str:
    """The message with which loading an arm fails, from a file with this content."""
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(UlnaInputError) as caught:
        Arm.load(path)
    return str(caught.value)


def says(message: str, *fragments: str) -> None:
    """A message is one line, a sentence, and holds every fragment."""
    assert "\n" not in message
    assert message[-1] in ".?", message
    for fragment in fragments:
        assert fragment in message, f"{fragment!r} not in: {message}"

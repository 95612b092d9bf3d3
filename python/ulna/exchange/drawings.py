"""An arm from whatever says what it is: an arm file, a result, a robot's description, a table.

One row of `FORMS` for each; which it is, is seen by the ending of the name.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from ulna.arm.arm import Arm
from ulna.exchange.export.source import remarks_of_result
from ulna.exchange.importers.dh import arm_from_table
from ulna.exchange.importers.dh_table import read_dh
from ulna.exchange.importers.urdf import base_remark
from ulna.exchange.urdf.arm import arm_from_chain
from ulna.exchange.urdf.chain import read_chain
from ulna.exchange.urdf.units import in_units
from ulna.ground.errors import UlnaInputError


@dataclass(frozen=True)
class Asked:
    """What must be said of a drawing that does not say it, as options of the same names."""

    convention: str | None = None
    """"dh" or "modified-dh"."""
    length_unit: str | None = None
    angle_unit: str | None = None
    tip: tuple[float, float, float] | None = None
    tip_link: str | None = None
    base_link: str | None = None


@dataclass(frozen=True)
class Drawn:
    """An arm, the file that it is in, and what should be known of it."""

    arm: Arm
    file: Path
    remarks: Sequence[str] = ()


@dataclass(frozen=True)
class Form:
    """A kind of file with an arm in it."""

    what: str
    endings: tuple[str, ...]
    options: tuple[str, ...]
    """Fields of `Asked` that go with it."""
    read: Callable[[Path, Asked], Drawn]


def read_drawing(path: Path, asked: Asked) -> Drawn:
    """The arm of a file, or of a folder with a result. Raises UlnaInputError."""
    file = _in_folder(path) if path.is_dir() else path
    form = next((form for form in FORMS if file.suffix.lower() in form.endings), None)
    if form is None:
        known = "; ".join(f"{', '.join(form.endings)}: {form.what}" for form in FORMS)
        raise UlnaInputError(f"{file}: its ending does not say what it is; expected one of {known}. Rename it.")
    for each in fields(asked):
        if getattr(asked, each.name) is not None and each.name not in form.options:
            option = "--" + each.name.replace("_", "-")
            own = [form.what for form in FORMS if each.name in form.options]
            raise UlnaInputError(
                f"option {option}: got it for {file}, {form.what}; expected it with {' or '.join(own)} only. Leave it "
                "out."
            )
    return form.read(file, asked)


def _in_folder(folder: Path) -> Path:
    """What is there of a calibration."""
    for name in ("result.json", "arm.toml"):
        if (folder / name).is_file():
            return folder / name
    raise UlnaInputError(
        f"{folder}: there is neither result.json nor arm.toml in this folder; expected the folder of a calibration. "
        "Name the arm's file."
    )


def _arm(file: Path, _: Asked) -> Drawn:
    return Drawn(Arm.load(file), file, remarks_of_result(file))


def _urdf(file: Path, asked: Asked) -> Drawn:
    chain = in_units(read_chain(file, asked.tip_link, asked.base_link), asked.length_unit, asked.angle_unit)
    arm, t_root_base = arm_from_chain(chain)
    return Drawn(arm, file, [base_remark(t_root_base, f"of link '{chain.base_link}'"), *chain.remarks])


def _table(file: Path, asked: Asked) -> Drawn:
    if asked.convention is None:
        raise UlnaInputError(
            f"{file}: whether a row of the table holds alpha and a after its joint or before it is not known and never "
            "guessed; expected --convention dh (after) or modified-dh (before). Add it."
        )
    convention: Any = asked.convention
    found = arm_from_table(read_dh(file, asked.length_unit, asked.angle_unit), convention, asked.tip)
    return Drawn(found.arm, file, found.remarks)


FORMS = (
    Form("an arm file", (".toml",), (), _arm),
    Form("a result", (".json",), (), _arm),
    Form(
        "a robot's description (URDF)",
        (".urdf", ".xml"),
        ("length_unit", "angle_unit", "tip_link", "base_link"),
        _urdf,
    ),
    Form("a DH table (CSV)", (".csv", ".tsv", ".txt"), ("convention", "length_unit", "angle_unit", "tip"), _table),
)

"""The examples that `ulna demo` plays: one row each. Their files are those of `examples/` in the repository, which a
wheel holds beside the program."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ulna.ground.errors import UlnaInputError


@dataclass(frozen=True)
class Step:
    """A command, and what is shown of that which it prints."""

    title: str
    command: str
    """Without `ulna`; {} is the folder."""
    shows: tuple[str, ...]
    """How the paragraphs begin that are shown; "" is the first one."""
    makes: bool = True
    """Whether it writes something, which `--force` overwrites."""


@dataclass(frozen=True)
class Demo:
    """An example."""

    about: str
    files: tuple[str, ...]
    """Below examples/, in the order in which a reader would open them."""
    steps: tuple[Step, ...]
    results: tuple[tuple[str, str], ...]
    """File → what is in it."""
    next: tuple[tuple[str, str], ...]
    """Command → what for."""


_OWN = ("new --readings YOUR-TABLE.xlsx", "your own table")
_BEFORE_AND_AFTER = ("", "Before and after")

DEMOS = {
    "bars": Demo(
        about="A seven-axis arm touched both ends of a bar in 101 places. Its drawing is wrong by up to 45 mm.",
        files=(
            "platinum/study.toml",
            "platinum/platinum.toml",
            "platinum/bars.csv",
            "platinum/check.toml",
            "platinum/check-bars.csv",
        ),
        steps=(
            Step("Fit the arm to the readings", "calibrate {}/study.toml -o {}/result", _BEFORE_AND_AFTER),
            Step(
                "Ten fresh bars, which the fit has not seen",
                "evaluate {}/result/result.json {}/check.toml",
                ("Over all readings",),
                makes=False,
            ),
        ),
        results=(
            ("result/arm.toml", "the calibrated arm, ready to use"),
            ("result/result.json", "all that was found, with uncertainties"),
        ),
        next=(
            ("report {}/result -o {}/report.html", "the report"),
            ("measure {}/result/result.json {}/bars.csv", "x, y, z and u"),
            ("show {}/result -o {}/arm.html", "the arm, drawn"),
            _OWN,
        ),
    ),
    "seat": Demo(
        about="A calibrated arm gets a straight probe: 32 poses in one conical seat, whose place nobody knows.",
        files=("platinum/seat.toml", "platinum/platinum-straight.toml", "platinum/seat.csv"),
        steps=(Step("Fit the probe alone", "calibrate {}/seat.toml -o {}/result", _BEFORE_AND_AFTER),),
        results=(("result/arm.toml", "the arm with its new probe"), ("result/result.json", "all that was found")),
        next=(
            ("measure {}/result/result.json {}/seat.csv", "x, y, z and u"),
            ("report {}/result -o {}/report.html", "the report"),
            _OWN,
        ),
    ),
    "spreadsheet": Demo(
        about="A table as people keep it, of an arm without a drawing: German headings, decimal commas, gaps, a "
        "comment here and there. Nobody knows the encoders' zeros.",
        files=("home-built/messung.csv",),
        steps=(
            Step(
                "Make a study of it",
                "new --readings {}/messung.csv --artefact bar --length 443.172 --reach 1000 --parallel none "
                "-o {}/study",
                ("messung.csv",),
            ),
            Step("Search for the arm", "calibrate {}/study/study.toml -o {}/result", ("Before and after",)),
        ),
        results=(
            ("study/study.toml", "what was touched, how the table is read"),
            ("result/arm.toml", "the arm as it was found"),
        ),
        next=(
            ("evaluate {}/result/result.json {}/study/study.toml", "each standing"),
            ("report {}/result -o {}/report.html", "the report"),
            _OWN,
        ),
    ),
}


def examples_folder() -> Path:
    """Where the examples are: in the package, or in the checkout that is used where it stands. Raises
    UlnaInputError."""
    package = Path(__file__).resolve().parents[1]
    checkout = package.parents[1]
    # an editable build lays a copy into the package too, which need not be of today
    folder = (checkout if (checkout / "crates").is_dir() else package) / "examples"
    if not (folder / "platinum" / "study.toml").is_file():
        raise UlnaInputError(f"{folder}: the examples are not there; expected them with Ulna. Install it again.")
    return folder

"""The messages on the errors page: each kind of bad input made from the shipped example, and what the command says."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from docs_running import reader_folder, ulna

STUDY = "examples/platinum/study.toml"
ARM = "examples/platinum/platinum.toml"
READINGS = "examples/platinum/bars.csv"
Break = Callable[[Path], None]


def swap(name: str, old: str, new: str, count: int = 1) -> Break:
    """Replace text in a file; fails where it is not there, so that a case cannot quietly stop being one."""

    def edit(folder: Path) -> None:
        text = (folder / name).read_text(encoding="utf-8")
        assert old in text, f"{name} has no {old!r}"
        (folder / name).write_text(text.replace(old, new, count), encoding="utf-8")

    return edit


def cell(row: int, column: int, value: str) -> Break:
    """Put a value into a data row (from 1) and column (from 0) of the readings."""

    def edit(folder: Path) -> None:
        lines = (folder / READINGS).read_text(encoding="utf-8").splitlines()
        cells = lines[row].split(",")
        cells[column] = value
        lines[row] = ",".join(cells)
        (folder / READINGS).write_text("\n".join(lines) + "\n", encoding="utf-8")

    return edit


def rows(keep: Callable[[list[str]], list[str]]) -> Break:
    """Keep some data rows of the readings."""

    def edit(folder: Path) -> None:
        header, *data = (folder / READINGS).read_text(encoding="utf-8").splitlines()
        (folder / READINGS).write_text("\n".join([header, *keep(data)]) + "\n", encoding="utf-8")

    return edit


def degrees(folder: Path) -> None:
    """Write the angles in degrees, but let the study go on calling them radians."""
    header, *data = (folder / READINGS).read_text(encoding="utf-8").splitlines()
    turned = []
    for line in data:
        cells = line.split(",")
        turned.append(",".join([*cells[:2], *(f"{float(value) * 57.29578:.4f}" for value in cells[2:])]))
    (folder / READINGS).write_text("\n".join([header, *turned]) + "\n", encoding="utf-8")


def decimal_commas(folder: Path) -> None:
    """As a spreadsheet of another country writes it."""
    text = (folder / READINGS).read_text(encoding="utf-8")
    (folder / READINGS).write_text(text.replace(",", ";").replace(".", ","), encoding="utf-8")


def keep_results(folder: Path) -> None:
    """A result of yesterday."""
    (folder / "out").mkdir()
    (folder / "out" / "result.json").write_text("{}", encoding="utf-8")


def mapped(keys: str) -> Break:
    """Say more of the readings' file."""
    return swap(STUDY, 'file = "bars.csv"\n', f'file = "bars.csv"\n{keys}\n')


def workbook(edit: Callable[[Any], object], keys: str = "") -> Break:
    """The readings as a workbook, edited."""

    def write(folder: Path) -> None:
        import openpyxl

        lines = [line.split(",") for line in (folder / READINGS).read_text(encoding="utf-8").splitlines()]
        book = openpyxl.Workbook()
        book.active.title = "Sheet1"
        book.active.append(lines[0])
        for line in lines[1:]:
            book.active.append([*line[:2], *map(float, line[2:])])
        edit(book)
        book.save((folder / READINGS).with_suffix(".xlsx"))
        swap(STUDY, 'file = "bars.csv"\n', f'file = "bars.xlsx"\n{keys}')(folder)

    return write


#: section → what is wrong → how to break the example
CASES: dict[str, dict[str, Break]] = {
    "Files": {
        "a file that is not there": swap(STUDY, '"bars.csv"', '"bar.csv"'),
        "another kind of file": swap(STUDY, "ulna-study/1", "ulna-arm/1"),
        "a format of the future": swap(STUDY, "ulna-study/1", "ulna-study/7"),
        "an unknown key": swap(STUDY, "encoder =", "encodr ="),
        "no units": swap(ARM, 'units = { length = "mm", angle = "rad" }\n', ""),
        "an empty file": rows(lambda data: []),
        "a result of yesterday in the way": keep_results,
    },
    "Cells": {
        "not a number": cell(17, 4, "n/a"),
        "NaN": cell(17, 4, "nan"),
        "degrees read as radians": degrees,
        "decimal commas": decimal_commas,
    },
    "Tables of others": {
        "a column that is not there": mapped('columns = { q1 = "sholder" }'),
        "a key that the format has no use for": mapped('sheet = "Sheet1"'),
        "several sheets": workbook(lambda book: book.create_sheet("Notes")),
        "a cell of a workbook": workbook(lambda book: book.active.__setitem__("E18", "n/a")),
        "a formula that nobody computed": workbook(lambda book: book.active.__setitem__("E18", "=E17*2")),
        "a filter that leaves nothing": mapped('where = { placement = "place 1000" }'),
        "a split that leaves nothing to fit": mapped('split = { column = "feature", fit = "C", check = "B" }'),
    },
    "Names": {
        "an unknown probe": swap(STUDY, 'probe = "bent"', 'probe = "bend"'),
        "an unknown artefact": swap(STUDY, 'artefact = "bar"', 'artefact = "baar"'),
        "an unknown feature": cell(17, 1, "C"),
        "a pattern that matches nothing": swap(STUDY, "joint.1.theta0", "joint.8.theta0"),
    },
    "Sense": {
        "another number of joints": swap(ARM, "[[joint]]\ntheta0 = 1.521927\nalpha = -1.57\na = 35.0\nd = 149.7\n", ""),
        "a bar touched at one end only": rows(lambda data: data[:-1]),
        "fewer observations than unknowns": rows(lambda data: data[:20]),
        "links that grow, and nobody knows how warm it was": swap(STUDY, "[fit]", '[fit]\nextras = ["link-expansion"]'),
        "joints that give way to nothing": swap(STUDY, "[fit]", '[fit]\nextras = ["compliance"]'),
    },
}
#: the same for files that other commands read: what is wrong → command and file to write
BROUGHT_IN: dict[str, tuple[list[str], str, str]] = {
    "a xacro file for a URDF": (
        ["import", "urdf", "robot.urdf", "-o", "arm.toml"],
        "robot.urdf",
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="arm.xacro"/></robot>',
    ),
    "a joint that floats": (
        ["import", "urdf", "robot.urdf", "-o", "arm.toml"],
        "robot.urdf",
        '<robot name="r"><link name="hall"/><link name="base"/>'
        '<joint name="lift" type="floating"><parent link="hall"/><child link="base"/></joint></robot>',
    ),
    "a table without units": (
        ["import", "dh", "maker.csv", "-o", "arm.toml", "--convention", "modified-dh"],
        "maker.csv",
        "theta0,alpha,a,d\n0,0,0,0.333\n0,-90,0,0\n",
    ),
    "a column that may mean two things": (
        ["import", "dh", "maker.csv", "-o", "arm.toml", "--convention", "dh"],
        "maker.csv",
        "theta,alpha_deg,a_m,d_m\n0,-90,0,0.333\n0,0,0,0\n",
    ),
    "an option without its file": (
        ["export", "urdf", ARM, "-o", "arm.urdf", "--tip-link", "tool0"],
        "unused",
        "",
    ),
}

#: suspicious, but possible: the work is done all the same
WARNINGS: dict[str, Break] = {
    "a row twice": rows(lambda data: [*data, data[0]]),
    "readings outside a joint's limits": swap(ARM, "alpha = -1.57\n", "alpha = -1.57\nlimits = [-2.9, 2.9]\n"),
}


def message(broken: Break, exit_code: int = 2) -> str:
    """What `ulna calibrate` says to the example broken in this way."""
    with reader_folder() as folder:
        broken(folder)
        done = ulna(["calibrate", STUDY, "-o", "out"], folder)
        assert done.returncode == exit_code, f"expected exit code {exit_code}, got {done.returncode}: {done.stderr}"
        text = (
            done.stderr.split("Written:")[0]
            .strip()
            .replace(str(folder.resolve()) + "/", "")
            .replace(str(folder) + "/", "")
        )
        return re.sub(r"\s*\n\s*", " ", text)


def message_brought_in(arguments: list[str], name: str, text: str) -> str:
    """What another command says to a file of this name and text."""
    with reader_folder() as folder:
        (folder / name).write_text(text, encoding="utf-8")
        done = ulna(arguments, folder)
        assert done.returncode == 2, f"expected exit code 2, got {done.returncode}: {done.stderr}"
        return done.stderr.strip()


def _quoted(words: str, said: str) -> str:
    return f"**{words[0].upper()}{words[1:]}**\n\n> `{said}`"


def error_page() -> str:
    """Markdown: a section for each kind, a quoted message for each case."""
    parts = ["<!-- Generated by `make docs-output`; do not edit. -->"]
    for section, cases in CASES.items():
        parts.append(f"## {section}")
        parts += [_quoted(words, message(broken)) for words, broken in cases.items()]
    parts.append("## Robots and tables")
    parts += [_quoted(words, message_brought_in(*case)) for words, case in BROUGHT_IN.items()]
    parts.append("## Warnings")
    parts += [_quoted(words, message(broken, 0)) for words, broken in WARNINGS.items()]
    return "\n\n".join(parts) + "\n"

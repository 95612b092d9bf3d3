"""A home-built arm of six axes that touched a bar, and how its owner keeps the readings: a workbook or a text with
titles, headings in his language, bar ends in words, merged cells, a column of comments and five bad touches."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import openpyxl

from ulna.arm.arm import Arm
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.ground.arrays import F64
from ulna.simulation.simulate import simulate

LENGTH_MM = 443.172
COUNTS = 65536
STANDINGS, TOUCHES = 45, 4
DROPPED = 1
ROWS = STANDINGS * TOUCHES - DROPPED
"""179"""
MISSED = (12, 47, 88, 131, 160)
"""Rows, from 1, in which the ball was beside its seat."""

GERMAN = {
    "title": ("Messarm Eigenbau, Kugelstab", "gemessen am 12.3. in der Werkstatt"),
    "standing": "Messung",
    "axis": "Achse {}",
    "end": "Ende",
    "ends": ("links", "rechts"),
    "comment": "Bemerkung",
    "said": "neu aufgelegt",
    "sheet": "Messwerte",
}
CHINESE = {
    "title": ("自制六轴测量臂，球杆", "车间测量"),
    "standing": "测量",
    "axis": "轴{}",
    "end": "端",
    "ends": ("左", "右"),
    "comment": "备注",
    "said": "重新放置",
    "sheet": "数据",
}


@dataclass(frozen=True)
class Kept:
    """What was measured, and the truth behind it."""

    truth: Arm
    q_rad: F64
    """(179, 6)"""
    standing: list[int]
    end: list[int]
    """0 or 1"""

    @property
    def counts(self) -> F64:
        """(179, 6) whole numbers."""
        return np.round(self.q_rad * COUNTS / (2 * np.pi))

    def rows(self, words: dict[str, object], values: F64) -> list[list[object]]:
        """Standing, axes, end, comment of each touch; the standing only where it is new."""
        rows: list[list[object]] = []
        for k, (standing, end) in enumerate(zip(self.standing, self.end, strict=True)):
            new = k == 0 or self.standing[k - 1] != standing
            said = words["said"] if new and standing % 7 == 0 else ""
            rows.append([standing if new else "", *values[k].tolist(), words["ends"][end], said])  # type: ignore[index]
        return rows


def true_arm(seed: int) -> Arm:
    """Axes at nearly right angles, zeros and signs anywhere."""
    rng = np.random.default_rng(seed)
    d_mm = np.array([250.0, 0.0, 420.0, 0.0, 380.0]) + rng.normal(0, 20, 5)
    a_mm, off_rad = rng.normal(0, 25, 5), rng.normal(0, 0.004, 5)
    signs = rng.choice([-1, 1], 6)
    joints = [
        Joint(rng.uniform(-3, 3), (-1) ** (k + 1) * np.pi / 2 + off_rad[k], a_mm[k], d_mm[k], sign=int(signs[k]))
        for k in range(5)
    ]
    return Arm("home-built", (*joints, Joint(sign=int(signs[5]))), {"tip": Probe(30.0, 15.0, 150.0)})


def measured(folder: Path, seed: int = 1, arm: Arm | None = None, missed: bool = True) -> Kept:
    """Four touches of each of 45 standings, by turns left and right; one is missing, five miss their seat."""
    truth = arm or true_arm(seed)
    folder.mkdir(parents=True, exist_ok=True)
    truth.save(folder / "true.toml", force=True)
    specification = folder / "specification.toml"
    specification.write_text(
        f'format = "ulna-simulation/1"\narm = "true.toml"\nunits = {{ length = "mm", angle = "rad" }}\nseed = {seed}\n'
        f'noise = {{ encoder = 5e-5, seat = 0.02 }}\n[artefact.bar]\nkind = "bar"\nlength = {LENGTH_MM}\n'
        f"placements = {STANDINGS}\ntouches = {TOUCHES // 2}\n[travel]\nlimits = [[-2.5, 2.5]]\n"
    )
    group = simulate(specification).study.readings[0]
    q_rad = group.q_rad.copy()
    rng = np.random.default_rng(seed)
    keep = np.ones(len(q_rad), bool)
    keep[-1] = False
    q_rad = q_rad[keep]
    for row in MISSED if missed else ():
        q_rad[row - 1] += rng.choice([-1, 1], 6) * 0.02
    standing = (np.arange(len(keep))[keep] // TOUCHES + 1).tolist()
    for name in ("true.toml", "specification.toml"):
        (folder / name).unlink()
    return Kept(truth, q_rad, standing, group.feature[keep].tolist())


def workbook(kept: Kept, path: Path, words: dict[str, object] = GERMAN, merged: bool = True) -> None:
    """Counts, below two rows of titles and a blank one; the number of a standing in merged cells."""
    book = openpyxl.Workbook()
    sheet = book.active
    assert sheet is not None
    sheet.title = str(words["sheet"])
    for line in words["title"]:  # type: ignore[attr-defined]
        sheet.append([line])
    sheet.append([])
    sheet.append(headings(words))
    for row in kept.rows(words, kept.counts):
        sheet.append([cell if cell != "" else None for cell in row])
    first = 5
    for k in range(len(kept.standing)) if merged else ():
        if k and kept.standing[k] == kept.standing[k - 1]:
            continue
        last = k
        while last + 1 < len(kept.standing) and kept.standing[last + 1] == kept.standing[k]:
            last += 1
        sheet.merge_cells(start_row=first + k, end_row=first + last, start_column=1, end_column=1)
    book.save(path)


def headings(words: dict[str, object], unit: str = "") -> list[str]:
    """Above the columns."""
    axes = [str(words["axis"]).format(k) + unit for k in range(1, 7)]
    return [str(words["standing"]), *axes, str(words["end"]), str(words["comment"])]


def text(
    kept: Kept,
    path: Path,
    words: dict[str, object],
    encoding: str,
    values: F64,
    separator: str,
    decimal: str,
    unit: str = "",
    titles: bool = False,
) -> None:
    """The same as a text, as a spreadsheet program exports it."""
    stream = io.StringIO()
    writer = csv.writer(stream, delimiter=separator)
    for line in words["title"] if titles else ():  # type: ignore[attr-defined]
        writer.writerow([line])
    writer.writerow(headings(words, unit))
    for row in kept.rows(words, values):
        writer.writerow([repr(cell).replace(".", decimal) if isinstance(cell, float) else cell for cell in row])
    path.write_bytes(stream.getvalue().encode(encoding))


def example(path: Path, folder: Path) -> None:
    """examples/home-built/messung.csv: degrees with four decimals, as a German spreadsheet program writes them."""
    kept = measured(folder, seed=1)
    text(kept, path, GERMAN, "utf-8-sig", np.round(np.degrees(kept.q_rad), 4), ";", ",", " [°]", titles=True)


def length_errors_mm(found: Arm, truth: Arm, q_rad: F64) -> F64:
    """Distances between tips at readings and at the readings ten rows on, found minus true: what a bar tells of an arm,
    wherever its base stands, and of its mirror image too."""

    def lengths(arm: Arm) -> F64:
        tips = arm.tip(q_rad)
        return np.linalg.norm(tips[10:] - tips[:-10], axis=1)

    return lengths(found) - lengths(truth)


def turned(arm: Arm, zeros_rad: float, lengths_mm: float, seed: int) -> Arm:
    """The arm as a drawing has it: zeros and lengths a little off, twists right angles."""
    rng = np.random.default_rng(seed)
    joints = [
        replace(
            joint,
            theta0_rad=joint.theta0_rad + rng.uniform(-zeros_rad, zeros_rad),
            alpha_rad=round(joint.alpha_rad / (np.pi / 2)) * np.pi / 2,
            a_mm=joint.a_mm + rng.uniform(-lengths_mm, lengths_mm),
            d_mm=joint.d_mm + rng.uniform(-lengths_mm, lengths_mm),
        )
        for joint in arm.joints[:-1]
    ]
    return replace(arm, joints=(*joints, arm.joints[-1]))

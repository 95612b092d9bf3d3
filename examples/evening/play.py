"""Your own arm in an evening, played: every command is run, a hand at a simulated arm does what it asks for in words.

    python examples/evening/play.py out/evening

It takes some six minutes, as long as the hand takes. What each command printed is in FOLDER/said, and what it wrote
beside it. `docs/evening.md` shows it.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from home_built import HomeBuilt, Line
from ulna.ground.arrays import F64
from ulna.live.commission.posture import posture
from ulna.planning.stands import elbow_sides, probe_from

HERE = Path(__file__).resolve().parent
BAR_MM, GAUGE_MM = 300.012, 180.004
"""The bar that the arm is calibrated with, and one that nobody has told it."""
BY_EYE_DEG = 3.0
Heard = Callable[[str], None]


class Hand:
    """Does what it hears."""

    def __init__(self, arm: HomeBuilt) -> None:
        self.arm = arm
        self.bar_mm: F64 | None = None
        self._last: tuple[int, str | None, str] = (0, None, "near")

    def commissions(self, line: str) -> None:
        """Holds, turns, and takes a posture, as it is asked for."""
        arm, built = self.arm, self.arm.built
        joint = int(found[1]) - 1 if (found := re.search(r"Turn only joint (\d+)", line)) else -1
        if "(from the base)" in line:
            low, high = arm.travel_rad[joint]
            arm.turn(joint, low, high, arm.middle_rad[joint])
        elif joint >= 0:
            here = arm.end_rad[joint]
            arm.turn(joint, here + built.arm.joints[joint].sign * np.radians(30.0))
        elif "Bring the arm into this posture" in line:
            off = np.radians(BY_EYE_DEG) * arm.rng.standard_normal(len(arm.middle_rad))
            arm.go(built.encoders(posture(arm.drawing).turned_rad + off))

    def touches(self, line: str) -> None:
        """Puts the bar where it is asked for and touches it; a little otherwise where that cannot be."""
        place = re.match(r"Next, put it at x (\S+), y (\S+), z (\S+) mm, (\w+)(?: (\d+)°)?, towards (\d+)°", line)
        if place:
            x, y, z, lies, slope, azimuth = place.groups()
            steep = {"upright": 88.0, "hanging": -88.0, "level": 0.0}.get(lies, float(slope or 0.0))
            steep = -steep if lies == "falling" else steep
            self.put(np.array([x, y, z], dtype=float), np.radians(float(azimuth)), np.radians(steep), BAR_MM)
        how = re.search(r"touch ([AB])(?:, elbow ([\w-]+))?, probe from (\w+)", line)
        if how:
            self._touch("AB".index(how[1]), how[2], how[3])
        elif line.startswith("Not taken"):
            self._touch(*self._last)

    def put(self, middle_mm: F64, azimuth_rad: float, slope_rad: float, length_mm: float) -> F64:
        """A bar about where it was asked for, where the arm reaches both ends: (2, 3) mm."""
        along = np.array(
            [np.cos(slope_rad) * np.cos(azimuth_rad), np.cos(slope_rad) * np.sin(azimuth_rad), np.sin(slope_rad)]
        )
        for _ in range(40):
            about = middle_mm + 4.0 * self.arm.rng.standard_normal(3)
            bar = np.array([about - 0.5 * length_mm * along, about + 0.5 * length_mm * along])
            if all(len(self.arm.postures(end, 20)) for end in bar):
                break
            middle_mm = 0.97 * middle_mm  # a little nearer
        self.bar_mm = bar
        return bar

    def _touch(self, end: int, elbow: str | None, comes_from: str) -> None:
        """With the elbow to the side that was asked for, if the arm can."""
        self._last = end, elbow, comes_from
        assert self.bar_mm is not None
        postures = self.arm.postures(self.bar_mm[end], 80)
        at = np.repeat(self.bar_mm[end][None], len(postures), axis=0)
        same = np.array(elbow_sides(self.arm.built.arm, postures, at)) == elbow
        same = same.astype(int) * 2 + (np.array(probe_from(self.arm.built.arm, postures, at)) == comes_from)
        best = np.flatnonzero(same == same.max())
        self.arm.go(postures[int(self.arm.rng.choice(best))])


def run(folder: Path, name: str, command: str, hears: Heard) -> None:
    """A command; what it prints goes to FOLDER/said/NAME.txt, and line by line to the hand."""
    process = subprocess.Popen(
        [sys.executable, "-m", "ulna", *command.split()],
        cwd=folder,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        env=os.environ | {"COLUMNS": "80", "PYTHONUNBUFFERED": "1", "NO_COLOR": "1"},
        text=True,
    )
    assert process.stdout is not None
    print(f"$ ulna {command}", flush=True)
    heard = []
    for line in process.stdout:
        heard.append(line)
        print(line, end="", flush=True)
        hears(line)
    if process.wait() != 0:
        raise SystemExit(f"ulna {command} exited with {process.returncode}")
    (folder / "said" / f"{name}.txt").write_text("".join(heard), encoding="utf-8")


def main(folder: Path) -> None:
    """The evening."""
    (folder / "said").mkdir(parents=True, exist_ok=True)
    arm = HomeBuilt(HERE / "drawing.toml")
    hand, line = Hand(arm), Line(arm, folder / "ttyACM0")
    try:
        run(folder, "guess", "live guess serial:ttyACM0 -o arduino.toml --force", lambda _: None)
        shutil.copy(HERE / "drawing.toml", folder)
        command = "live commission arduino.toml --arm drawing.toml --counts-per-turn 16384 --yes --force -o my-arm"
        run(folder, "commission", command, hand.commissions)
        fill_in(folder / "my-arm" / "plan.toml")
        arm.go(arm.middle_rad)
        line.wait()
        command = "live touch my-arm/arm.toml my-arm/plan.toml my-arm/source.toml -o touched --trigger still"
        run(folder, "touch", f"{command} --goal 0.05 --length 300 --held-out 5", hand.touches)
        arm.go(arm.middle_rad)
        line.wait()
        # a gauge of another length, in a place where nothing was touched, twice from end to end
        bar_mm = hand.put(np.array([250.0, -260.0, 220.0]), 0.4, 0.3, GAUGE_MM)
        arm.go(arm.postures(bar_mm[0], 20)[0])
        line.wait()
        ends = threading.Thread(target=_touch_ends, args=(arm, bar_mm), daemon=True)
        ends.start()
        command = "live measure touched/result my-arm/source.toml --still --feature length --seconds 36 -o gauge.csv"
        run(folder, "measure", command, lambda _: None)
        ends.join()
    finally:
        line.close()


def fill_in(plan: Path) -> None:
    """What is known of the bar, as one types it into the file."""
    text = plan.read_text(encoding="utf-8")
    text = re.sub(r"^length = .*$", f"length = {BAR_MM}", text, flags=re.M)
    plan.write_text(re.sub(r"^seat = .*$", "seat = 0.02", text, flags=re.M), encoding="utf-8")


def _touch_ends(arm: HomeBuilt, bar_mm: F64) -> None:
    time.sleep(10.0)  # until the command listens and has taken the first
    for end in (1, 0, 1):
        arm.go(arm.postures(bar_mm[end], 20)[0], rest_s=4.0)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/evening"))

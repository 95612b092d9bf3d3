"""The picture of all ways: what each leaves of the arm's errors."""

from __future__ import annotations

from pathlib import Path

from matplotlib import rc_context
from matplotlib.figure import Figure

from ulna.ground.style import BLUE, STYLE, VERMILION, save_picture
from ulna.reproduce.ways.arms import ARMS
from ulna.reproduce.ways.outcome import Outcome


def draw_ways(outcomes: list[Outcome], folder: Path) -> None:
    """`ways.svg` and `ways.png`: length and point errors by way, one panel an arm, on a logarithmic axis."""
    ways = list(dict.fromkeys(outcome.way for outcome in outcomes if outcome.touches))
    at = {way: len(ways) - 1 - k for k, way in enumerate(ways)}
    with rc_context(STYLE):
        figure = Figure(figsize=(7.6, 4.4), layout="constrained")
        panels = figure.subplots(1, len(ARMS), sharex=True, sharey=True)
        for axes, arm in zip(panels, ARMS, strict=True):
            mine = [outcome for outcome in outcomes if outcome.arm == arm and outcome.touches]
            rows = [at[outcome.way] for outcome in mine]
            for label, colour, marker, values in (
                ("lengths of fresh bars, rms", BLUE, "o", [outcome.bars_by_arm_rms_mm for outcome in mine]),
                ("worst point anywhere", VERMILION, "D", [outcome.worst_point_mm for outcome in mine]),
            ):
                micrometres = [1000 * value for value in values]
                axes.plot(micrometres, rows, linestyle="", marker=marker, color=colour, label=label, clip_on=False)
            axes.set_xscale("log")
            axes.set_title(arm.capitalize())
            axes.set_yticks(list(at.values()), list(at))
            axes.set_ylim(-0.6, len(ways) - 0.4)
            axes.grid(axis="y", color="0.9", linewidth=0.8)
            axes.set_axisbelow(True)
        figure.supxlabel("error that the calibrated arm contributes / µm", fontsize=10)
        handles, labels = panels[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper center", ncols=2)
        save_picture(figure, folder, "ways", pdf=True)

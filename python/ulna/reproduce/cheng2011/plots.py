"""The pictures of the study, as SVG and PNG."""

from __future__ import annotations

from math import pi
from pathlib import Path

from matplotlib import rc_context
from matplotlib.figure import Figure

from ulna.ground.style import BLUE, GREEN, GREY, STYLE, VERMILION, save_picture
from ulna.reproduce.cheng2011.arms import RATED_MM
from ulna.reproduce.cheng2011.convergence import WRONG_BY_MM, Convergence
from ulna.reproduce.cheng2011.experiment import Experiment


def draw_bars(found: Experiment, folder: Path) -> None:
    """`bars.svg` and `bars.png`: errors of the ten fresh bars against the rated accuracy."""
    with rc_context(STYLE):
        figure = Figure(figsize=(7.2, 3.6), layout="constrained")
        left, right = figure.subplots(1, 2, sharey=True)
        panels = (
            (left, "Bent probe", BLUE, "o", found.bent_errors_mm, found.bent_errors_true_arm_mm),
            (right, "Straight probe", VERMILION, "s", found.straight_errors_mm, found.straight_errors_true_arm_mm),
        )
        for axes, title, colour, marker, errors, true_arm in panels:
            number = range(1, len(errors) + 1)
            axes.axhspan(-1000 * RATED_MM, 1000 * RATED_MM, color=GREY, alpha=0.10, linewidth=0)
            for sign in (-1, 1):
                axes.axhline(1000 * sign * RATED_MM, color=GREY, linestyle="--", linewidth=1)
            axes.axhline(0, color=GREY, linewidth=0.6)
            axes.plot(
                number,
                [1000 * e for e in true_arm],
                linestyle="",
                marker="_",
                markersize=11,
                color="black",
                label="true arm: noise alone",
            )
            axes.plot(
                number, [1000 * e for e in errors], linestyle="", marker=marker, color=colour, label="calibrated arm"
            )
            axes.set_title(title)
            axes.set_xlabel("fresh bar")
            axes.set_xticks(list(number))
            axes.set_ylim(-50, 62)
            axes.legend(loc="upper left", ncols=2, fontsize=8, handletextpad=0.3, columnspacing=1.0)
        left.set_ylabel("length error / µm")
        right.annotate(
            "rated ±37 µm",
            (10.4, -37),
            xytext=(0, -3),
            textcoords="offset points",
            ha="right",
            va="top",
            color=GREY,
            fontsize=8,
        )
        save_picture(figure, folder, "bars", pdf=True)


def draw_convergence(found: list[Convergence], folder: Path) -> None:
    """`convergence.svg` and `convergence.png`: how many wrong starts found the arm, by how wrong they were."""
    with rc_context(STYLE):
        figure = Figure(figsize=(7.2, 3.8), layout="constrained")
        axes = figure.subplots()
        size = [at.wrong_by_rad for at in found]
        curves = (
            ("search", GREEN, "^", "-", [at.search / at.starts for at in found]),
            ("default: searches on from a poor minimum", BLUE, "o", "--", [at.given / at.starts for at in found]),
            ("one start", VERMILION, "s", "-", [at.one_start / at.starts for at in found]),
        )
        for label, colour, marker, line, share in curves:
            axes.plot(
                size,
                [100 * s for s in share],
                color=colour,
                marker=marker,
                linestyle=line,
                label=label,
                markersize=9 if marker == "^" else 6,
                clip_on=False,
            )
        axes.axvline(0.1, color=GREY, linestyle=":", linewidth=1)
        axes.annotate(
            "the paper's limit: 0.1 rad", (0.1, 4), xytext=(5, 0), textcoords="offset points", color=GREY, fontsize=8
        )
        axes.set_xscale("log")
        axes.set_xticks(size, ["π" if value == pi else f"{value:g}" for value in size])
        axes.set_xticks([], minor=True)
        axes.set_xlabel(f"zero offsets wrong by up to / rad   (lengths by up to {WRONG_BY_MM:g} mm)")
        axes.set_ylabel(f"starts that find the arm / %   (of {found[0].starts} each)")
        axes.set_ylim(0, 104)
        axes.legend(loc="lower left", bbox_to_anchor=(0.05, 0.10))
        save_picture(figure, folder, "convergence", pdf=True)

"""How the pictures look: colours that a colour-blind reader can tell apart, and shapes besides."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

# Okabe and Ito's palette (2008), the orange darker so that words can have it: one meaning each, in every picture
# and table. Blue: readings, values, after. Vermilion: outliers, fails, what is lost. Green: passes, what the noise
# explains. Orange: undecided, the guard band. Grey: before, limits, what is given.
BLUE, VERMILION, GREEN, ORANGE, GREY = "#0072B2", "#D55E00", "#009E73", "#9A6700", "#595959"
#: verdict → colour
OF_VERDICT: dict[str | None, str] = {"pass": GREEN, "undecided": ORANGE, "fail": VERMILION, None: GREY}

STYLE: Any = {
    "font.size": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "svg.hashsalt": "ulna",  # the same numbers make the same file
    "svg.fonttype": "path",
}


def save_picture(figure: Figure, folder: Path, name: str, pdf: bool = False) -> None:
    """As SVG and as PNG; as PDF too where it is asked for."""
    if pdf:
        figure.savefig(folder / f"{name}.pdf", metadata={"CreationDate": None})
    figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
    figure.savefig(folder / f"{name}.png", dpi=160)

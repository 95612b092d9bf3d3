"""What `docs/evening.md` shows: the evening of examples/evening, played in real time, some five minutes.

A hand and a clock are never twice the same to the last digit, so no test compares these files with what is printed
today; `tests/examples/test_evening.py` plays the same hand without the clock.
"""

import re
import sys
import tempfile
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
EXAMPLE = ROOT / "examples" / "evening"
PARTS: dict[str, tuple[str, str]] = {
    "guess": ("", ""),
    "commission": ("", ""),
    "touch": ("Touch 3,", "Fresh places touched"),
    "measure": ("", ""),
}
"""Name → the lines between which some are left out, where there are very many."""
MANY, SHOWN = "x ", 2
"""Lines that come every second, and how many of them in a row are shown."""


FILES = [f"evening-{name}.txt" for name in PARTS]
"""Below docs/output."""


def evening_outputs() -> dict[str, str]:
    """File below docs/output → text."""
    sys.path.insert(0, str(EXAMPLE))
    from play import main

    with tempfile.TemporaryDirectory() as folder:
        main(Path(folder))
        said = {name: (Path(folder) / "said" / f"{name}.txt").read_text(encoding="utf-8") for name in PARTS}
    return {f"evening-{name}.txt": _shown(text, *PARTS[name]) for name, text in said.items()}


def _shown(text: str, first: str = "", again: str = "") -> str:
    """As it is on the page: the port by its usual name, no spaces at ends of lines; of many touches the first and the
    last."""
    text = text.replace("serial:ttyACM0", "serial:/dev/ttyACM0")
    text = re.sub(r"(?m)^ttyACM0:", "/dev/ttyACM0:", text)
    lines = [line.rstrip() for line in text.strip("\n").splitlines()]
    if first:
        begin = next(k for k, line in enumerate(lines) if line.startswith(first))
        end = next(k for k, line in enumerate(lines) if line.startswith(again))
        lines = [*lines[: begin + 1], "…", *lines[end:]]
    shown, many = list[str](), 0
    for line in lines:
        many = many + 1 if line.startswith(MANY) else 0
        if many <= SHOWN:
            shown.append(line)
        elif many == SHOWN + 1:
            shown.append("…")
    # as a terminal of 80 columns shows it
    folded = [part for line in shown for part in (textwrap.wrap(line, 80) if len(line) > 80 else [line])]
    return "\n".join(folded) + "\n"


if __name__ == "__main__":
    for name, text in evening_outputs().items():
        (ROOT / "docs" / "output" / name).write_text(text, encoding="utf-8")

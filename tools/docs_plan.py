"""The table on the page about planning: the example's plan with one thing changed at a time."""

import json
import re
from pathlib import Path
from typing import Any

from docs_running import reader_folder, ulna

#: what the first column says → keys of [plan] in place of the example's
VARIANTS = {
    "nothing": {},
    "`trials = 2000`": {"trials": "2000"},
    "`seed = 1`": {"seed": "1"},
    "`seed = 2`": {"seed": "2"},
    "`placements = 100`: any": {"placements": "100"},
    "`placements = 20`": {"placements": "20"},
    "`placements = 5`": {"placements": "5"},
    **{
        f'`criterion = "{criterion}"`': {"criterion": f'"{criterion}"'}
        for criterion in ("length-worst", "point", "D", "A", "E", "G")
    },
    "`choose = 50`": {"choose": "50"},
}


def _planned(folder: Path, keys: dict[str, str]) -> dict[str, Any]:
    example = folder / "examples" / "platinum"
    text = (example / "plan.toml").read_text(encoding="utf-8")
    for key, value in keys.items():
        text = re.sub(rf"^{key} =.*\n", "", text, flags=re.MULTILINE) + f"{key} = {value}\n"
    (example / "variant.toml").write_text(text, encoding="utf-8")
    done = ulna(["plan", "examples/platinum/platinum.toml", "examples/platinum/variant.toml", "--json"], folder)
    if done.returncode != 0:
        raise RuntimeError(f"ulna plan with {keys}: {done.stderr}")
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def _figures(figures: dict[str, Any]) -> str:
    values = (figures[name] for name in ("u_length_mm", "u_length_worst_mm", "u_point_mm"))
    return " | ".join(f"{1000 * value:.2f}" for value in values)


def plan_table() -> str:
    """Markdown: expected uncertainties in µm, and the gain over as many random measurements by simulation."""
    lines = ["| changed | stands | u(length) | worst | u(point) | by simulation |", "|---|---:|---:|---:|---:|---:|"]
    with reader_folder() as folder:
        for words, keys in VARIANTS.items():
            found = _planned(folder, keys)
            trial = found["trial"]
            if not keys:
                lines.append(f"| random, {found['choose']} | | {_figures(found['random'])} | |")
            gain = f"{100 * trial['gain']:.0f}\u00a0%".replace("-", "\N{MINUS SIGN}")
            both = f"{1000 * trial['planned_mm']:.2f} against {1000 * trial['random_mm']:.2f}\u00a0µm"
            lines.append(f"| {words} | {found['stands']} | {_figures(found['planned'])} | {gain}: {both} |")
    return "\n".join(lines) + "\n"

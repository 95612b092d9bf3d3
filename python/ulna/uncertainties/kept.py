"""A volume map kept: its numbers and its picture, in a folder."""

from __future__ import annotations

import json
from pathlib import Path

from ulna.formats.output import output_folder
from ulna.ground.extras import need
from ulna.uncertainties.volume import VolumeMap
from ulna.uncertainties.zones import as_dict, cells

FILES = ["volume.json", "volume.csv", "volume.svg", "volume.png"]


def check_pictures() -> None:
    """Raises UlnaInputError where what draws the map is not installed."""
    need("the picture of a map", "matplotlib")


def save_volume(found: VolumeMap, folder: Path, force: bool = False) -> None:
    """Write FILES, whole or not at all. Raises UlnaInputError."""
    check_pictures()
    from ulna.uncertainties.plots import draw_volume

    with output_folder(folder, FILES, force) as staging:
        text = json.dumps(as_dict(found), indent=1, ensure_ascii=False, allow_nan=False)
        (staging / "volume.json").write_text(text + "\n", encoding="utf-8")
        cells(found).write_csv(staging / "volume.csv")
        draw_volume(found, staging)

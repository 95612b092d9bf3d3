"""Points that were taken, as a table: with their angles, so that another calibration can measure them anew."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import polars as pl

from ulna.formats.output import new_file, refuse_inputs
from ulna.ground.errors import UlnaInputError
from ulna.live.features import Notebook
from ulna.live.figures import Calibrated
from ulna.measuring.written import writer_of


def check_points(path: Path, inputs: Sequence[Path], force: bool) -> None:
    """Whether they can be written there, asked before the work. Raises UlnaInputError."""
    from ulna.arm.file import result_file

    writer_of(path)
    refuse_inputs([path], [*inputs, result_file(inputs[0])])
    if path.exists() and not force:
        raise UlnaInputError(f"{path}: exists already and is not overwritten. Name another file, or give --force.")


def write_points(path: Path, arm: Calibrated, notebook: Notebook, force: bool) -> None:
    """One row a point: id, probe, x, y, z, u_x, u_y, u_z (mm; empty where not determined, or not known), q1, … (rad),
    of which feature it is, samples, spread and drift (mm) of its dwell. Whole or not at all. Raises UlnaInputError."""
    rows = []
    for feature in notebook.features:
        for point in feature.points:
            row: dict[str, object] = {"id": point.name, "probe": arm.probe}
            row |= {each.name: each.value for each in point.figures}
            row |= {f"u_{each.name}": each.u for each in point.figures}
            row |= {f"q{k + 1}": angle for k, angle in enumerate(point.q_rad.tolist())}
            row |= {"part_of": f"{feature.name} {feature.kind}", "samples": point.samples}
            rows.append(row | {"spread": point.spread_mm, "drift": point.drift_mm})
    texts = {"id": pl.String, "probe": pl.String, "part_of": pl.String, "samples": pl.Int64}
    frame = pl.DataFrame(rows, schema={name: texts.get(name, pl.Float64) for name in rows[0]})
    write = writer_of(path)
    with new_file(path, force) as staged:
        write(iter([frame]), staged)

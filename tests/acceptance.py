"""What the tests of acceptance tests share: small verify files with x, y, z of no particular arm, and exact answers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
from numpy.typing import NDArray

F64 = NDArray[np.float64]

BALL = (
    '[artefact.ball]\nkind = "ball"\ndiameter = 25.0\nu = 0.0003\nform = 0.0004\nexpansion = 5.5e-6\n'
    "u_expansion = 0.5e-6\n"
)


def sphere(centre: tuple[float, float, float], radius: float, count: int = 25) -> F64:
    """Points spread evenly over a whole sphere."""
    k = np.arange(count) + 0.5
    z, turn = 1.0 - 2.0 * k / count, np.pi * (1.0 + 5**0.5) * k
    beside = np.sqrt(1.0 - z**2)
    return np.asarray(radius * np.column_stack([beside * np.cos(turn), beside * np.sin(turn), z]) + np.array(centre))


def rows(points: F64, **labels: str) -> pl.DataFrame:
    """Touches with the same labels."""
    columns = {name: [label] * len(points) for name, label in labels.items()}
    return pl.DataFrame({**columns, **{axis: points[:, k] for k, axis in enumerate("xyz")}})


def iso_rows() -> pl.DataFrame:
    """Errors by hand: P_Size +10 and -20 µm, L_Dia 50 µm, E_Uni +20 and -30 µm."""
    parts = [
        rows(sphere((100, 200, 300), 15.505), test="probing", artefact="ball", position="1"),
        rows(sphere((-400, 200, 100), 15.490), test="probing", artefact="ball", position="2"),
    ]
    centres = [(0, 0, 0), (0.030, 0.040, 0), (0.015, 0.02, 0.005), (0.02, 0.02, 0), (0.01, 0.02, 0.0)]
    for k, centre in enumerate(centres, start=1):
        points = sphere((500 + centre[0], centre[1], centre[2]), 15.5, 5)
        parts.append(rows(points, test="articulation", artefact="ball", orientation=str(k)))
    for position, length in (("1", 600.020), ("2", 599.970)):
        for feature, x in (("A", 0.0), ("B", length)):
            point = np.array([[x, 10.0, 20.0 * float(position)]])
            parts.append(rows(point, test="uni", artefact="bar", position=position, repeat="1", feature=feature))
    return pl.concat(parts, how="diagonal").fill_null("")


def write_plan(folder: Path, table: pl.DataFrame | None = None, more: str = "", **replaced: str) -> Path:
    """plan.toml and touches.csv; `replaced`: other text for the parts of the file, by name."""
    parts = {
        "head": 'format = "ulna-verify/1"\nprofile = "iso-10360-12"\nunits = { length = "mm", angle = "rad" }\n',
        "keys": 'arm = "a foreign arm"\nball = 6.0\nrange = 900.0\n',
        "mpe": "[mpe]\nP_Size = 0.018\nP_Form = 0.03\nL_Dia = 0.06\nE_Uni = { a = 0.020, b = 60000 }\n",
        "ball": BALL,
        "bar": '[artefact.bar]\nkind = "length"\nlength = 600.0\nu = 0.001\nends = "seats"\nexpansion = 11.5e-6\n'
        "u_expansion = 1e-6\n",
        "air": "[temperature]\nvalue = 20.0\nu = 0.1\n[fixture]\nu = 0.0005\n",
        "readings": '[[readings]]\nfile = "touches.csv"\n',
    } | replaced
    folder.mkdir(parents=True, exist_ok=True)
    (iso_rows() if table is None else table).write_csv(folder / "touches.csv")
    path = folder / "plan.toml"
    path.write_text("".join(parts.values()) + more, encoding="utf-8")
    return path

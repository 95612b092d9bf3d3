"""A simulated study as files: study.toml and the readings, in mm and rad, or counts where the encoders count."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import polars as pl

from ulna.arm.arm import Arm
from ulna.arm.file import arm_toml
from ulna.arm.payload import Payload
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.orientation import AXES
from ulna.artefacts.readings import Readings
from ulna.formats.toml_text import toml_key, toml_value
from ulna.ground.arrays import F64
from ulna.simulation.account import account_json
from ulna.study.data import AUTO, FitOptions, Noise
from ulna.study.study import Study

#: keys of [fit] that are said as they are, where they are not as usual
FIT_KEYS = ("hold", "free", "loss", "start", "extras", "harmonics", "judge_extras")
KNOWN = {"known_length": "known_length_mm", "known_angle": "known_angle_rad"}
"""Keys of [fit] with a unit, in the study's mm and rad, and their fields."""


def names_for(artefacts: Iterable[Artefact]) -> list[str]:
    """Names of all files, the readings last."""
    names = ["arm.toml", "study.toml", "truth.toml", "truth.json"]
    for artefact in artefacts:
        names.append(f"{artefact.name}.csv")
        if kind_of(artefact).features_file:
            names.append(features_file(artefact))
    return names


def texts(study: Study, truth: Arm, account: dict[str, Any]) -> dict[str, str]:
    """The hand-written kind of files, by name."""
    return {
        "arm.toml": arm_toml(study.arm),
        "study.toml": study_toml(study, counts=account["reads_counts"]),
        "truth.toml": arm_toml(truth),
        "truth.json": account_json(account),
    }


def study_toml(study: Study, counts: bool, split: Mapping[str, str] | None = None) -> str:
    """The text of a study file for readings beside it. split: the key of all readings, where some are kept to check."""
    lines = ['format = "ulna-study/1"', 'arm = "arm.toml"', 'units = { length = "mm", angle = "rad" }']
    for group in study.readings:
        table: dict[str, Any] = {"file": f"{group.artefact.name}.csv", "artefact": group.artefact.name}
        if counts:
            table["angle"] = "counts"
        if split is not None:
            table["split"] = dict(split)
        if not _several_probes(group):
            table["probe"] = list(study.arm.probes)[int(group.probe[0])]
        lines += _table("[[readings]]", table)
    for group in study.readings:
        lines += _table(f"[artefact.{toml_key(group.artefact.name)}]", artefact_table(group.artefact))
    if study.noise is not None:
        lines += _table("[noise]", _noise_table(study.noise))
    usual = FitOptions()
    fit = {key: getattr(study.fit, key) for key in FIT_KEYS if getattr(study.fit, key) != getattr(usual, key)}
    if study.fit.auto:
        fit["extras"] = AUTO
    other = {key: name for key, name in KNOWN.items() if getattr(study.fit, name) != getattr(usual, name)}
    fit |= {key: getattr(study.fit, name) for key, name in other.items()}
    if fit:
        lines += _table("[fit]", fit)
    return "\n".join(lines) + "\n"


def write_tables(
    study: Study, step_rad: F64 | None, folder: Path, beside: Mapping[str, pl.Series] = MappingProxyType({})
) -> None:
    """The readings, and the features of points, into a folder. beside: of an artefact one column more."""
    for group in study.readings:
        table = readings_table(group, list(study.arm.probes), step_rad, study.arm.payloads)
        if group.artefact.name in beside:
            table = table.with_columns(beside[group.artefact.name])
        table.write_csv(folder / f"{group.artefact.name}.csv")
        if kind_of(group.artefact).features_file:
            features_table(group.artefact).write_csv(folder / features_file(group.artefact))


def readings_table(
    group: Readings, probes: list[str], step_rad: F64 | None, payloads: Mapping[str, Payload] = MappingProxyType({})
) -> pl.DataFrame:
    """Columns as in a readings file; angles in rad, or whole counts of step_rad (n,)."""
    columns: dict[str, Any] = {"placement": group.placement.tolist()}
    if len(group.artefact.features) > 1:
        columns["feature"] = np.array(list(group.artefact.features), dtype=object)[group.feature].tolist()
    if _several_probes(group):
        columns["probe"] = np.array(probes, dtype=object)[group.probe].tolist()
    for letter, angles_rad in (("q", group.q_rad), ("p", group.p_rad)):
        for k in range(0 if angles_rad is None else angles_rad.shape[1]):
            assert angles_rad is not None
            column = angles_rad[:, k]
            columns[f"{letter}{k + 1}"] = column if step_rad is None else np.rint(column / step_rad[k]).astype(np.int64)
    measured = kind_of(group.artefact).measured_column
    if measured is not None and group.artefact.length_mm is None and group.length_mm is not None:
        columns[measured] = group.length_mm
    if group.rotation_rad is not None:
        columns |= {name: group.rotation_rad[:, k] for k, name in enumerate(AXES)}
    for condition, name, said in group.conditions():
        columns |= condition.written(said, name, payloads)
    return pl.DataFrame(columns)


def features_table(artefact: Artefact) -> pl.DataFrame:
    """Columns feature, x, y, z, and u where it differs from feature to feature."""
    xyz_mm = np.array(list(artefact.features.values()))
    columns: dict[str, Any] = {"feature": list(artefact.features)} | dict(zip("xyz", xyz_mm.T, strict=True))
    if artefact.feature_u_mm is not None:
        columns["u"] = np.array(artefact.feature_u_mm)
    return pl.DataFrame(columns)


def features_file(artefact: Artefact) -> str:
    """Name of the table of its features, beside the study."""
    return f"{artefact.name}-features.csv"


def _several_probes(group: Readings) -> bool:
    return bool((group.probe != group.probe[0]).any())


def artefact_table(artefact: Artefact) -> dict[str, Any]:
    """Its table in a study file, mm; features are in `features_file`."""
    table: dict[str, Any] = {"kind": artefact.kind, **kind_of(artefact).written(artefact, features_file(artefact))}
    if artefact.u_mm and artefact.feature_u_mm is None:
        table["u"] = artefact.u_mm
    if artefact.fitted:
        table["fit"] = True
    return table


def _noise_table(noise: Noise) -> dict[str, Any]:
    table: dict[str, Any] = {}
    if noise.encoder_rad is not None:
        each = noise.encoder_rad.tolist()
        table["encoder"] = each[0] if len(set(each)) == 1 else each
    if noise.seat_mm is not None:
        table["seat"] = noise.seat_mm
    return table


def _table(head: str, table: dict[str, Any]) -> list[str]:
    return ["", head, *(f"{key} = {toml_value(value)}" for key, value in table.items())]

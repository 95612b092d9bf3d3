"""How a study shows itself: its arm, what was touched how often, what is fitted."""

from __future__ import annotations

import numpy as np

from ulna.artefacts.kinds import KINDS
from ulna.artefacts.readings import Readings
from ulna.ground.shown import About, Table
from ulna.study.data import FitOptions, StudyData


def about_study(study: StudyData) -> About:
    """One screen."""
    count = sum(len(group) for group in study.readings)
    where = "in memory" if study.path is None else str(study.path)
    facts = {"arm": f"'{study.arm.name}', {study.arm.n} joints, probe {', '.join(study.arm.probes)}"}
    if study.noise is not None:
        facts["noise"] = ", ".join(_noise(study))
    facts["fit"] = ", ".join(_fit(study.fit))
    if study.rows is not None:
        facts["rows"] = f"{study.rows}, of a study with a split"
    tables = [
        Table(
            ["artefact", "kind", "stated", "readings", "standings"],
            [_group(group, study) for group in study.readings],
            texts=3,
        )
    ]
    if study.taken:
        rows = [[each.column, each.ours or "not used", each.why] for each in study.taken]
        tables.append(Table(["column", "taken for", "because"], rows, "Columns, as recognised", texts=3))
    return About(
        f"Study {where}: {count} readings of {len(study.readings)} artefact{'s' * (len(study.readings) != 1)}",
        facts,
        tables,
        study.warnings,
    )


def _group(group: Readings, study: StudyData) -> list[str]:
    artefact = group.artefact
    placed = artefact.kind in KINDS and KINDS[artefact.kind].placed(artefact)
    standings = str(len(np.unique(group.placement_code))) if placed else "–"
    return [artefact.name, artefact.kind, artefact.stated, str(len(group)), standings]


def _noise(study: StudyData) -> list[str]:
    noise, said = study.noise, []
    if noise is not None and noise.encoder_rad is not None:
        low, high = float(np.min(noise.encoder_rad)), float(np.max(noise.encoder_rad))
        said.append(f"encoders {low:g}" + (f" to {high:g}" if high > low else "") + " rad")
    if noise is not None and noise.seat_mm is not None:
        said.append(f"touches {noise.seat_mm:g} mm")
    return said


def _fit(fit: FitOptions) -> list[str]:
    said = [f"holds {', '.join(fit.hold)}"] if fit.hold else ["all parameters free"]
    if fit.free != ["*"]:
        said.append(f"frees {', '.join(fit.free)}")
    said += [f"extras {', '.join(fit.extras)}"] if fit.extras else ["extras chosen by readings left out"] * fit.auto
    said += [f"loss {fit.loss}"] if fit.loss != "none" else []
    said += ["searches the zeros"] if fit.start == "search" else []
    said += [f"method {fit.method}"] if fit.method != "lm" else []
    return said

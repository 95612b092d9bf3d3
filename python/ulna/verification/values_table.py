"""All single values of an acceptance test as a table."""

from __future__ import annotations

import polars as pl

from ulna.verification.outcome import StateResult


def values_table(states: list[StateResult]) -> pl.DataFrame:
    """One row for each value of each figure; lengths in mm, empty where nothing is known."""
    rows = []
    for state in states:
        for test in state.tests:
            for figure in test.figures:
                for judged in figure.values:
                    single = judged.single
                    rows.append(
                        {
                            "state": state.state,
                            "test": test.name,
                            "figure": figure.definition.name,
                            "artefact": single.labels.artefact,
                            "position": single.labels.position,
                            "repeat": single.labels.repeat,
                            "calibrated_mm": single.calibrated_mm,
                            "measured_mm": single.measured_mm,
                            "value_mm": single.value_mm,
                            "limit_mm": judged.limit_mm,
                            "u_mm": single.budget.u_mm,
                            "guard_mm": judged.decided.guard_mm,
                            "verdict": judged.decided.verdict or "",
                            "conformity": judged.conformity,
                        }
                    )
    return pl.DataFrame(rows, infer_schema_length=None)

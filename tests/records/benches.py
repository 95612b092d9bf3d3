"""What the tests of records share: a small result, and files made of it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
RESULT = ROOT / "tests" / "data" / "fossils" / "result-1.json"
EVALUATION = ROOT / "tests" / "data" / "fossils" / "evaluation-1.json"
CROSS_VALIDATION = ROOT / "tests" / "data" / "fossils" / "cross-validation-1.json"
VERIFICATION = ROOT / "tests" / "data" / "fossils" / "verification-1.json"


def evaluation(path: Path, rms_mm: float, time: str = "2026-01-01T12:00:00+00:00") -> Path:
    """An evaluation with this figure."""
    document: dict[str, Any] = json.loads(EVALUATION.read_text())
    document["overall"] = {"length_error_rms_mm": rms_mm}
    if document.get("provenance"):
        document["provenance"]["time"] = time
    path.write_text(json.dumps(document))
    return path


def verification(path: Path, value: float, verdict: str, state: str = "as-found") -> Path:
    """An acceptance test whose first figure has this value and verdict; the others none."""
    document: dict[str, Any] = json.loads(VERIFICATION.read_text())
    (first, *_) = document["states"]
    first["state"] = state
    figures = first["tests"][0]["figures"]
    del figures[1:], first["tests"][1:]
    figures[0] |= {"value": value, "verdict": verdict}
    document["states"] = [first]
    path.write_text(json.dumps(document))
    return path

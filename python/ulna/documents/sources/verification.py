"""An acceptance test: figures of this arm with limits and verdicts.

A test of encoder readings names the arm files that turned them into points: this result, or the arm.toml beside it; as
found also the arm that the calibration started from. A test of coordinates only names the arm.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ulna.documents.languages.said import Said
from ulna.documents.sources.source import Calibration, Source
from ulna.formats.toml import read_bytes, sha256
from ulna.verification.result_file import SourceTable, VerificationFile, load_verification


def calibrated_arms(calibration: Calibration) -> set[str]:
    """SHA-256 of the files that are this calibrated arm: the result, and the arm.toml beside it."""
    beside = calibration.file.path.parent / "arm.toml"
    return {calibration.file.sha256} | ({sha256(read_bytes(beside, "an arm file"))} if beside.is_file() else set())


def arms_before(calibration: Calibration) -> set[str]:
    """SHA-256 of what the calibration started from."""
    return {str(each["sha256"]) for each in calibration.result.provenance.get("files", [])}


def strange_arms(used: Sequence[SourceTable], calibration: Calibration, as_found: bool) -> list[SourceTable]:
    """Those that are not of this calibration; as found it may also be the arm that it started from."""
    allowed = calibrated_arms(calibration) | (arms_before(calibration) if as_found else set())
    return [each for each in used if each.sha256 not in allowed]


def _read(path: Path, _: Calibration) -> tuple[VerificationFile, str]:
    return load_verification(path)


def _remarks(file: VerificationFile, path: Path, calibration: Calibration) -> list[Said]:
    used = file.provenance.arms
    as_found = any(state.state == "as-found" for state in file.states)
    if not used and file.arm != calibration.result.arm.name:
        return [Said("verification.by-name", {"file": path.name, "arm": file.arm})]
    strange = strange_arms(used, calibration, as_found)
    return [Said("verification.other-arm", {"file": path.name, "arm": each.path}) for each in strange]


VERIFICATION = Source("verification", "ulna-verification", _read, _remarks)

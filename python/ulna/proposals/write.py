"""A proposal as files: an arm and a study with comments, whole or not at all, and only where the study loads."""

from __future__ import annotations

import os
import warnings
from pathlib import Path

from ulna.arm.file import arm_toml
from ulna.artefacts.kinds import KINDS
from ulna.formats.output import output_folder, refuse_inputs
from ulna.formats.toml_text import toml_key, toml_value
from ulna.ground.errors import UlnaInputError
from ulna.proposals.propose import Proposal
from ulna.study.study import Study

FILES = ("arm.toml", "study.toml")


def write_proposal(proposal: Proposal, folder: Path, force: bool = False) -> None:
    """Write arm.toml and study.toml into a folder; the readings stay where they are.

    Raises UlnaInputError where they exist and `force` is not given, and where the study would not load: nothing is
    written then.
    """
    folder = folder.resolve() if folder.name in ("", "..") else folder
    refuse_inputs((folder / name for name in FILES), proposal.inputs)
    with output_folder(folder, FILES, force) as staging:
        (staging / "arm.toml").write_text(_arm_text(proposal), encoding="utf-8")
        (staging / "study.toml").write_text(study_text(proposal, folder), encoding="utf-8")
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # whoever loads the study next is told
                Study.load(staging / "study.toml")
        except UlnaInputError as error:
            raise UlnaInputError(str(error).replace(str(staging), str(folder))) from None


def _comment(text: str) -> str:
    """A line that nothing in it can end."""
    return "# " + "".join(c if c.isprintable() else "?" for c in text)


def _arm_text(proposal: Proposal) -> str:
    lines = [f"The arm to start from: {proposal.drawn.said}."]
    if proposal.arm.unknown_signs.any():
        lines.append("sign = 0: nobody knows which way the encoder counts; the calibration finds it.")
    if proposal.search:
        lines.append("The zeros (theta0) are not known; the study asks the calibration to search for them.")
    if proposal.drawn.guessed:
        lines.append("Lengths and twists are a first guess; the calibration finds what they are.")
    return "".join(_comment(line) + "\n" for line in lines) + "\n" + arm_toml(proposal.arm)


def study_text(proposal: Proposal, folder: Path) -> str:
    """The study file, to stand in a folder."""
    files = ", ".join(dict.fromkeys(each.readings.name for each in proposal.every))
    lines = [
        _comment(f"Written by ulna new from {files}. Change what is not so; ulna calibrate reads it."),
        'format = "ulna-study/1"',
        'arm = "arm.toml"',
        f'units = {{ length = "{proposal.stated.length_unit}", angle = "rad" }}',
    ]
    artefacts = {each.stated.artefact.name: each.stated for each in proposal.every}
    for each in proposal.every:
        lines += ["", "[[readings]]", f"file = {toml_value(_relative(each.readings, folder))}"]
        if len(artefacts) > 1 and "artefact" not in each.entry.get("where", {}):
            lines.append(f"artefact = {toml_value(each.stated.artefact.name)}")
        lines += [_line(key, value, each) for key, value in each.entry.items()]
    for name, stated in artefacts.items():
        lines += ["", f"[artefact.{toml_key(name)}]"]
        for key, value in stated.keys.items():
            text = toml_value(_relative(Path(value), folder)) if key == "features" else toml_value(value)
            lines.append(f"{toml_key(key)} = {text}")
        if "u" in KINDS[stated.artefact.kind].table.model_fields and "u" not in stated.keys:
            lines.append(_comment("u = 0.001    (the standard uncertainty of its certificate, where you have it)"))
    lines += ["", "[fit]"]
    if proposal.search:
        lines.append('start = "search"    # the encoders\' zeros are not known: find them')
    lines.append('loss = "cauchy"     # readings that are far off count less, and are named; "none": by their squares')
    lines += ["", _comment("[noise]"), _comment("encoder and seat: standard deviations of the readings, where known")]
    return "\n".join(lines) + "\n"


def _line(key: str, value: object, proposal: Proposal) -> str:
    why = f"    # {proposal.angle_why}" if key == "angle" else ""
    return f"{toml_key(key)} = {toml_value(value)}" + "".join(c if c.isprintable() else "?" for c in why)


def _relative(path: Path, folder: Path) -> str:
    """A file as the study in `folder` names it."""
    try:
        return Path(os.path.relpath(path.absolute(), folder.absolute())).as_posix()
    except ValueError:  # another drive
        return path.absolute().as_posix()

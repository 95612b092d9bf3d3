"""Every way in which an arm file can be wrong, and what the user is told: file, key, value, expected, remedy."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.small_study import ARM, says

from ulna import Arm, UlnaInputError

CASES: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "no format": ('format = "ulna-arm/1"\n', "", ("key 'format' is missing", 'format = "ulna-arm/1"', "Add it")),
    "unknown format": ('"ulna-arm/1"', '"arm"', ("key 'format'", "'arm'", "unknown format", "ulna-arm/1")),
    "another format": ('"ulna-arm/1"', '"ulna-study/1"', ("'ulna-study/1'", "another kind of file", "ulna-arm/1")),
    "a later version": ('"ulna-arm/1"', '"ulna-arm/2"', ("version 2", "not known to this Ulna", "Update Ulna")),
    "no units": (
        'units = { length = "mm", angle = "rad" }\n',
        "",
        ("'units' is missing", "never guessed", "Add units"),
    ),
    "half the units": (', angle = "rad"', "", ("'units.angle' is missing", "never guessed")),
    "unknown unit": ('"rad"', '"grad"', ("'units.angle'", "'grad'", "'rad' or 'deg'")),
    "unknown key": ("theta0 = 0.1", "thata0 = 0.1", ("unknown key 'joint.1.thata0'", "Did you mean 'theta0'?")),
    "unknown table": ("[probe.straight]", "[prope.straight]", ("unknown key 'prope'", "Did you mean 'probe'?")),
    "unknown tip key": ("h = 223.0", "hh = 223.0", ("unknown key 'probe.bent.tip.hh'", "Did you mean 'h'?")),
    "half a tip": (", z = 238.0", "", ("'probe.straight.tip.z' is missing", "Add it")),
    "text for a number": ("a = 40.0", 'a = "long"', ("'joint.1.a'", "'long'", "a number without quotes")),
    "decimal comma": ("a = 40.0", 'a = "40,0"', ("'joint.1.a'", "'40,0'", "decimal point, not a comma")),
    "not a number": ("a = 40.0", "a = nan", ("'joint.1.a'", "got nan", "a finite number")),
    "infinity": ("d = 1.5", "d = inf", ("'joint.2.d'", "got inf", "a finite number")),
    "missing geometry": ("d = 1.5\n", "", ("'joint.2.d' is missing", "every joint but the last", "Add it")),
    "geometry of the last": (
        'name = "wrist roll"',
        'name = "wrist roll"\ntheta0 = 0.3',
        ("'joint.3.theta0'", "got 0.3", "part of the probe's tip", "Remove the key"),
    ),
    "beta of a DH joint": ("d = 1.5", "d = 1.5\nbeta = 0.1", ("'joint.2.beta'", "got 0.1", 'model = "hayati"')),
    "d of a Hayati joint": (
        "d = 1.5",
        'd = 1.5\nbeta = 0.1\nmodel = "hayati"',
        ("'joint.2.d'", "got 1.5", "'hayati'", 'model = "dh"'),
    ),
    "sign": ("d = 1.5", "d = 1.5\nsign = 2", ("'joint.2.sign'", "got 2", "1, -1 or 0")),
    "sign of truth": ("d = 1.5", "d = 1.5\nsign = true", ("'joint.2.sign'", "got True", "1, -1 or 0")),
    "two ways of a tip": ("r = 39.0", "x = 0.5, r = 39.0", ("'probe.bent.tip'", "mixed", "x, y, z or theta0, r, h")),
    "model": ("d = 1.5", 'd = 1.5\nmodel = "poe"', ("'joint.2.model'", "'poe'", "'dh' or 'hayati'")),
    "limits swapped": ("[-3.0, 3.0]", "[3.0, -3.0]", ("'joint.1.limits'", "[3.0, -3.0]", "lower limit first")),
    "one limit": ("[-3.0, 3.0]", "[3.0]", ("'joint.1.limits'", "at least 2 entries (there are 1)")),
    "no counts": ("counts_per_turn = 4096", "counts_per_turn = 0", ("'joint.1.counts_per_turn'", "greater than 0")),
    "negative radius": ("r = 39.0", "r = -39.0", ("'probe.bent.tip.r'", "got -39.0", "at least 0")),
    "probe name": ("[probe.straight]", '[probe."a.b"]', ("'probe.a.b'", "cannot be used", "Rename it")),
    "not TOML": ("a = 40.0", "a = 40.0.0", ("not valid TOML", "line 9")),
}


@pytest.mark.parametrize("case", CASES)
def test_what_an_arm_file_is_told(tmp_path: Path, case: str) -> None:
    old, new, fragments = CASES[case]
    assert old in ARM
    path = tmp_path / "arm.toml"
    path.write_text(ARM.replace(old, new, 1))
    with pytest.raises(UlnaInputError) as caught:
        Arm.load(path)
    says(str(caught.value), f"{path}: ", *fragments)


def test_too_few_joints_and_no_probe(tmp_path: Path) -> None:
    path = tmp_path / "arm.toml"
    path.write_text(
        'format = "ulna-arm/1"\nunits = { length = "mm", angle = "rad" }\n[[joint]]\n[probe.p]\ntip={x=0,y=0,z=1}\n'
    )
    with pytest.raises(UlnaInputError) as caught:
        Arm.load(path)
    says(str(caught.value), "'joint'", "at least 2 entries (there are 1)")
    path.write_text(ARM[: ARM.index("[probe.bent]")])
    with pytest.raises(UlnaInputError) as caught:
        Arm.load(path)
    says(str(caught.value), "key 'probe' is missing")


def test_a_missing_file_a_folder_and_an_unreadable_file(tmp_path: Path) -> None:
    (tmp_path / "platinum.toml").write_text(ARM)
    for path, fragments in (
        (tmp_path / "platinun.toml", ("no such file", "Did you mean 'platinum.toml'?")),
        (tmp_path / "nowhere" / "arm.toml", ("no such file", "does not exist either")),
        (tmp_path, ("this is a folder", "Name the file in it")),
    ):
        with pytest.raises(UlnaInputError) as caught:
            Arm.load(path)
        says(str(caught.value), f"{path}: ", *fragments)


@pytest.mark.parametrize(
    ("content", "fragments"),
    [
        (b"", ("the file is empty", "an arm file")),
        (ARM.encode("utf-16"), ("UTF-16", "Save it as UTF-8")),
        (ARM.replace("shoulder", "Länge").encode("latin-1"), ("line 6", "0xe4", "Save it as UTF-8")),
    ],
)
def test_a_file_that_is_no_text(tmp_path: Path, content: bytes, fragments: tuple[str, ...]) -> None:
    path = tmp_path / "arm.toml"
    path.write_bytes(content)
    with pytest.raises(UlnaInputError) as caught:
        Arm.load(path)
    says(str(caught.value), str(path), *fragments)


@pytest.mark.parametrize(
    ("text", "fragments"),
    [
        ("{", ("not valid JSON", "line 1")),
        ("[]", ("a list", "expected an object")),
        ('{"format": NaN}', ("NaN is no number in JSON",)),
        ("[" * 100_000, ("brackets within brackets",)),
        ('{"format": "ulna-result/1"}', ("'arm'", "Calibrate again")),
        ('{"format": "ulna-result/7"}', ("version 7", "Update Ulna")),
    ],
)
def test_a_result_that_is_none(tmp_path: Path, text: str, fragments: tuple[str, ...]) -> None:
    path = tmp_path / "result.json"
    path.write_text(text)
    with pytest.raises(UlnaInputError) as caught:
        Arm.load(path)
    says(str(caught.value), str(path), *fragments)


def test_a_probe_that_the_arm_does_not_have(tmp_path: Path) -> None:
    path = tmp_path / "arm.toml"
    path.write_text(ARM)
    arm = Arm.load(path)
    with pytest.raises(UlnaInputError, match=r"no probe 'bend'\. Did you mean 'bent'\?"):
        arm.probe_index("bend")
    with pytest.raises(UlnaInputError, match="say which of bent, straight is on"):
        arm.probe_index()

"""Every way in which a study file can be wrong, and what the user is told: file, key, value, expected, remedy."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.small_study import SmallStudy, says

from ulna import Study, UlnaInputError, calibrate

CASES: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "no format": ('format = "ulna-study/1"\n', "", ("key 'format' is missing",)),
    "arm as a study": ('"ulna-study/1"', '"ulna-arm/1"', ("another kind of file", "ulna-study/1")),
    "no units": ('units = { length = "mm", angle = "rad" }\n', "", ("'units' is missing", "never guessed")),
    "no arm": ('arm = "arm.toml"\n', "", ("key 'arm' is missing",)),
    "unknown key": ("[fit]", "[fits]", ("unknown key 'fits'", "Did you mean 'fit'?")),
    "unknown readings key": (
        'angle = "rad"\nart',
        'angel = "rad"\nart',
        ("unknown key 'readings.1.angel'", "Did you mean 'angle'?"),
    ),
    "angle": (
        'angle = "rad"\nart',
        'angle = "grad"\nart',
        ("'readings.1.angle'", "'grad'", "'rad', 'deg' or 'counts'"),
    ),
    "artefact key": ("u = 0.001", "uu = 0.001", ("unknown key 'artefact.bar.uu'", "Did you mean 'u'?")),
    "no kind": ('kind = "bar"\n', "", ("'artefact.bar.kind' is missing", "bar, seat, points, length")),
    "unknown kind": ('kind = "bar"', 'kind = "baar"', ("'artefact.bar.kind'", "'baar'", "Did you mean 'bar'?")),
    "another kind": ('kind = "bar"', 'kind = "sphere"', ("unknown key 'artefact.bar.length'",)),
    "no length": ("length = 443.172\n", "", ("'artefact.bar.length' is missing",)),
    "length of zero": ("length = 443.172", "length = 0", ("'artefact.bar.length'", "got 0", "greater than 0")),
    "artefact name": ("[artefact.bar]", '[artefact."a/b"]', ("'artefact.a/b'", "cannot be used", "Rename it")),
    "noise of zero": ("encoder = 5e-6", "encoder = 0", ("'noise.encoder'", "got 0", "greater than 0")),
    "noise of too many": ("5e-6", "[1e-6, 2e-6]", ("'noise.encoder'", "got 2 numbers", "3: one per joint")),
    "hold nothing": ('"joint.1.theta0"', '"joint.9.*"', ("'fit.hold'", "'joint.9.*'", "matches no parameter")),
    "hold a slip": ('"joint.1.theta0"', '"joint.1.theta"', ("'fit.hold'", "Did you mean 'joint.1.theta0'?")),
    "free nothing": ("hold =", 'free = ["x"]\nhold =', ("'fit.free'", "'x'", "matches no parameter")),
    "hold a text": ('["joint.1.theta0"]', '"joint.1.theta0"', ("'fit.hold'", "a list")),
    "unknown loss": ("[fit]", '[fit]\nloss = "hubert"', ("'fit.loss'", "'hubert'", "'none', 'huber'")),
    "compliance without masses": ("[fit]", '[fit]\nextras = ["compliance"]', ("'fit.extras'", "no joint", "a mass")),
    "unknown extra": (
        "[fit]",
        '[fit]\nextras = ["complience"]',
        ("'fit.extras.1'", "'complience'", "'compliance', 'backlash', 'coupling', 'base-tilt' or 'base-offset'"),
    ),
    "start": ("[fit]", '[fit]\nstart = "guess"', ("'fit.start'", "'guess'", "'given' or 'search'")),
    "whole number": ("[fit]", "[fit]\nseed = 0.5", ("'fit.seed'", "got 0.5", "a whole number")),
    "huge seed": ("[fit]", f"[fit]\nseed = {2**64}", ("'fit.seed'", f"got {2**64}", f"at most {2**63 - 1}")),
    "negative seed": ("[fit]", "[fit]\nseed = -1", ("'fit.seed'", "got -1", "at least 0")),
    "huge iterations": (
        "[fit]",
        "[fit]\nmax_iterations = 99999999999999999999999",
        ("'fit.max_iterations'", "at most 1000000"),
    ),
    "digits without end": ("[fit]", "[fit]\nseed = " + "9" * 5000, ("study.toml: ", "thousands of digits")),
    "version without end": ("ulna-study/1", "ulna-study/" + "9" * 5000, ("key 'format'", "unknown format")),
    "brackets without end": ("[fit]", "[fit]\nhold = " + "[" * 5000, ("study.toml: ", "brackets within brackets")),
    "character 0 in the readings' path": ('"bars.csv"', '"a\\u0000b"', ("a\\x00b", "no character 0")),
    "character 0 in the arm's path": ('"arm.toml"', '"a\\u0000b"', ("a\\x00b", "no character 0")),
    "no readings": ("[[readings]]", "[readings]", ("'readings'", "one table", "a list", "Write [[readings]]")),
    "missing arm": ('"arm.toml"', '"arms.toml"', ("arms.toml: no such file", "Did you mean 'arm.toml'?")),
    "missing readings": ('"bars.csv"', '"bar.csv"', ("bar.csv: no such file", "Did you mean 'bars.csv'?")),
    "unknown artefact": (
        'artefact = "bar"',
        'artefact = "baa"',
        ("'readings.1.artefact'", "'baa'", "Did you mean 'bar'?"),
    ),
    "unknown probe": ('probe = "bent"', 'probe = "bend"', ("'readings.1.probe'", "'bend'", "Did you mean 'bent'?")),
    "no probe": ('probe = "bent"\n', "", ("no column 'probe'", "'readings.1.probe'", "bent, straight")),
}


@pytest.mark.parametrize("case", CASES)
def test_what_a_study_file_is_told(tmp_path: Path, case: str) -> None:
    old, new, fragments = CASES[case]
    small = SmallStudy(tmp_path)
    small.swap("study.toml", old, new)
    says(small.error(), str(tmp_path), *fragments)


def test_a_key_of_another_kind_is_not_suggested_to_itself(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    small.swap("study.toml", 'kind = "bar"', 'kind = "seat"')
    told = small.error()
    says(told, "unknown key 'artefact.bar.length'")
    assert "Did you mean 'length'" not in told


def test_a_device_that_never_ends(tmp_path: Path) -> None:
    # stands for /dev/zero: a file with a hole, of which no more than the limit is read
    path = tmp_path / "study.toml"
    with path.open("wb") as file:
        file.truncate(1 << 40)
    with pytest.raises(UlnaInputError, match="more than 8 MB, too large"):
        Study.load(path)


def test_the_good_study_loads(tmp_path: Path) -> None:
    _, warned = SmallStudy(tmp_path).load()
    assert warned == []


PLATE_CASES: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "short row": ("100,0,0", "100,0", ("row 2 (line 3", "3 cells, expected 4")),
    "long row": ("100,0,0", "100,0,0,0", ("row 2 (line 3", "5 cells, expected 4")),
    "named wrongly": ("feature,x,y,z", "name,x,y,z", ("unknown column 'name'",)),
    "column missing": (
        "feature,x,y,z\ns1,0,0,0\ns2,100,0,0\ns3,0,100,0",
        "feature,x,y\ns1,0,0",
        ("column 'z' is missing",),
    ),
    "twice": ("s3", "s1", ("row 3 (line 4", "column 'feature'", "'s1' stands in row 1 already")),
    "cell": ("100,0,0", "100,zero,0", ("row 2 (line 3", "column 'y'", "'zero'", "a number")),
    "no rows": ("s1,0,0,0\ns2,100,0,0\ns3,0,100,0\n", "", ("there are no rows",)),
}


@pytest.mark.parametrize("case", PLATE_CASES)
def test_what_a_features_file_is_told(tmp_path: Path, case: str) -> None:
    old, new, fragments = PLATE_CASES[case]
    small = SmallStudy(tmp_path)
    small.swap("study.toml", 'kind = "bar"\nlength = 443.172\nu = 0.001', 'kind = "points"\nfeatures = "plate.csv"')
    small.swap("plate.csv", old, new)
    says(small.error(), "plate.csv: ", *fragments)


def test_negative_and_doubled_uncertainties(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    small.swap("study.toml", 'kind = "bar"\nlength = 443.172\nu = 0.001', 'kind = "points"\nfeatures = "plate.csv"')
    small.write("plate.csv", "feature,x,y,z,u\nA,0,0,0,0.001\nB,443,0,0,-0.001\n")
    says(small.error(), "plate.csv: row 2", "column 'u'", "got -0.001", "0 or more")
    small.write("plate.csv", "feature,x,y,z,u\nA,0,0,0,0.001\nB,443,0,0,0.002\n")
    small.swap("study.toml", 'features = "plate.csv"', 'features = "plate.csv"\nu = 0.1')
    says(small.error(), "'artefact.bar.u'", "got 0.1", "Remove one of them")


def test_three_coordinates_a_feature(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    small.swap("study.toml", 'kind = "bar"\nlength = 443.172\nu = 0.001', 'kind = "points"\nfeatures = { A = [0, 0] }')
    says(small.error(), "'artefact.bar.features.A'", "at least 3 entries (there are 2)")


def test_fewer_observations_than_unknowns(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    lines = (tmp_path / "bars.csv").read_text().splitlines()
    small.write("bars.csv", "\n".join([lines[0], lines[1], lines[4]]) + "\n")
    study, _ = small.load()
    with pytest.raises(UlnaInputError) as caught:
        calibrate(study)
    for fragment in (f"{small.path}: ", "6 equations for 14 unknowns", "take more readings (at least 3), or hold"):
        assert fragment in str(caught.value)


@pytest.mark.parametrize(("option", "value"), [("seed", -1), ("seed", 2**63), ("max_iterations", 2_000_000)])
def test_options_out_of_range_from_python(tmp_path: Path, option: str, value: int) -> None:
    study, _ = SmallStudy(tmp_path).load()
    with pytest.raises(UlnaInputError, match=rf"'fit\.{option}': {value}; expected a whole number"):
        calibrate(study, **{option: value})

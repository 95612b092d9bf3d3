"""`ulna measure` reads a table as somebody keeps it like the plain one, by options and by arguments."""

from __future__ import annotations

import warnings
from pathlib import Path

from tests.cli_runs import run
from tests.small_study import SmallStudy

import ulna
from ulna import InputWarning

ROWS = [("Taster", 0.5, -0.25, 1.5), ("", 0.125, 1.0, -0.75)]


def test_the_same_points(tmp_path: Path) -> None:
    arm = SmallStudy(tmp_path).folder / "arm.toml"
    probe = next(iter(ulna.Arm.load(arm).probes))
    plain, kept = tmp_path / "plain.csv", tmp_path / "kept.csv"
    plain.write_text("probe,q1,q2,q3\n" + "".join(f"{probe},{a},{b},{c}\n" for _, a, b, c in ROWS))
    lines = [f"{name};{a};{b};{c}".replace(".", ",") for name, a, b, c in ROWS]
    kept.write_bytes("\n".join(["Größe °C", "", "probe;q1;q2;q3", ";rad;rad;rad", *lines]).encode("cp1252"))
    expected = ulna.measure(arm, plain).table
    assert expected is not None
    options = ["--separator", ";", "--decimal", ",", "--encoding", "cp1252", "--header", "3", "--units-row"]
    result = run("measure", str(arm), str(kept), *options, "--fill-down", "probe", "--name", f"probe.{probe}=Taster")
    assert result.returncode == 0, result.stderr
    assert result.stdout == expected.write_csv()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        found = ulna.measure(
            arm, kept, separator=";", decimal=",", fill_down=["probe"], names={"probe": {probe: "Taster"}}
        ).table
    said = " ".join(str(each.message) for each in caught)
    for part in ("read as cp1252", "named in line 3", "line 4 holds units (rad)", "1 cell filled from the one above"):
        assert part in said
    assert found is not None
    assert found.equals(expected)

"""From files to files: the Must-hold exactness with everything written and read as text on the way."""

import json

import numpy as np
import pytest
from tests.oracle import virtual
from tests.oracle.chain import cylindrical_tip
from tests.oracle.published import STRAIGHT_4, table_2, table_3, table_4

import ulna


def write_arm(path, arm, probes):
    text = ['format = "ulna-arm/1"', 'name = "arm"', 'units = { length = "mm", angle = "rad" }']
    rows = zip(arm.theta0_rad.tolist(), arm.alpha_rad.tolist(), arm.a_mm.tolist(), arm.last.tolist(), strict=True)
    for theta0, alpha, a, d in rows:
        text += ["[[joint]]", f"theta0 = {theta0!r}", f"alpha = {alpha!r}", f"a = {a!r}", f"d = {d!r}"]
    text.append("[[joint]]")
    for name, (x, y, z) in probes.items():
        text += [f"[probe.{name}]", f"tip = {{ x = {float(x)!r}, y = {float(y)!r}, z = {float(z)!r} }}"]
    path.write_text("\n".join(text) + "\n", "utf-8")


def write_table(path, columns):
    rows = zip(*(np.asarray(values).tolist() for values in columns.values()), strict=True)
    lines = [",".join(columns), *(",".join(map(str, row)) for row in rows)]
    path.write_text("\n".join(lines) + "\n", "utf-8")


def joints(prefix, poses):
    return {f"{prefix}{k + 1}": poses[:, k] for k in range(poses.shape[1])}


@pytest.mark.parametrize("angle", ["rad", "deg"])
def test_table_2_from_table_3_through_files(tmp_path, angle):
    truth, start = table_2(), table_3()
    rows = virtual.random_lengths(truth, np.random.default_rng(1), 101)
    unit = 1.0 if angle == "rad" else 180.0 / np.pi
    write_arm(tmp_path / "arm.toml", start, {"bent": start.tips_mm[0]})
    write_table(
        tmp_path / "lengths.csv",
        {**joints("q", rows.q_rad * unit), **joints("p", rows.p_rad * unit), "length": rows.length_mm},
    )
    (tmp_path / "study.toml").write_text(
        'format = "ulna-study/1"\narm = "arm.toml"\nunits = { length = "mm", angle = "rad" }\n'
        f'[[readings]]\nfile = "lengths.csv"\nangle = "{angle}"\nartefact = "rows"\n[artefact.rows]\nkind = "length"\n',
        "utf-8",
    )
    result = ulna.calibrate(ulna.Study.load(tmp_path / "study.toml"))
    result.save(tmp_path / "out")
    written = json.loads((tmp_path / "out" / "result.json").read_text("utf-8"))
    status = {p["name"]: p["status"] for p in written["parameters"]}
    assert {name for name, what in status.items() if what != "fitted"} == {"joint.1.theta0", "joint.1.d"}
    assert {status["joint.1.theta0"], status["joint.1.d"]} == {"not-determined"}
    for parameter, true in zip(written["parameters"], truth.parameters, strict=True):
        if parameter["status"] == "fitted":
            assert parameter["value"] == pytest.approx(true, abs=1e-9 if parameter["unit"] == "rad" else 1e-6)
    # The arm written measures as the arm found.
    again = ulna.Arm.load(tmp_path / "out" / "arm.toml")
    np.testing.assert_allclose(again.tip(rows.q_rad), result.arm.tip(rows.q_rad), rtol=0, atol=1e-9)


def test_the_probe_alone_is_a_study_with_holds(tmp_path):
    """Cheng 2011, second step: `hold = ["joint.*"]`, one seat; nothing else is needed."""
    truth = table_4(straight=True)
    seat = virtual.seats(truth, np.random.default_rng(2), 1, 32)
    write_arm(tmp_path / "arm.toml", truth, {"straight": (0.0, 0.0, 220.0)})
    write_table(tmp_path / "seat.csv", joints("q", seat.q_rad))
    (tmp_path / "study.toml").write_text(
        'format = "ulna-study/1"\narm = "arm.toml"\nunits = { length = "mm", angle = "rad" }\n'
        '[[readings]]\nfile = "seat.csv"\nangle = "rad"\nartefact = "cone"\n[artefact.cone]\nkind = "seat"\n'
        '[fit]\nhold = ["joint.*"]\n',
        "utf-8",
    )
    result = ulna.calibrate(ulna.Study.load(tmp_path / "study.toml"))
    tip = result.arm.probes["straight"].tip_mm
    np.testing.assert_allclose(tip, cylindrical_tip(*STRAIGHT_4), rtol=0, atol=1e-6)
    theta0, r, h = result.arm.probes["straight"].cylindrical
    assert (theta0, r, h) == pytest.approx(STRAIGHT_4, abs=1e-4)
    assert [p.status for p in result.parameters] == ["held"] * 24 + ["fitted"] * 3

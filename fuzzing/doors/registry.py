"""Which doors there are: one row each. `tests/fuzzing` asks for one of every table format and of every schema."""

from __future__ import annotations

from fuzzing.door import Door
from fuzzing.doors.csv_files import csv_bytes
from fuzzing.doors.hdf5_files import hdf5_bytes
from fuzzing.doors.journals import JournalDoor
from fuzzing.doors.json_files import JsonDoor
from fuzzing.doors.mat_files import mat_bytes
from fuzzing.doors.new import new_trial
from fuzzing.doors.options import option_trial
from fuzzing.doors.parquet_files import arrow_bytes, parquet_bytes
from fuzzing.doors.tables import TableDoor
from fuzzing.doors.texts import TextDoor
from fuzzing.doors.toml_files import TomlDoor
from fuzzing.doors.xlsx_files import xlsx_bytes

_FRESH = " --readings task.csv --artefact bar:200 --zeros known --signs known --counts-per-turn 4096 -o fresh"
_RESULT = (
    "measure {file} task.csv --angle counts",
    "measure {file} task.csv --angle counts --covariance --json",
    "evaluate {file} made/study.toml",
    "certificate {file} fossils/lab-1.toml -o c.xml",
    "uncertainty {file} task.toml --trials 20",
    "uncertainty {file} volume.toml --trials 20",
    "export urdf {file} -o a.urdf",
    "export dh {file} -o a.csv --convention modified-dh",
    "show {file} -o s.html",
    "report {file} -o r.html --study made/study.toml",
    "verify {file} fossils/verify-1.toml",
)
_ARM = (
    "show {file} -o s.html --pose 0,1,2,3",
    "measure {file} task.csv --angle counts",
    "export urdf {file} -o a.urdf",
    "export dh {file} -o a.csv --hayati",
    "identify made/study.toml",
    "new --arm {file}" + _FRESH,
    "simulate simulation.toml -o virtual",
    "uncertainty {file} task.toml --performance performance.toml --trials 20",
)
_FOSSIL_ARM = (
    "show {file} -o s.html",
    "export urdf {file} -o a.urdf",
    "export dh {file} -o a.csv --hayati",
    "identify fossils/study-1.toml",
    "identify fossils/study-1-ways.toml",
)
_EVALUATED = ("report out/result.json -o r.html --evaluation {file}",)
_VERIFIED = (
    "report out/result.json -o r.html --verification {file}",
    "certificate fossils/result-1.json fossils/lab-1.toml -o c.xml --verification {file}",
)
_STUDY = (
    "identify {file}",
    "identify {file} --json",
    "evaluate arm.toml {file}",
    "measure arm.toml task.csv --like {file}",
)

_WATCHED = ("live watch {file} --seconds 2", "live watch {file} --seconds 2 --json")
_REPLAYED = (
    "live replay {file} --speed max",
    "live replay {file} --speed max --json",
    "live replay {file} -o again.csv",
)

DOORS: dict[str, Door] = {
    door.name: door
    for door in [
        Door("table CSV", TableDoor(".csv", csv_bytes)),
        Door("table Excel", TableDoor(".xlsx", xlsx_bytes), short=25),
        Door("table Parquet", TableDoor(".parquet", parquet_bytes), short=25),
        Door("table HDF5", TableDoor(".h5", hdf5_bytes)),
        Door("table MAT", TableDoor(".mat", mat_bytes)),
        Door("table Arrow", TableDoor(".arrow", arrow_bytes), short=25),
        Door(
            "arm",
            TomlDoor(
                ["arm.toml"],
                _ARM,
            ),
        ),
        Door(
            "arm of every key",
            TomlDoor(
                [
                    "fossils/arm-1.toml",
                    "fossils/arm-1-effects.toml",
                    "fossils/arm-1-modified.toml",
                ],
                _FOSSIL_ARM,
            ),
        ),
        Door(
            "study",
            TomlDoor(
                [
                    "made/study.toml",
                    "fossils/study-1.toml",
                    "fossils/study-1-tables.toml",
                    "fossils/study-1-ways.toml",
                ],
                _STUDY,
            ),
        ),
        Door(
            "study calibrated",
            TomlDoor(
                ["made/study.toml"],
                [
                    "calibrate {file} -o again",
                    "cross-validate {file} --by artefact",
                ],
            ),
            short=12,
        ),
        Door(
            "simulation",
            TomlDoor(
                [
                    "simulation.toml",
                    "simulation.toml",
                    "fossils/simulation-1.toml",
                ],
                [
                    "simulate {file} -o virtual",
                    "simulate {file} --json",
                ],
            ),
        ),
        Door(
            "plan",
            TomlDoor(
                ["plan.toml"],
                ["plan arm.toml {file} -o p"],
            ),
            seconds=90.0,
            short=3,
        ),
        Door(
            "task",
            TomlDoor(
                [
                    "task.toml",
                    "task.toml",
                    "fossils/task-1.toml",
                ],
                ["uncertainty out/result.json {file} --trials 20"],
            ),
        ),
        Door(
            "volume",
            TomlDoor(
                [
                    "volume.toml",
                    "volume.toml",
                    "fossils/volume-1.toml",
                ],
                ["uncertainty out/result.json {file} --trials 5"],
            ),
            seconds=90.0,
            short=6,
        ),
        Door(
            "performance",
            TomlDoor(
                [
                    "performance.toml",
                    "performance.toml",
                    "fossils/performance-1.toml",
                ],
                ["uncertainty arm.toml task.toml --performance {file} --trials 20"],
            ),
            seconds=30.0,
            short=10,
        ),
        Door(
            "profile",
            TomlDoor(
                ["fossils/profile-1.toml"],
                [
                    "verify --make-plan {file} -o p",
                    "verify fossils/verify-1.toml",
                ],
            ),
        ),
        Door(
            "verify",
            TomlDoor(
                [
                    "fossils/verify-1.toml",
                    "fossils/verify-1-risk.toml",
                ],
                [
                    "verify {file}",
                    "verify {file} --json",
                    "verify arm.toml {file} -o v",
                ],
            ),
        ),
        Door(
            "lab",
            TomlDoor(
                [
                    "fossils/lab-1.toml",
                    "fossils/lab-1-cmc.toml",
                ],
                ["certificate out/result.json {file} -o c.xml"],
            ),
        ),
        Door(
            "result",
            JsonDoor(
                [
                    "out/result.json",
                    "fossils/result-1.json",
                ],
                _RESULT,
            ),
            short=25,
        ),
        Door(
            "result kept by batch",
            JsonDoor(
                [
                    "batched/study/result.json",
                    "batched/batch.json",
                ],
                ["batch made -o batched"],
            ),
        ),
        Door(
            "evaluation",
            JsonDoor(
                [
                    "judged/evaluation.json",
                    "fossils/evaluation-1.json",
                ],
                _EVALUATED,
            ),
            short=12,
        ),
        Door(
            "cross-validation",
            JsonDoor(
                [
                    "crossed/cross-validation.json",
                    "fossils/cross-validation-1.json",
                ],
                ["report out/result.json -o r.html --cross-validation {file}"],
            ),
            short=12,
        ),
        Door(
            "verification",
            JsonDoor(
                [
                    "tested/verification.json",
                    "fossils/verification-1.json",
                    "fossils/verification-1-risk.json",
                ],
                _VERIFIED,
            ),
            short=12,
        ),
        Door(
            "protocol",
            TomlDoor(
                ["fossils/protocol-1.toml"],
                [
                    "check {file} fossils/protocol-1.csv",
                    "check {file} fossils/protocol-1.csv --date 2030-01-01 --history fossils/check-1.json --json",
                ],
            ),
        ),
        Door(
            "check",
            JsonDoor(
                ["fossils/check-1.json"],
                [
                    "check fossils/protocol-1.toml fossils/protocol-1.csv --date 2030-01-01 --history {file}",
                    "check fossils/protocol-1.toml fossils/protocol-1.csv --date 2030-01-01 --history {file} "
                    "--history fossils/checks-1 --json",
                ],
            ),
            short=12,
        ),
        Door(
            "record",
            JsonDoor(
                [
                    "out/result.json",
                    "judged/evaluation.json",
                    "crossed/cross-validation.json",
                    "tested/verification.json",
                    "fossils/result-1.json",
                    "fossils/check-1.json",
                ],
                [
                    "record add {file} --arm small --records bench",
                    "record add {file} --arm small --at 2026-01-01 --records bench --json",
                ],
            ),
            short=25,
        ),
        Door(
            "record added to",
            TomlDoor(
                ["bench/bench.toml"],
                [
                    "record list --records bench",
                    "record add task.csv --arm small --records bench",
                ],
            ),
        ),
        Door(
            "plan result",
            JsonDoor(
                ["planned/plan.json"],
                [
                    "plan planned --check made/study.toml",
                    "simulate --plan planned -o tried",
                ],
            ),
            short=12,
        ),
        Door(
            "URDF",
            TextDoor(
                ["robot.urdf"],
                [
                    "import urdf {file} -o a.toml",
                    "show {file} -o s.html",
                    "export urdf out/result.json -o a.urdf --template {file}",
                    "new --urdf {file}" + _FRESH,
                ],
                " <>\"'\n",
            ),
        ),
        Door(
            "DH table",
            TextDoor(
                ["dh.csv"],
                [
                    "import dh {file} -o a.toml --convention dh",
                    "import dh {file} -o a.toml --convention modified-dh --tip 1 2 3",
                    "show {file} --convention dh -o s.html",
                    "new --convention dh --dh {file}" + _FRESH,
                ],
                ",\n",
            ),
        ),
        Door(
            "others' layouts",
            TextDoor(
                [
                    "panda_9/front/hole_0.csv",
                    "ipa.csv",
                    "serial.csv",
                ],
                [
                    "import mukca panda_9 -o m",
                    "import ipa-ur10 ipa.csv -o m",
                    "import ipa-ur10 ipa.csv -o m --orientations --fit 2",
                    "import serial-robots serial.csv -o m --robot ur5",
                ],
                ",;\n",
            ),
        ),
        Door(
            "features",
            TextDoor(
                [
                    "fossils/plate-1.csv",
                    "fossils/plate-1-commas.csv",
                    "fossils/verify-1.csv",
                ],
                [
                    "identify fossils/study-1.toml",
                    "identify fossils/study-1-tables.toml",
                    "verify fossils/verify-1.toml",
                ],
                ",;\n",
            ),
        ),
        Door(
            "workbench",
            TomlDoor(["fossils/workbench-1.toml"], ["workbench bench --laboratory {file} --check"]),
            short=12,
        ),
        Door("source", TomlDoor(["fossils/source-1.toml"], _WATCHED), short=25),
        Door("journal", JournalDoor(["fossils/journal-1.journal"], _REPLAYED), short=25),
        Door("new", new_trial),
        Door("options", option_trial),
    ]
}

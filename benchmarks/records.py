"""How long a record of many years takes to be asked, and to be added to.

python -m benchmarks.records [--calibrations 10000] [--database URL] [--page docs/benchmarks/records.md]

Each calibration is of its own (its figures differ), of one of ten arms, and has ten figures or more.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

from sqlalchemy import func, select

from ulna.records.bench import Bench
from ulna.records.filing import Filing, file_all
from ulna.records.records import Records
from ulna.records.tables import CALIBRATION, FIGURE

ROOT = Path(__file__).resolve().parents[1]
ARMS = 10
REPEATS = 7
FIGURE_NAME = "length_error_rms_mm"


def filled(folder: Path, calibrations: int, database: str | None) -> Records:
    """A record of so many calibrations, a day apart."""
    records = Records.init(folder / "bench", database, by="benchmark")
    for k in range(ARMS):
        records.register(f"P{k}", model="Platinum")
    document: dict[str, Any] = json.loads((ROOT / "tests/data/fossils/result-1.json").read_text())
    names = [
        f"{what}_error_{of}_mm" for what in ("length", "coordinate") for of in ("mean", "mean_abs", "rms", "max_abs")
    ]
    begins = datetime(1990, 1, 1, 12, tzinfo=UTC)
    with records.bench.writing() as doing:
        for k in range(calibrations):
            for state, scale in (("before", 10.0), ("after", 1.0)):
                document["overall"][state] = dict.fromkeys(names, scale * (0.01 + 1e-06 * (k * 7919 % 997)))
            sha256 = records.bench.files.put(json.dumps(document).encode())
            at = (begins + timedelta(days=k)).isoformat()
            stated = {"kind": "calibration", "at": at, "names": {"file": "result.json"}, "artefacts": []}
            doing.add("filed", f"P{k % ARMS}", stated, {"file": sha256})
    return records


def median_ms(work: Callable[[], object]) -> float:
    """Of some runs, after one that is not counted."""
    work()
    times = []
    for _ in range(REPEATS):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return 1000.0 * statistics.median(times)


def adds_ms(bench: Bench, folder: Path) -> float:
    """A result of its own each time, in a process that runs already."""
    text = (ROOT / "tests/data/fossils/result-1.json").read_text()
    numbers = iter(range(1000))

    def add() -> None:
        path = folder / "result.json"
        path.write_text(text.replace('"seed": 0', f'"seed": {next(numbers) + 10**6}', 1) + " " * next(numbers))
        assert file_all(bench, [Filing(path, "P1", "2026-11-30")])[0].new

    return median_ms(add)


def measured(folder: Path, calibrations: int, database: str | None) -> list[tuple[str, float]]:
    """What takes how long, ms."""
    began = time.perf_counter()
    records = filled(folder, calibrations, database)
    filled_s = time.perf_counter() - began
    with records.bench.reading() as connection:
        count = connection.scalar(select(func.count()).select_from(FIGURE)) or 0
        made = connection.scalar(select(func.count()).select_from(CALIBRATION)) or 0
    print(f"{made} calibrations, {count} figures, filled in {filled_s:.0f} s", flush=True)
    rows = [
        ("list of equipment", median_ms(records.equipment)),
        ("history of an arm, all of it", median_ms(lambda: records.history("P1"))),
        ("figures of an arm over time", median_ms(lambda: records.figures("P1", FIGURE_NAME, "after"))),
        ("trend: line and chart", median_ms(lambda: records.trend("P1", FIGURE_NAME, state="after", limit=1.0))),
        ("which figures there are", median_ms(lambda: records.series("P1"))),
        ("calibrations of an arm", median_ms(lambda: records.calibrations("P1"))),
        ("what is due", median_ms(records.due)),
        ("advice, all arms of a model", median_ms(lambda: records.advise("P1", "a3"))),
        ("add a result", adds_ms(records.bench, folder)),
    ]
    began = time.perf_counter()
    assert records.verify().good
    return [*rows, ("verify all of it", 1000.0 * (time.perf_counter() - began))]


def command_ms(*arguments: str) -> float:
    """A whole command."""
    environment = os.environ | {"PYTHONPATH": str(ROOT / "python")}
    return median_ms(
        lambda: subprocess.run(
            [sys.executable, "-m", "ulna", *arguments], check=True, capture_output=True, env=environment
        )
    )


def page(found: dict[str, list[tuple[str, float]]], calibrations: int) -> str:
    """As the docs have it."""
    head = " | ".join(["", *found, ""]).strip()
    names = [name for name, _ in next(iter(found.values()))]
    times = {database: dict(rows) for database, rows in found.items()}
    lines = [f"| {name} | {' | '.join(f'{times[each][name]:.0f}' for each in found)} |" for name in names]
    today = datetime.now(UTC).date().isoformat()
    return "\n".join(
        [
            f"`python -m benchmarks.records --calibrations {calibrations}`, {today}, {os.cpu_count()} cores, "
            f"{platform.system()} {platform.machine()}, Python {platform.python_version()}. ms, median of {REPEATS} "
            "runs in a process that runs already; `verify` once.",
            "",
            f"| {head}".replace("|  |", "| |"),
            "|---" * (len(found) + 1) + "|",
            *lines,
            "",
        ]
    )


def main() -> None:
    """Measure, print, and write the page where one is named."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--calibrations", type=int, default=10_000)
    parser.add_argument("--database", default=None, help="an empty PostgreSQL database, measured beside SQLite")
    parser.add_argument("--page", type=Path, default=None)
    asked = parser.parse_args()
    found = {}
    for name, url in (("SQLite", None), ("PostgreSQL", asked.database)):
        if name == "SQLite" or url is not None:
            with tempfile.TemporaryDirectory() as folder:
                found[name] = measured(Path(folder), asked.calibrations, url)
    text = page(found, asked.calibrations)
    print(text)
    print(f"ulna --help: {command_ms('--help'):.0f} ms; ulna record --help: {command_ms('record', '--help'):.0f} ms")
    if asked.page is not None:
        asked.page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()

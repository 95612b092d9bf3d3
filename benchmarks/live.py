"""Readings as they come: whether any is lost, how old the newest is when it is shown, and what memory a long replay
takes.

python -m benchmarks.live [--seconds 60] [--rate 1000] [--hours 1] [--page docs/benchmarks/live.md]

A process of its own writes lines of seven axes into a pseudo-terminal, each with a number and the time at which it was
written, by the clock that both processes share.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
import tty
from collections import Counter
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from ulna.live.journal import Journal
from ulna.live.registry import opened
from ulna.live.samples import Hello, Samples
from ulna.live.source import SourceEnded
from ulna.live.stream import streaming

AXES = 7
SHOWN_HZ = 60.0
WRITER = """\
import math, os, sys, time
out, rate, seconds, batch = int(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3]), int(sys.argv[4])
time.sleep(0.5)
os.write(out, b"\\n")
begin, k = time.monotonic(), 0
while k < rate * seconds:
    due = begin + k / rate
    time.sleep(max(0.0, due - time.monotonic()))
    lines = ""
    for _ in range(batch):
        axes = ",".join(f"{20 * math.sin(k / rate + j):.4f}" for j in range(7))
        lines += f"{time.monotonic():.6f},{k},{axes}\\n"
        k += 1
    data = lines.encode()
    while data:
        data = data[os.write(out, data):]
time.sleep(0.5)
"""


def lost_and_age(seconds: float, rate_hz: float, batch: int, folder: Path) -> tuple[int, int, float, float, float, str]:
    """Readings sent, read, median and 99th percentile of the age of the newest when shown (ms), share of a core that
    reading took, and faults but the first line's."""
    ours, theirs = os.openpty()
    tty.setraw(theirs)
    toml = folder / "source.toml"
    toml.write_text(
        f'format = "ulna-source/1"\nurl = "serial:{os.ttyname(theirs)}"\n[decode]\nkind = "fields"\n'
        'names = ["t", "k", "c1", "c2", "c3", "c4", "c5", "c6", "c7"]\ntime = "t"\ntime_unit = "s"\n'
        '[map]\nunit = "deg"\nchannels = ["c1", "c2", "c3", "c4", "c5", "c6", "c7"]\n'
    )
    words = [sys.executable, "-c", WRITER, str(ours), str(rate_hz), str(seconds), str(batch)]
    writer = subprocess.Popen(words, pass_fds=[ours])
    numbers, ages, kinds = [], list[float](), Counter[str]()
    used = time.process_time()
    with streaming(toml) as stream:
        shown = time.monotonic()
        while writer.poll() is None:
            frames = stream.read(1.0 / SHOWN_HZ)
            kinds.update(fault.kind for fault in frames.faults if fault.kind != "garbage")
            if not len(frames.samples):
                continue
            numbers.append(frames.samples.raw[:, 0])
            if time.monotonic() - shown >= 1.0 / SHOWN_HZ and frames.samples.t_device_s is not None:
                shown = time.monotonic()
                ages.append(1000.0 * (shown - float(frames.samples.t_device_s[-1])))
    used = time.process_time() - used
    os.close(ours)
    os.close(theirs)
    read = np.concatenate(numbers)
    assert np.array_equal(read, np.unique(read)), "out of order"
    told = ", ".join(f"{count} {kind}" for kind, count in kinds.items()) or "none"
    median, late = np.percentile(ages, [50, 99])
    return int(rate_hz * seconds), len(read), float(median), float(late), used / seconds, told


def replayed(hours: float, folder: Path) -> tuple[int, float, float, list[float]]:
    """Samples of a journal of so many hours at 1 kHz, its MB, the samples a second at full speed, and the process's MB
    after each quarter of the replay."""
    path = folder / "long.journal"
    n, block = int(hours * 3.6e6), 4096
    rng = np.random.default_rng(1)
    with Journal.create(path, Hello(tuple(f"c{k + 1}" for k in range(AXES)), "deg", "a benchmark", 1000.0)) as journal:
        for begin in range(0, n, block):
            t = np.arange(begin, min(begin + block, n)) / 1000.0
            angles = 20.0 * np.sin(t[:, None] + np.arange(AXES)) + rng.normal(0, 0.001, (len(t), AXES))
            journal.samples(Samples(t, t, np.round(angles, 4)))
    size, count, memory = path.stat().st_size / 1e6, 0, list[float]()
    begin_s = time.monotonic()
    with opened(f"file:{path}?speed=max") as source:
        while True:
            try:
                count += len(source.read(1.0))
            except SourceEnded:
                break
            if count >= n * (len(memory) + 1) / 4:
                memory.append(_resident_mb())
    return count, size, count / (time.monotonic() - begin_s), memory


def _resident_mb() -> float:
    statm = Path("/proc/self/statm")
    if statm.exists():
        return int(statm.read_text().split()[1]) * resource.getpagesize() / 1e6
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


def page(seconds: float, rate_hz: float, hours: float) -> str:
    """The figures as tables."""
    lines = [
        "| seven axes by a pseudo-terminal | sent | read | age when shown, median | 99 % | of a core | faults |",
        "|---|---|---|---|---|---|---|",
    ]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for rate, batch in ((rate_hz, 1), (4 * rate_hz, 8)):
            sent, read, median, late, core, faults = lost_and_age(seconds, rate, batch, folder)
            how = f"{rate:.0f} Hz, {seconds:.0f} s" + (f", {batch} at once" if batch > 1 else "")
            lines.append(f"| {how} | {sent} | {read} | {median:.1f} ms | {late:.1f} ms | {core:.2f} | {faults} |")
        count, size, speed, memory = replayed(hours, folder)
    lines += [
        "",
        "| replay at full speed | samples | journal | samples a second | MB after each quarter |",
        "|---|---|---|---|---|",
        f"| {hours:g} h at 1 kHz | {count} | {size:.0f} MB | {speed:.2g} | "
        f"{', '.join(f'{each:.0f}' for each in memory)} |",
        "",
        f"Measured {datetime.now(UTC):%Y-%m-%d}, {os.cpu_count()} cores, the writer on one of them.",
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Prints the tables, and writes them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--rate", type=float, default=1000.0)
    parser.add_argument("--hours", type=float, default=1.0)
    parser.add_argument("--page", type=Path)
    given = parser.parse_args()
    text = page(given.seconds, given.rate, given.hours)
    print(text)
    if given.page is not None:
        given.page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()

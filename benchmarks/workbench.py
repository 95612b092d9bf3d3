"""The workbench's server and page: from a touch to its tone, ten pages on one stream, a day at an arm.

python -m benchmarks.workbench [--touches 200] [--seconds 30] [--minutes 8] [--page docs/benchmarks/workbench.md]

A server is begun as somebody begins it, clients are real ones over HTTP and WebSockets, the page runs in Chromium. The
day is a recording of eight hours, played faster than it was.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from tests.serve.servers import Client, Process
from websockets.exceptions import ConnectionClosed

from benchmarks.machine import describe
from ulna.live.journal import Journal
from ulna.live.samples import Hello, Samples

PAGES, HOURS, DAY_HZ, AXES = 10, 8.0, 100.0, 7
FAST = "moves=told&noise=5e-6&rate=1000&hand=10&speed=10"
TICKS = os.sysconf("SC_CLK_TCK")


@contextmanager
def served(folder: Path) -> Iterator[tuple[Client, Process]]:
    """A server on a bench of its own, and somebody who is signed in."""
    process = Process(folder)
    client = Client(process.address).sign_in()
    try:
        yield client, process
    finally:
        client.close()
        process.end()


def cpu_s(pid: int) -> float:
    """That a process has used, s."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


def resident_mb(pid: int) -> float:
    """Of a process."""
    return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


class Listening:
    """A client that reads all that it is told, and notes when."""

    def __init__(self, client: Client, activity: str) -> None:
        self._socket = client.socket(activity)
        self.frames = 0
        self.touches: dict[int, float] = {}
        self.known: list[float] = []
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def _read(self) -> None:
        with suppress(ConnectionClosed):
            for message in self._socket:
                now_s = time.monotonic()
                if isinstance(message, bytes):
                    self.frames += 1
                    continue
                event = json.loads(message)
                if event["event"] == "touch":
                    self.touches.setdefault(event["touch"]["number"], now_s)
                elif event["event"] == "known":
                    self.known.append(now_s)

    def close(self) -> None:
        self._socket.close()
        self._thread.join(10)


def touched(folder: Path, touches: int) -> list[str]:
    """From the word to its event, ms: a key is pressed where the arm rests in the posture that was asked for."""
    delays, knowns = list[float](), list[float]()
    with served(folder) as (client, _):
        play = client.post("/play")
        source = f"{play['source'].partition('?')[0]}?{FAST}"
        asked = {"kind": "touch", "source": source, "arm": play["arm"], "plan": play["plan"], "by": "key"}
        name = client.post("/activities", {**asked, "goal_mm": 1e-4, "length_mm": 500.0})["id"]
        listening = Listening(client, name)
        while len(delays) < touches:
            activity = client.get(f"/activities/{name}")
            state = activity["state"]
            if state["next"] is None:
                break
            client.post(f"/activities/{name}/do", {"word": "go", "q_deg": state["next"]["q_deg"]})
            time.sleep(0.6)
            count, known = len(listening.touches), len(listening.known)
            begun_s = time.monotonic()
            client.post(f"/activities/{name}/do", {"word": "touch"})
            end_s = begun_s + 5.0
            while (len(listening.touches) == count or len(listening.known) == known) and time.monotonic() < end_s:
                time.sleep(0.002)
            if len(listening.touches) > count:
                delays.append(1000.0 * (max(listening.touches.values()) - begun_s))
                knowns.append(1000.0 * (listening.known[-1] - begun_s))
        listening.close()
        client.post(f"/activities/{name}/do", {"word": "end"})
    parts = [slice(k * len(delays) // 4, (k + 1) * len(delays) // 4) for k in range(4)]
    rows = [
        "| touches | from the key to its tone, median | 99 % | to what is known and what is next, median |",
        "|---|---:|---:|---:|",
    ]
    for part in parts:
        some, then = delays[part], knowns[part]
        rows.append(
            f"| {part.start + 1}–{part.stop} | {np.median(some):.1f} ms | {np.percentile(some, 99):.1f} ms | "
            f"{np.median(then):.1f} ms |"
        )
    return rows


def shared(folder: Path, seconds: float) -> list[str]:
    """What ten pages on one stream of 1 kHz take."""
    with served(folder) as (client, process):
        play = client.post("/play")
        source = f"{play['source'].partition('?')[0]}?noise=5e-6&rate=1000"
        name = client.post("/activities", {"kind": "watch", "source": source, "arm": play["arm"]})["id"]
        rows = ["| pages on one stream of 1 kHz | frames a second each | of a core | server |", "|---|---:|---:|---:|"]
        for count in (1, PAGES):
            listening = [Listening(client, name) for _ in range(count)]
            time.sleep(1.0)
            before, frames, begun_s = cpu_s(process.pid), sum(each.frames for each in listening), time.monotonic()
            time.sleep(seconds)
            took_s = time.monotonic() - begun_s
            shown = (sum(each.frames for each in listening) - frames) / took_s / count
            used = (cpu_s(process.pid) - before) / took_s
            rows.append(f"| {count} | {shown:.0f} | {used:.2f} | {resident_mb(process.pid):.0f} MB |")
            for each in listening:
                each.close()
        client.post(f"/activities/{name}/do", {"word": "end"})
    return rows


def day(folder: Path, minutes: float) -> list[str]:
    """Memory of server and page while a day's recording is played."""
    path = folder / "day.journal"
    n, block = int(HOURS * 3600.0 * DAY_HZ), 4096
    with Journal.create(path, Hello(tuple(f"q{k + 1}" for k in range(AXES)), "deg", "a day", DAY_HZ)) as journal:
        for begin in range(0, n, block):
            t = np.arange(begin, min(begin + block, n)) / DAY_HZ
            journal.samples(Samples(t, t, np.round(30.0 * np.sin(0.05 * t[:, None] + np.arange(AXES)), 4)))
    from playwright.sync_api import sync_playwright

    with served(folder / "bench") as (client, process), sync_playwright() as started:
        recording = client.bring(path)
        arm = client.post("/play")["arm"]
        speed = HOURS * 60.0 / minutes
        browser = started.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        shown = browser.new_page()
        shown.goto(process.address)
        shown.locator("main h1").first.wait_for()
        name = client.post("/activities", {"kind": "watch", "source": f"file:{recording}?speed={speed:g}", "arm": arm})[
            "id"
        ]
        shown.goto(f"{process.address.partition('/#')[0]}/arm")
        measured = shown.context.new_cdp_session(shown)
        measured.send("Performance.enable")
        rows: list[tuple[float, float, float]] = []
        begun_s = time.monotonic()
        while client.get(f"/activities/{name}")["running"] and time.monotonic() - begun_s < 120.0 * minutes:
            shown.wait_for_timeout(1000.0 * 60.0 * minutes / 16)
            rows.append((time.monotonic() - begun_s, resident_mb(process.pid), _heap_mb(measured)))
        stream: dict[str, Any] = client.get(f"/activities/{name}")["stream"]
        browser.close()
    quarters = [rows[max(0, (k + 1) * len(rows) // 4 - 1)] for k in range(4)]
    return [
        f"| {HOURS:g} h at {DAY_HZ:g} Hz in {minutes:g} min, after | server | page (JavaScript, after a collection) |",
        "|---|---:|---:|",
        *(
            f"| {seconds / 60.0 / minutes * HOURS:.1f} h | {server:.0f} MB | {heap:.1f} MB |"
            for seconds, server, heap in quarters
        ),
        "",
        f"{stream['samples']} of {n} samples came.",
    ]


def _heap_mb(measured: Any) -> float:
    measured.send("HeapProfiler.collectGarbage")
    found = {each["name"]: each["value"] for each in measured.send("Performance.getMetrics")["metrics"]}
    return float(found["JSHeapUsedSize"]) / 1e6


def main() -> None:
    """Prints the tables, and writes them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--touches", type=int, default=200)
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--minutes", type=float, default=8.0)
    parser.add_argument("--page", type=Path)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        parts = [
            touched(folder / "touched", given.touches),
            shared(folder / "shared", given.seconds),
            day(folder, given.minutes),
        ]
    head = [
        "<!-- Generated by `python -m benchmarks.workbench`; do not edit. -->",
        "",
        *(f"- {key}: {value}" for key, value in describe().items()),
    ]
    measured = f"Measured {datetime.now(UTC):%Y-%m-%d}; clients and the browser ran on the same two cores."
    text = "\n\n".join("\n".join(part) for part in (head, *parts, [measured])) + "\n"
    print(text)
    if given.page is not None:
        given.page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()

"""What the benchmark ran on, and when."""

import datetime
import os
import platform
import subprocess
from pathlib import Path


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.machine())


def _memory_gib() -> str:
    try:
        line = Path("/proc/meminfo").read_text(encoding="utf-8").splitlines()[0]
    except OSError:
        return "unknown"
    return f"{int(line.split()[1]) / 2**20:.0f} GiB"


def _first_line(*command: str) -> str:
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError:
        return "not found"
    return (done.stdout or done.stderr).splitlines()[0] if done.stdout or done.stderr else "not found"


def describe() -> dict[str, str]:
    """Ordered, ready to print."""
    return {
        "date": datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d"),
        "processor": f"{_processor()}, {os.cpu_count()} cores visible",
        "memory": _memory_gib(),
        "system": f"{platform.system()} {platform.machine()}",
        "Python": platform.python_version(),
        "Rust": _first_line("rustc", "--version"),
        "C++": _first_line("c++", "--version"),
    }

"""``python -m benchmarks``: run every contender in a process of its own, print the tables, write the page of the docs.

Options: --quick (small sizes, nothing written), --python PATH (another interpreter that has the peers installed;
Ulna itself always runs in this one), --only NAME (repeatable), --output FILE.
"""

import argparse
import importlib
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

from benchmarks.machine import describe
from benchmarks.peers import ALL, MissingPeerError
from benchmarks.report import page

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "benchmarks" / "results.md"
#: numerical libraries must not start threads of their own: everybody gets one
ONE_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")


def _run_here(name: str, quick: bool) -> dict[str, Any]:
    """One contender, in this process: its times, or why it cannot run."""
    if hasattr(os, "sched_setaffinity") and name != "ulna_core":
        # The Rust program takes two threads itself where a row says so.
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    try:
        contender = importlib.import_module(f"benchmarks.peers.{name}").contender()
        times = contender.measure(quick)
    except (MissingPeerError, ImportError) as error:
        return {"skipped": str(error)}
    return {"name": contender.name, "version": contender.version, "counted": contender.counted, "times": times}


def _run_apart(name: str, quick: bool, peers_python: str) -> dict[str, Any]:
    """One contender in a fresh process, so that neither memory nor threads of one touch another."""
    python = sys.executable if name.startswith("ulna") else peers_python
    command = [python, "-m", "benchmarks", "--contender", name, *(["--quick"] if quick else [])]
    # the peers' interpreter need not have Ulna: the readings that all are timed on come from this tree
    environment = os.environ | ONE_THREAD | {"PYTHONPATH": str(ROOT / "python")}
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT, env=environment)
    if done.returncode != 0:
        sys.exit(f"benchmark of {name} failed:\n{done.stderr}")
    answer: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return answer


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "--quick", action="store_true", help="small sizes only; writes nothing unless --output is given"
    )
    parser.add_argument("--python", default=sys.executable, help="interpreter that has the peers installed")
    parser.add_argument("--only", action="append", choices=ALL, help="run these contenders only; repeatable")
    parser.add_argument("--output", type=Path, help=f"where to write the page (default {PAGE.relative_to(ROOT)})")
    parser.add_argument("--contender", choices=ALL, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.contender:
        print(json.dumps(_run_here(arguments.contender, arguments.quick)))
        return

    contenders, skipped = [], {}
    for name in arguments.only or ALL:
        print(f"{name} …", file=sys.stderr, flush=True)
        answer = _run_apart(name, arguments.quick, arguments.python)
        if "skipped" in answer:
            print(f"{name}: skipped, {answer['skipped']}", file=sys.stderr)
            skipped[name] = answer["skipped"]
        else:
            contenders.append(answer)
    if not contenders:
        sys.exit("no contender could run")
    text = page(describe(), contenders, skipped)
    print(text)
    output = arguments.output or (None if arguments.quick or arguments.only else PAGE)
    if output is not None:
        output.parent.mkdir(parents=True, exist_ok=True)
        output.write_text(text, encoding="utf-8")
        print(f"written: {output}", file=sys.stderr)


if __name__ == "__main__":
    main()

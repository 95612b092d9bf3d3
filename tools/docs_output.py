"""Writes what the docs show of commands and examples: `make docs-output`. Nothing on those pages is typed by hand.

Each command runs in a folder of its own that holds a copy of examples/, so the paths in its output are those that a
reader sees. A test compares every file with what the program prints today.
"""

import os
import re
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

from docs_artefacts import artefact_table
from docs_check import check_outputs
from docs_errors import error_page
from docs_plan import plan_table
from docs_real_readings import real_readings_tables
from docs_records import year_outputs
from docs_running import ROOT, reader_folder, ulna

OUTPUT = ROOT / "docs" / "output"
EXAMPLES_OUTPUT = ROOT / "docs" / "examples" / "output"
#: an example that prints this as its exit code says that its data are not at hand
SKIPPED = 77

#: the arm that plays what is shown of acceptance tests
TRUTH = "examples/platinum/truth.toml"
#: file below docs/output → command, run in this order in one folder; lines: only the first ones are shown
COMMANDS: dict[str, tuple[list[str], int | None]] = {
    "demo.txt": (["demo"], None),
    "identify.txt": (["identify", "examples/platinum/study.toml"], None),
    "calibrate.txt": (["calibrate", "examples/platinum/study.toml", "-o", "out/demo"], None),
    "evaluate.txt": (["evaluate", "out/demo/result.json", "examples/platinum/check.toml"], None),
    "evaluate-before.txt": (["evaluate", "examples/platinum/platinum.toml", "examples/platinum/check.toml"], None),
    "cross-validate.txt": (["cross-validate", "examples/platinum/study.toml", "--by", "5"], None),
    "seat.txt": (["calibrate", "examples/platinum/seat.toml", "-o", "out/straight", "--all"], None),
    "measure.txt": (["measure", "out/demo/result.json", "examples/platinum/check-bars.csv"], 5),
    "uncertainty.txt": (["uncertainty", "out/demo/result.json", "examples/platinum/length.toml"], None),
    "performance.txt": (
        [
            *("uncertainty", "out/demo/arm.toml", "examples/platinum/length.toml"),
            *("--performance", "examples/platinum/performance.toml", "--trials", "5000"),
        ],
        None,
    ),
    "volume.txt": (
        ["uncertainty", "out/demo/result.json", "examples/platinum/volume.toml", "-o", "out/volume"],
        None,
    ),
    "plan.txt": (["plan", "examples/platinum/platinum.toml", "examples/platinum/plan.toml", "-o", "out/plan"], None),
    "compare-simulate.txt": (["simulate", "examples/platinum/next-year.toml", "-o", "out/next-year"], 4),
    "compare-calibrate.txt": (["calibrate", "out/next-year/study.toml", "-o", "out/next-year-result"], 3),
    "compare.txt": (["compare", "out/demo", "out/next-year-result"], None),
    "verify-plan.txt": (
        f"verify --make-plan iso-10360-12 --play {TRUTH} --seed 1 -o out/acceptance".split(),
        None,
    ),
    "verify.txt": (["verify", "out/demo/result.json", "out/acceptance/plan.toml", "-o", "out/verified"], None),
    "new.txt": (
        [
            *("new", "--readings", "examples/home-built/messung.csv", "--artefact", "bar", "--length", "443.172"),
            *("--reach", "1000", "--parallel", "none", "-o", "out/home-built"),
        ],
        23,
    ),
    "new-calibrate.txt": (["calibrate", "out/home-built/study.toml"], 4),
    "reproduce.txt": (["reproduce", "cheng2011", "-o", "out/cheng2011"], None),
}
#: a minute of a thousand fits, which the test of the rerun itself looks at with fewer of them
SLOW = ("reproduce.txt",)
#: the ways of the literature: file below docs/output → study. They take minutes and print times, so the test that the
#: docs are of today compares what is quick, without the times (tests/reproduce/test_ways.py)
WAYS = {
    f"ways-{study}.txt": study
    for study in ("all", "shimojima2002", "santolaria2010", "wang2007", "gao2009", "wang2010", "cheng2010")
}
WAYS_PICTURE = ROOT / "docs" / "pictures" / "ways.png"
#: where the outcomes begin; the page has those of all works once
OUTCOMES = "\nOn the same two arms"

#: pictures that a command above makes → where the docs have them
PICTURES = {
    "out/volume/volume.png": ROOT / "docs" / "pictures" / "volume.png",
    "out/plan/places.png": ROOT / "docs" / "pictures" / "plan-places.png",
    "out/plan/curve.png": ROOT / "docs" / "pictures" / "plan-curve.png",
    "out/verified/lengths.png": ROOT / "docs" / "pictures" / "verify-lengths.png",
    "out/cheng2011/bars.png": ROOT / "docs" / "pictures" / "cheng2011-bars.png",
    "out/cheng2011/convergence.png": ROOT / "docs" / "pictures" / "cheng2011-convergence.png",
}


def tidy(text: str) -> str:
    """Without the spaces that fill a table's lines; one line end at the end."""
    return "\n".join(line.rstrip() for line in text.strip("\n").splitlines()) + "\n"


def first_lines(text: str, lines: int) -> str:
    """The first lines, and a sign that there are more."""
    return "".join(text.splitlines(keepends=True)[:lines]) + "…\n"


#: how the page on certificates comes to its own; only what the last one prints is shown
CERTIFICATE = [
    ["verify", "--make-plan", "iso-10360-12", "--play", "out/demo/arm.toml", "-o", "out/to-measure"],
    ["verify", "out/demo/result.json", "out/to-measure/plan.toml", "-o", "out/tested"],
    [
        *["certificate", "out/demo/result.json", "examples/platinum/laboratory.toml", "--dcc"],
        *["--verification", "out/tested/verification.json", "-o", "out/certificate.xml"],
    ],
]


def certificate_outputs(folder: Path) -> dict[str, str]:
    """What the command prints, and pieces of its XML, long lists cut short. Raises RuntimeError where one fails."""
    for arguments in CERTIFICATE:
        done = ulna(arguments, folder)
        if done.returncode != 0:
            raise RuntimeError(f"ulna {' '.join(arguments)} exited with {done.returncode}:\n{done.stderr}")
    text = (folder / "out" / "certificate.xml").read_text(encoding="utf-8")
    second = [match.start() for match in re.finditer("<si:columnXMLList>", text)][1]
    size = text.index("<dcc:content>P_Size.Sph")
    return {
        "certificate.txt": tidy(done.stdout),
        "certificate-head.txt": _piece(text, text.index('<dcc:quantity refType="basic_measuredValue">'), second),
        "certificate-test.txt": _piece(text, text.rindex("<dcc:quantity ", 0, size), text.index("<dcc:data>", size)),
    }


def _piece(text: str, begin: int, end: int) -> str:
    """Whole lines from begin to end, without their indent."""
    lines = textwrap.dedent(text[text.rindex("\n", 0, begin) + 1 : end].rstrip()).splitlines()
    return "\n".join(re.sub(r"^( *<[^>]+>(?:\S+ ){4}).{30,}?(?=</si)", r"\1…", line) for line in lines) + "\n…\n"


def command_outputs(pictures: bool = False, slow: bool = True) -> dict[str, str]:
    """File name → text, of all commands; pictures: also put theirs in place; slow: those of `SLOW` too. Raises
    RuntimeError where one fails."""
    found = {}
    with reader_folder() as folder:
        head = (folder / "examples" / "platinum" / "bars.csv").read_text(encoding="utf-8").splitlines()[:5]
        found["bars-head.txt"] = tidy("\n".join(head))
        for name, (arguments, lines) in COMMANDS.items():
            if name in SLOW and not slow:
                continue
            done = ulna(arguments, folder)
            if done.returncode not in (0, 1):
                raise RuntimeError(f"ulna {' '.join(arguments)} exited with {done.returncode}:\n{done.stderr}")
            text = tidy(done.stdout)
            found[name] = text if lines is None else first_lines(text, lines)
        table = ["export", "dh", "out/demo/result.json", "-o", "out/table.csv"]
        done = ulna([*table, "--convention", "modified-dh", "--angle-unit", "deg"], folder)
        if done.returncode != 0:
            raise RuntimeError(f"ulna {' '.join(table)} exited with {done.returncode}:\n{done.stderr}")
        found["dh-table.txt"] = tidy((folder / "out" / "table.csv").read_text(encoding="utf-8"))
        found |= certificate_outputs(folder)
        found |= {name: tidy(text) for name, text in check_outputs(folder).items()}
        found["calibrate-short.txt"] = first_lines(found["calibrate.txt"], 20)
        for made, shown in PICTURES.items() if pictures else ():
            shown.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(folder / made, shown)
    return found


def ways_outputs() -> dict[str, str]:
    """File name → text, of the ways of the literature; puts their picture in place. Raises RuntimeError."""
    found = {}
    with reader_folder() as folder:
        for name, study in WAYS.items():
            done = ulna(["reproduce", study, "-o", f"out/{study}"], folder)
            if done.returncode != 0:
                raise RuntimeError(f"ulna reproduce {study} exited with {done.returncode}:\n{done.stdout}{done.stderr}")
            text = tidy(done.stdout)
            found[name] = text if study == "all" else tidy(text.split(OUTCOMES)[0])
        shutil.copyfile(folder / "out" / "all" / "ways.png", WAYS_PICTURE)
    return found


def example_output(example: Path) -> str | None:
    """What an example prints; None where it says that its data are not at hand. Raises RuntimeError where it fails."""
    environment = os.environ | {"PYTHONWARNINGS": "error"}
    command = [sys.executable, str(example)]
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    if done.returncode == SKIPPED:
        return None
    if done.returncode != 0:
        raise RuntimeError(f"{example.name} exited with {done.returncode}:\n{done.stderr}")
    return done.stdout


def examples() -> list[Path]:
    """The numbered examples, in order."""
    return sorted((ROOT / "examples").glob("[0-9][0-9]_*.py"))


#: first words after the prompt in a block of the README → file with what the command prints
IN_README = {
    ".venv/bin/ulna calibrate": OUTPUT / "calibrate-short.txt",
    ".venv/bin/ulna evaluate": OUTPUT / "evaluate.txt",
    ".venv/bin/python examples/03": EXAMPLES_OUTPUT / "03_identify_before_you_fit.txt",
}


def filled_readme(text: str) -> str:
    """The README with the output of the commands that it shows. Raises RuntimeError for a command it does not know."""

    def filled(block: re.Match[str]) -> str:
        for words, file in IN_README.items():
            if block["command"].startswith(words):
                return f"```console\n$ {block['command']}\n{file.read_text(encoding='utf-8')}```\n"
        raise RuntimeError(f"README.md shows '{block['command']}', whose output nobody writes: add it to IN_README")

    return re.sub(r"```console\n\$ (?P<command>[^\n]*)\n.*?```\n", filled, text, flags=re.DOTALL)


def main() -> None:
    OUTPUT.mkdir(parents=True, exist_ok=True)
    EXAMPLES_OUTPUT.mkdir(parents=True, exist_ok=True)
    year = {name: tidy(text) for name, text in year_outputs().items()}
    for name, text in (command_outputs(pictures=True) | ways_outputs() | year).items():
        (OUTPUT / name).write_text(text, encoding="utf-8")
    (OUTPUT / "plan-variants.md").write_text(plan_table(), encoding="utf-8")
    (OUTPUT / "which-artefact.md").write_text(artefact_table(), encoding="utf-8")
    (OUTPUT / "errors.md").write_text(error_page(), encoding="utf-8")
    for example in examples():
        printed = example_output(example)
        if printed is None:
            print(f"{example.name}: data not at hand, left as it was")
        else:
            (EXAMPLES_OUTPUT / f"{example.stem}.txt").write_text(printed, encoding="utf-8")
    tables = real_readings_tables()
    if tables is None:
        print("real readings: data not at hand, left as they were")
    for name, table in (tables or {}).items():
        (OUTPUT / f"real-{name}.md").write_text(table, encoding="utf-8")
    readme = ROOT / "README.md"
    readme.write_text(filled_readme(readme.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()

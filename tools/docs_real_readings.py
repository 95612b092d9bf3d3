"""The results on the page about real readings, from runs of the public commands on the data beside the project."""

import json
import tempfile
from pathlib import Path
from typing import Any

from docs_running import ROOT, ulna

DATA = ROOT.parent / "shared" / "data"
ROBOTS = {
    "panda_1": "Franka Panda, 7 axes",
    "panda_2_clean": "another Panda",
    "kuka_14": "KUKA iiwa 14, 7 axes",
    "dinova_1": "Kinova Gen3 lite, 6 axes",
}
#: what a plain fit with SciPy, that the data came with, gives on places left out: scatter, length error
REFERENCE = {"panda_1": ("0.81", "0.62"), "panda_2_clean": ("0.288", "0.149")}
#: what was fitted → what the study says beyond the importer's
NOISE_STATED = "everything, noise stated: encoders 2e-4 rad, touch 0.1 mm"
VARIANTS = {
    "everything, every reading weighs one": "",
    NOISE_STATED: "[noise]\nencoder = 2e-4\nseat = 0.1\n",
    "all but the offsets `d`": '[fit]\nhold = ["joint.*.d"]\n',
    "all but lengths `a` and offsets `d`": '[fit]\nhold = ["joint.*.a", "joint.*.d"]\n',
    "all but the twists `alpha`": '[fit]\nhold = ["joint.*.alpha"]\n',
    "all but joint 1": '[fit]\nhold = ["joint.1.*"]\n',
    "zero offsets and probe only": '[fit]\nfree = ["joint.*.theta0", "probe.*"]\n',
}
#: not asked: where residuals are millimetres, a stated noise of tenths is simply wrong
LEFT_OUT = {(NOISE_STATED, "dinova_1")}
SCATTER, LENGTH, COORDINATE = "seat_scatter_mean_mm", "length_error_mean_abs_mm", "coordinate_error_mean_mm"


def _done(arguments: list[str], folder: Path) -> Any:
    done = ulna(arguments, folder)
    if done.returncode not in (0, 1):
        raise RuntimeError(f"ulna {' '.join(arguments)}: {done.stderr}")
    return done


def _json(arguments: list[str], folder: Path) -> dict[str, Any]:
    answer: dict[str, Any] = json.loads(_done([*arguments, "--json"], folder).stdout)
    return answer


def _variant(folder: Path, study: str, name: str, more: str) -> str:
    """A study beside another, that says more."""
    path = folder / study
    (path.parent / f"{name}.toml").write_text(f"{path.read_text(encoding='utf-8')}\n{more}", encoding="utf-8")
    return str(Path(study).parent / f"{name}.toml")


def sockets(folder: Path) -> list[str]:
    """The table of two-socket readings, each tool position left out once."""
    lines = [
        "| readings | rows | places | scatter before | after | SciPy | length error before | after | SciPy |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for robot, words in ROBOTS.items():
        counted = _done(["import", "mukca", str(DATA / "mukca" / robot), "-o", robot], folder).stderr.split(": ", 1)[1]
        rows, places = counted.split()[0], counted.split(" readings in ")[1].split()[0]
        found = _json(["cross-validate", f"{robot}/study.toml", "--by", "placement"], folder)
        before, after = found["before"], found["after"]
        reference = REFERENCE.get(robot, ("–", "–"))
        lines.append(
            f"| {words}, `{robot}` | {rows} | {places} "
            f"| {before[SCATTER]:.2f} | **{after[SCATTER]:.3f}** | {reference[0]} "
            f"| {before[LENGTH]:.2f} | **{after[LENGTH]:.3f}** | {reference[1]} |"
        )
    return lines


def variants(folder: Path) -> list[str]:
    """What holding and weighting do to the scatter on places left out; after `sockets`."""
    lines = ["| fitted | " + " | ".join(f"`{robot}`" for robot in ROBOTS) + " |", "|---" + "|---:" * len(ROBOTS) + "|"]
    for number, (words, more) in enumerate(VARIANTS.items()):
        cells = []
        for robot in ROBOTS:
            if (words, robot) in LEFT_OUT:
                cells.append("–")
                continue
            study = _variant(folder, f"{robot}/study.toml", f"variant{number}", more)
            cells.append(f"{_json(['cross-validate', study], folder)['after'][SCATTER]:.3f}")
        lines.append(f"| {words} | {' | '.join(cells)} |")
    return lines


def tracked(folder: Path) -> list[str]:
    """The table of the tracked UR10: 300 rows fitted, the rest held out."""
    file = next((DATA / "ipa_ur10" / "Series_B").glob("measurements_*.csv"))
    lines = ["| the tracker stood | fitted | held out | before | after | SciPy |", "|---|---:|---:|---:|---:|---:|"]
    for standings, words, reference in (("1", "in one place", "0.401"), ("5", "in five, one after the other", "–")):
        name = f"ur10-{standings}"
        chosen = ["--fit", "300", "--spread", "--standings", standings]
        counted = _done(["import", "ipa-ur10", str(file), "-o", name, *chosen], folder).stderr.split(": ", 1)[1].split()
        # before: the nominal arm, with the tracker's target on the flange found from the same 300 rows
        target = _variant(folder, f"{name}/study.toml", "target", '[fit]\nfree = ["probe.*"]\n')
        figures = []
        for study, out in ((target, f"{name}/target"), (f"{name}/study.toml", f"{name}/result")):
            _done(["calibrate", study, "-o", out], folder)
            found = _json(["evaluate", f"{out}/result.json", f"{name}/held-out.toml"], folder)
            figures.append(found["overall"][COORDINATE])
        fitted, held_out = counted[0], counted[counted.index("held") - 1]
        lines.append(f"| {words} | {fitted} | {held_out} | {figures[0]:.3f} | **{figures[1]:.4f}** | {reference} |")
    return lines


def real_readings_tables() -> dict[str, str] | None:
    """Name → Markdown table; None where the data are not at hand."""
    if not DATA.is_dir():
        return None
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tables = {"sockets": sockets(folder), "variants": variants(folder), "tracked": tracked(folder)}
    return {name: "\n".join(lines) + "\n" for name, lines in tables.items()}

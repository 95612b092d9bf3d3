"""The results on the page about real readings, from runs of the public commands on the data beside the project."""

import json
import math
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import takewhile
from pathlib import Path
from typing import Any

from docs_running import ROOT, Done, ulna
from ulna import Arm

DATA = ROOT.parent / "shared" / "data"
ROBOTS = {
    "panda_1": "Franka Panda, 7 axes",
    "panda_2_clean": "Franka Panda, second set",
    "kuka_14": "KUKA iiwa 14, 7 axes",
    "dinova_1": "Kinova Gen3 lite, 6 axes",
}
HARMONICS, COMPLIANCE = "encoder-harmonics", "compliance"
BOTH = (HARMONICS, COMPLIANCE)
#: how well a robot keeps to its drawing, rad and mm
PRIORS = {"joint.*.theta0": 0.01, "joint.*.alpha": 0.01, "joint.*.a": 1.0, "joint.*.d": 1.0, "probe.*": 5.0}
#: how much its joints may give way, rad/(N m)
STIFF = {"joint.*.compliance": 1e-4}
#: amplitudes of each of many harmonics, rad
SMALL = {"joint.*.[cs][0-9]*": 1e-4}
#: between the lines of a long list
SEPARATOR = ",\n    "


def fit_table(extras: Sequence[str], orders: Sequence[int] = (1,), more: Mapping[str, float] | None = None) -> str:
    """`[fit]` and `[fit.prior]` of the recipe with some blocks beyond geometry; more: further priors."""
    lines = ["[fit]", 'loss = "huber"']
    if extras:
        lines.append(f"extras = {json.dumps(list(extras))}")
    if HARMONICS in extras:
        rows = [list(orders)[k : k + 15] for k in range(0, len(orders), 15)]  # of a page's width
        lines.append(f"harmonics = [{SEPARATOR.join(', '.join(map(str, row)) for row in rows)}]")
    prior = PRIORS | (STIFF if COMPLIANCE in extras else {}) | dict(more or {})
    return "\n".join([*lines, "", "[fit.prior]", *(f'"{pattern}" = {u!r}' for pattern, u in prior.items())]) + "\n"


PLAIN_SECOND = f'[fit]\nextras = ["{HARMONICS}"]\nharmonics = [1, 2]\n'
#: what was fitted → what the study says beyond the importer's
BEYOND = {
    "geometry, plain least squares": "",
    "geometry, recipe": fit_table([]),
    "+ harmonics 1": fit_table([HARMONICS]),
    "+ harmonics 1, 2": fit_table([HARMONICS], (1, 2)),
    "+ compliance": fit_table([COMPLIANCE]),
    "+ harmonics 1, compliance": fit_table(BOTH),
    "+ harmonics 1, 2, compliance": fit_table(BOTH, (1, 2)),
    "plain + harmonics 1, 2": PLAIN_SECOND,
    "plain + harmonics 1, 2, nothing known of them": f'{PLAIN_SECOND}\n[fit.prior]\n"joint.*.[cs][0-9]*" = 1.0\n',
}
HELD = {
    "geometry, plain least squares": "",
    "noise stated: encoders 2e-4 rad, touch 0.1 mm": "[noise]\nencoder = 2e-4\nseat = 0.1\n",
    "all but lengths `a` and offsets `d`": '[fit]\nhold = ["joint.*.a", "joint.*.d"]\n',
    "all but the twists `alpha`": '[fit]\nhold = ["joint.*.alpha"]\n',
    "all but joint 1": '[fit]\nhold = ["joint.1.*"]\n',
    "zero offsets and probe only": '[fit]\nfree = ["joint.*.theta0", "probe.*"]\n',
}
#: where no geometry explains the readings, neither weights nor amplitudes are the question, and searches take long
NOT_ASKED = {(words, "dinova_1") for words in (list(HELD)[1], *list(BEYOND)[-2:])}
TILTS = {"joint.*.beta": 0.01}
#: the same for the tracked robot, whose parallel axes have a tilt
TRACKED = {
    "geometry, plain least squares": "",
    "geometry, recipe": fit_table([], more=TILTS),
    "+ harmonics 1": fit_table([HARMONICS], more=TILTS),
    "+ compliance": fit_table([COMPLIANCE], more=TILTS),
    "+ harmonics 1, compliance": fit_table(BOTH, more=TILTS),
    "+ harmonics 1, 2, compliance": fit_table(BOTH, (1, 2), TILTS),
    "+ harmonics 1 to 20, compliance": fit_table(BOTH, range(1, 21), TILTS | SMALL),
    "+ harmonics 1 to 40, compliance": fit_table(BOTH, range(1, 41), TILTS | SMALL),
}
#: of a UR10: kg and mm after each link, about as its maker says
UR10_MASSES = (
    (7.1, (21.0, 0.0, 27.0)),
    (12.7, (380.0, 0.0, 158.0)),
    (4.27, (240.0, 0.0, 68.0)),
    (2.0, (0.0, 7.0, 18.0)),
    (2.0, (0.0, 7.0, 18.0)),
    (0.365, (0.0, 0.0, 66.0)),
)
SCATTER, LENGTH, COORDINATE = "seat_scatter_mean_mm", "length_error_mean_abs_mm", "coordinate_error_mean_mm"
SCATTER_RMS, COORDINATE_RMS = "seat_scatter_rms_mm", "coordinate_error_rms_mm"
VERDICTS = {"earned": "earned its place", "undecided": "cannot be told", "not-earned": "made it worse"}

Masses = Sequence[tuple[float, tuple[float, float, float]]]


def _done(arguments: list[str], folder: Path) -> Done:
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


def rough_masses(arm: Arm) -> Masses:
    """Nobody weighed anything: 4 kg falling to 1 kg from the base to the probe, each in the middle of its link."""
    found: list[tuple[float, tuple[float, float, float]]] = []
    for number, joint in enumerate(arm.joints[:-1]):
        sine, cosine = math.sin(joint.alpha_rad), math.cos(joint.alpha_rad)
        middle = (-joint.a_mm / 2.0, -joint.d_mm / 2.0 * sine, -joint.d_mm / 2.0 * cosine)
        found.append((round(4.0 - 3.0 * number / (arm.n - 1), 1), _round(middle)))
    (probe,) = arm.probes.values()
    return [*found, (1.0, _round((probe.x_mm / 2.0, probe.y_mm / 2.0, probe.z_mm / 2.0)))]


def _round(centre_mm: Sequence[float]) -> tuple[float, float, float]:
    x, y, z = (round(value) + 0.0 for value in centre_mm)
    return x, y, z


def _weigh(path: Path, masses: Masses | None = None, times: float = 1.0) -> Masses:
    """Write masses into an arm file that has none; masses: rough ones. Returns those of the file."""
    arm = Arm.load(path)
    masses = masses or rough_masses(arm)
    joints = tuple(
        replace(joint, effects=replace(joint.effects, mass_kg=times * kg, centre_mm=centre_mm))
        for joint, (kg, centre_mm) in zip(arm.joints, masses, strict=True)
    )
    replace(arm, joints=joints).save(path, force=True)
    return masses


def sockets(folder: Path) -> list[str]:
    """The table of two-socket readings, each tool position left out once; leaves the studies behind for the others."""
    lines = ["| readings | rows | places | scatter before | after | length error before | after |"]
    lines.append("|---|---:|---:|---:|---:|---:|---:|")
    for robot, words in ROBOTS.items():
        counted = _done(["import", "mukca", str(DATA / "mukca" / robot), "-o", robot], folder).stderr.split(": ", 1)[1]
        rows, places = counted.split()[0], counted.split(" readings in ")[1].split()[0]
        found = _json(["cross-validate", f"{robot}/study.toml", "--by", "placement"], folder)
        before, after = found["before"], found["after"]
        lines.append(
            f"| {words}, `{robot}` | {rows} | {places} | {before[SCATTER]:.2f} | **{after[SCATTER]:.3f}** "
            f"| {before[LENGTH]:.2f} | **{after[LENGTH]:.3f}** |"
        )
    return lines


def masses(folder: Path) -> list[str]:
    """What was added to the arm files, by example; adds it. After `sockets`."""
    lines = ["| KUKA iiwa 14 | `mass` | `centre` |", "|---|---:|---|"]
    for robot in ROBOTS:
        path = folder / robot / "arm.toml"
        if any(joint.effects.mass_kg for joint in Arm.load(path).joints):
            continue  # the drawing has them
        found = _weigh(path)
        if robot == "kuka_14":
            lines += [f"| joint {k} | {kg} | `{list(centre)}` |" for k, (kg, centre) in enumerate(found, start=1)]
    return lines


def _left_out(folder: Path, variants: Mapping[str, str], name: str, figures: Sequence[str]) -> list[str]:
    """A row for each variant, a column for each robot: figures on places left out."""
    lines = ["| fitted | " + " | ".join(f"`{robot}`" for robot in ROBOTS) + " |", "|---" + "|---:" * len(ROBOTS) + "|"]
    for number, (words, more) in enumerate(variants.items()):
        cells = []
        for robot in ROBOTS:
            if (words, robot) in NOT_ASKED:
                cells.append("–")
                continue
            study = _variant(folder, f"{robot}/study.toml", f"{name}{number}", more)
            after = _json(["cross-validate", study], folder)["after"]
            cells.append("&nbsp;/&nbsp;".join(f"{after[figure]:.3f}" for figure in figures))
        lines.append(f"| {words} | {' | '.join(cells)} |")
    return lines


def verdicts(folder: Path) -> list[str]:
    """What the reports say of both blocks, harmonics of order 1; after `masses`."""
    lines = ["| readings | block | without | with | better by | |", "|---|---|---:|---:|---:|---|"]
    for robot in ROBOTS:
        study = _variant(folder, f"{robot}/study.toml", "judged", fit_table(BOTH))
        for entry in _json(["calibrate", study], folder)["extras"]:
            block = {HARMONICS: "harmonics 1"}.get(entry["extra"], entry["extra"])
            better = f"{entry['better_by_mm']:.3f}&nbsp;±&nbsp;{entry['u_better_by_mm']:.3f}"
            lines.append(
                f"| `{robot}` | {block} | {entry['without_mm']:.3f} | {entry['with_mm']:.3f} "
                f"| {better} | {VERDICTS[entry['verdict']]} |"
            )
    return lines


def tracked(folder: Path) -> list[str]:
    """The table of the tracked UR10: 300 rows fitted, the rest held out, the tracker in one place or in five; and the
    other series, of which nothing was fitted."""
    fitted, other = (next((DATA / "ipa_ur10" / f"Series_{name}").glob("measurements_*.csv")) for name in "BD")
    _done(["import", "ipa-ur10", str(other), "-o", "other"], folder)
    rough: Masses = []
    for standings in ("1", "5"):
        name = f"ur10-{standings}"
        chosen = ["--fit", "300", "--spread", "--standings", standings]
        _done(["import", "ipa-ur10", str(fitted), "-o", name, *chosen], folder)
        rough = _weigh(folder / name / "arm.toml")
    # before: the nominal arm, with the tracker's target on the flange found from the same 300 rows
    rows = {"nothing but the target's place": '[fit]\nfree = ["probe.*"]\n'} | TRACKED
    lines = ["| fitted | held out | held out, `--standings 5` | Series D |", "|---|---:|---:|---:|"]
    for words, more in rows.items():
        one, series_d = _coordinate_errors(folder, "ur10-1", more, ["ur10-1/held-out.toml", "other/study.toml"])
        (five,) = _coordinate_errors(folder, "ur10-5", more, ["ur10-5/held-out.toml"])
        lines.append(f"| {words} | {one:.3f} | {five:.3f} | {series_d:.3f} |")
    both = list(TRACKED)[4]
    weighed: list[tuple[str, Masses, float]] = [("all masses doubled", rough, 2.0), ("UR's masses", UR10_MASSES, 1.0)]
    for words, kilograms, times in weighed:
        _weigh(folder / "ur10-1" / "arm.toml", kilograms, times)
        judged = ["ur10-1/held-out.toml", "other/study.toml"]
        one, series_d = _coordinate_errors(folder, "ur10-1", TRACKED[both], judged)
        lines.append(f"| {both}, {words} | {one:.3f} | – | {series_d:.3f} |")
    return lines


def _coordinate_errors(folder: Path, name: str, more: str, judged: Sequence[str]) -> list[float]:
    """A variant fitted, and its mean error on other studies."""
    quick = more.replace("[fit]\n", "[fit]\njudge_extras = false\n")
    study = _variant(folder, f"{name}/study.toml", "variant", quick)
    _done(["calibrate", study, "-o", f"{name}/result", "--force"], folder)
    found = [_json(["evaluate", f"{name}/result/result.json", other], folder) for other in judged]
    return [float(one["overall"][COORDINATE]) for one in found]


def intervals(folder: Path) -> list[str]:
    """How many of what was left out lie inside their stated 95 % intervals; after `masses` and `tracked`."""
    lines = ["| readings | fitted | judged on | rms error / mm | points inside | lengths inside |"]
    lines.append("|---|---|---|---:|---:|---:|")
    for robot, words in ROBOTS.items():
        for fitted in [*BEYOND][:6:5]:
            study = _variant(folder, f"{robot}/study.toml", "intervals", BEYOND[fitted])
            found = _json(["cross-validate", study], folder)
            held = _inside(found["coverage"])
            lines.append(f"| {words} | {fitted} | places left out | {found['after'][SCATTER_RMS]:.3f} | {held} |")
    judged = {"ur10-1/held-out.toml": "1195 poses held out", "other/study.toml": "Series D, four months later"}
    for fitted in [*TRACKED][:: len(TRACKED) - 1]:
        quick = TRACKED[fitted].replace("[fit]\n", "[fit]\njudge_extras = false\n")
        study = _variant(folder, "ur10-1/study.toml", "intervals", quick)
        _done(["calibrate", study, "-o", "ur10-1/intervals", "--force"], folder)
        for other, words in judged.items():
            found = _json(["evaluate", "ur10-1/intervals", other], folder)
            held = _inside(found["coverage"])
            lines.append(
                f"| UR10, laser tracker | {fitted} | {words} | {found['overall'][COORDINATE_RMS]:.3f} | {held} |"
            )
    return lines


def intervals_said(folder: Path) -> list[str]:
    """What a command prints where too few hold; after `sockets`."""
    printed = _done(["cross-validate", "panda_1/study.toml"], folder).stdout.splitlines()
    start = next(k for k, line in enumerate(printed) if line.startswith("Inside their stated"))
    block = takewhile(lambda line: line.strip(), printed[start:])
    return ["```text", *(line.rstrip() for line in block), "```"]


def _inside(coverage: Mapping[str, Any]) -> str:
    """Of points and lengths: the share in %, with its interval, bold where the stated u is too small."""
    cells = []
    for name in ("points", "lengths"):
        share = coverage[name]
        said = f"{100 * share['share']:.1f}"
        said = f"**{said}**" if share["high"] < 0.95 else said
        cells.append(f"{said} ({100 * share['low']:.0f}–{100 * share['high']:.0f})")
    return " | ".join(cells)


def real_readings_tables(long: bool = True) -> dict[str, str] | None:
    """Name → Markdown table, or the study's tables that made it; None where the data are not at hand. long: also those
    that take minutes each."""
    if not DATA.is_dir():
        return None
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tables = {
            "recipe": ["```toml", *fit_table(BOTH).splitlines(), "```"],
            "sockets": sockets(folder),
            "held": _left_out(folder, HELD, "held", [SCATTER]),
            "masses": masses(folder),
            "verdicts": verdicts(folder),
            "intervals-said": intervals_said(folder),
            "recipe-tracked": ["```toml", *list(TRACKED.values())[-1].splitlines(), "```"],
        }
        if long:
            tables["beyond"] = _left_out(folder, BEYOND, "beyond", [SCATTER, LENGTH])
            tables["tracked"] = tracked(folder)
            tables["intervals"] = intervals(folder)
    return {name: "\n".join(lines) + "\n" for name, lines in tables.items()}

"""``python -m benchmarks.choosing``: errors held out of a model that chose itself and of models chosen by hand.

The tracked robot is fitted to 300 rows of Series B and judged on the others and on the other series; of the robots that
touched two sockets each place is left out once, and the choice sees nothing of it. Nobody weighed those robots:
`--masses` gives them rough ones, without which no compliance can be fitted.
"""

import argparse
import dataclasses
import sys
import time
import warnings
from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import ulna
from benchmarks.choosing.fixed import AUTO, CHOICES, PLAIN, SLOW, without_masses
from benchmarks.choosing.weighed import weighed
from benchmarks.coverage.real_sets import SETS, Fold
from ulna.calibration.choosing.tried import ChosenModel
from ulna.calibration.figures import overall_figures

DATA = Path(__file__).resolve().parents[3] / "shared" / "data"
FIGURES = ("seat_scatter_mean_mm", "coordinate_error_mean_mm")
"""What is judged, the first that readings give."""


def error_mm(arm: ulna.Arm, study: ulna.Study, readings: ulna.Readings) -> float:
    """Of readings that the fit has not seen."""
    found = overall_figures(arm, dataclasses.replace(study, readings=[readings]))
    return next(found[figure] for figure in FIGURES if figure in found)


def options(arm: ulna.Arm, fit: Mapping[str, Any], loss: str) -> dict[str, Any]:
    """Fields of `ulna.FitOptions`, with the priors of those patterns that match something: effects always do."""
    prior = {
        pattern: ulna.Prior(u)
        for pattern, u in fit.get("prior", {}).items()
        if "[" in pattern or "compliance" in pattern or any(fnmatchcase(name, pattern) for name in arm.parameter_names)
    }
    return dict(fit) | {"prior": prior, "judge_extras": False, "loss": loss}


def judged(folds: Sequence[Fold], fit: Mapping[str, Any], loss: str) -> tuple[dict[str, float], float, list[str]]:
    """By the columns of the table the mean error of the folds, mm; the longest fit, s; and what was chosen, of each."""
    sums: dict[str, float] = {}
    longest, said = 0.0, []
    for fold in folds:
        began = time.perf_counter()
        result = ulna.calibrate(fold.fitted, **options(fold.fitted.arm, fit, loss))
        longest = max(longest, time.perf_counter() - began)
        if result.chosen is not None:
            said.append(in_words(result.chosen))
        for name, group in fold.held_out.items():
            sums[name] = sums.get(name, 0.0) + error_mm(result.arm, fold.fitted, group) / len(folds)
    return sums, longest, said


def in_words(chosen: ChosenModel) -> str:
    """Short."""
    words = [extra for extra in chosen.extras if extra != "encoder-harmonics"]
    if chosen.harmonics:
        words.insert(0, f"1-{chosen.harmonics[-1]}")
    return " ".join(["drawing" if chosen.drawn else "plain", *words])


def table(data: Path, sets: Sequence[str], masses: bool, loss: str, slow: bool) -> Iterator[str]:
    """Lines of Markdown, each as soon as it is known."""
    choices = CHOICES if masses else without_masses(CHOICES)
    for name in sets:
        folder, folds_of = SETS[name]
        if not (data / folder).is_dir():
            yield f"{name}: skipped, there is no folder {folder} in that of the data\n"
            continue
        folds = [weighed(fold) if masses else fold for fold in folds_of(data)]
        columns = list(folds[0].held_out)
        yield f"| {name}, loss {loss} | {' | '.join(columns)} | longest fit / s |"
        yield "|---" + "|---:" * (len(columns) + 1) + "|"
        by_hand: dict[str, dict[str, float]] = {}
        for choice, fit in choices.items():
            if choice == SLOW and len(folds) > 1 and not slow:
                continue
            by_hand[choice], longest, _ = judged(folds, fit, loss)
            yield _row(choice, by_hand[choice], longest)
        auto, longest, said = judged(folds, {"extras": AUTO}, loss)
        yield _row("**auto**", auto, longest)
        best = {column: min(each[column] for each in by_hand.values()) for column in columns}
        for words, beside in (("auto over the best by hand", best), ("auto over plain", by_hand[PLAIN])):
            yield f"| {words} | " + " | ".join(f"{auto[k] / beside[k]:.3f}" for k in columns) + " | |"
        yield f"\nChosen: {'; '.join(said)}.\n"


def _row(words: str, errors: Mapping[str, float], longest: float) -> str:
    return f"| {words} | {' | '.join(f'{each:.3f}' for each in errors.values())} | {longest:.1f} |"


def main(arguments: Sequence[str]) -> None:
    """Print the tables, and write them where that is asked for."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.choosing", description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--data", type=Path, default=DATA, help="folder with ipa_ur10 and mukca (../shared/data)")
    parser.add_argument("--sets", default="*", help=f"with commas: {', '.join(SETS)}")
    parser.add_argument("--masses", action="store_true", help="rough masses for all, so that joints may give way")
    parser.add_argument("--loss", default="none", help="of all fits: none, huber, ...")
    parser.add_argument("--slow", action="store_true", help=f"also '{SLOW}' with places left out (many minutes)")
    parser.add_argument("--output", type=Path, help="file for the tables, beside the screen")
    given = parser.parse_args(arguments)
    sets = [name for name in SETS if any(fnmatchcase(name, pattern.strip()) for pattern in given.sets.split(","))]
    if not sets:
        sys.exit(f"nothing to judge; sets: {', '.join(SETS)}")
    lines = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ulna.InputWarning)
        for line in table(given.data, sets, given.masses, given.loss, given.slow):
            print(line, flush=True)
            lines.append(line)
    if given.output is not None:
        given.output.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])

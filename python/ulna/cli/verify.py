"""`ulna verify`: an acceptance test, planned, played or evaluated."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.options import Force, Json, OutFolder
from ulna.cli.recorded import Record, record, recording
from ulna.cli.running import guard


@guard
def verify(
    files: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="[ARM] PLAN",
            help="The arm (arm.toml or result.json), for encoder readings; then the verify file (TOML).",
            show_default=False,
        ),
    ] = None,
    make_plan: Annotated[
        str | None,
        typer.Option("--make-plan", metavar="PROFILE", help="Write the list of what to measure, for -o DIR."),
    ] = None,
    play: Annotated[
        Path | None,
        typer.Option("--play", metavar="TRUTH", help="With --make-plan: this arm plays the list, virtually."),
    ] = None,
    encoder_noise: Annotated[
        float, typer.Option("--encoder-noise", metavar="RAD", help="Of the playing arm, standard deviation.")
    ] = 5e-6,
    touch_noise: Annotated[
        float, typer.Option("--touch-noise", metavar="MM", help="Of its touches, standard deviation per coordinate.")
    ] = 0.005,
    seed: Annotated[int, typer.Option("--seed", metavar="N", help="Of its random numbers.")] = 0,
    out: OutFolder = None,
    force: Force = False,
    as_json: Json = False,
    to_record: Record = None,
) -> None:
    """Evaluate an acceptance test in the manner of ISO 10360-12, ASME B89.4.22 or VDI/VDE 2617-9.

    Readings are those of the arm's encoders, or x, y, z of any arm, whoever made it; then ARM is left out. Each figure
    is printed with its formula, its limit and what the decision rule says; what was measured otherwise than the profile
    counts is told. With -o it writes verification.json, values.csv and a picture. Exit code 1 where a value of the arm
    as left fails; where it was tested as found only, of the arm as found.

    Example: [bold]ulna verify arm.toml plan.toml -o tested[/bold]

    Example: [bold]ulna verify --make-plan iso-10360-12 -o to-measure[/bold]
    """
    from ulna.ground.errors import UlnaInputError

    given = files or []
    if make_plan is not None and to_record is not None:
        raise UlnaInputError("option --record: files what was found; a plan has found nothing yet. Leave it out.")
    if make_plan is not None:
        _make(given, make_plan, play, encoder_noise, touch_noise, seed, out, force, as_json)
        return
    if play is not None:
        raise UlnaInputError("option --play: there is nothing to play; expected --make-plan PROFILE as well. Add it.")
    if len(given) not in (1, 2):
        raise UlnaInputError(
            f"ulna verify: got {len(given)} files; expected ARM PLAN, or PLAN alone for readings as x, y, z. Name "
            "them, or make a plan with --make-plan iso-10360-12."
        )
    _evaluate(given, out, force, as_json, to_record)


def _evaluate(files: list[Path], out: Path | None, force: bool, as_json: bool, to_record: str | None) -> None:
    from ulna.cli import output
    from ulna.cli.printed.verification import WORDS, verification_report
    from ulna.formats.output import check_output, refuse_inputs
    from ulna.verification.verify import FILE, PICTURES, TABLE
    from ulna.verification.verify import verify as run_verify

    *arm, plan = files
    every = (FILE, TABLE, *PICTURES)
    if out is not None:
        check_output(out, every, force)
    kept = recording(to_record, out)
    found = run_verify(plan, arm[0] if arm else None)
    if out is not None:
        read = [each.path for parts in found.plan.touches.values() for each in parts]
        refuse_inputs((out / name for name in every), [*files, found.plan.profile.path, *read])
        found.save(out, force)
    if as_json:
        output.print_json(found.as_dict())
    else:
        output.print_renderable(*verification_report(found))
    if out is not None:
        output.say(f"Written to {out}: {', '.join(found.files)}")
        beside = {f"touches {k}": path for k, path in enumerate(read, start=1)}
        record(kept, out / FILE, {"plan": plan, "profile": found.plan.profile.path, **beside})
    failed = [state.state for state in found.states if state.verdict == "fail"]
    if not failed:
        return
    decides = found.standing.state
    output.say(f"A value fails ({' and '.join(failed)}): see the table above.")
    if len(found.states) > 1:
        output.say(f"The exit code is that of the arm {decides}: {WORDS[found.standing.verdict]}.")
    if decides in failed:
        raise typer.Exit(1)


def _make(
    files: list[Path],
    profile: str,
    play: Path | None,
    encoder_rad: float,
    touch_mm: float,
    seed: int,
    out: Path | None,
    force: bool,
    as_json: bool,
) -> None:
    import math

    from ulna.arm.arm import Arm
    from ulna.cli import output
    from ulna.formats.output import check_output, refuse_inputs
    from ulna.ground.errors import UlnaInputError
    from ulna.verification.test_plan import FILES, make_test_plan, play_test_plan

    if len(files) > 1:
        raise UlnaInputError(
            f"option --make-plan: got {len(files)} files; expected none, or the arm whose encoders are read. "
            "Remove one."
        )
    if out is None:
        raise UlnaInputError("option --make-plan: where to write is not said; expected -o DIR. Add it.")
    for option, value in (("--encoder-noise", encoder_rad), ("--touch-noise", touch_mm), ("--seed", float(seed))):
        if not (math.isfinite(value) and value >= 0.0):
            raise UlnaInputError(f"option {option}: got {value:g}, expected a number of 0 or more. Correct it.")
    check_output(out, FILES, force)
    own = Path(profile)
    refuse_inputs((out / name for name in FILES), [*files, *([] if play is None else [play]), own])
    arm = Arm.load(files[0]) if files else None
    if play is None:
        made = make_test_plan(profile, arm)
    else:
        truth = Arm.load(play)
        if arm is not None and arm.n != truth.n:
            raise UlnaInputError(
                f"{play}: the playing arm has {truth.n} joints, {files[0]} has {arm.n}; expected as many. Name another."
            )
        with output.progress_bar() as progress:
            made = play_test_plan(profile, truth, encoder_rad, touch_mm, seed, progress=progress)
    made.save(out, force)
    counts = made.counts()
    if as_json:
        output.print_json({"profile": made.profile.file.name, "out": str(out), "touches": counts, "files": list(FILES)})
    else:
        listed = ", ".join(f"{test} {count}" for test, count in counts.items())
        print(f"Profile {made.profile.file.name}: {sum(counts.values())} touches ({listed}).")
    output.say(f"Written to {out}: {', '.join(FILES)}")

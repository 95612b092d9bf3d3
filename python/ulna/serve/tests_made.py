"""Plans of acceptance tests, made of what somebody states, as `ulna verify --make-plan` makes them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ulna.arm.given import as_arm
from ulna.ground.errors import UlnaInputError, nearest
from ulna.ground.worded import recalled, worded
from ulna.serve.beside import usable
from ulna.serve.contract import guided as wire
from ulna.serve.workshop import Workshop
from ulna.verification.departures import FIGURES, said_of
from ulna.verification.kinds.registry import kind_of
from ulna.verification.plan_files import Filled, plan_toml
from ulna.verification.player import range_of
from ulna.verification.profile import Profile, load_profile, shipped
from ulna.verification.steps import artefacts_of, steps_of
from ulna.verification.tables import State

_DIGEST = re.compile(r"[0-9a-f]{64}")


def profiles() -> wire.Profiles:
    """Those that come with Ulna."""
    found = [load_profile(name, Path(), "profile") for name in shipped()]
    return wire.Profiles(
        profiles=[
            wire.ProfileInfo(name=each.file.name, standard=each.file.standard, touches=len(steps_of(each.file)))
            for each in found
        ]
    )


def _profile(workshop: Workshop, given: str) -> Profile:
    if _DIGEST.fullmatch(given):
        path = usable(workshop.desk, given)
        return load_profile(path.name, path.parent, "profile")
    if given not in shipped():
        raise UlnaInputError(
            worded(
                "profile: got '{given}', none that comes with Ulna.{near} Name one, or bring your own.",
                given=given[:80],
                near=nearest(given, shipped()),
            )
        )
    return load_profile(given, Path(), "profile")


def wants(workshop: Workshop, given: str, arm: str) -> wire.ProfileWants:
    """What a profile asks of a test with an arm. Raises UlnaInputError."""
    profile = _profile(workshop, given)
    range_mm = range_of(as_arm(workshop.desk.path(arm)))
    artefacts = []
    for each in artefacts_of(profile.file):
        if each.SIZE is None:
            continue
        example = each.stated(range_mm)
        artefacts.append(
            wire.WantedArtefact(
                name=each.name,
                kind=each.KIND,
                size_mm=example[each.SIZE],
                u_mm=example["u"],
                form_mm=example.get("form"),
                expansion=example["expansion"],
                u_expansion=example["u_expansion"],
            )
        )
    limits = []
    for table in profile.file.test.values():
        kind = kind_of(table.kind)
        for figure in kind.figures(table):
            limit = kind.limits.get(figure.key)
            a, b = (limit["a"], limit["b"]) if isinstance(limit, Mapping) else (limit, None)
            limits.append(wire.WantedLimit(figure=figure.key, name=recalled(figure.name, FIGURES), a_mm=a, b=b))
    return wire.ProfileWants(
        name=profile.file.name,
        standard=profile.file.standard,
        statement=said_of(profile.file.statement),
        touches=len(steps_of(profile.file)),
        range_mm=range_mm,
        artefacts=artefacts,
        limits=limits,
    )


def test_made(workshop: Workshop, asked: wire.TestAsked) -> wire.TestPlanMade:
    """A verify file on the desk, to be touched. Raises UlnaInputError."""
    desk, profile = workshop.desk, _profile(workshop, asked.profile)
    arm = as_arm(desk.path(asked.arm))
    own = [asked.profile] if _DIGEST.fullmatch(asked.profile) else []
    wanted = {each.name: each for each in artefacts_of(profile.file) if each.SIZE is not None}
    stated: dict[str, dict[str, Any]] = {}
    for each in asked.artefacts:
        if each.name not in wanted:
            raise UlnaInputError(
                worded(
                    "artefacts: '{name}': profile '{profile}' asks for none of that name.{near} Correct it.",
                    name=each.name[:80],
                    profile=profile.file.name,
                    near=nearest(each.name, wanted),
                )
            )
        keys = {
            str(wanted[each.name].SIZE): each.size_mm,
            "u": each.u_mm,
            "form": each.form_mm,
            "expansion": each.expansion,
            "u_expansion": each.u_expansion,
        }
        stated[each.name] = {key: value for key, value in keys.items() if value is not None}
    temperature = {"value": asked.temperature_c, "u": asked.u_temperature_k or 0.0}
    filled = Filled(
        arm=asked.item or arm.name,
        range_mm=asked.range_mm or range_of(arm),
        artefacts=stated,
        mpe={each.figure: each.a_mm if each.b is None else {"a": each.a_mm, "b": each.b} for each in asked.limits},
        temperature=None if asked.temperature_c is None else temperature,  # type: ignore[arg-type]
        fixture_mm=asked.fixture_mm,
    )
    states: tuple[State, ...] = ("as-found", "as-left") if asked.as_found else ("as-left",)
    # beside its profile, so that it names it as a file that is brought with it
    text = plan_toml(profile, filled, True, profile.path.parent, states)
    name = f"{profile.file.name}-test.toml"
    lacks = [worded("artefact '{name}': its certificate", name=name) for name in wanted if name not in stated]
    made = desk.put(name, text.encode())
    return wire.TestPlanMade(
        test=made.sha256, beside=own, name=made.name, touches=len(steps_of(profile.file)), lacks=lacks
    )

"""Command lines: options and values as nobody types them."""

from __future__ import annotations

import functools
from random import Random
from typing import Any

from fuzzing.room import Room
from fuzzing.trial import Trial
from fuzzing.values import NUMBERS, TEXTS

#: each with what it takes; options are added
LINES = (
    "calibrate made/study.toml",
    "identify made/study.toml",
    "evaluate out/result.json made/study.toml",
    "measure out/result.json task.csv",
    "uncertainty out/result.json task.toml --trials 100",
    "cross-validate made/study.toml",
    "certificate out/result.json fossils/lab-1.toml",
    "batch made -o all",
    "simulate simulation.toml",
    "report out/result.json -o r.html",
    "verify fossils/verify-1.toml",
    "show arm.toml",
    "import urdf robot.urdf -o a.toml",
    "import dh dh.csv -o a.toml --convention dh",
    "import mukca panda_9 -o m",
    "export urdf out/result.json -o a.urdf",
    "export dh out/result.json -o a.csv",
    "new --readings task.csv",
    "completion",
    "reproduce",
)
#: what opens a window, works on other machines, or takes minutes by right
NEVER = {"--open", "--dask", "--trials", "--study", "--by", "--make-plan"}
NAMES = (
    "out/result.json",
    "out",
    "arm.toml",
    "made/study.toml",
    "task.csv",
    "nowhere",
    "",
    "-",
    "/dev/null",
    "task.toml",
)


@functools.cache
def _options() -> dict[str, list[Any]]:
    """Of each command, by its words: the parameters that begin with a dash."""
    import typer.main

    from ulna.cli import app

    found: dict[str, list[Any]] = {}

    def look(command: Any, words: str) -> None:
        found[words] = [each for each in command.params if each.opts[0].startswith("-")]
        for name, inner in getattr(command, "commands", {}).items():
            look(inner, f"{words} {name}".strip())

    look(typer.main.get_command(app), "")
    return found


def option_trial(_room: Room, source: Random) -> Trial:
    """A command with some of its options, values of any kind, or words too many or too few."""
    words = source.choice(LINES).split()
    known = _options().get(" ".join(words[:2])) or _options()[words[0]]
    for _ in range(source.choice([0, 1, 1, 2, 4])):
        option = source.choice(known)
        name = source.choice([*option.opts, *option.secondary_opts])
        if name in NEVER or option.opts[-1] in NEVER:
            continue
        words.append(name)
        if not getattr(option, "is_flag", False):
            words += [_value(source) for _ in range(max(option.nargs, 1))]
    way = source.randrange(12)
    at = source.randrange(len(words))
    if way == 0:
        del words[at]
    elif way == 1:
        words[at] = _value(source)
    elif way == 2:
        words.insert(at, _value(source))
    elif way == 3:
        words.append(source.choice(["--nothing", "-x", "--", "--out", "--=", "-o=", "--json=1", "--force=no", "-"]))
    return Trial([word for word in words if word not in NEVER and not any(word.startswith(f"{n}=") for n in NEVER)])


def _value(source: Random) -> str:
    value = str(source.choice(source.choice([NAMES, NUMBERS, TEXTS, _SAID])))
    # what a shell cannot hand over: zeros end a word, other surrogates are no bytes of a file's name
    return "".join("\udc80" if 0xD800 <= ord(sign) <= 0xDFFF else sign for sign in value if sign != "\0")[:200]


_SAID = (
    "q1=q2",
    "q1=",
    "=q1",
    "a=b=c",
    "feature.A=B",
    "feature.A",
    "bar:200",
    "bar:200:0.001",
    "bar:x",
    "bar:200:-1",
    "bar:nan",
    "points:task.csv",
    "x=bar:1",
    "0,30,-45,0",
    "0,30",
    "0,,1",
    "0;1;2",
    "1 2 3",
    "known",
    "unknown",
    "tab",
    "cp1252",
    "utf-7",
    "idna",
    "base64",
    "rot13",
    "hex",
    "zlib",
    "unicode_escape",
    "iso-10360-12",
    "a.csv",
    "a.xlsx",
    "a.parquet",
    "a.jsonl",
    "a.exe",
    "a.pdf",
    "a.html",
    "made",
    "x/y/z/a.csv",
    "fit",
    "check",
    "all",
    "bent",
    "none",
)

"""What Ulna says to a user whose input it cannot use, or uses with a remark.

One message names the file, the row and column or the key, the value, what was expected and what to do. The command
line prints it and exits with code 2; no traceback, no value put in its place.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable

from ulna.ground.worded import worded


class UlnaInputError(Exception):
    """Input that cannot be used. ``str(error)`` is the whole message, meant for the user (exit code 2)."""


class InputWarning(UserWarning):
    """Input that is used, with a remark that the user should see."""


def nearest(name: str, known: Iterable[str]) -> str:
    """`" Did you mean 'x'?"`, or `" Known: a, b, c."` where nothing is near: the tail of a message."""
    names = list(known)
    close = difflib.get_close_matches(name, names, n=1, cutoff=0.6)
    if close:
        return worded(" Did you mean '{name}'?", name=close[0])
    if not names:
        return ""
    shown = ", ".join(names[:12]) + (", …" if len(names) > 12 else "")
    return worded(" Known: {names}.", names=shown)


def wrong_type(given: object, expected: str) -> TypeError:
    """Of an argument that is none of what may be given: one sentence that says what it is and what was expected."""
    kind = type(given).__name__
    article = "an" if kind[:1].lower() in "aeiou" or kind == "ndarray" else "a"
    shown = "None" if given is None else f"{article} {kind}"
    return TypeError(f"got {shown}, expected {expected}.")


def cannot_be_read(error: OSError) -> str:
    """A disk that is full, a network folder that went away, permissions: what nobody can foresee, as a message."""
    where = f"{error.filename}: " if error.filename else ""
    return f"{where}cannot be read or written ({error.strerror or error}). Check the disk and the permissions."


LONGEST = 1200
"""Characters of a line of a message: what a person reads."""


def for_people(message: str) -> str:
    """A message as a terminal may have it: what files put into it moves no cursor, breaks no line and fills no screen.

    Lines are those of a list ("- …"), which is the one thing that messages have lines for.
    """
    said = "\n".join(map(_line, re.split(r"\n(?=- )", message)))
    return message if said == message else said  # a worded one stays one


def _line(line: str) -> str:
    if len(line) > LONGEST:
        line = f"{line[: LONGEST - 300]} … {line[-250:]}"
    return "".join(
        each if each.isprintable() or each == "\t" else each.encode("unicode_escape").decode() for each in line
    )

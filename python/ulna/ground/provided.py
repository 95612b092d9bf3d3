"""What a class offers and a higher room does: the class says what it is, the public face says where it is done.

`Arm.from_urdf` reads a drawing, `Result.plot` draws what reports draw, and both stand on floors above. The lower room
states the signature and asks for the work by name; the public face (`ulna/__init__.py`), which puts the rooms together,
names the function that does it. So no file imports from a higher room.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import Any

_WHERE: dict[str, str] = {}


def provide(where: Mapping[str, str]) -> None:
    """Say who does what: name of the work → "module:function". Nothing is loaded yet."""
    _WHERE.update(where)


def provided(work: str) -> Any:
    """The function that does it, loaded now. Errors: LookupError where nobody was named, which is a mistake of ours."""
    if work not in _WHERE:
        raise LookupError(f"nobody provides '{work}'; name who does in ulna/__init__.py")
    module, _, name = _WHERE[work].partition(":")
    return getattr(importlib.import_module(module), name)

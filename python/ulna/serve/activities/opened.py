"""A source as a client names it, opened: by its URL, or by a file of the desk. No path of a client is opened."""

from __future__ import annotations

from urllib.parse import quote

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.registry import KINDS
from ulna.live.source_file import StatedSource, read_source
from ulna.serve.desk import Desk
from ulna.serve.sources import OF_FILES, Allowed


def stated_source(desk: Desk, given: str, allowed: Allowed) -> StatedSource:
    """A URL, or the SHA-256 of a source file or a recording. Raises UlnaInputError."""
    stated = _stated(desk, given)
    allowed(stated)
    return stated


def _stated(desk: Desk, given: str) -> StatedSource:
    scheme, colon, rest = given.partition(":")
    if not colon:
        path = desk.path(given)
        stated = read_source(path)
        if desk.brought(path) and path.suffix.lower() == ".toml" and stated.url.scheme in OF_FILES and stated.url.path:
            raise UlnaInputError(
                worded(
                    "{file}: key 'url': names a file of this machine; expected a stream. Bring that file, and name it "
                    "as the source.",
                    file=path.name,
                )
            )
        return stated
    if scheme.lower() not in OF_FILES:
        if scheme.lower() not in KINDS:
            known = ", ".join(KINDS)
            raise UlnaInputError(
                worded(
                    "source '{source}': got '{got}:'; expected one of {known}. Correct it.",
                    source=given[:80],
                    got=scheme[:20],
                    known=known,
                )
            )
        return read_source(given)
    name, question, options = rest.partition("?")
    if options and "poses=" in options:
        raise UlnaInputError(f"source '{given[:80]}': poses are files; expected none here. Leave them out.")
    path = desk.path(name)
    return read_source(f"{scheme}:{quote(str(path))}{question}{options}")

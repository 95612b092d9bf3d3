"""Urls of sources, in parts: `serial:/dev/ttyACM0?baud=115200`, `tcp://host:port`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from urllib.parse import parse_qsl, unquote, urlsplit

from ulna.ground.errors import UlnaInputError, nearest


@dataclass(frozen=True)
class Url:
    """A url. What messages show of it, `text`, has no password in it."""

    text: str
    scheme: str
    host: str
    port: int | None
    path: str
    """What follows the host, or the scheme, decoded."""
    options: Mapping[str, str]
    user: str | None = None
    password: str | None = None

    @classmethod
    def read(cls, text: str) -> Url:
        """Raises UlnaInputError."""
        scheme, colon, _ = text.partition(":")
        if not colon or not scheme.isascii() or any(letter.isspace() or not letter.isprintable() for letter in text):
            raise UlnaInputError(f"source {text!r}: not a url; expected one such as serial:/dev/ttyACM0. Correct it.")
        try:
            parts = urlsplit(text)
            port = parts.port
            options = parse_qsl(parts.query, keep_blank_values=True, strict_parsing=bool(parts.query))
        except ValueError as error:
            raise UlnaInputError(
                f"source '{text}': not a url ({error}); expected scheme://host:port. Correct it."
            ) from None
        twice = {name for name, _ in options if [each for each, _ in options].count(name) > 1 and name != "node"}
        if twice:
            raise UlnaInputError(f"source '{text}': says {min(twice)} twice; expected it once. Take one out.")
        merged: dict[str, str] = {}
        for name, value in options:
            merged[name] = f"{merged[name]}\n{value}" if name in merged else value
        shown = text if parts.password is None else text.replace(f":{parts.password}@", ":…@", 1)
        if merged.get("token"):
            shown = shown.replace(merged["token"], "…")
        path = unquote(parts.path)
        return cls(shown, scheme.lower(), parts.hostname or "", port, path, merged, parts.username, parts.password)

    def check(self, known: Sequence[str], host: bool = False, port: bool = False) -> None:
        """Options that the kind knows, and whether it needs a host and a port. Raises UlnaInputError."""
        for name in self.options:
            if name not in known:
                hint = nearest(name, known)
                raise UlnaInputError(
                    f"source '{self.text}': unknown option '{name}'; expected those of {self.scheme}:.{hint}"
                    f"{'' if hint else ' It has none. Take it out.'}"
                )
        if (host and not self.host) or (port and self.port is None):
            raise UlnaInputError(f"source '{self.text}': expected {self.scheme}://host:port. Correct it.")

    def number(self, name: str, default: float, least: float, most: float) -> float:
        """An option that is a number. Raises UlnaInputError."""
        if name not in self.options:
            return default
        try:
            value = float(self.options[name])
        except ValueError:
            value = float("nan")
        if not least <= value <= most:
            raise UlnaInputError(
                f"source '{self.text}': option '{name}': got '{self.options[name]}', expected a number from {least:g} "
                f"to {most:g}. Correct it."
            )
        return value

    def word(self, name: str, default: str, known: Sequence[str]) -> str:
        """An option that is one of some words. Raises UlnaInputError."""
        value = self.options.get(name, default)
        if value not in known:
            raise UlnaInputError(
                f"source '{self.text}': option '{name}': got '{value}', expected {' or '.join(known)}. Correct it."
            )
        return value

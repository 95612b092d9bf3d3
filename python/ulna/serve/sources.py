"""Which sources a server may open when a browser asks it to: it would connect to them in its own name."""

from __future__ import annotations

import ipaddress
import socket
from collections.abc import Callable, Collection

from ulna.live.source_file import StatedSource
from ulna.serve.problems import NotAllowedError

Allowed = Callable[[StatedSource], None]
"""Raises NotAllowedError for a source that may not be opened."""
SERIAL = ("serial", "microscribe")
OF_FILES = ("file", "bag", "virtual")
"""Schemes whose URL begins with a path: here with the SHA-256 of a file of the desk."""
CONNECTS = ("tcp", "ws", "wss", "rosbridge", "mqtt", "mqtts", "opc.tcp")
"""That go to another machine."""


def allow_all(stated: StatedSource) -> None:
    """On one's own machine."""


def allow_listed(hosts: Collection[str], serial: bool) -> Allowed:
    """In a laboratory: machines that its file lists, and serial lines where it says so; never an address of the link
    itself, where clouds answer with their secrets."""
    listed = {host.lower() for host in hosts}

    def allowed(stated: StatedSource) -> None:
        url = stated.url
        if url.scheme in OF_FILES or (serial and url.scheme in SERIAL):
            return
        if url.scheme in CONNECTS and url.host.lower() in listed and not _of_the_link(url.host):
            return
        raise NotAllowedError(
            f"source '{url.text[:80]}': this laboratory's server does not open it; expected one of "
            f"{', '.join(sorted(listed)) or 'no host'}{', or a serial line' if serial else ''}. An admin adds it to "
            "[sources] of the server's file."
        )

    return allowed


def _of_the_link(host: str) -> bool:
    try:
        found = {each[4][0] for each in socket.getaddrinfo(host, None)}
    except OSError:
        return False  # opening it says so better
    return any(ipaddress.ip_address(str(each).partition("%")[0]).is_link_local for each in found)

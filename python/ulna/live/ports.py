"""Serial ports of this machine."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Port:
    """A port, and what is plugged in there."""

    path: str
    what: str
    url: str


def ports() -> list[Port]:
    """All there are, by name; those that are soldered in and have nothing behind them are left out."""
    from serial.tools.list_ports import comports

    found = []
    for port in sorted(comports(), key=lambda each: each.device):
        if port.hwid in (None, "n/a") and port.device.startswith("/dev/ttyS"):
            continue
        maker = f"{port.manufacturer} " if port.manufacturer else ""
        serial = f", serial number {port.serial_number}" if port.serial_number else ""
        found.append(Port(port.device, f"{maker}{port.description or ''}{serial}".strip(), f"serial:{port.device}"))
    return found

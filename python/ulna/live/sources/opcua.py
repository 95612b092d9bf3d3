"""`opc.tcp://host:4840/`: angles of a robot or an arm, by OPC UA.

`?node=ns=2;s=Arm.Q1` names a node, once for each axis, or one that holds a list of them. Without it the axes are those
whose variable is called ActualPosition, as OPC 40010 (robotics) has it in every axis's ParameterSet, in the order in
which the server lists them.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from contextlib import suppress
from datetime import UTC, datetime
from typing import Any

import numpy as np

from ulna.ground.errors import UlnaInputError
from ulna.live.decode.decoder import Row
from ulna.live.faults import ENDED, Fault
from ulna.live.samples import MOST_CHANNELS, Hello, Samples
from ulna.live.source import SourceEnded
from ulna.live.source_file import StatedSource
from ulna.live.sources.wire import as_samples

QUEUE = 1000
"""Values that the server keeps for us; by default it keeps the newest alone."""
_MOST_NODES = 5000
_ALIVE_S = 1.0
_TOGETHER_S = 0.05
"""Within it all axes that moved at one time have reported."""


class OpcUaSource:
    """Values that the server reports as they change. What came with one time of the source is one sample; an axis that
    did not change stays as it was."""

    def __init__(self, stated: StatedSource) -> None:
        """Raises UlnaInputError where nobody answers, or no axis is found."""
        from asyncua.sync import Client
        from asyncua.ua.uaerrors import UaError

        url = stated.url
        url.check(("node", "period"), host=True)
        port = "" if url.port is None else f":{url.port}"
        self._device = f"opc.tcp://{url.host}{port}{url.path}"
        self._came = threading.Event()
        self._reported: deque[tuple[float, float, int, Any]] = deque()
        self._faults: list[Fault] = []
        self._why: str | None = None
        self._end_said = False
        self._held: dict[float, tuple[float, dict[int, float]]] = {}
        self._checked_s = time.monotonic()
        period_ms = url.number("period", 10.0, 1.0, 10000.0)
        self._client: Any = Client(self._device, timeout=5)
        try:
            self._client.connect()
        except (OSError, UaError, TimeoutError, ConnectionError) as error:
            with suppress(Exception):
                self._client.tloop.stop()
            raise UlnaInputError(
                f"{self._device}: no OPC UA server answers ({_said(error)}); expected one. Check the address."
            ) from None
        try:
            self._nodes = self._axes(url.options.get("node"))
            self._values = self._now()
            names = self._names()
            self.hello = Hello(names, stated.file.map.unit, self._device, None)
            self._subscription = self._client.create_subscription(period_ms, self)
            self._subscription.subscribe_data_change(self._nodes, queuesize=QUEUE, sampling_interval=0)
        except (OSError, UaError, TimeoutError, ValueError, TypeError) as error:
            self.close()
            raise UlnaInputError(
                f"{self._device}: {_said(error)}; expected axes that can be read. Check node=."
            ) from None
        except BaseException:
            self.close()
            raise

    def _axes(self, stated: str | None) -> list[Any]:
        if stated is not None:
            return [self._client.get_node(each) for each in stated.split("\n")]
        waiting, found, seen = deque([self._client.nodes.objects]), [], 0
        while waiting and seen < _MOST_NODES:
            for child in waiting.popleft().get_children():
                seen += 1
                name = child.read_browse_name()
                if name.Name == "ActualPosition":
                    found.append(child)
                elif name.NamespaceIndex:  # the server's own object has hundreds, and no axis
                    waiting.append(child)
        if not found:
            raise UlnaInputError(
                f"{self._device}: no variable 'ActualPosition' in {seen} nodes; expected one of each axis. Name them "
                "with ?node=ns=2;s=NAME&node=…"
            )
        return found

    def _now(self) -> list[float]:
        """What all axes read, as one row. Raises ValueError where that is no numbers."""
        read = self._client.read_values(self._nodes)
        flat = read[0] if len(read) == 1 and isinstance(read[0], list) else read
        self._list = flat is not read
        values = [float(each) for each in flat]
        if not 0 < len(values) <= MOST_CHANNELS:
            raise ValueError(f"{len(values)} axes; expected 1 to {MOST_CHANNELS}")
        return values

    def _names(self) -> tuple[str, ...]:
        if self._list:
            return tuple(f"c{k + 1}" for k in range(len(self._values)))
        names = tuple(node.nodeid.to_string() for node in self._nodes)
        self._index = {name: k for k, name in enumerate(names)}
        return names

    def datachange_notification(self, node: Any, value: Any, data: Any) -> None:
        """As asyncua calls it, in a thread of its own."""
        stamp: datetime | None = data.monitored_item.Value.SourceTimestamp
        stamped_s = time.time() if stamp is None else stamp.replace(tzinfo=UTC).timestamp()
        at = -1 if self._list else self._index[node.nodeid.to_string()]
        self._reported.append((time.monotonic(), stamped_s, at, value))
        self._came.set()

    def status_change_notification(self, status: Any) -> None:
        """As asyncua calls it: the subscription ended."""
        self._why = f"{self._device}: the server ended the subscription ({status.Status})."
        self._came.set()

    def read(self, timeout_s: float) -> Samples:
        """As `Source`."""
        if not self._reported:
            self._came.wait(min(timeout_s, _TOGETHER_S) if self._held else timeout_s)
        self._came.clear()
        while self._reported:
            self._hold(*self._reported.popleft())
        self._alive()
        rows = self._rows(time.monotonic())
        if not rows and self._why is not None and not self._reported:
            if not self._end_said:
                self._faults.append(Fault(ENDED, time.monotonic(), self._why))
                self._end_said = True
            raise SourceEnded(self._why)
        return as_samples(rows, len(self._values))

    def _hold(self, t_host_s: float, stamped_s: float, at: int, value: Any) -> None:
        """Values of one time of the source are put together."""
        _, values = self._held.setdefault(stamped_s, (t_host_s, {}))
        if at < 0:
            values.update(enumerate(map(float, value)))
        else:
            values[at] = float(value)

    def _rows(self, now_s: float) -> list[Row]:
        """What is whole: every axis reported it, or no more came for a while, as axes that stand still report
        nothing."""
        rows: list[Row] = []
        for stamped_s in sorted(self._held):
            t_host_s, values = self._held[stamped_s]
            if len(values) < len(self._values) and now_s - t_host_s < _TOGETHER_S and self._why is None:
                break
            del self._held[stamped_s]
            for at, value in values.items():
                if at < len(self._values):
                    self._values[at] = value
            if np.isfinite(self._values).all():
                rows.append(Row(t_host_s, stamped_s, tuple(self._values), None))
        return rows

    def _alive(self) -> None:
        """Asks once a second whether the server is there: asyncua tries for long by itself."""
        if time.monotonic() - self._checked_s < _ALIVE_S or self._why is not None:
            return
        self._checked_s = time.monotonic()
        try:
            self._client.check_connection()
        except Exception as error:
            self._why = f"{self._device}: the server is gone ({_said(error)})."

    def faults(self) -> list[Fault]:
        """As `Source`."""
        found, self._faults = self._faults, []
        return found

    def close(self) -> None:
        """As `Source`."""
        with suppress(Exception):  # it may be gone
            self._client.disconnect()
        with suppress(Exception):
            self._client.tloop.stop()


def _said(error: Exception) -> str:
    return str(getattr(error, "strerror", None) or error)[:120].rstrip(".") or type(error).__name__


def open_source(stated: StatedSource) -> OpcUaSource:
    """As the registry asks. Raises UlnaInputError."""
    return OpcUaSource(stated)

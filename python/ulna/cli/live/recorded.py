"""Streams into files: journals as they come, CSV from recordings."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from urllib.parse import quote

from ulna.ground.errors import UlnaInputError
from ulna.live.faults import Fault
from ulna.live.journal import Journal
from ulna.live.relay import Relay
from ulna.live.rounds import Round
from ulna.live.samples import Samples
from ulna.live.stream import Frames


class Recording:
    """A journal that begins with the first samples: a source that cannot be opened, or sends none, leaves none."""

    def __init__(self, path: Path) -> None:
        """Raises UlnaInputError where there is a file already."""
        if path.exists():
            raise UlnaInputError(f"{path}: exists already and is never overwritten. Name another file with -o.")
        self._path = path
        self._journal: Journal | None = None
        self._before: list[Fault] = []
        """What was wrong before the first sample."""

    def take(self, known: Round, frames: Frames) -> None:
        """What came."""
        if not known.count:
            self._before += frames.told
            return
        journal = self._opened(known)
        journal.samples(frames.samples)
        for fault in (*self._before, *frames.told):
            journal.event(fault.as_dict())
        self._before = []

    def end(self, known: Round) -> None:
        """Why it ended. Raises UlnaInputError where no reading came."""
        if self._journal is None:
            raise UlnaInputError(
                f"{self._path}: not written, for no reading came from {known.stream.source.hello.device}; expected one "
                "at the least. See what comes: ulna live watch"
            )
        why = known.why or "ended by the user."
        self._journal.event({"kind": "end", "text": why, "samples": known.count})

    def _opened(self, known: Round) -> Journal:
        if self._journal is None:
            stream = known.stream
            source = stream.stated.file.model_dump(mode="json", exclude_none=True)
            source |= {"format": "ulna-source/1", "url": stream.stated.url.text}
            self._journal = Journal.create(self._path, stream.source.hello, source=source)
        return self._journal

    def __enter__(self) -> Recording:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._journal is not None:
            self._journal.close()


class HandingOn:
    """A relay that begins with the first samples."""

    def __init__(self, to: str) -> None:
        self._to = to
        self._relay: Relay | None = None

    def take(self, known: Round, frames: Frames) -> None:
        """What came. Raises UlnaInputError where the other side is not there, or gone."""
        from ulna.live.source import SourceEnded

        if not len(frames.samples):
            return
        if self._relay is None:
            self._relay = Relay(self._to, known.stream.source.hello)
        try:
            self._relay.send(frames.samples)
        except SourceEnded as ended:
            raise UlnaInputError(f"{ended} {known.count} samples were read. Begin again when it is there.") from None

    def __enter__(self) -> HandingOn:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._relay is not None:
            self._relay.close()


def write_csv(file: Path, out: Path, force: bool) -> int:
    """All samples of a recording as CSV, with all their digits; how many. Raises UlnaInputError."""
    from ulna.formats.output import new_file, refuse_inputs
    from ulna.live.registry import opened
    from ulna.live.source import SourceEnded

    refuse_inputs([out], [file])
    count = 0
    with opened(f"file:{quote(str(file))}?speed=max") as source, new_file(out, force) as staged:
        with staged.open("w", encoding="utf-8") as stream, suppress(SourceEnded):
            while True:
                samples = source.read(1.0)
                names, rows = _rows(source.hello.channels, samples)
                if not count:
                    stream.write(",".join(names) + "\n")
                stream.writelines(",".join(map(repr, row)) + "\n" for row in rows)
                count += len(samples)
        if not count:
            raise UlnaInputError(f"{file}: no sample in it; expected a recording of some. Record it again.")
    return count


def _rows(channels: Sequence[str], samples: Samples) -> tuple[list[str], Iterator[tuple[float, ...]]]:
    """Names of the columns, and rows."""
    columns = {"t_host_s": samples.t_host_s.tolist()}
    if samples.t_device_s is not None:
        columns["t_device_s"] = samples.t_device_s.tolist()
    columns |= dict(zip(channels, samples.raw.T.tolist(), strict=True))
    if samples.button is not None:
        columns["button"] = samples.button.astype(int).tolist()
    return list(columns), zip(*columns.values(), strict=True)

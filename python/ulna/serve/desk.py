"""The desk: files of the bench folder by the hash of what is in them. No path of a client is ever opened."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from datetime import UTC, datetime
from hashlib import sha256
from pathlib import Path

from ulna.formats.output import write_file
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.serve.contract.files import FileInfo, FileKind
from ulna.serve.contract.model import shortened
from ulna.serve.problems import NotThereError
from ulna.serve.what import what_is

MOST_BYTES = 256 << 20
LONGEST = 120
_LOOKED = {".toml", ".json"}
"""Of a session's folder: its other files are asked for through these."""
_MADE = {".toml", ".json", ".html", ".pdf", ".xml", ".csv"}
"""Of a job's."""


@dataclass(frozen=True)
class _Kept:
    path: Path
    info: FileInfo


class Desk:
    """Files that were brought, and those that sessions left.

    folder: what is brought goes to FOLDER/SHA-256/NAME. sessions, jobs: a folder each, looked through for what they
    left.
    """

    def __init__(self, folder: Path, sessions: Path, jobs: Path) -> None:
        self._folder = folder
        self._lock = threading.Lock()
        self._kept: dict[str, _Kept] = {}
        for path in sorted(folder.glob("*/*")):
            if path.is_file():
                self._keep(path)
        for place, looked in ((sessions, _LOOKED), (jobs, _MADE)):
            for path in sorted(place.glob("*/**/*")):
                if path.suffix.lower() in looked and path.is_file() and not path.name.startswith("."):
                    self._keep(path)

    def put(self, name: str, content: bytes) -> FileInfo:
        """A file that was brought; the same content is there once. Raises UlnaInputError."""
        if len(content) > MOST_BYTES:
            raise UlnaInputError(f"{name[:80]}: {len(content)} bytes; expected {MOST_BYTES} at most. Cut it.")
        digest = sha256(content).hexdigest()
        with self._lock:
            known = self._kept.get(digest)
        if known is not None and known.path.exists():
            return known.info
        folder = self._folder / digest
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / plain_name(name)
        write_file(path, content, force=True)
        return self._keep(path)

    def take(self, path: Path) -> FileInfo:
        """A file of a session's folder, as it is now. Raises UlnaInputError where it is not there."""
        if not path.is_file():
            raise UlnaInputError(
                worded("{file}: it is not there; expected a file that was just written. Look for it.", file=path.name)
            )
        return self._keep(path)

    def path(self, digest: str) -> Path:
        """Where a file is. Raises NotThereError, also where somebody changed it meanwhile."""
        with self._lock:
            kept = self._kept.get(digest)
        if kept is None or not kept.path.is_file():
            raise NotThereError(worded("file {hash}…: it is not on this desk. Bring it once more.", hash=digest[:12]))
        if kept.info.size != kept.path.stat().st_size or _digest(kept.path) != digest:
            raise NotThereError(
                worded("{file}: it was changed since it came. Bring it once more.", file=kept.info.name)
            )
        return kept.path

    def brought(self, path: Path) -> bool:
        """Whether somebody brought it; else this program wrote it."""
        return self._folder in path.parents

    def has(self, digest: str) -> bool:
        """Whether it is here; what is in it is not looked at."""
        with self._lock:
            kept = self._kept.get(digest)
        return kept is not None and kept.path.is_file()

    def info(self, digest: str) -> FileInfo:
        """What is known of it. Raises NotThereError."""
        self.path(digest)
        with self._lock:
            return self._kept[digest].info

    def all(self, *kinds: FileKind) -> list[FileInfo]:
        """The newest first; kinds: only those."""
        with self._lock:
            found = [kept.info for kept in self._kept.values() if not kinds or kept.info.kind in kinds]
        return sorted(found, key=lambda info: info.at, reverse=True)

    def _keep(self, path: Path) -> FileInfo:
        digest, stat = _digest(path), path.stat()
        kind, what = what_is(path)
        at = datetime.fromtimestamp(stat.st_mtime, UTC).isoformat(timespec="seconds")
        info = FileInfo(sha256=digest, name=path.name, size=stat.st_size, kind=kind, what=shortened(what), at=at)
        with self._lock:
            self._kept.setdefault(digest, _Kept(path, info))
            if not self._kept[digest].path.exists():
                self._kept[digest] = _Kept(path, info)
            return self._kept[digest].info


def plain_name(name: str) -> str:
    """A file's name and nothing else: no folder, no control characters, not hidden, not too long."""
    last = name.replace("\\", "/").rsplit("/", 1)[-1]
    kept = "".join(c if c.isprintable() else "_" for c in last).lstrip(". ").rstrip()
    stem, dot, suffix = kept.rpartition(".")
    while len(kept.encode()) > LONGEST:
        stem = stem[:-1]
        kept = f"{stem}{dot}{suffix}" if stem else kept[: LONGEST // 4]
    return kept or "file"


def _digest(path: Path) -> str:
    found = sha256()
    with path.open("rb") as stream:
        while piece := stream.read(1 << 20):
            found.update(piece)
    return found.hexdigest()

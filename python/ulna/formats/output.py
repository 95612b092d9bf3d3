"""Writing results whole or not at all: what is there after a crash is what was there before."""

from __future__ import annotations

import errno
import os
import re
import secrets
import shutil
import threading
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from ulna.ground.errors import UlnaInputError

#: staging places of this process: whoever must end it at once takes them away first
UNDER_WAY: set[Path] = set()

#: no space, too large a file, quota: only writing fails so
_NO_ROOM = (errno.ENOSPC, errno.EFBIG, errno.EDQUOT)

#: held while results move from staging to their places
MOVING = threading.Lock()


def check_output(folder: Path, names: Sequence[str], force: bool = False) -> None:
    """Whether `names` may be written into `folder`, asked before the long work. Raises UlnaInputError.

    Names must stay in the folder; files that exist are refused without `force`.
    """
    for name in names:
        if Path(name).name != name or name in ("", ".", ".."):
            raise UlnaInputError(f"{folder}: the result name {name!r} leaves the folder; expected a plain file name.")
    if folder.exists() and not folder.is_dir():
        raise UlnaInputError(f"{folder}: this is a file; expected an output folder. Name another folder with -o.")
    for name in names:
        if (folder / name).is_dir():
            raise UlnaInputError(f"{folder / name}: a folder stands where a result goes. Name another folder with -o.")
        if (folder / name).exists() and not force:
            raise UlnaInputError(
                f"{folder / name}: exists already and is not overwritten. Name another folder with -o, or give --force."
            )


def refuse_inputs(targets: Iterable[Path], inputs: Iterable[Path]) -> None:
    """No output may take the place of a file that this run reads, not even where overwriting was allowed: its meaning,
    or the readings themselves, would be lost. The same file by another name counts. Raises UlnaInputError."""
    known = list(inputs)
    for target in targets:
        for source in known:
            try:
                same = target.samefile(source)
            except (OSError, ValueError):
                continue  # one of them is not there: nothing to lose
            if same:
                raise UlnaInputError(
                    f"{target}: is an input of this run and is never overwritten, also with --force. Name another "
                    "place with -o."
                )


@contextmanager
def output_folder(
    folder: str | Path, names: Sequence[str], force: bool = False, instead_of: Sequence[str] = ()
) -> Iterator[Path]:
    """A staging folder to write `names` into; they appear in `folder` together when the block ends without an error.

    A folder that exists keeps its other files, but none of `instead_of`: what an earlier run wrote where this one
    writes something else, which needs `force` too. Raises UlnaInputError as `check_output`, or where it cannot be
    written.
    """
    folder = Path(folder)
    check_output(folder, [*names, *instead_of], force)
    staging = _staging(folder, folder.name)
    try:
        try:
            folder.parent.mkdir(parents=True, exist_ok=True)
            staging.mkdir(mode=0o700)
        except OSError as error:
            raise _unwritable(folder, error) from None
        try:
            yield staging
        except OSError as error:  # what is done here is writing
            raise _unwritable(folder, error) from None
        absent = [name for name in names if not (staging / name).is_file()]
        if absent:
            raise RuntimeError(f"not written: {', '.join(absent)}")  # a mistake of ours, not of the user
        try:
            with MOVING:
                _move_all(staging, folder, names, instead_of)
        except OSError as error:
            raise _unwritable(folder, error) from None
    finally:
        shutil.rmtree(staging, ignore_errors=True)
        UNDER_WAY.discard(staging)


def _move_all(staging: Path, folder: Path, names: Sequence[str], instead_of: Sequence[str]) -> None:
    if not folder.exists():
        staging.chmod(0o777 & ~_umask())  # a temporary folder is private; a result is as public as its maker's others
        staging.replace(folder)
        return
    kept = staging / ".before"
    kept.mkdir()
    moved: list[str] = []
    try:
        for name in [*names, *instead_of]:
            if (folder / name).exists():
                (folder / name).replace(kept / name)
            moved.append(name)
            if name in names:
                (staging / name).replace(folder / name)
    except BaseException:
        for name in moved:  # back to what was there before
            (folder / name).unlink(missing_ok=True)
            if (kept / name).exists():
                (kept / name).replace(folder / name)
        raise


def write_file(path: str | Path, content: str | bytes, force: bool = False) -> None:
    """Write one file, whole or not at all. Raises UlnaInputError where it exists and `force` is not given."""
    path = Path(path)
    with new_file(path, force=force) as staged:
        staged.write_bytes(content if isinstance(content, bytes) else content.encode())


@contextmanager
def new_file(path: str | Path, force: bool = False) -> Iterator[Path]:
    """A staging path to write one file to, of any size; it appears at `path` when the block ends without an error."""
    path = Path(path)
    if path.is_dir():
        raise UlnaInputError(f"{path}: this is a folder; expected a file name to write to.")
    if path.exists() and not force:
        raise UlnaInputError(f"{path}: exists already and is not overwritten. Name another file, or give --force.")
    staged = _staging(path, path.stem, path.suffix)
    try:
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            staged.touch(mode=0o600, exist_ok=False)
        except OSError as error:
            raise _unwritable(path, error) from None
        try:
            yield staged
        except OSError as error:
            if not _no_room(error):
                raise  # the readings may be what failed
            raise _unwritable(path, error) from None
        with MOVING:
            staged.chmod(0o666 & ~_umask())
            staged.replace(path)
    finally:
        with suppress(OSError):
            staged.unlink()
        UNDER_WAY.discard(staged)


def _staging(target: Path, stem: str, suffix: str = "") -> Path:
    """A name beside the target that nobody else has. Known as under way before anything is made there, so that an
    interrupt at any moment leaves nothing behind."""
    staging = target.parent / f".{stem}-{secrets.token_hex(6)}.partial{suffix}"
    UNDER_WAY.add(staging)
    return staging


def _no_room(error: OSError) -> bool:
    number = re.search(r"\(os error (\d+)\)", str(error))  # as Polars says it, without errno
    return (int(number[1]) if number else error.errno) in _NO_ROOM


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _unwritable(path: Path, error: OSError) -> UlnaInputError:
    reason = re.sub(r" \(os error \d+\)", "", error.strerror or str(error))
    return UlnaInputError(f"{path}: cannot be written ({reason}). Choose a place with room where you may write.")

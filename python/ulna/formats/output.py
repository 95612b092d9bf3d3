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

from ulna.formats.arriving import arrive
from ulna.formats.moving import alone, flush, place_instead, place_new, umask
from ulna.formats.names import check_path
from ulna.ground.errors import UlnaInputError

#: staging places of this process: whoever must end it at once takes them away first
UNDER_WAY: set[Path] = set()

#: folders of this process that were made for results under way
MADE: list[Path] = []

#: no space, too large a file, quota: only writing fails so
_NO_ROOM = (errno.ENOSPC, errno.EFBIG, errno.EDQUOT)

#: results of this process that are in their places
FINISHED: list[Path] = []

#: held while a place is made or taken away in which a result will be staged
_PARENTS = threading.Lock()

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
    check_path(folder)
    check_output(folder, [*names, *instead_of], force)
    place = folder.resolve() if folder.is_symlink() else folder
    staging, made = None, list[Path]()
    try:
        try:
            with _PARENTS:
                made += missing(place.parent)
                place.parent.mkdir(parents=True, exist_ok=True)
                staging = _staged_folder(place)
        except OSError as error:
            raise unwritable(folder, error) from None
        try:
            yield staging
        except OSError as error:  # what is done here is writing
            raise unwritable(folder, error) from None
        absent = [name for name in names if not (staging / name).is_file()]
        if absent:
            raise RuntimeError(f"not written: {', '.join(absent)}")  # a mistake of ours, not of the user
        try:
            for name in names:
                flush(staging / name)
            with MOVING, alone(place.parent):
                arrive(staging, place, names, instead_of, force)
                FINISHED.append(folder)
        except FileExistsError as error:
            raise _appeared(Path(error.filename or folder)) from None
        except OSError as error:
            raise unwritable(folder, error) from None
    finally:
        if staging is not None:
            shutil.rmtree(staging, ignore_errors=True)
            UNDER_WAY.discard(staging)
        leave(made)


def _staged_folder(place: Path) -> Path:
    """Beside the folder; within it where that is another disk, or nobody may write beside it. Raises OSError."""
    staging = _staging(place.parent, place.name)
    try:
        if place.is_dir() and os.path.ismount(place):
            raise OSError(errno.EXDEV, os.strerror(errno.EXDEV))
        staging.mkdir(mode=0o700)
        return staging
    except OSError as error:
        UNDER_WAY.discard(staging)
        if not place.is_dir() or _no_room(error):
            raise
    staging = _staging(place, place.name)
    staging.mkdir(mode=0o700)
    return staging


def write_file(path: str | Path, content: str | bytes, force: bool = False, instead_of: str | None = None) -> None:
    """Write one file, whole or not at all. Raises UlnaInputError where it exists and `force` is not given."""
    path = Path(path)
    with new_file(path, force, instead_of) as staged:
        staged.write_bytes(content if isinstance(content, bytes) else content.encode())


@contextmanager
def new_file(path: str | Path, force: bool = False, instead_of: str | None = None) -> Iterator[Path]:
    """A staging path to write one file to, of any size; it appears at `path` when the block ends without an error.

    instead_of: the SHA-256 of what stood there when the work began, which may be replaced also without `force`.
    """
    path = Path(path)
    check_path(path)
    if path.is_dir():
        raise UlnaInputError(f"{path}: this is a folder; expected a file name to write to.")
    if path.exists() and not force and instead_of is None:
        raise UlnaInputError(f"{path}: exists already and is not overwritten. Name another file, or give --force.")
    staged, made = _staging(path.parent, path.stem, path.suffix), list[Path]()
    try:
        try:
            with _PARENTS:
                made += missing(path.parent)
                path.parent.mkdir(parents=True, exist_ok=True)
                staged.touch(mode=0o600, exist_ok=False)
        except OSError as error:
            raise unwritable(path, error) from None
        try:
            yield staged
        except OSError as error:
            if not _no_room(error):
                raise  # the readings may be what failed
            raise unwritable(path, error) from None
        try:
            with MOVING, alone(path.parent):
                staged.chmod(0o666 & ~umask())
                flush(staged)
                if force:
                    staged.replace(path)
                elif instead_of is not None:
                    place_instead(staged, path, instead_of)
                else:
                    place_new(staged, path)
                FINISHED.append(path)
        except FileExistsError:
            raise _appeared(path) from None
        except OSError as error:
            raise unwritable(path, error) from None
    finally:
        with suppress(OSError):
            staged.unlink()
        UNDER_WAY.discard(staged)
        leave(made)


def missing(folder: Path) -> list[Path]:
    """What is to be made so that a folder is there, the innermost first; known so that an interrupt leaves none."""
    made = [each for each in (folder, *folder.parents) if not each.exists()]
    MADE.extend(made)
    return made


def leave(made: list[Path]) -> None:
    """Takes folders away that were made for a result, where none came into them."""
    with _PARENTS:
        for folder in made:
            with suppress(OSError):
                folder.rmdir()
            MADE.remove(folder)


def _appeared(path: Path) -> UlnaInputError:
    return UlnaInputError(
        f"{path}: exists already and is not overwritten: another program wrote it meanwhile. Name another place with "
        "-o, or give --force."
    )


def _staging(folder: Path, stem: str, suffix: str = "") -> Path:
    """A name in a folder that nobody else has. Known as under way before anything is made there, so that an
    interrupt at any moment leaves nothing behind."""
    # absolute: Polars takes a name such as file:x for an address
    staging = folder.absolute() / f".{stem}-{secrets.token_hex(6)}.partial{suffix}"
    UNDER_WAY.add(staging)
    return staging


def _number(error: OSError) -> int | None:
    """Its errno; Polars and pyarrow have it in their words alone."""
    told = re.search(r"\(os error (\d+)\)|\[errno (\d+)\]", str(error))
    return int(told[1] or told[2]) if told else error.errno


def _no_room(error: OSError) -> bool:
    return _number(error) in _NO_ROOM


def unwritable(path: Path, error: OSError) -> UlnaInputError:
    number = _number(error)
    reason = str(error) if number is None else os.strerror(number)
    return UlnaInputError(f"{path}: cannot be written ({reason}). Choose a place with room where you may write.")

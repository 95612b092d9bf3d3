"""A folder of results comes to its place as a whole: whoever is killed at any moment leaves the old one or the new.

The new folder gets what the old one has besides, and both change places at once. Where they cannot (a folder that has
folders in it, the folder that somebody works in, a disk that has no such step), files go one by one, each whole, and
back again where one of them fails.
"""

from __future__ import annotations

import errno
import os
import shutil
import stat
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from ulna.formats.moving import flush, place_new, place_new_folder, swap, umask


def arrive(staging: Path, folder: Path, names: Sequence[str], instead_of: Sequence[str], force: bool) -> None:
    """The files `names` of `staging` into `folder`, where none of `instead_of` stays.

    Raises FileExistsError where one of them is there and `force` is not given; OSError. Nothing is changed then.
    """
    if not folder.exists():
        staging.chmod(0o777 & ~umask())  # a temporary folder is private; a result is as public as its maker's others
        try:
            place_new_folder(staging, folder)
        except FileExistsError:
            staging.chmod(0o700)
        else:
            flush(folder.parent)
            return
    taken = _taken(folder, [*names, *instead_of])
    if taken is not None and not force:
        raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(folder / taken))
    ours = {*names, *instead_of}
    if not (_may_swap(staging, folder, ours) and _swapped(staging, folder, ours, force)):
        _one_by_one(staging, folder, names, instead_of, force)
    flush(folder)


def _taken(folder: Path, names: Sequence[str]) -> str | None:
    return next((name for name in names if os.path.lexists(folder / name)), None)


def _besides(folder: Path, ours: set[str]) -> list[Path]:
    return [path for path in folder.iterdir() if path.name not in ours]


def _may_swap(staging: Path, folder: Path, ours: set[str]) -> bool:
    """Whether the folder itself may be another one: nobody stands in it, and it holds files alone."""
    if staging.parent == folder or os.path.ismount(folder):
        return False
    with suppress(OSError):
        here = Path.cwd()
        if any(each.samefile(folder) for each in (here, *here.parents)):
            return False
    return all(not path.is_symlink() and path.is_file() for path in _besides(folder, ours))


def _swapped(staging: Path, folder: Path, ours: set[str], force: bool) -> bool:
    """Whether it could be done; where not, everything is as it was. Raises FileExistsError, OSError."""
    try:
        others = [path.name for path in _besides(folder, ours)]
        for name in others:
            os.link(folder / name, staging / name, follow_symlinks=False)
        _as_its_owner_has_it(staging, folder)
        done = swap(staging, folder)
    except OSError:
        done = False
    if not done:
        for name in others:
            (staging / name).unlink(missing_ok=True)
        staging.chmod(0o700)
        return False
    staging.chmod(stat.S_IMODE(staging.stat().st_mode) | stat.S_IRWXU)
    late = None if force else _taken(staging, sorted(ours))
    if late is not None:
        swap(staging, folder)
        raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(folder / late))
    for path in _besides(staging, ours):  # what somebody put there meanwhile, or wrote anew
        here = folder / path.name
        if not os.path.lexists(here) or not os.path.samestat(path.lstat(), here.lstat()):
            path.replace(here)
    return True


def _as_its_owner_has_it(staging: Path, folder: Path) -> None:
    """Raises OSError where a folder of ours cannot be like it."""
    there, here = folder.stat(), staging.stat()
    if (there.st_uid, there.st_gid) != (here.st_uid, here.st_gid):
        os.chown(staging, there.st_uid, there.st_gid)
    shutil.copystat(folder, staging)


def _one_by_one(staging: Path, folder: Path, names: Sequence[str], instead_of: Sequence[str], force: bool) -> None:
    kept = staging / ".before"
    kept.mkdir()
    moved: list[str] = []
    try:
        for name in [*names, *instead_of]:
            if force and os.path.lexists(folder / name):
                _keep(folder / name, kept / name)
            moved.append(name)
            if name not in names:
                (folder / name).unlink(missing_ok=True)
            elif force:
                (staging / name).replace(folder / name)
            else:
                place_new(staging / name, folder / name)
    except BaseException as error:
        new = moved[:-1] if isinstance(error, FileExistsError) else moved
        for name in new:  # back to what was there before
            if os.path.lexists(kept / name):
                (kept / name).replace(folder / name)
            else:
                (folder / name).unlink(missing_ok=True)
        raise


def _keep(path: Path, kept: Path) -> None:
    """The same file by another name, or a copy where the disk has no links."""
    try:
        os.link(path, kept, follow_symlinks=False)
    except OSError:
        shutil.copy2(path, kept, follow_symlinks=False)

"""Moving what is written to its place in one step that no kill can halve, and over nothing that is another's."""

from __future__ import annotations

import ctypes
import errno
import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

from ulna.formats.toml import sha256

_AT_FDCWD = -100
_NO_REPLACE, _EXCHANGE = 1, 2
_SWAP_OF_DARWIN, _EXCL_OF_DARWIN = 2, 4
_NOT_HERE = (errno.ENOSYS, errno.EINVAL, errno.ENOTSUP, errno.EOPNOTSUPP)
"""What a system or a file system answers that cannot do it."""

PATIENCE_S = 5.0
"""Of one who waits for another to have moved its files: it takes milliseconds."""


def place_new(staged: Path, target: Path) -> None:
    """A file to where none is. Raises FileExistsError where one has appeared; OSError."""
    try:
        os.link(staged, target)
    except FileExistsError:
        raise
    except OSError as error:
        if error.errno not in (*_NOT_HERE, errno.EPERM, errno.EMLINK, errno.EXDEV):
            raise
        # a disk without links: the name is taken first, so that nobody else can
        os.close(os.open(target, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600))
        staged.replace(target)
        return
    staged.unlink()


def place_instead(staged: Path, target: Path, known: str) -> None:
    """A file to where one of this SHA-256 is, and no other one: what somebody put there since is not lost. Raises
    FileExistsError; OSError."""
    try:
        swapped = swap(staged, target)
    except FileNotFoundError:
        swapped = False
    if not swapped and not os.path.lexists(target):  # taken away meanwhile
        place_new(staged, target)
        return
    there = staged if swapped else target
    if there.is_symlink() or not there.is_file() or sha256(there.read_bytes()) != known:
        if swapped:
            swap(staged, target)
        raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(target))
    staged.unlink() if swapped else staged.replace(target)


@contextmanager
def alone(folder: Path) -> Iterator[None]:
    """While files move into a folder, no other process of ours moves any there.

    Each step is safe by itself; of several, two who overwrite one result would leave some files of each. Where a disk
    has no locks, or somebody else keeps this one, nobody waits for ever.
    """
    handle = _locked(folder)
    try:
        yield
    finally:
        if handle is not None:
            os.close(handle)


def _locked(folder: Path) -> int | None:
    """A handle to be closed; None where there is no lock."""
    if sys.platform == "win32":
        return None
    import fcntl

    try:
        handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    except OSError:
        return None
    until = time.monotonic() + PATIENCE_S
    while time.monotonic() < until:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            time.sleep(0.001)
        except OSError:
            break
        else:
            return handle
    with suppress(OSError):
        os.close(handle)
    return None


def place_new_folder(staged: Path, target: Path) -> None:
    """A folder to where nothing is, or an empty folder. Raises FileExistsError where there is something; OSError."""
    if not _renamed(staged, target, _NO_REPLACE, _EXCL_OF_DARWIN):
        if target.exists() and (not target.is_dir() or any(target.iterdir())):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(target))
        staged.replace(target)


def swap(one: Path, other: Path) -> bool:
    """Two files or folders change places, at once; False where the system cannot. Raises OSError."""
    return _renamed(one, other, _EXCHANGE, _SWAP_OF_DARWIN)


def flush(path: Path) -> None:
    """To the disk itself, so that a name that survives a power cut has its content."""
    try:
        handle = os.open(path, os.O_RDONLY)
    except OSError:
        return  # of a folder, where the system does not open them
    try:
        os.fsync(handle)
    except OSError:
        pass
    finally:
        os.close(handle)


def umask() -> int:
    """Of this process."""
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _renamed(one: Path, other: Path, of_linux: int, of_darwin: int) -> bool:
    call = _call()
    if call is None:
        return False
    name, function = call
    a, b = os.fsencode(one), os.fsencode(other)
    linux = name == "renameat2"
    if not (function(_AT_FDCWD, a, _AT_FDCWD, b, of_linux) if linux else function(a, b, of_darwin)):
        return True
    number = ctypes.get_errno()
    if number in _NOT_HERE:
        return False
    raise OSError(number, os.strerror(number), str(other))


@cache
def _call() -> tuple[str, Any] | None:
    """The system's own rename that swaps and refuses."""
    name = {"linux": "renameat2", "darwin": "renamex_np"}.get(sys.platform)
    if name is None:
        return None
    try:
        function = getattr(ctypes.CDLL(None, use_errno=True), name)
    except (OSError, AttributeError):
        return None
    function.restype = ctypes.c_int
    whole, text, flags = ctypes.c_int, ctypes.c_char_p, ctypes.c_uint
    function.argtypes = [whole, text, whole, text, flags] if name == "renameat2" else [text, text, flags]
    return name, function

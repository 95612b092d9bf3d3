"""Moving what is written to its place in one step that no kill can halve, and over nothing that is another's."""

from __future__ import annotations

import ctypes
import errno
import os
import sys
from functools import cache
from pathlib import Path
from typing import Any

_AT_FDCWD = -100
_NO_REPLACE, _EXCHANGE = 1, 2
_SWAP_OF_DARWIN, _EXCL_OF_DARWIN = 2, 4
_NOT_HERE = (errno.ENOSYS, errno.EINVAL, errno.ENOTSUP, errno.EOPNOTSUPP)
"""What a system or a file system answers that cannot do it."""


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

"""Writing to disk so that a crash, at whatever moment, leaves either the whole file or none."""

import errno
import fcntl
import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from cobot_lfd.errors import DataError

_REMEDIES = {
    errno.ENOSPC: "Free some space, then try again; what was saved before is safe.",
    errno.EDQUOT: "Free some space, then try again; what was saved before is safe.",
    errno.EFBIG: "Choose a disk that takes larger files; what was saved before is safe.",
    errno.EROFS: "Choose a folder that you may write to.",
    errno.EACCES: "Choose a folder for which you have the permission.",
    errno.EPERM: "Choose a folder for which you have the permission.",
    errno.ENOENT: "Check the name.",
    errno.EISDIR: "Name a file, not a folder.",
    errno.ENOTDIR: "Name a folder, not a file.",
    errno.EEXIST: "Name a folder, not a file.",
}


@contextmanager
def told(path: Path, doing: str) -> Iterator[None]:
    """Turn an ``OSError`` inside the block into a ``DataError`` of one line.

    Args:
        path: The file or folder that is worked on.
        doing: What is tried, such as "write".

    Raises:
        DataError: For every ``OSError`` inside.
    """
    try:
        yield
    except OSError as error:
        reason = error.strerror or str(error)
        remedy = _REMEDIES.get(error.errno or 0, "Check the disk.")
        raise DataError(f"cannot {doing} {path}: {reason}. {remedy}") from error


def require_folder(file: Path) -> None:
    """Refuse a file that cannot be written because there is no such folder, before much work goes into it.

    Raises:
        DataError: If the folder is missing or is a file.
    """
    with told(file, "write"):
        os.stat(file.parent / ".")


@contextmanager
def folder_lock(folder: Path) -> Iterator[None]:
    """Let one process at a time work inside the block; the system gives the lock back when a process dies."""
    descriptor = os.open(folder / ".lock", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def write_temporary(folder: Path, contents: bytes, *, ending: str = ".partial") -> Path:
    """Write a new hidden file whose contents are on the disk when this returns.

    Args:
        folder: The folder in which the file will get its name.
        contents: All that is to be in it.
        ending: Ending of the hidden name, by which left-over files can be told apart.

    Raises:
        OSError: If the disk is full or the folder cannot be written; no file is left then.
    """
    path = folder / f".{secrets.token_hex(8)}{ending}"
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(contents)
            file.flush()
            os.fsync(file.fileno())
    except BaseException:
        with suppress(OSError):
            path.unlink()
        raise
    return path


def move_into_place(temporary: Path, path: Path) -> None:
    """Give a written file its name, for good: the name is on the disk when this returns."""
    os.replace(temporary, path)
    sync_folder(path.parent)


def write_file(path: Path, contents: bytes) -> None:
    """Write a file whole or not at all, in place of one that may be there.

    Raises:
        DataError: If the disk is full or the folder is missing or cannot be written.
    """
    with told(path, "write"):
        move_into_place(write_temporary(path.parent, contents), path)


def sync_folder(folder: Path) -> None:
    """Have the names in a folder written to the disk."""
    _sync(folder, os.O_RDONLY | os.O_DIRECTORY)


def sync_file(file: Path) -> None:
    """Have the contents of a file, which something else wrote, written to the disk."""
    _sync(file, os.O_RDONLY)


def _sync(path: Path, flags: int) -> None:
    descriptor = os.open(path, flags | os.O_CLOEXEC)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)

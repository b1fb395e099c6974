"""Results that are on disk whole or not at all. All writing of this package goes through write_file."""
from __future__ import annotations

import errno
import os
import pathlib
import stat
import sys
import uuid

_MOST_LINKS = 40  # as Linux


def write_file(path: str | os.PathLike[str], content: bytes) -> None:
    """Writes a file beside its place, then puts it there: nobody reads half of it.

    A symbolic link stays; its target is replaced. A file that is replaced hands on its mode; one that may not
    be written is not replaced. Devices, pipes and open files (/dev/stdout) are written directly.
    """
    if os.fspath(path) in ("/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"):
        if sys.stdout is not None:
            sys.stdout.flush()
        with open(1, "wb", closefd=False) as standard:
            standard.write(content)
        return
    existing = _stat(path)
    target = _target(pathlib.Path(path))
    if existing is not None and (target is None or not stat.S_ISREG(existing.st_mode)):
        with open(os.open(path, os.O_WRONLY | os.O_APPEND), "wb") as special:
            special.write(content)
    elif target is None:
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP), os.fspath(path))
    elif existing is not None and not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), os.fspath(path))
    else:
        _put(target, content, existing)


def _stat(path: str | os.PathLike[str]) -> os.stat_result | None:
    """What a path leads to; None if nothing is there."""
    try:
        return os.stat(path)
    except FileNotFoundError:
        return None


def _target(path: pathlib.Path) -> pathlib.Path | None:
    """The file that a path leads to, through symbolic links; it need not exist. None if the links are a
    circle, and for an open file of a process, which has no place of its own."""
    for _ in range(_MOST_LINKS):
        if pathlib.Path(os.path.realpath(path.parent)).is_relative_to("/proc"):
            return None
        if not path.is_symlink():
            return path
        path = path.parent / os.readlink(path)
    return None


def _put(target: pathlib.Path, content: bytes, existing: os.stat_result | None) -> None:
    temporary = target.with_name(f".patchmill-{uuid.uuid4().hex}")
    try:
        with open(os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666), "wb") as file:
            file.write(content)
            file.flush()
            if existing is not None:
                _take_mode(file.fileno(), existing)
            os.fsync(file.fileno())
        os.replace(temporary, target)
    except OSError as error:
        raise OSError(error.errno, error.strerror, os.fspath(target)) from None
    finally:
        temporary.unlink(missing_ok=True)


def _take_mode(file: int, existing: os.stat_result) -> None:
    """Gives an open file the mode of another one, and the owner as far as this process may."""
    try:
        os.fchown(file, existing.st_uid, existing.st_gid)
    except PermissionError:
        pass
    os.fchmod(file, stat.S_IMODE(existing.st_mode) & 0o777)

"""Writes results to the files that the properties of an object name."""
from __future__ import annotations

import pathlib

from patchmill._file import write_file

from .problem import Problem

# Every file that this add-on writes has one of these in its first 64 kB, in small letters.
MARKS = (b"patchmill", b'"outcome": "outcome_', b"iso-10303-21")


def write(file: pathlib.Path, content: bytes, what: str) -> None:
    """Writes a result whole or not at all. A file that is no earlier result stays as it is, because the name
    comes from the document, and the document may be somebody else's."""
    try:
        if file.is_file() and not is_result(file):
            raise Problem(f"{what} '{file}' is there and is no result of Patchmill, so it was not replaced: choose another name.")
        if file.exists() and not file.is_file():
            raise Problem(f"{what} '{file}' is a folder, a device or a pipe, so nothing was written: choose another name.")
        write_file(file, content)
    except OSError as error:
        raise Problem(f"{what} '{file}' cannot be written ({error.strerror}): choose a folder that is there and may be written "
                      "to.") from None


def is_result(file: pathlib.Path) -> bool:
    """Whether this add-on may have written the file. An empty one counts, too."""
    with file.open("rb") as stream:
        beginning = stream.read(1 << 16).lower()
    return not beginning or any(mark in beginning for mark in MARKS)

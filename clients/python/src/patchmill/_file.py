"""Files that are there whole or not at all."""
from __future__ import annotations

import os
import pathlib
import uuid


def write_file(path: str | os.PathLike[str], content: bytes) -> None:
    """Writes a file beside its place, then puts it there: nobody reads half of it."""
    target = pathlib.Path(path)
    temporary = target.with_name(f".{target.name}.{uuid.uuid4().hex}")
    try:
        temporary.write_bytes(content)
        os.replace(temporary, target)
    finally:
        temporary.unlink(missing_ok=True)

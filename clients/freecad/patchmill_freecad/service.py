"""The server that the add-on calls, and the progress of its calls."""
from __future__ import annotations

import atexit
import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import FreeCAD as App
import patchmill as pm

from . import FOLDER
from .problem import Cancelled

PREFERENCES = "User parameter:BaseApp/Preferences/Mod/Patchmill"
STEPS = 1000

_clients: dict[tuple[str, str, str], pm.Client] = {}


def _program(preferred: str) -> str | None:
    """The patchmilld to start: that of the preferences, of the environment, of the add-on, or of the path."""
    beside = FOLDER.parent / "bin" / "patchmilld"
    if preferred:
        return preferred
    if "PATCHMILLD" in os.environ or not os.access(beside, os.X_OK):
        return None
    return str(beside)


def client() -> pm.Client:
    """The client of the server that the preferences name; it starts one of its own if they name none."""
    preferences = App.ParamGet(PREFERENCES)
    address, program, authority = (preferences.GetString(name).strip() for name in ("Server", "Program", "Authority"))
    key = (address, program, authority)
    if key not in _clients:
        if address:
            _clients[key] = pm.Client(address, tls=pm.Tls(ca=authority) if authority else None)
        else:
            _clients[key] = pm.Client(program=_program(program))
    return _clients[key]


@atexit.register
def close() -> None:
    """Ends the servers that were started."""
    while _clients:
        _clients.popitem()[1].close()


class Bar:
    """FreeCAD's progress bar. Esc ends the call: the next progress raises Cancelled."""

    def __init__(self, indicator: Any) -> None:
        self._indicator = indicator
        self._step = 0
        self._stage = ""

    def __call__(self, progress: pm.Progress) -> None:
        if progress.stage != self._stage:
            self._stage, self._step = progress.stage, 0
            self._indicator.stop()
            self._indicator.start(f"Patchmill: {progress.stage}...", STEPS)
        # One step each time at least: only a step looks whether Esc was pressed.
        target = max(self._step + 1, int(progress.fraction * STEPS))
        while self._step < min(target, STEPS):
            self._step += 1
            self._next()

    def _next(self) -> None:
        try:
            self._indicator.next(True)
        except (App.Base.FreeCADAbort, Exception) as stop:
            raise Cancelled("The job was cancelled. Nothing of it is valid.") from stop


@contextmanager
def progress_bar(text: str) -> Iterator[Bar]:
    indicator = App.Base.ProgressIndicator()
    indicator.start(f"Patchmill: {text}...", STEPS)
    try:
        yield Bar(indicator)
    finally:
        indicator.stop()

"""The server that the add-on calls."""
from __future__ import annotations

import atexit
import os

import FreeCAD as App
import patchmill as pm

from . import FOLDER

PREFERENCES = "User parameter:BaseApp/Preferences/Mod/Patchmill"

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

"""What the tests share: the programs, the models, servers, and one job that is quick."""
import atexit
import contextlib
import json
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator

import numpy as np
import patchmill as pm

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ["PATCHMILL_BIN"])
HILLS = ROOT / "examples/two_hills.bv"
NO_RETRY = pm.Retry(attempts=1)
# For all tests that do not mind who else uses the server. It starts at the first call.
CLIENT = pm.Client(retry=NO_RETRY)
atexit.register(CLIENT.close)

DOME = np.array([[[0, 0, 0], [0, 20, 6], [0, 40, 6], [0, 60, 0]],
                 [[20, 0, 6], [20, 20, 30], [20, 40, 30], [20, 60, 6]],
                 [[40, 0, 6], [40, 20, 30], [40, 40, 30], [40, 60, 6]],
                 [[60, 0, 0], [60, 20, 6], [60, 40, 6], [60, 60, 0]]], dtype=float)
DOME_JSON = json.dumps({"length_unit": "LENGTH_UNIT_MILLIMETER", "patches": [
    {"bezier": {"degree_u": 3, "degree_v": 3, "points": DOME.ravel().tolist()}}]})


def operation(scallop_mm: float = 0.2, tolerance_mm: float = 0.05, tool: pm.Tool | None = None) -> pm.Operation:
    return pm.Operation(tool=tool or pm.ball(6), scallop_mm=scallop_mm, tolerance_mm=tolerance_mm)


def long_operation() -> pm.Operation:
    """A job of the hills that takes minutes."""
    return operation(0.0002, 0.0005)


def command_line(*words: object) -> bytes:
    """The program that the command line writes for a job."""
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder) / "program"
        run = subprocess.run([BIN / "patchmill", "mill", *map(str, words), "-o", program, "--quiet"], capture_output=True, text=True)
        assert run.returncode == 0, run.stderr
        return program.read_bytes()


class Daemon:
    """A running patchmilld."""

    def __init__(self, *flags: str, listen: str = "127.0.0.1:0") -> None:
        self._log = tempfile.NamedTemporaryFile("r")
        with open(self._log.name, "w") as log:
            self.process = subprocess.Popen([BIN / "patchmilld", "--listen", listen, *flags], stderr=log)
        end, found = time.monotonic() + 20, None
        while found is None and time.monotonic() < end:
            time.sleep(0.02)
            found = re.search(r"port (\d+)\n", self.log())
        assert found is not None, self.log()
        self.port = int(found[1])
        self.address = f"127.0.0.1:{self.port}"

    def log(self) -> str:
        return pathlib.Path(self._log.name).read_text()

    def signal(self, number: signal.Signals) -> None:
        self.process.send_signal(number)

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self._log.close()


@contextlib.contextmanager
def daemon(*flags: str) -> Iterator[Daemon]:
    running = Daemon(*flags)
    try:
        yield running
    finally:
        running.close()


def free_port() -> int:
    import socket

    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])

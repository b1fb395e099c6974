"""A server that the client starts for itself: patchmilld, on a socket that only this user can reach."""
from __future__ import annotations

import os
import pathlib
import shutil
import subprocess
import tempfile
import threading
import time
import weakref
from typing import IO

from .errors import StartError

START_SECONDS = 20.0
END_SECONDS = 1.0  # no call runs any more, and the server keeps nothing
LONGEST_SOCKET_PATH = 100  # the system allows 107 bytes

Program = str | os.PathLike[str]


def find_program(program: Program | None) -> str:
    """The patchmilld to start: the one that is named, that of the environment, or the one on the path."""
    name = os.fspath(program) if program is not None else os.environ.get("PATCHMILLD", "patchmilld")
    found = shutil.which(name)
    if found is None:
        raise StartError(f"The server {name} is not there or not executable. Name it by Client(program=...) or by the environment "
                         "variable PATCHMILLD, or give the address of a running server: Client('127.0.0.1:50051').")
    return found


def _guard(process: subprocess.Popen[bytes], folder: str) -> subprocess.Popen[bytes]:
    """A process that ends the server when this one is gone, however it went: its input ends then."""
    return subprocess.Popen(["/bin/sh", "-c", 'read -r _; kill "$0"; rm -rf "$1"', str(process.pid), folder],
                            stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)


def _stop(process: subprocess.Popen[bytes], guard: subprocess.Popen[bytes], folder: str) -> None:
    guard.kill()
    guard.communicate()
    if process.poll() is None:
        process.terminate()
        try:
            process.wait(END_SECONDS)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
    shutil.rmtree(folder, ignore_errors=True)


class OwnServer:
    """A running patchmilld. It ends with close(), or with this process at the latest."""

    def __init__(self, program: Program | None, threads: int) -> None:
        found = find_program(program)
        self.folder = tempfile.mkdtemp(prefix="patchmill-")
        if len(self.folder) + len("/socket") > LONGEST_SOCKET_PATH:
            os.rmdir(self.folder)
            self.folder = tempfile.mkdtemp(prefix="patchmill-", dir="/tmp")
        self.address = f"unix:{self.folder}/socket"
        self._log = pathlib.Path(self.folder) / "log"
        with open(self._log, "wb") as log:
            self.process = self._start([found, "--listen", self.address, "--threads", str(threads), "--max-job-seconds", "86400",
                                        "--max-in-flight-mib", "4096"], log)
        self._end = weakref.finalize(self, _stop, self.process, _guard(self.process, self.folder), self.folder)
        self._wait()

    def _start(self, command: list[str], log: IO[bytes]) -> subprocess.Popen[bytes]:
        # A session of its own: Ctrl-C in a terminal is for Python, which then cancels its calls.
        return subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True)

    def _wait(self) -> None:
        end = time.monotonic() + START_SECONDS
        while "listens on" not in self.log():
            status = self.process.poll()
            if status is not None or time.monotonic() > end:
                what = f"ended with status {status}" if status is not None else f"did not answer within {START_SECONDS:g} s"
                problem = f"patchmilld {what}:\n{self.log().strip()}"
                self.close()
                raise StartError(problem)
            time.sleep(0.01)

    def log(self) -> str:
        """What the server has written so far."""
        return self._log.read_text(errors="replace") if self._log.exists() else ""

    def ended(self) -> str:
        """How the server has ended by itself; empty while it runs."""
        # A process that was just killed takes a moment to be reaped.
        for _ in range(20):
            status = self.process.poll()
            if status is not None:
                by = f"by signal {-status}" if status < 0 else f"with status {status}"
                return f"The server that this client started has ended {by}"
            time.sleep(0.01)
        return ""

    def close(self) -> None:
        self._end()


class LazyServer:
    """Starts the server at the first call."""

    def __init__(self, program: Program | None, threads: int) -> None:
        self._program, self._threads = program, threads
        self._lock = threading.Lock()
        self.running: OwnServer | None = None

    def address(self) -> str:
        with self._lock:
            if self.running is None:
                self.running = OwnServer(self._program, self._threads)
            return self.running.address

    def close(self) -> None:
        with self._lock:
            if self.running is not None:
                self.running.close()
            self.running = None

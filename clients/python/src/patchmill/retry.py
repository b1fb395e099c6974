"""When a call is made again."""
from __future__ import annotations

import random
import time
from dataclasses import dataclass

from .errors import PatchmillError, ServerDrainingError, ServerLostError, ServerUnreachableError, TemporaryError


@dataclass(frozen=True)
class Retry:
    """How often a call is tried while the server is busy, drains, cannot be reached or is lost.

    Every job is without side effects, and an upload or a removal does the same twice, so trying again is
    always safe. All tries of a call have one name in the logs of the servers.

    attempts: largest number of tries; 1: none but the first. Tries at a server that drains do not count.
    first_wait_s: time before the second try. Each further one waits twice as long, all with a random share.
    longest_wait_s: longest time between two tries.
    broken_attempts: largest number of tries of a call that is lost while it runs. Such a call may be the
        reason why its server ended, and would end the next one.
    draining_s: how long a call is tried again while its server drains. 0: such tries count as all others.
    """

    attempts: int = 4
    first_wait_s: float = 0.5
    longest_wait_s: float = 10.0
    broken_attempts: int = 3
    draining_s: float = 60.0


class Tries:
    """The tries of one call, and the error to raise after the last one."""

    LONGEST_WAIT_DRAINING_S = 2.0

    def __init__(self, retry: Retry) -> None:
        self._retry = retry
        self._made, self._waits, self._broken = 1, 0, 0
        self._drains_until: float | None = None
        self._lost: ServerLostError | None = None

    def wait_after(self, error: PatchmillError) -> float | None:
        """Time to wait before the next try, after one that ended with this error. None: there is none."""
        retry = self._retry
        if isinstance(error, ServerLostError):
            self._lost = error
            self._broken += 1
            if not error.may_retry or self._broken >= retry.broken_attempts:
                return None
        elif not isinstance(error, TemporaryError):
            return None
        wait_s = min(retry.longest_wait_s, retry.first_wait_s * 2.0**self._waits) * random.uniform(0.75, 1.25)
        if isinstance(error, ServerDrainingError) and retry.attempts > 1:
            if self._drains_until is None:
                self._drains_until = time.monotonic() + retry.draining_s
            wait_s = min(wait_s, self.LONGEST_WAIT_DRAINING_S)
            if time.monotonic() + wait_s < self._drains_until:
                return wait_s
        if self._made >= retry.attempts:
            return None
        self._made += 1
        self._waits += 1
        return wait_s

    def raised(self, last: PatchmillError) -> PatchmillError:
        """The error of the try that broke, if nobody was reached since; else the last one."""
        return self._lost if self._lost is not None and isinstance(last, ServerUnreachableError) else last


class Deadline:
    """The end of a call with all its tries."""

    def __init__(self, timeout_s: float | None) -> None:
        self._end = None if timeout_s is None else time.monotonic() + timeout_s

    def left_s(self) -> float | None:
        return None if self._end is None else max(0.0, self._end - time.monotonic())

    def allows(self, wait_s: float) -> bool:
        """Whether there is time left after a wait."""
        return self._end is None or time.monotonic() + wait_s < self._end

"""When a call is made again."""
from __future__ import annotations

import random
import time
from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True)
class Retry:
    """How often a call is tried while the server is busy, drains or cannot be reached.

    A call that was lost while it ran is not tried again. Every job is without side effects, so trying again
    is always safe.

    attempts: largest number of tries; 1: none but the first.
    first_wait_s: time before the second try. Each further one waits twice as long, all with a random share.
    longest_wait_s: longest time between two tries.
    """

    attempts: int = 4
    first_wait_s: float = 0.5
    longest_wait_s: float = 10.0

    def waits(self) -> Iterator[float]:
        """Times to wait before the second try, the third, and so on."""
        for k in range(self.attempts - 1):
            yield min(self.longest_wait_s, self.first_wait_s * 2**k) * random.uniform(0.75, 1.25)


class Deadline:
    """The end of a call with all its tries."""

    def __init__(self, timeout_s: float | None) -> None:
        self._end = None if timeout_s is None else time.monotonic() + timeout_s

    def left_s(self) -> float | None:
        return None if self._end is None else max(0.0, self._end - time.monotonic())

    def allows(self, wait_s: float) -> bool:
        """Whether there is time left after a wait."""
        return self._end is None or time.monotonic() + wait_s < self._end

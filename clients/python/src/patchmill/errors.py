"""Everything that can go wrong. All errors are PatchmillErrors; those of a call know why the server refused
it."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

__all__ = [
    "CallError", "DeadlineError", "IncompleteAnswerError", "InternalServerError", "InvalidRequestError",
    "JobCancelledError", "LimitError", "ModelError", "ModelNotCachedError", "NoProgramError",
    "NotAuthenticatedError", "NotAvailableError", "OptionError", "PatchmillError", "QuotaError", "RegionsStaleError", "ServerBusyError",
    "ServerDrainingError", "ServerLostError", "ServerUnreachableError", "StartError", "TemporaryError",
    "UnreadableError", "WrongField",
]


class PatchmillError(Exception):
    """Any error of this package."""


class OptionError(PatchmillError, ValueError):
    """An option cannot be sent. `field` is its path in the request."""

    def __init__(self, field: str, problem: str) -> None:
        super().__init__(f"{field} {problem}" if field else problem)
        self.field = field


class StartError(PatchmillError):
    """The server that the client wanted to start is not there, or did not start."""


class NoProgramError(PatchmillError):
    """The job has no program: its outcome says why."""


class IncompleteAnswerError(PatchmillError):
    """The answer ended without its report, or the program did not arrive whole. Nothing of it is valid."""


@dataclass(frozen=True)
class WrongField:
    """A wrong field of a request: its path ("job.operations[0].scallop_mm"), and its value with the
    constraint."""

    field: str
    description: str


class CallError(PatchmillError):
    """A call that failed.

    code: name of the gRPC status ("INVALID_ARGUMENT").
    reason: the reason of the contract ("INVALID_FIELDS"); empty where gRPC itself answered.
    wrong_fields: the wrong fields, at most 20 of them; wrong_field_count counts all.
    limit, limit_value, actual_value: the limit that was passed, its value, and the value of the request.
    model_code: of a model that cannot be read, a code where a program may react: ZERO_WEIGHT.
    """

    def __init__(self, message: str, code: str = "", reason: str = "", *, wrong_fields: Sequence[WrongField] = (),
                 wrong_field_count: int = 0, limit: str = "", limit_value: float = 0.0, actual_value: float = 0.0,
                 model_code: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.reason = reason
        self.wrong_fields = tuple(wrong_fields)
        self.wrong_field_count = wrong_field_count
        self.limit = limit
        self.limit_value = limit_value
        self.actual_value = actual_value
        self.model_code = model_code

    def __str__(self) -> str:
        if len(self.wrong_fields) < 2:
            return super().__str__()
        lines = [f"{self.wrong_field_count} fields are wrong:"]
        lines += [f"  {wrong.field} {wrong.description}" for wrong in self.wrong_fields]
        hidden = self.wrong_field_count - len(self.wrong_fields)
        return "\n".join(lines + ([f"  and {hidden} more"] if hidden > 0 else []))


class InvalidRequestError(CallError):
    """Fields of the request are wrong. `wrong_fields` lists them."""


class ModelError(InvalidRequestError):
    """The model cannot be read, or cannot be used."""


class UnreadableError(InvalidRequestError):
    """The program to verify, or the curve to fair, cannot be read."""


class NotAvailableError(CallError):
    """The server does not have this yet, or was built without it."""


class NotAuthenticatedError(CallError):
    """The token is missing, unknown or has expired. `reason` says which."""


class ModelNotCachedError(CallError):
    """The server does not hold the model that was named by its digest. Send it inline."""


class RegionsStaleError(CallError):
    """The overrides were made for other regions. Split the surface again."""


class LimitError(CallError):
    """The job is larger than the server allows. `limit` names the limit."""


class JobCancelledError(CallError):
    """The call was cancelled. Nothing of it is valid."""


class DeadlineError(CallError):
    """The time is over: `timeout_s` of the call, or the longest time that the server gives a job."""


class InternalServerError(CallError):
    """A fault of the server. Please report it."""


class TemporaryError(CallError):
    """The server cannot take the call now. The same call may succeed later, and Client tries it again."""


class ServerBusyError(TemporaryError):
    """The server has as many jobs or bytes as it may."""


class QuotaError(TemporaryError):
    """This caller has taken what it may take: requests, places, seconds of jobs. `limit` names the quota."""


class ServerDrainingError(TemporaryError):
    """The server shuts down. Another one may take the call."""


class ServerUnreachableError(TemporaryError):
    """No server answers at the address, or TLS does not agree."""


class ServerLostError(CallError):
    """The connection broke while the call ran. Client tries the call again, but less often: if the call was
    what ended the server, it would end the next one.

    may_retry: whether Client does; not where its own server ended, or where the answer was read too slowly.
    """

    may_retry = True

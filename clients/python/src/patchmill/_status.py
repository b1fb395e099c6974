"""From the status of a call to the error that says what it is."""
from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import grpc

from . import errors
from .v1 import status_pb2

_OF_REASON: dict[str, type[errors.CallError]] = {
    "INVALID_FIELDS": errors.InvalidRequestError,
    "REQUEST_UNREADABLE": errors.InvalidRequestError,
    "NOT_IMPLEMENTED": errors.NotAvailableError,
    "MODEL_UNREADABLE": errors.ModelError,
    "MODEL_INVALID": errors.ModelError,
    "MODEL_NOT_CACHED": errors.ModelNotCachedError,
    "PROGRAM_UNREADABLE": errors.UnreadableError,
    "CURVE_UNREADABLE": errors.UnreadableError,
    "LIMIT_EXCEEDED": errors.LimitError,
    "TOO_MANY_JOBS": errors.ServerBusyError,
    "TOO_MANY_BYTES": errors.ServerBusyError,
    "TOO_MUCH_MEMORY": errors.ServerBusyError,
    "QUOTA_EXCEEDED": errors.QuotaError,
    "DRAINING": errors.ServerDrainingError,
    "REGIONS_STALE": errors.RegionsStaleError,
    "CANCELLED": errors.JobCancelledError,
    "DEADLINE_EXCEEDED": errors.DeadlineError,
    "INTERNAL": errors.InternalServerError,
}
_OF_CODE: dict[str, type[errors.CallError]] = {
    "INVALID_ARGUMENT": errors.InvalidRequestError,
    "UNIMPLEMENTED": errors.NotAvailableError,
    "RESOURCE_EXHAUSTED": errors.LimitError,
    "UNAUTHENTICATED": errors.NotAuthenticatedError,
    "CANCELLED": errors.JobCancelledError,
    "DEADLINE_EXCEEDED": errors.DeadlineError,
    "INTERNAL": errors.InternalServerError,
}
# How gRPC begins its message when it has not come as far as a connection.
_NO_CONNECTION = ("failed to connect", "DNS resolution failed", "Failed to pick", "connections to all backends failing")


def _info_of(trailers: Iterable[tuple[str, Any]] | None) -> status_pb2.ErrorInfo | None:
    for key, value in trailers or ():
        if key != "grpc-status-details-bin":
            continue
        for detail in status_pb2.Status.FromString(value).details:
            info = status_pb2.ErrorInfo()
            if detail.Unpack(info):
                return info
    return None


def _unavailable(code: str, details: str, where: str) -> errors.CallError:
    if details.startswith(_NO_CONNECTION):
        return errors.ServerUnreachableError(f"No server answers at {where}: {details}", code)
    if details == "Cancelling all calls":  # gRPC's word for the end of the time to drain
        return errors.ServerLostError(f"The server at {where} shut down before the call was done.", code)
    return errors.ServerLostError(f"The connection to {where} broke while the call ran: {details}", code)


def ended_by_server(where: str, has_begun: bool) -> errors.CallError:
    """The error for a call that was cancelled, but not by this client."""
    if has_begun:
        lost = errors.ServerLostError(f"The server at {where} ended the call: it shuts down, or the answer was read too slowly.",
                                      "CANCELLED")
        lost.may_retry = False
        return lost
    return errors.ServerDrainingError(f"The server at {where} ended the call before it began: it shuts down.", "CANCELLED")


def error_of(status: Any, where: str) -> errors.CallError:
    """The error for a failed call; `status` is a grpc.RpcError with its code, `where` names the server."""
    code, details = status.code().name, status.details() or ""
    trailers = status.trailing_metadata()
    info = _info_of(trailers)
    if info is not None:
        kind = _OF_REASON.get(info.reason, _OF_CODE.get(code, errors.CallError))
        fields = [errors.WrongField(v.field, v.description) for v in info.field_violations]
        return kind(details, code, info.reason, wrong_fields=fields, wrong_field_count=info.violation_count,
                    limit=info.limit, limit_value=info.limit_value, actual_value=info.actual_value,
                    model_code=info.code)
    if status.code() == grpc.StatusCode.DEADLINE_EXCEEDED:
        return errors.DeadlineError("The call was not done within its time (timeout_s).", code)
    if status.code() == grpc.StatusCode.UNIMPLEMENTED:
        return errors.NotAvailableError(f"The server at {where} has no such call: it is no server of Patchmill, or one of another "
                                        "version.", code)
    # A proxy that has passed on a part of the answer has no other way to say that the rest will not come.
    is_reset = status.code() == grpc.StatusCode.INTERNAL and "RST_STREAM" in details
    if status.code() == grpc.StatusCode.UNAVAILABLE or is_reset:
        return _unavailable(code, details, where)
    return _OF_CODE.get(code, errors.CallError)(details or code, code)

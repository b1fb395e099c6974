"""The call of ServerService: capabilities."""
from __future__ import annotations

from ._call import RPCS, Call, One
from ._message import from_message
from .messages import GetCapabilitiesResponse
from .v1 import server_service_pb2


def capabilities(*, timeout_s: float | None = None) -> Call[GetCapabilitiesResponse]:
    """What the server can do: version, dialects, formats, limits, and the quotas of this caller."""
    return Call(RPCS["GetCapabilities"], server_service_pb2.GetCapabilitiesRequest(),
                lambda: One(lambda answer: from_message(GetCapabilitiesResponse, answer)), timeout_s=timeout_s)

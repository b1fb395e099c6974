"""How a server is reached: its address, TLS, and what is sent with every call."""
from __future__ import annotations

import ipaddress
import os
import pathlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import grpc

from .errors import OptionError

MAX_MESSAGE_BYTES = 64 << 20  # of client and server

CHANNEL_OPTIONS = [
    ("grpc.max_send_message_length", MAX_MESSAGE_BYTES),
    ("grpc.max_receive_message_length", MAX_MESSAGE_BYTES),
    # A call that finds no server ends at once; these say how soon the next one may look again.
    ("grpc.initial_reconnect_backoff_ms", 200),
    ("grpc.max_reconnect_backoff_ms", 2000),
    ("grpc.dns_min_time_between_resolutions_ms", 200),
    ("grpc.enable_retries", 0),  # the package retries, and knows which errors are temporary
]


@dataclass(frozen=True)
class Tls:
    """A connection over TLS. Each field is the path of a PEM file, or its bytes.

    ca: certificate of the authority that the server's certificate is checked with. None: those of the
        machine.
    cert, key: certificate and key of this client, for servers that want them.
    """

    ca: str | os.PathLike[str] | bytes | None = None
    cert: str | os.PathLike[str] | bytes | None = None
    key: str | os.PathLike[str] | bytes | None = None


def _pem(value: str | os.PathLike[str] | bytes | None) -> bytes | None:
    return value if value is None or isinstance(value, bytes) else pathlib.Path(value).read_bytes()


def credentials(tls: Tls) -> Any:
    if (tls.cert is None) != (tls.key is None):
        raise OptionError("tls.cert", "and tls.key belong together; give both or none")
    return grpc.ssl_channel_credentials(_pem(tls.ca), _pem(tls.key), _pem(tls.cert))


def check_address(address: str) -> None:
    """OptionError if this is no address of gRPC: HOST:PORT, or one with a scheme (unix:/run/patchmill)."""
    if address.startswith(("unix:", "unix-abstract:", "dns:", "ipv4:", "ipv6:")):
        return
    host, _, port = address.rpartition(":")
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise OptionError("address", f"= {address!r}; it must be HOST:PORT, for example 'cam.example:50051', or unix:PATH")


def is_loopback(address: str) -> bool:
    """Whether an address stays on this machine."""
    if address.startswith("unix:"):
        return True
    host = address.rsplit(":", 1)[0].strip("[]")
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


Token = str | Callable[[], str]


def check_token(token: Token | None, address: str, tls: Tls | None) -> None:
    if token is not None and tls is None and not is_loopback(address):
        raise OptionError("token", f"would be sent to {address} unencrypted; give tls=patchmill.Tls(...) as well")


def metadata(token: Token | None) -> list[tuple[str, str]]:
    if token is None:
        return []
    return [("authorization", f"Bearer {token if isinstance(token, str) else token()}")]

"""What the tests share: a running server, its log, calls with a token, certificates."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
from typing import Any

import grpc

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ["PATCHMILL_BIN"]).resolve()
PATCHMILLD, PATCHMILL = BIN / "patchmilld", BIN / "patchmill"
sys.path.insert(0, str(ROOT / "scripts"))

from contract.calls import Types, documents_in  # noqa: E402
from contract.descriptors import descriptor_set, read_contract  # noqa: E402

FILES = descriptor_set(ROOT / "proto")
TYPES = Types(FILES)
RPCS = {rpc.name: rpc for rpc in read_contract(FILES).rpcs}
TOKENS = {"ann": "token-of-ann-0001", "bob": "token-of-bob-0001"}


def wait_until(what: Any, seconds: float = 10.0) -> bool:
    end = time.monotonic() + seconds
    while not what():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


class Folder:
    """A folder of its own, removed at the end."""

    def __init__(self) -> None:
        self._folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self._folder.name)

    def __enter__(self) -> "Folder":
        return self

    def __exit__(self, *_: object) -> None:
        self._folder.cleanup()

    def write(self, name: str, text: str) -> str:
        (self.path / name).write_text(text)
        return str(self.path / name)

    def tokens(self, extra: str = "") -> str:
        return self.write("tokens.conf", "".join(f"[{name}]\ntoken = text:{token}\n{extra}" for name, token in TOKENS.items()))


class Server:
    """A patchmilld on a free port of this machine."""

    def __init__(self, *flags: str, env: dict[str, str] | None = None, listen: str | None = "127.0.0.1:0",
                 program: pathlib.Path | None = None) -> None:
        self._log = tempfile.NamedTemporaryFile()
        listening = ["--listen", listen] if listen else []
        self.process = subprocess.Popen([program or PATCHMILLD, *listening, *flags], stderr=self._log, env={**os.environ, **(env or {})})
        wait_until(lambda: self.process.poll() is not None or self._port() is not None, 30.0)
        if self._port() is None:
            raise AssertionError(self.log())
        self.address = f"127.0.0.1:{self._port()}"

    def __enter__(self) -> "Server":
        return self

    def __exit__(self, *_: object) -> None:
        self.process.kill()
        self.process.wait()
        self._log.close()

    def log(self) -> str:
        return pathlib.Path(self._log.name).read_text()

    def logged(self, text: str) -> bool:
        """Whether the log has this text, or gets it soon."""
        return wait_until(lambda: text in self.log())

    def _port(self) -> str | None:
        found = re.search(r'listens on [^ ]+, port (\d+)', self.log())
        return found[1] if found else None


def refused(*flags: str, env: dict[str, str] | None = None, program: list[Any] | None = None) -> tuple[int, str]:
    """Status and message of a server that does not start."""
    ended = subprocess.run([*(program or [PATCHMILLD, "--listen", "127.0.0.1:0"]), *flags], stderr=subprocess.PIPE, text=True,
                           timeout=30, env={**os.environ, **(env or {})})
    return ended.returncode, ended.stderr


class Answer:
    """How a call ended: the name of its status, the reason of its ErrorInfo, and what it answered."""

    def __init__(self, code: str, events: list[Any], message: str = "", info: Any = None, retry_s: float | None = None) -> None:
        self.code, self.events, self.message, self.info, self.retry_s = code, events, message, info, retry_s
        self.reason = "" if info is None else info.reason


def _refusal(error: grpc.RpcError, events: list[Any]) -> Answer:
    details = dict(error.trailing_metadata() or ()).get("grpc-status-details-bin")
    info, retry_s = None, None
    if details is not None:
        for detail in TYPES.of("Status").FromString(details).details:
            if detail.type_url.endswith("ErrorInfo"):
                info = TYPES.of("ErrorInfo").FromString(detail.value)
            if detail.type_url.endswith("RetryInfo"):
                retry_s = TYPES.of("RetryInfo").FromString(detail.value).retry_delay.ToTimedelta().total_seconds()
    return Answer(error.code().name, events, error.details() or "", info, retry_s)


def worked_request(name: str) -> list[Any]:
    """The messages of docs/requests/NAME.json."""
    from google.protobuf import json_format
    text = (ROOT / "docs/requests" / f"{name}.json").read_text()
    return [json_format.ParseDict(document, TYPES.of(RPCS[name].request)(), descriptor_pool=TYPES.pool) for document in documents_in(text)]


def call(channel: grpc.Channel, name: str, messages: list[Any] | None = None, *, token: str | None = None,
         metadata: dict[str, str] | None = None, timeout: float = 60.0) -> Answer:
    """Makes a call of the contract; by default the worked request of its documentation."""
    rpc = RPCS[name]
    if messages is None:
        messages = worked_request(name)
    sent = dict(metadata or {})
    if token is not None:
        sent["authorization"] = f"Bearer {token}"
    make = channel.stream_stream(f"/{rpc.path}", lambda m: m.SerializeToString(), TYPES.of(rpc.response).FromString)
    events: list[Any] = []
    try:
        for event in make(iter(messages), timeout=timeout, metadata=list(sent.items())):
            events.append(event)
    except grpc.RpcError as error:
        return _refusal(error, events)
    return Answer("OK", events)


def health(channel: grpc.Channel, service: str = "") -> str:
    """"SERVING", "NOT_SERVING", or the code of the error."""
    request = bytes([10, len(service)]) + service.encode() if service else b""
    try:
        answer = channel.unary_unary("/grpc.health.v1.Health/Check", None, None)(request, timeout=20)
    except grpc.RpcError as error:
        return error.code().name
    return {b"\x08\x01": "SERVING", b"\x08\x02": "NOT_SERVING"}[answer]

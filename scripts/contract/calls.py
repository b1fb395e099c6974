"""Calls of a server by the descriptors alone: no generated code."""
import contextlib
import json
import pathlib
import re
import subprocess
import tempfile
import time
from collections.abc import Iterator
from typing import Any

import grpc
from google.protobuf import descriptor_pb2, descriptor_pool, json_format, message_factory

from .descriptors import PACKAGE, Rpc

CALL_SECONDS = 60


class Types:
    """The classes of all messages of the contract."""

    def __init__(self, files: descriptor_pb2.FileDescriptorSet) -> None:
        self.pool = descriptor_pool.DescriptorPool()
        for file in files.file:  # protoc puts a file after the files that it imports
            self.pool.Add(file)
        self._factory = message_factory.MessageFactory(self.pool)

    def of(self, name: str) -> Any:
        return self._factory.GetPrototype(self.pool.FindMessageTypeByName(f"{PACKAGE}.{name}"))


@contextlib.contextmanager
def server(program: pathlib.Path) -> Iterator[str]:
    """A running patchmilld on a free port of this machine; its address."""
    with tempfile.NamedTemporaryFile("r") as log:
        with open(log.name, "w") as errors:
            process = subprocess.Popen([program, "--listen", "127.0.0.1:0"], stderr=errors)
        try:
            end, port = time.monotonic() + 20, None
            while port is None and process.poll() is None and time.monotonic() < end:
                time.sleep(0.02)
                port = re.search(r"port (\d+)\n", pathlib.Path(log.name).read_text())
            if port is None:
                raise SystemExit(f"contract_pages.py: {program} does not listen: {pathlib.Path(log.name).read_text()}")
            yield f"127.0.0.1:{port[1]}"
        finally:
            process.kill()
            process.wait()


def documents_in(request: str) -> list[dict[str, Any]]:
    """The messages of a request: one, or several in a row where the client sends a stream."""
    found, at = [], 0
    while request[at:].strip():
        at += len(request[at:]) - len(request[at:].lstrip())
        document, at = json.JSONDecoder().raw_decode(request, at)
        found.append(document)
    return found


def call(address: str, types: Types, rpc: Rpc, request: str) -> list[dict[str, Any]]:
    """The answers to a request in JSON, by the names of the contract: one, or those of the stream."""
    # A field that the contract does not know is an error here, and so is one of the wrong type.
    messages = [json_format.Parse(json.dumps(document), types.of(rpc.request)(), descriptor_pool=types.pool)
                for document in documents_in(request)]
    message = messages[0]
    answer = types.of(rpc.response)
    options = [("grpc.max_receive_message_length", 64 << 20)]
    with grpc.insecure_channel(address, options=options) as channel:
        path, write = f"/{rpc.path}", type(message).SerializeToString
        if rpc.uploads:
            answers = [channel.stream_unary(path, write, answer.FromString)(iter(messages), timeout=CALL_SECONDS)]
        elif rpc.streams:
            answers = list(channel.unary_stream(path, write, answer.FromString)(message, timeout=CALL_SECONDS))
        else:
            answers = [channel.unary_unary(path, write, answer.FromString)(message, timeout=CALL_SECONDS)]
    return [json.loads(json_format.MessageToJson(a, preserving_proto_field_name=True, descriptor_pool=types.pool))
            for a in answers]


def refusal(address: str, types: Types, rpc: Rpc, request: str) -> dict[str, Any]:
    """The error with which a request ends: its status code, its message and its ErrorInfo."""
    try:
        call(address, types, rpc, request)
    except grpc.RpcError as error:
        found = {key: value for key, value in error.trailing_metadata() if key == "grpc-status-details-bin"}
        status = types.of("Status").FromString(found["grpc-status-details-bin"])
        info = types.of("ErrorInfo").FromString(status.details[0].value)
        return {"code": error.code().name, "message": error.details(), "ErrorInfo": json_format.MessageToDict(
            info, preserving_proto_field_name=True, descriptor_pool=types.pool)}
    raise SystemExit(f"contract_pages.py: {rpc.name} accepted a request that must fail")

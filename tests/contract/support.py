"""What the tests share: the contract by the descriptors of protobuf's runtime, and where programs are.

The pages come from scripts/contract, which reads the output of protoc itself. The tests of the pages walk the
runtime's descriptors instead, so that what one of the two misses, the other has.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from typing import Any

from google.protobuf import descriptor_pb2, descriptor_pool

ROOT = pathlib.Path(__file__).resolve().parents[2]
PATCHMILLD = pathlib.Path(os.environ["PATCHMILLD"]).resolve()
SCRIPT = ROOT / "scripts/contract_pages.py"
PACKAGE = "patchmill.v1"
sys.path.insert(0, str(ROOT / "scripts"))


def protoc() -> descriptor_pb2.FileDescriptorSet:
    files = sorted(str(path) for path in (ROOT / "proto").rglob("*.proto"))
    with tempfile.NamedTemporaryFile() as out:
        subprocess.run(["protoc", "-I", str(ROOT / "proto"), "--include_imports", "--include_source_info",
                        f"--descriptor_set_out={out.name}", *files], check=True)
        return descriptor_pb2.FileDescriptorSet.FromString(pathlib.Path(out.name).read_bytes())


class Runtime:
    """RPCs, messages and enums of the contract, as protobuf's runtime has them."""

    def __init__(self, files: descriptor_pb2.FileDescriptorSet) -> None:
        pool = descriptor_pool.DescriptorPool()
        for file in files.file:
            pool.Add(file)
        found = [pool.FindFileByName(file.name) for file in files.file if file.package == PACKAGE]
        self.methods = [method for file in found for service in file.services_by_name.values() for method in service.methods]
        self.messages = [message for file in found for message in file.message_types_by_name.values()]
        self.enums = [enum for file in found for enum in file.enum_types_by_name.values()]


def closure(*messages: Any) -> tuple[dict[str, Any], dict[str, Any]]:
    """Messages and enums of the contract that the given ones hold at any depth, by name."""
    found: dict[str, Any] = {}
    enums: dict[str, Any] = {}

    def visit(message: Any) -> None:
        if message.name in found or message.file.package != PACKAGE:
            return
        found[message.name] = message
        for field in message.fields:
            if field.message_type is not None:
                visit(field.message_type)
            if field.enum_type is not None:
                enums[field.enum_type.name] = field.enum_type

    for message in messages:
        visit(message)
    return found, enums


def comments(files: descriptor_pb2.FileDescriptorSet) -> Iterator[tuple[str, str]]:
    """"Job", "Job.source", "Output.OUTPUT_PATHS" and RPC names, with their comments."""
    for file in files.file:
        if file.package != PACKAGE:
            continue
        for at in file.source_code_info.location:
            text, path = at.leading_comments, list(at.path)
            if path[:1] == [4] and len(path) == 2:
                yield file.message_type[path[1]].name, text
            elif path[:1] == [4] and len(path) == 4 and path[2] == 2:
                message = file.message_type[path[1]]
                yield f"{message.name}.{message.field[path[3]].name}", text
            elif path[:1] == [5] and len(path) == 2:
                yield file.enum_type[path[1]].name, text
            elif path[:1] == [5] and len(path) == 4 and path[2] == 2:
                enum = file.enum_type[path[1]]
                yield f"{enum.name}.{enum.value[path[3]].name}", text
            elif path[:1] == [6] and len(path) == 4 and path[2] == 2:
                yield file.service[path[1]].method[path[3]].name, text

"""The contract as protoc understands it, with its comments."""
import pathlib
import subprocess
import tempfile
from dataclasses import dataclass, field

from google.protobuf import descriptor_pb2

PACKAGE = "patchmill.v1"
Kind = descriptor_pb2.FieldDescriptorProto
SCALARS = {
    Kind.TYPE_DOUBLE: "double", Kind.TYPE_FLOAT: "float", Kind.TYPE_INT32: "int32", Kind.TYPE_INT64: "int64",
    Kind.TYPE_UINT32: "uint32", Kind.TYPE_UINT64: "uint64", Kind.TYPE_BOOL: "bool", Kind.TYPE_STRING: "string",
    Kind.TYPE_BYTES: "bytes",
}


@dataclass(frozen=True)
class Field:
    name: str
    number: int
    type_name: str  # "double", or the name of a message or an enum
    comment: str
    repeated: bool
    optional: bool  # the client can tell "not set" from zero
    oneof: str  # name of the oneof that the field is a choice of, or ""
    deprecated: bool


@dataclass(frozen=True)
class Message:
    name: str
    file: str
    comment: str
    fields: list[Field]
    oneofs: dict[str, str]  # comment of each oneof


@dataclass(frozen=True)
class Value:
    name: str
    number: int
    comment: str


@dataclass(frozen=True)
class Enum:
    name: str
    file: str
    comment: str
    values: list[Value]


@dataclass(frozen=True)
class Rpc:
    service: str
    name: str
    comment: str
    request: str
    response: str
    streams: bool  # the server answers with a stream
    uploads: bool  # the client sends a stream

    @property
    def path(self) -> str:
        return f"{PACKAGE}.{self.service}/{self.name}"


@dataclass
class Contract:
    services: dict[str, str] = field(default_factory=dict)  # comment of each service
    rpcs: list[Rpc] = field(default_factory=list)
    messages: dict[str, Message] = field(default_factory=dict)
    enums: dict[str, Enum] = field(default_factory=dict)

    def reached(self, *names: str) -> list[str]:
        """Messages and enums that the named messages hold, at any depth: each once, the named ones first."""
        found: list[str] = []
        todo = list(names)
        while todo:
            name = todo.pop(0)
            if name in found or not (name in self.messages or name in self.enums):
                continue
            found.append(name)
            if name in self.messages:
                todo += [f.type_name for f in self.messages[name].fields]
        return found


def descriptor_set(proto: pathlib.Path) -> descriptor_pb2.FileDescriptorSet:
    """What protoc says of the folder `proto`, imports included."""
    files = sorted(str(p) for p in proto.glob("patchmill/v1/*.proto"))
    if not files:
        raise SystemExit(f"contract_pages.py: {proto} has no patchmill/v1/*.proto: run the script from its repository")
    with tempfile.NamedTemporaryFile() as out:
        subprocess.run(["protoc", "-I", str(proto), "--include_imports", "--include_source_info",
                        f"--descriptor_set_out={out.name}", *files], check=True)
        return descriptor_pb2.FileDescriptorSet.FromString(pathlib.Path(out.name).read_bytes())


def _short(type_name: str) -> str:
    return type_name.removeprefix(f".{PACKAGE}.").removeprefix(".")


def _field(proto: descriptor_pb2.FieldDescriptorProto, oneofs: list[str], comment: str) -> Field:
    choice = proto.HasField("oneof_index") and not proto.proto3_optional
    return Field(
        name=proto.name, number=proto.number, type_name=_short(proto.type_name) if proto.type_name else SCALARS[proto.type],
        comment=comment, repeated=proto.label == Kind.LABEL_REPEATED, optional=proto.proto3_optional,
        oneof=oneofs[proto.oneof_index] if choice else "", deprecated=proto.options.deprecated)


def read_contract(files: descriptor_pb2.FileDescriptorSet) -> Contract:
    contract = Contract()
    for file in files.file:
        if file.package != PACKAGE:
            continue
        comments = {tuple(at.path): at.leading_comments for at in file.source_code_info.location}
        name = pathlib.PurePosixPath(file.name).name

        def text(*path: int) -> str:
            lines = comments.get(path, "").splitlines()
            return "\n".join(line.removeprefix(" ") for line in lines).strip()

        for k, message in enumerate(file.message_type):
            if message.nested_type or message.enum_type:
                raise SystemExit(f"contract_pages.py: {message.name} has types inside: the pages show types of files only")
            oneofs = [o.name for o in message.oneof_decl]
            contract.messages[message.name] = Message(
                message.name, name, text(4, k), [_field(f, oneofs, text(4, k, 2, i)) for i, f in enumerate(message.field)],
                {o: text(4, k, 8, i) for i, o in enumerate(oneofs)})
        for k, enum in enumerate(file.enum_type):
            contract.enums[enum.name] = Enum(
                enum.name, name, text(5, k), [Value(v.name, v.number, text(5, k, 2, i)) for i, v in enumerate(enum.value)])
        for k, service in enumerate(file.service):
            contract.services[service.name] = text(6, k)
            contract.rpcs += [
                Rpc(service.name, m.name, text(6, k, 2, i), _short(m.input_type), _short(m.output_type), m.server_streaming,
                    m.client_streaming)
                for i, m in enumerate(service.method)]
    return contract

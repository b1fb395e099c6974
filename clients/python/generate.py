"""Writes the dataclasses of the package out of the contract: its names, its defaults, its texts.

usage: generate.py DESCRIPTORS OUT.py     DESCRIPTORS: of protoc --include_source_info --descriptor_set_out

Messages of a request become options, messages of an answer become results. Requests themselves are left out:
the fields of a request are the arguments of a function.
"""
import keyword
import pathlib
import re
import sys
import textwrap
from collections.abc import Iterator

from google.protobuf import descriptor_pb2

Field = descriptor_pb2.FieldDescriptorProto
Message = descriptor_pb2.DescriptorProto
PACKAGE = "patchmill.v1."
WIDTH = 100

# Answers that the package collects in classes of its own, and messages that nobody but the package reads.
LEFT_OUT = {
    "GenerateProgramResponse", "VerifyProgramResponse", "SplitRegionsResponse", "PathBlock", "MeshBlock", "ProgramChunk",
    "Status", "ErrorInfo", "RetryInfo", "ImportResult", "ImportReport", "ImportedKind",
}
# Their fields may be given by position: Point3(1, 2, 3).
POSITIONAL = {"Point2", "Point3"}
# Numbers in one row of an array, where the contract does not say it in one of the forms of ROW.
COLUMNS = {"FairCurveResponse.curvatures_before": 3, "FairCurveResponse.curvatures_after": 3}
ROW = re.compile(r"\bpacked (x y z|x y|u v|E F G|L M N|in pairs|by three)\b", re.IGNORECASE)
ROW_SIZE = {"x y z": 3, "x y": 2, "u v": 2, "e f g": 3, "l m n": 3, "in pairs": 2, "by three": 3}
SCALARS = {
    Field.TYPE_DOUBLE: ("float", "0.0"), Field.TYPE_FLOAT: ("float", "0.0"), Field.TYPE_INT32: ("int", "0"),
    Field.TYPE_INT64: ("int", "0"), Field.TYPE_UINT32: ("int", "0"), Field.TYPE_UINT64: ("int", "0"),
    Field.TYPE_BOOL: ("bool", "False"), Field.TYPE_STRING: ("str", '""'), Field.TYPE_BYTES: ("bytes", 'b""'),
}
ARRAYS = {Field.TYPE_DOUBLE: "float64", Field.TYPE_FLOAT: "float32", Field.TYPE_INT32: "int32", Field.TYPE_INT64: "int64",
          Field.TYPE_UINT32: "uint32", Field.TYPE_UINT64: "uint64"}

Comments = dict[tuple[int, ...], str]


def short(type_name: str) -> str:
    return type_name.removeprefix(f".{PACKAGE}")


def comments_of(file: descriptor_pb2.FileDescriptorProto) -> Comments:
    return {tuple(at.path): " ".join(at.leading_comments.split()) for at in file.source_code_info.location}


def paragraph(text: str, indent: str, hanging: str) -> str:
    return textwrap.fill(text, WIDTH, initial_indent=indent, subsequent_indent=hanging, break_on_hyphens=False,
                         break_long_words=False)


def docstring(text: str, members: list[tuple[str, str]]) -> Iterator[str]:
    """The comment of a message, then one paragraph for each member."""
    assert '"""' not in text and "\\" not in text, text
    yield paragraph(f'"""{text or "Of the contract."}', "    ", "    ")
    if members:
        yield ""
    for name, comment in members:
        yield paragraph(f"{name}: {comment}", "    ", "        ")
    yield '    """'


def columns(owner: str, field: Field, comment: str) -> int:
    """Numbers in a row of the array; 1: the field is a plain list of numbers."""
    found = ROW.search(comment)
    return COLUMNS.get(f"{owner}.{field.name}", ROW_SIZE[found[1].lower()] if found else 1)


def declaration(owner: str, field: Field, comment: str, is_option: bool) -> str:
    if field.label == Field.LABEL_REPEATED:
        if field.type in ARRAYS:
            size = columns(owner, field, comment)
            if is_option:
                return f"{field.name}: ArrayLike = numbers({size})"
            return f"{field.name}: NDArray[np.{ARRAYS[field.type]}] = numbers({size}, np.{ARRAYS[field.type]})"
        item = short(field.type_name) if field.type_name else SCALARS[field.type][0]
        return f"{field.name}: Sequence[{item}] = ()"
    if field.type == Field.TYPE_MESSAGE:
        return f"{field.name}: {short(field.type_name)} | None = None"
    if field.type == Field.TYPE_ENUM:
        kind, default = short(field.type_name), f"{short(field.type_name)}.UNSPECIFIED"
    else:
        kind, default = SCALARS[field.type]
    return f"{field.name}: {kind} | None = None" if field.HasField("oneof_index") else f"{field.name}: {kind} = {default}"


def message_class(message: Message, text: str, of_fields: list[str], is_option: bool) -> str:
    wrong = [f.name for f in message.field if keyword.iskeyword(f.name)]
    assert not wrong, f"{message.name}.{wrong} is a word of Python"
    lines = ["", "", f'@register("{PACKAGE}{message.name}")',
             f"@dataclass(kw_only={message.name not in POSITIONAL}, eq=False, repr=False, slots=True)", f"class {message.name}(Message):"]
    lines += docstring(text, [(f.name, c) for f, c in zip(message.field, of_fields)])
    lines += [""] + [f"    {declaration(message.name, f, c, is_option)}" for f, c in zip(message.field, of_fields)]
    return "\n".join(lines).rstrip()


def enum_class(enum: descriptor_pb2.EnumDescriptorProto, text: str, of_values: list[str]) -> str:
    prefix = re.sub(r"(?<!^)(?=[A-Z])", "_", enum.name).upper() + "_"
    names = [value.name.removeprefix(prefix) for value in enum.value]
    assert names[0] == "UNSPECIFIED", f"{enum.name} begins with {names[0]}"
    lines = ["", "", f'@register("{PACKAGE}{enum.name}")', f"class {enum.name}(Enumeration):"]
    lines += docstring(text, list(zip(names, of_values)))
    return "\n".join(lines + [""] + [f"    {name} = {value.number}" for name, value in zip(names, enum.value)])


def used_by_requests(messages: dict[str, Message]) -> set[str]:
    """Names of the messages that a request may hold, at any depth."""
    found: set[str] = set()
    todo = [name for name in messages if name.endswith("Request")]
    while todo:
        name = todo.pop()
        if name not in found:
            found.add(name)
            todo += [short(f.type_name) for f in messages[name].field if short(f.type_name) in messages]
    return found


HEAD = '''"""Options and results as the contract states them. Made from proto/patchmill/v1; do not edit."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._message import Enumeration, Message, numbers, register

__all__ = ['''


def generate(descriptors: descriptor_pb2.FileDescriptorSet) -> str:
    files = [f for f in descriptors.file if f.package == PACKAGE.rstrip(".")]
    messages = {m.name: m for f in files for m in f.message_type}
    options = used_by_requests(messages)
    classes: dict[str, str] = {}
    for file in files:
        comments = comments_of(file)
        for k, enum in enumerate(file.enum_type):
            texts = [comments.get((5, k, 2, i), "") for i in range(len(enum.value))]
            classes[enum.name] = enum_class(enum, comments.get((5, k), ""), texts)
        for k, message in enumerate(file.message_type):
            if message.name in LEFT_OUT or message.name.endswith("Request"):
                continue
            texts = [comments.get((4, k, 2, i), "") for i in range(len(message.field))]
            classes[message.name] = message_class(message, comments.get((4, k), ""), texts, message.name in options)
    names = textwrap.fill(", ".join(f'"{name}"' for name in sorted(classes)), WIDTH, initial_indent="    ", subsequent_indent="    ")
    # Enumerations first: their values are defaults.
    enums = {e.name for f in files for e in f.enum_type}
    ordered = sorted(classes, key=lambda name: (name not in enums, name))
    return HEAD + f"\n{names},\n]\n" + "\n".join(classes[name] for name in ordered) + "\n"


def main() -> None:
    descriptors = descriptor_pb2.FileDescriptorSet.FromString(pathlib.Path(sys.argv[1]).read_bytes())
    pathlib.Path(sys.argv[2]).write_text(generate(descriptors))


if __name__ == "__main__":
    main()

"""What the dataclasses of the contract have in common, and how they become messages of protobuf and come
back."""
from __future__ import annotations

import dataclasses
import enum
import operator
from collections.abc import Callable, Sequence
from typing import Any, ClassVar, TypeVar

import numpy as np
from google.protobuf.descriptor import FieldDescriptor
from numpy.typing import NDArray

from .errors import OptionError

_T = TypeVar("_T", bound=type)
_M = TypeVar("_M", bound="Message")
_REGISTRY: dict[str, Any] = {}


def register(name: str) -> Callable[[_T], _T]:
    """Notes which class stands for a message or an enumeration of the contract."""
    def note(cls: _T) -> _T:
        _REGISTRY[name] = cls
        return cls
    return note


def numbers(columns: int, kind: Any = None) -> Any:
    """A field with packed numbers, `columns` of them in each row. Options take anything that numpy makes an
    array of; results have an array of the type `kind`."""
    if kind is None:
        return dataclasses.field(default=(), metadata={"columns": columns})

    def empty() -> NDArray[Any]:
        return np.empty((0, columns) if columns > 1 else (0,), dtype=kind)

    return dataclasses.field(default_factory=empty, metadata={"columns": columns})


class Enumeration(enum.IntEnum):
    """An enumeration of the contract. UNSPECIFIED, or leaving an option out, means the server's default."""

    @classmethod
    def _missing_(cls, value: object) -> Enumeration | None:
        # A newer server may know more values than this package.
        if not isinstance(value, int):
            return None
        member = int.__new__(cls, value)
        member._name_, member._value_ = f"VALUE_{value}", value
        return member

    def __str__(self) -> str:
        return self.name


def _is_default(value: Any) -> bool:
    return value is None or (isinstance(value, (int, float, str, bytes, Sequence)) and not value)


def _brief(value: Any) -> str:
    if isinstance(value, Enumeration):
        return f"{type(value).__name__}.{value.name}"
    if isinstance(value, np.ndarray):
        return f"<array {' x '.join(map(str, value.shape))}>" if value.size > 12 else repr(value.tolist())
    if isinstance(value, bytes) and len(value) > 40:
        return f"<{len(value)} bytes>"
    if isinstance(value, (list, tuple)) and len(value) > 4:
        return f"<{len(value)} items>"
    return repr(value)


class Message:
    """A message of the contract as a dataclass. It prints what is set."""

    __slots__ = ()  # a misspelt field is an AttributeError
    __dataclass_fields__: ClassVar[dict[str, Any]]

    def __repr__(self) -> str:
        values = {f.name: getattr(self, f.name) for f in dataclasses.fields(self)}
        shown = {name: value for name, value in values.items()
                 if (value.size > 0 if isinstance(value, np.ndarray) else not _is_default(value))}
        return f"{type(self).__name__}({', '.join(f'{name}={_brief(value)}' for name, value in shown.items())})"


def _at(path: str, name: str) -> str:
    return f"{path}.{name}" if path else name


def _numbers(values: Any, descriptor: Any, columns: int, path: str) -> list[Any]:
    is_whole = descriptor.cpp_type not in (descriptor.CPPTYPE_DOUBLE, descriptor.CPPTYPE_FLOAT)
    try:
        array = np.asarray(values)
        if array.size == 0:
            return []
        if array.dtype.kind not in ("iu" if is_whole else "iuf"):
            raise ValueError(f"it has the type {array.dtype}")
    except ValueError as error:
        kind = "whole numbers" if is_whole else "numbers"
        raise OptionError(path, f"must be an array of {kind}: {error}") from None
    is_flat = array.ndim == 1
    if columns > 1 and (array.size % columns if is_flat else array.shape[-1] != columns):
        raise OptionError(path, f"has the shape {array.shape}; it must have {columns} numbers for each point")
    flat: list[Any] = array.ravel().tolist()
    return flat


def _members_of(enum_type: Any) -> str:
    """The values of an enumeration that an option takes."""
    kind = _REGISTRY[enum_type.full_name]
    names = [member.name for member in kind if member.value]
    return f"patchmill.{kind.__name__}.{names[0]}" + (f", or {', '.join(names[1:])} of it" if len(names) > 1 else "")


def _scalar(value: Any, descriptor: Any, path: str) -> Any:
    kind = descriptor.cpp_type
    try:
        if kind in (descriptor.CPPTYPE_DOUBLE, descriptor.CPPTYPE_FLOAT):
            if isinstance(value, (str, bytes)):
                raise TypeError
            return float(value)
        if kind == descriptor.CPPTYPE_BOOL:
            if not isinstance(value, (bool, np.bool_)):
                raise TypeError
            return bool(value)
        if descriptor.type == descriptor.TYPE_STRING and not isinstance(value, str):
            raise TypeError
        if kind != descriptor.CPPTYPE_STRING:
            return operator.index(value)
        return bytes(value) if descriptor.type == descriptor.TYPE_BYTES and not isinstance(value, str) else value
    except TypeError:
        names = {descriptor.CPPTYPE_BOOL: "True or False", descriptor.CPPTYPE_STRING: "text",
                 descriptor.CPPTYPE_DOUBLE: "a number", descriptor.CPPTYPE_FLOAT: "a number"}
        wanted = names.get(kind) or (_members_of(descriptor.enum_type) if kind == descriptor.CPPTYPE_ENUM else "a whole number")
        raise OptionError(path, f"= {value!r}; it must be {wanted}") from None


def _set(message: Any, descriptor: Any, value: Any, columns: int, path: str) -> None:
    name = descriptor.name
    try:
        if descriptor.label == descriptor.LABEL_REPEATED:
            target = getattr(message, name)
            if isinstance(value, (str, bytes)):
                raise OptionError(path, f"= {value!r}; it must be a list")
            if descriptor.message_type is not None:
                for k, item in enumerate(value):
                    to_message(item, target.add(), f"{path}[{k}]")
            elif descriptor.cpp_type in (descriptor.CPPTYPE_STRING, descriptor.CPPTYPE_ENUM):
                target.extend(_scalar(item, descriptor, f"{path}[{k}]") for k, item in enumerate(value))
            else:
                target.extend(_numbers(value, descriptor, columns, path))
        elif descriptor.message_type is not None:
            part = getattr(message, name)
            part.SetInParent()
            to_message(value, part, path)
        else:
            setattr(message, name, _scalar(value, descriptor, path))
    except (TypeError, ValueError) as error:
        if isinstance(error, OptionError):
            raise
        raise OptionError(path, f"cannot be used: {error}") from None


def _check_choice(value: Message, descriptor: Any, path: str) -> None:
    for oneof in descriptor.oneofs:
        given = [f.name for f in oneof.fields if getattr(value, f.name, None) is not None]
        if len(oneof.fields) > 1 and len(given) > 1:
            raise OptionError(path or descriptor.name, f"has {' and '.join(given)}; only one of them can be set")


def to_message(value: Any, message: Any, path: str = "") -> Any:
    """Fills `message` with the fields of a dataclass that are set. OptionError names the path of a wrong
    field."""
    descriptor = message.DESCRIPTOR
    if _REGISTRY.get(descriptor.full_name) is None or not isinstance(value, _REGISTRY[descriptor.full_name]):
        raise OptionError(path, f"is of the type {type(value).__name__}; it must be patchmill.{descriptor.name}")
    _check_choice(value, descriptor, path)
    for f in dataclasses.fields(value):
        item, of_field = getattr(value, f.name), descriptor.fields_by_name.get(f.name)
        if of_field is not None and item is not None:
            _set(message, of_field, item, f.metadata.get("columns", 1), _at(path, f.name))
    return message


def set_fields(message: Any, path: str = "", /, **values: Any) -> Any:
    """Sets the fields that are not None."""
    for name, value in values.items():
        if value is not None:
            _set(message, message.DESCRIPTOR.fields_by_name[name], value, 1, _at(path, name))
    return message


_ARRAY_TYPES = {FieldDescriptor.CPPTYPE_FLOAT: np.float32, FieldDescriptor.CPPTYPE_DOUBLE: np.float64,
                FieldDescriptor.CPPTYPE_INT32: np.int32, FieldDescriptor.CPPTYPE_INT64: np.int64,
                FieldDescriptor.CPPTYPE_UINT32: np.uint32, FieldDescriptor.CPPTYPE_UINT64: np.uint64}


def array_of(numbers: Any, kind: Any, columns: int = 1) -> NDArray[Any]:
    """A packed field as an array with `columns` numbers in each row."""
    array = np.fromiter(numbers, dtype=kind, count=len(numbers))
    return array.reshape(-1, columns) if columns > 1 else array


def _get(message: Any, descriptor: Any, columns: int) -> Any:
    value = getattr(message, descriptor.name)
    is_many = descriptor.label == descriptor.LABEL_REPEATED
    if descriptor.message_type is not None:
        cls = _REGISTRY[descriptor.message_type.full_name]
        if is_many:
            return [from_message(cls, item) for item in value]
        return from_message(cls, value) if message.HasField(descriptor.name) else None
    if descriptor.enum_type is not None:
        cls = _REGISTRY[descriptor.enum_type.full_name]
        if is_many:
            return [cls(item) for item in value]
        value = cls(value)
    elif is_many:
        if descriptor.cpp_type in (descriptor.CPPTYPE_STRING, descriptor.CPPTYPE_BOOL):
            return list(value)
        return array_of(value, _ARRAY_TYPES[descriptor.cpp_type], columns)
    return None if descriptor.containing_oneof is not None and not message.HasField(descriptor.name) else value


def from_message(cls: type[_M], message: Any) -> _M:
    """The dataclass `cls` with the values of a message; a subclass of the one that stands for it will do."""
    known = message.DESCRIPTOR.fields_by_name
    return cls(**{f.name: _get(message, known[f.name], f.metadata.get("columns", 1))
                  for f in dataclasses.fields(cls) if f.name in known})

"""Answers in JSON, shortened for a reader: nothing is changed, and what is left out is counted."""
import base64
import json
from collections.abc import Iterator
from typing import Any

from .descriptors import Contract

NUMBERS, ITEMS, TEXT = 9, 2, 100


def _more(count: int, of: str) -> str:
    return f"… {count:,} more {of}" if count != 1 else f"… 1 more {of.removesuffix('s')}"


def _is_plain(value: Any) -> bool:
    return not isinstance(value, (dict, list))


def shortened(value: Any, indent: str = "") -> str:
    inner = indent + "  "
    if isinstance(value, dict):
        if not value:
            return "{}"
        rows = [f"{inner}{json.dumps(key)}: {shortened(item, inner)}" for key, item in value.items()]
        return "{\n" + ",\n".join(rows) + f"\n{indent}}}"
    if isinstance(value, list):
        if all(_is_plain(item) for item in value):
            rows = [shortened(item) for item in value[:NUMBERS]]
            return "[" + ", ".join(rows + ([_more(len(value) - NUMBERS, "values")] if len(value) > NUMBERS else [])) + "]"
        rows = [inner + shortened(item, inner) for item in value[:ITEMS]]
        if len(value) > ITEMS:
            rows.append(inner + _more(len(value) - ITEMS, "elements"))
        return "[\n" + ",\n".join(rows) + f"\n{indent}]"
    if isinstance(value, str) and len(value) > TEXT:
        return json.dumps(value[:TEXT], ensure_ascii=False)[:-1] + f'"{_more(len(value) - TEXT, "characters")}'
    return json.dumps(value, ensure_ascii=False)


def shortened_stream(answers: list[dict[str, Any]]) -> str:
    """Events of one kind that follow each other are counted after the first."""
    out: list[str] = []
    count = 0
    for k, answer in enumerate(answers):
        kind = next(iter(answer), "")
        if k > 0 and next(iter(answers[k - 1]), "") == kind:
            count += 1
        else:
            count = 0
            out.append(shortened(answer))
        if count and (k + 1 == len(answers) or next(iter(answers[k + 1]), "") != kind):
            out.append(_more(count, f"events with “{kind}”"))
    return "\n".join(out)


def texts(contract: Contract, message: str, value: dict[str, Any], path: str = "") -> Iterator[tuple[str, str]]:
    """The fields of bytes that are readable text, with their paths: in JSON they are base64."""
    for field in contract.messages[message].fields:
        if field.name not in value:
            continue
        items = value[field.name] if field.repeated else [value[field.name]]
        for item in items:
            at = f"{path}{field.name}"
            if field.type_name in contract.messages:
                yield from texts(contract, field.type_name, item, f"{at}.")
            elif field.type_name == "bytes":
                try:
                    text = base64.b64decode(item).decode()
                except UnicodeDecodeError:
                    continue
                if text and all(c.isprintable() or c in "\r\n\t" for c in text):
                    yield at, text

"""What name and comment of a field say of its unit, range and default, and what it means to leave it out."""
import re
from dataclasses import dataclass

from .descriptors import Contract, Field, Message

# Endings of names, the longest first.
NAME_UNITS = {
    "_mm_per_min": "mm/min", "_mm_per_s2": "mm/s^2", "_per_mm": "1/mm", "_mm2": "mm2", "_mm": "mm", "_deg": "degrees",
    "_rpm": "1/min", "_bytes": "bytes", "_seconds": "s", "_s": "s",
}
COMMENT_UNITS = [
    (r"1/mm\b", "1/mm"), (r"\bmm/min\b", "mm/min"), (r"\bmm/s\^2", "mm/s^2"), (r"\bmm(?:2|\^2)(?!\w)", "mm2"),
    (r"\b[Pp]er length_unit\b", "1/length_unit"), (r"\b[Ii]n length_unit\b", "length_unit"), (r"(?:, |^)mm\b", "mm"),
    (r", s[.,]", "s"), (r", degrees\b", "degrees"),
]
NUMBER = r"-?\d[\d.]*(?:e-?\d+)?"
COUNT = r"\d+(?:,\d{3})*"
END = rf"(?:{NUMBER}|[a-z][\w ]*?)"
WHAT = r"(?: (?:printable ASCII characters|bytes|KiB|finite numbers|vectors|points|corners|sections|patches|faces|segments|spans))?"
RANGES = re.compile(
    rf"(?<!\w)[\[(]{NUMBER}, {END}[\])](?!\w)"  # [0, 1], (0, ball radius)
    rf"|(?:(?<=[,;:.] )|^){COUNT} to {COUNT}(?! times){WHAT}|(?<=[Dd]egree, )\d+ to \d+|(?<=degree )\d+ to \d+"
    rf"|(?<=[,;] )at most (?:0x[0-9A-F]+|{COUNT}){WHAT}|(?<=have )at most {COUNT}{WHAT}"
    rf"|(?<=, )>=? 0\b|(?<=, )\d+ bytes\b|(?<=[a-z], )(?:two|three|\d+) (?:points )?or more|(?<=: )exactly three numbers"
    r"|\"G54\" to \"G59\""
)
# The end of a sentence is a point before white space; "Default" may follow a colon or stand alone.
DEFAULT = re.compile(r"(?:^|(?<=\. )|(?<=; ))Default:? (?:is )?(.+?)\.(?:\s|$)")
REQUIRED = re.compile(r"\bRequired\b[^.]*\.")
ZEROS = {"bool": "false", "string": "empty", "bytes": "empty"}


@dataclass(frozen=True)
class Facts:
    unit: str
    ranges: list[str]
    default: str
    presence: str


def unit(field: Field) -> str:
    for ending, name in NAME_UNITS.items():
        if field.name.endswith(ending):
            return name
    if field.type_name not in ("double", "float"):
        return ""
    text = " ".join(field.comment.split())
    for pattern, name in COMMENT_UNITS:
        if re.search(pattern, text):
            return name
    return ""


def ranges(field: Field) -> list[str]:
    found = [m.group().strip() for m in RANGES.finditer(" ".join(field.comment.split()))]
    return list(dict.fromkeys(found))


def default(field: Field) -> str:
    found = DEFAULT.search(" ".join(field.comment.split()))
    return re.sub(r"^(true|false|empty): .*", r"\1", found[1]) if found else ""


def presence(contract: Contract, message: Message, field: Field) -> str:
    """What it means that the field is not sent."""
    required = REQUIRED.search(" ".join(field.comment.split()))
    if required:
        return required[0].rstrip(".").lower() if len(required[0]) > len("Required.") else "required"
    if field.oneof:
        return f"choice of {field.oneof}" + (", one is required" if "Required." in message.oneofs[field.oneof] else "")
    if field.repeated:
        return "list"
    if field.type_name in contract.messages or field.optional:
        return "may be left out"
    if field.type_name in contract.enums:
        return f"{contract.enums[field.type_name].values[0].name} when left out"
    return f"{ZEROS.get(field.type_name, '0')} when left out"


def facts(contract: Contract, message: Message, field: Field) -> Facts:
    return Facts(unit(field), ranges(field), default(field), presence(contract, message, field))

"""The parts of the comment of an RPC: what it does, the order of its stream, its errors."""
import re
from dataclasses import dataclass

from .descriptors import Contract, Rpc

STATUS = {
    "CANCELLED": 1, "INVALID_ARGUMENT": 3, "DEADLINE_EXCEEDED": 4, "NOT_FOUND": 5, "RESOURCE_EXHAUSTED": 8,
    "FAILED_PRECONDITION": 9, "UNIMPLEMENTED": 12, "INTERNAL": 13, "UNAVAILABLE": 14,
}
WORDS = r"[A-Z][A-Z_]{3,}(?:,? [A-Z][A-Z_]{3,})*"  # NOT_FOUND, MODEL_NOT_CACHED


@dataclass(frozen=True)
class RpcError:
    codes: list[str]  # status codes, and reasons of ErrorInfo
    text: str


@dataclass(frozen=True)
class RpcComment:
    text: str
    order: list[tuple[list[str], bool]]  # each part of the stream: its events, and whether it comes any number of times
    errors: list[RpcError]
    errors_of: str  # name of the RPC whose errors these are, too, or ""


def _error(text: str) -> RpcError:
    codes = re.match(WORDS, text)
    if codes is None:
        raise SystemExit(f"contract_pages.py: an error of a comment begins with no status code: {text!r}")
    rest = text[codes.end():].strip().removeprefix(":").strip()
    whole = re.fullmatch(r"\((.*)\)", rest)
    return RpcError(re.split(r",? ", codes[0]), whole[1] if whole else rest)


def _errors(text: str) -> list[RpcError]:
    if text.startswith("- "):
        return [_error(" ".join(item.split()).rstrip(".")) for item in re.split(r"(?:^|\n)- ", text) if item.strip()]
    found = []
    for sentence in re.split(r"(?<=\.)\s+(?=[A-Z_]{4,} )", " ".join(text.split())):
        sentence = sentence.rstrip(".")
        if re.match(rf"{WORDS} (?:also|when)\b", sentence):
            found.append(_error(sentence))
        else:  # CODE (why), CODE, CODE REASON (why)
            found += [_error(item) for item in re.split(r", (?=[A-Z_]{4,})(?![^(]*\))", sentence) if item]
    return found


def _order(text: str) -> list[tuple[list[str], bool]]:
    parts = [part.strip() for part in text.split(",")]
    return [(re.findall(r"\w+", part), part.endswith("*")) for part in parts]


def read_comment(contract: Contract, rpc: Rpc) -> RpcComment:
    text, _, errors = re.sub(r"(?:^|\s+)Errors:\s*", "\0", rpc.comment, count=1).partition("\0")
    order = re.search(r"Order of the stream: ([^.]*)\.\s*", text.replace("\n", " "))
    if order:
        text = text.replace("\n", "\v")
        text = re.sub(r"Order of the stream:[^.]*\.[\s\v]?", "", text).replace("\v", "\n").strip()
    inherited = re.match(r"as (?:\w+\.)?(\w+)\.\s*", errors)
    if inherited:
        errors = errors[inherited.end():]
        if inherited[1] not in {r.name for r in contract.rpcs}:
            raise SystemExit(f"contract_pages.py: {rpc.name} has the errors of {inherited[1]}, which is no RPC: correct its comment")
    return RpcComment(text, _order(order[1]) if order else [], _errors(errors) if errors else [], inherited[1] if inherited else "")


def status_codes(contract: Contract, rpc: Rpc) -> set[str]:
    """All status codes that the comment names, those of another RPC included."""
    comment = read_comment(contract, rpc)
    found = {code for error in comment.errors for code in error.codes if code in STATUS}
    for other in contract.rpcs:
        if other.name == comment.errors_of:
            found |= status_codes(contract, other)
    return found

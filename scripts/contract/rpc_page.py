"""The page of an RPC."""
import re
from dataclasses import dataclass
from typing import Any

from .descriptors import Contract, Rpc
from .frame import page
from .markup import Links, Names, blocks, escape, inline, link
from .rpc_comment import STATUS, RpcError, read_comment
from .shorten import shortened, shortened_stream, texts
from .type_sections import TypeSections

PORT = 50051  # of docs/service.md
ANSWER_LINES = 24


@dataclass(frozen=True)
class Example:
    request: str  # JSON, as in its file
    message: dict[str, Any]  # the same, parsed
    answers: list[dict[str, Any]] | None  # None: no server was asked


def command(rpc: Rpc) -> str:
    return (f"node_modules/.bin/buf curl --schema proto --protocol grpc -d @docs/requests/{rpc.name}.json "
            f"http://127.0.0.1:{PORT}/{rpc.path}")


def _decoded(contract: Contract, message: str, values: list[dict[str, Any]], lines: int | None) -> str:
    out = ""
    for path, text in (found for value in values for found in texts(contract, message, value)):
        rows = text.splitlines()
        more = f"\n… {len(rows) - lines} more lines" if lines and len(rows) > lines else ""
        body = "\n".join(rows[:lines]) + more
        out += (f"<details><summary><code>{escape(path)}</code>, decoded</summary>\n"
                f'<pre class="decoded">{escape(body)}</pre>\n</details>\n')
    return out


def _example(contract: Contract, rpc: Rpc, example: Example) -> str:
    out = (f'<section id="example">\n<h2>Worked request</h2>\n<p><code>docs/requests/{rpc.name}.json</code></p>\n'
           f'<pre class="request">{escape(example.request.rstrip())}</pre>\n'
           + _decoded(contract, rpc.request, [example.message], None)
           + "<p>Start the server with <code>build/release/bin/patchmilld</code>. From the folder of the repository:</p>\n"
           f'<pre class="command">{escape(command(rpc))}</pre>\n'
           "<p><code>--schema proto</code> may be left out: the server has reflection.</p>\n")
    if example.answers is None:
        return out + "<p>These pages were made without a server, so the answer is not shown.</p>\n</section>\n"
    text = shortened_stream(example.answers) if rpc.streams else shortened(example.answers[0])
    return (out + "<h3>The answer</h3>\n<p>As the server gave it, shortened where the sign … stands. Zeros and empty values are left out. "
            "<code>buf</code> writes the names of fields as <code>camelCase</code>, and reads both.</p>\n"
            f'<pre class="answer">{escape(text)}</pre>\n'
            + _decoded(contract, rpc.response, example.answers, ANSWER_LINES) + "</section>\n")


def _stream(rpc: Rpc, order: list[tuple[list[str], bool]], links: Links) -> str:
    if not rpc.streams:
        return "<p>One request, one answer.</p>\n"
    if not order:
        raise SystemExit(f"contract_pages.py: the comment of {rpc.name} does not state the order of the stream: add it")
    out = "<p>One request; the answer is a stream. Its events come in this order:</p>\n<ol>\n"
    for events, many in order:
        named = [link(links(f"{rpc.response}.{event}"), f"<code>{event}</code>") for event in events]
        out += f'<li>{" or ".join(named)}{", any number of times" if many else ", once"}</li>\n'
    return out + "</ol>\n"


def _error_list(errors: list[RpcError], names: Names, links: Links) -> str:
    out, reason = "", ' class="reason"'
    codes: list[str] = []
    for k, error in enumerate(errors):
        codes += error.codes
        if not error.text and k + 1 < len(errors) and not errors[k + 1].text:
            continue  # the next one says no more either: one line for both
        shown = ", ".join(f"<code{'' if c in STATUS else reason}>{c}</code>" for c in codes)
        out += f"<li>{shown}{': ' if error.text else ''}{inline(error.text, names, links)}</li>\n"
        codes = []
    return f"<ul>\n{out}</ul>\n" if out else ""


def _errors(contract: Contract, rpc: Rpc, names: Names, links: Links) -> str:
    comment = read_comment(contract, rpc)
    out = _error_list(comment.errors, names, links)
    if comment.errors_of:
        other = next(r for r in contract.rpcs if r.name == comment.errors_of)
        out += f"<p>{'And as' if out else 'As'} {link(links(other.name), other.name)}:</p>\n" + _errors(contract, other, names, links)
    return out


def rpc_page(contract: Contract, rpc: Rpc, names: Names, sections: TypeSections, links: Links, example: Example) -> str:
    comment = read_comment(contract, rpc)
    of_request, of_response = contract.reached(rpc.request), contract.reached(rpc.response)
    others = [n for n in dict.fromkeys(of_request + of_response) if n not in (rpc.request, rpc.response)]
    shown = {rpc.request, rpc.response, *others}
    chips = "".join(f'<li>{link(f"#{name}", name)}</li>' for name in sorted(shown))
    out = (f"<h1>{rpc.name}</h1>\n<p><code>{rpc.path}</code></p>\n"
           f'<div class="text">{blocks(comment.text, names, links)}</div>\n{_stream(rpc, comment.order, links)}'
           '<nav><a href="#example">Worked request</a> <a href="#errors">Errors</a> <a href="#request">Request</a> '
           '<a href="#response">Answer</a> <a href="#types">Messages and enums</a></nav>\n'
           f"<details><summary>All {len(shown)} messages and enums of this page</summary>\n<ul class=\"chips\">{chips}</ul>\n</details>\n")
    out += _example(contract, rpc, example)
    # A comment of a service may say what a status means in all its RPCs.
    sentences = re.split(r"(?<=\.)\s+", contract.services[rpc.service])
    of_service = [sentence for sentence in sentences if sentence.partition(" ")[0] in STATUS]
    out += f'<section id="errors">\n<h2>Errors</h2>\n{_errors(contract, rpc, names, links)}'
    out += f"<p>{inline(' '.join(of_service), names, links)}</p>\n" if of_service else ""
    out += '<p><a href="errors.html">How an error looks, and all reasons</a></p>\n</section>\n'
    for anchor, title, name in (("request", "Request", rpc.request), ("response", "Answer", rpc.response)):
        out += f'<h2 id="{anchor}">{title}</h2>\n' + sections.section(name, links, shown)
    out += '<h2 id="types">Messages and enums</h2>\n'
    out += "".join(sections.section(name, links, shown) for name in others)
    return page(rpc.name, out)

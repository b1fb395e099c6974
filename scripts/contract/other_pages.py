"""The index, the page of errors, and the page of messages that no RPC carries."""
import json
import pathlib
import re
from typing import Any

from .descriptors import Contract
from .frame import page
from .markup import Links, Names, blocks, escape, inline, link
from .rpc_comment import STATUS, read_comment, status_codes
from .type_sections import TypeSections

ERROR_TYPES = ("Status", "ErrorInfo")
SEARCH = (pathlib.Path(__file__).parent / "search.js").read_text()


def error_types(contract: Contract) -> list[str]:
    return contract.reached(*ERROR_TYPES)


def types_without_rpc(contract: Contract) -> list[str]:
    """Messages and enums that neither an RPC nor an error carries."""
    carried = {name for rpc in contract.rpcs for name in contract.reached(rpc.request, rpc.response)}
    carried |= set(error_types(contract))
    return [name for name in [*contract.messages, *contract.enums] if name not in carried]


def errors_page(contract: Contract, sections: TypeSections, links: Links, example: dict[str, Any] | None) -> str:
    rows = ""
    for status, number in STATUS.items():
        using = [link(links(rpc.name), rpc.name) for rpc in contract.rpcs if status in status_codes(contract, rpc)]
        rows += f'<dt><code>{status}</code> = {number}</dt>\n<dd>{", ".join(using) or "No comment of an RPC names it."}</dd>\n'
    out = ("<h1>Errors</h1>\n<p>A call that fails has a status code, a message for a person, and in the trailer "
           f"<code>grpc-status-details-bin</code> a {link(links('Status'), 'Status')} with one {link(links('ErrorInfo'), 'ErrorInfo')} "
           "for programs. Findings about a model or a program are no errors: "
           f"they are {link(links('Diagnostic'), 'Diagnostic')} messages in the answer.</p>\n")
    if example is not None:
        out += ("<h2>A wrong field</h2>\n<p>The worked request of "
                f"{link(links('GenerateProgram'), 'GenerateProgram')} with a scallop of 9 mm, as the server answers it:</p>\n"
                f'<pre class="answer">{escape(json.dumps(example, indent=2, ensure_ascii=False))}</pre>\n')
    out += ("<h2>Status codes</h2>\n<p>With the RPCs whose comments name them.</p>\n"
            f'<dl class="errors">\n{rows}</dl>\n<h2>The details of an error</h2>\n')
    shown = set(error_types(contract))
    out += "".join(sections.section(name, links, shown) for name in error_types(contract))
    return page("Errors", out)


def types_page(contract: Contract, sections: TypeSections, links: Links) -> str:
    listed = types_without_rpc(contract)
    out = ("<h1>Messages without an RPC</h1>\n<p>Neither a request, nor an answer, nor an error of an RPC "
           "carries these.</p>\n")
    return page("Messages without an RPC", out + "".join(sections.section(name, links, set(listed)) for name in listed))


def index_page(contract: Contract, names: Names, links: Links) -> str:
    out = ("<h1>Patchmill contract</h1>\n<p>All RPCs of <code>proto/patchmill/v1</code>, each with a worked request, its messages, fields "
           "and enum values. The server also has <code>grpc.health.v1.Health</code> and server reflection.</p>\n"
           '<p id="search" hidden><label>Search <input type="search" placeholder="scallop, OUTPUT_PATHS, ErrorInfo"></label> '
           '<span role="status"></span></p>\n<ul id="found" class="found"></ul>\n')
    for service, comment in contract.services.items():
        out += f'<h2 id="{service}">{service}</h2>\n<div class="text">{blocks(comment, names, links)}</div>\n<dl class="rpcs">\n'
        for rpc in contract.rpcs:
            if rpc.service == service:
                first = re.split(r"(?<=\.)\s", " ".join(read_comment(contract, rpc).text.split()))[0]
                out += f"<dt>{link(links(rpc.name), rpc.name)}</dt>\n<dd>{inline(first, names, links)}</dd>\n"
        out += "</dl>\n"
    out += ('<h2>More</h2>\n<dl class="rpcs">\n<dt><a href="errors.html">Errors</a></dt>\n<dd>Status codes, reasons, details.</dd>\n'
            '<dt><a href="types.html">Messages without an RPC</a></dt>\n'
            "<dd>Types that no request, no answer and no error carries.</dd>\n</dl>\n")
    everything = [rpc.name for rpc in contract.rpcs]
    for message in contract.messages.values():
        everything += [message.name, *(f"{message.name}.{field.name}" for field in message.fields)]
    for enum in contract.enums.values():
        everything += [enum.name, *(f"{enum.name}.{value.name}" for value in enum.values)]
    rows = "\n".join(f"<li>{link(links(name), name)}</li>" for name in everything)
    out += f'<details id="names"><summary>All {len(everything):,} names</summary>\n<ul class="found">\n{rows}\n</ul>\n</details>\n'
    return page("Patchmill contract", out + f"<script>\n{SEARCH}</script>", home=True)

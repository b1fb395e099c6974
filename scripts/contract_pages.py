#!/usr/bin/python3
"""Writes the contract, proto/patchmill/v1, as HTML: an index, and a page with a worked request for each RPC.

usage: contract_pages.py OUTDIR [--server PATCHMILLD | --no-answers]

The answers on the pages are those of a patchmilld that the script starts on this machine, by default
build/release/bin/patchmilld. It needs protobuf-compiler, python3-protobuf and python3-grpcio (Debian).
"""
import argparse
import json
import pathlib
from typing import Any

from contract.calls import Types, call, documents_in, refusal, server
from contract.descriptors import Contract, descriptor_set, read_contract
from contract.markup import Links, Names
from contract.other_pages import error_types, errors_page, index_page, types_page, types_without_rpc
from contract.rpc_page import Example, rpc_page
from contract.type_sections import TypeSections

ROOT = pathlib.Path(__file__).resolve().parents[1]


def request_text(name: str) -> str:
    path = ROOT / "docs/requests" / f"{name}.json"
    if not path.is_file():
        raise SystemExit(f"contract_pages.py: {path.relative_to(ROOT)} is missing: each RPC needs a worked request")
    return path.read_text()


def pages_of_types(contract: Contract) -> dict[str, list[str]]:
    """The types that each page has."""
    pages = {f"{rpc.name}.html": contract.reached(rpc.request, rpc.response) for rpc in contract.rpcs}
    return pages | {"errors.html": error_types(contract), "types.html": types_without_rpc(contract)}


def links_of(page: str, pages: dict[str, list[str]], contract: Contract) -> Links:
    """Links to the page itself where it has the type, else to the page that has it and is about it."""
    own = set(pages.get(page, []))
    rpcs = {rpc.name for rpc in contract.rpcs}
    ends = {name: f"{rpc.name}.html" for rpc in contract.rpcs for name in (rpc.request, rpc.response)}

    def links(name: str) -> str:
        if name in rpcs:
            return f"{name}.html"
        of_type = name.partition(".")[0]
        if of_type in own:
            return f"#{name}"
        where = ends.get(of_type) or next((p for p, types in pages.items() if of_type in types), "")
        return f"{where}#{name}" if where else ""

    return links


def with_scallop(request: str, scallop_mm: float) -> str:
    message = json.loads(request)
    message["job"]["operations"][0]["scallop_mm"] = scallop_mm
    return json.dumps(message)


def write_pages(out: pathlib.Path, program: pathlib.Path | None) -> None:
    """`program`: the server; None: no answers."""
    files = descriptor_set(ROOT / "proto")
    contract, types = read_contract(files), Types(files)
    requests = {rpc.name: request_text(rpc.name) for rpc in contract.rpcs}
    answers: dict[str, Any] = {}
    error = None
    if program is not None:
        with server(program) as address:
            answers = {rpc.name: call(address, types, rpc, requests[rpc.name]) for rpc in contract.rpcs}
            generate = next(rpc for rpc in contract.rpcs if rpc.name == "GenerateProgram")
            error = refusal(address, types, generate, with_scallop(requests[generate.name], 9))
    names, pages = Names(contract), pages_of_types(contract)
    sections = TypeSections(contract, names)
    written = {}
    for rpc in contract.rpcs:
        text = requests[rpc.name]
        name = f"{rpc.name}.html"
        example = Example(text, documents_in(text)[0], answers.get(rpc.name))
        written[name] = rpc_page(contract, rpc, names, sections, links_of(name, pages, contract), example)
    written["errors.html"] = errors_page(contract, sections, links_of("errors.html", pages, contract), error)
    written["types.html"] = types_page(contract, sections, links_of("types.html", pages, contract))
    written["index.html"] = index_page(contract, names, links_of("index.html", pages, contract))
    out.mkdir(parents=True, exist_ok=True)
    for name, text in written.items():
        (out / name).write_text(text)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("outdir", type=pathlib.Path, metavar="OUTDIR", help="folder of the pages, for example build/contract")
    choice = parser.add_mutually_exclusive_group()
    choice.add_argument("--server", type=pathlib.Path, metavar="PATCHMILLD", default=ROOT / "build/release/bin/patchmilld",
                        help="the program whose answers are shown; default: build/release/bin/patchmilld")
    choice.add_argument("--no-answers", action="store_true", help="start no server, and show no answers")
    args = parser.parse_args()
    if not args.no_answers and not args.server.is_file():
        parser.error(f"--server {args.server}: there is no such program; build it, name another one, or use --no-answers")
    write_pages(args.outdir, None if args.no_answers else args.server.resolve())
    print(args.outdir / "index.html")


if __name__ == "__main__":
    main()

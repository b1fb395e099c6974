"""Comments as HTML, with links to what they name."""
import html
import re
from collections.abc import Callable

from .descriptors import Contract

Links = Callable[[str], str]  # address of "Job", "Job.source", "Output.OUTPUT_PATHS" or an RPC from this page; "" for none

# A word, or a word with a field: Stock.allowance_mm, PatchModel, OUTPUT_PATHS, steep_angle_deg.
NAME = re.compile(r"(?<![\w.])[A-Za-z]\w*(?:\.[A-Za-z]\w*)?")


def escape(text: str) -> str:
    return html.escape(text, quote=True)


def link(address: str, text: str) -> str:
    return f'<a href="{escape(address)}">{text}</a>' if address else text


class Names:
    """What a word of a comment stands for."""

    def __init__(self, contract: Contract) -> None:
        self.known = {rpc.name for rpc in contract.rpcs}
        self.values: dict[str, str] = {}
        for message in contract.messages.values():
            self.known.add(message.name)
            self.known |= {f"{message.name}.{field.name}" for field in message.fields}
        for enum in contract.enums.values():
            self.known.add(enum.name)
            for value in enum.values:
                self.values[value.name] = f"{enum.name}.{value.name}"

    def meaning(self, word: str, owner: str) -> str:
        if word in self.values:
            return self.values[word]
        if re.fullmatch(r"\w+Service\.\w+", word):
            word = word.partition(".")[2]
        # A name of one word, such as Tool, is a word of English as well: it is a link only with a field.
        if word in self.known and ("." in word or len(re.findall("[A-Z]", word)) > 1):
            return word
        own = f"{owner}.{word}"
        return own if "_" in word and own in self.known else ""


def inline(text: str, names: Names, links: Links, owner: str = "") -> str:
    """One paragraph of a comment. `owner` is the message whose fields the comment may name alone."""
    def named(match: re.Match[str]) -> str:
        meaning = names.meaning(match[0], owner)
        return link(links(meaning), match[0]) if meaning else match[0]

    def marked(part: str) -> str:
        return NAME.sub(named, escape(part))

    parts = re.split(r"`([^`]*)`", " ".join(text.split()))
    return "".join(f"<code>{marked(part)}</code>" if k % 2 else marked(part) for k, part in enumerate(parts))


def blocks(text: str, names: Names, links: Links, owner: str = "") -> str:
    """A comment: paragraphs, and lists whose items begin with "- "."""
    out: list[str] = []
    for paragraph in re.split(r"\n\s*\n", text.strip()):
        lines = paragraph.splitlines()
        runs: list[tuple[str, list[str]]] = []  # ("p" or "li", lines)
        for line in lines:
            if line.startswith("- "):
                runs.append(("li", [line[2:]]))
            elif runs and (runs[-1][0] == "p" or line.startswith("  ")):
                runs[-1][1].append(line)
            else:
                runs.append(("p", [line]))
        for k, (kind, run) in enumerate(runs):
            content = inline(" ".join(run), names, links, owner)
            if kind == "p":
                out.append(f"<p>{content}</p>")
                continue
            first = k == 0 or runs[k - 1][0] == "p"
            last = k + 1 == len(runs) or runs[k + 1][0] == "p"
            out.append(("<ul>" if first else "") + f"<li>{content}</li>" + ("</ul>" if last else ""))
    return "\n".join(out)

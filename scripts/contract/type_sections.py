"""Messages and enums as sections of a page."""
import itertools

from .descriptors import Contract, Enum, Field, Message
from .facts import facts
from .markup import Links, Names, blocks, escape, inline, link


class TypeSections:
    def __init__(self, contract: Contract, names: Names) -> None:
        self.contract, self.names = contract, names
        self.holders: dict[str, list[str]] = {}  # fields of each type
        for message in contract.messages.values():
            for field in message.fields:
                self.holders.setdefault(field.type_name, []).append(f"{message.name}.{field.name}")

    def section(self, name: str, links: Links, shown: set[str]) -> str:
        """`shown`: the types of the page."""
        if name in self.contract.enums:
            return self._enum(self.contract.enums[name], links, shown)
        return self._message(self.contract.messages[name], links, shown)

    def _head(self, kind: str, name: str, file: str, comment: str, links: Links, shown: set[str]) -> str:
        holders = [h for h in self.holders.get(name, []) if h.partition(".")[0] in shown]
        used = ", ".join(link(links(h), escape(h)) for h in holders)
        return (f'<section class="type" id="{name}">\n<h3>{link(f"#{name}", name)} <small>{kind}, {escape(file)}</small></h3>\n'
                f'<div class="text">{blocks(comment, self.names, links, name)}</div>\n'
                + (f'<p class="used">In {used}</p>\n' if used else ""))

    def _field(self, message: Message, field: Field, links: Links) -> str:
        known = facts(self.contract, message, field)
        repeated = "list of " if field.repeated else ""
        shown = [f'<b class="{"must" if known.presence.startswith("required") else "may"}">'
                 f"{inline(known.presence, self.names, links, message.name)}</b>"]
        shown += [f'<span class="unit">{escape(known.unit)}</span>'] if known.unit else []
        shown += [f'<span class="range">{escape(r)}</span>' for r in known.ranges]
        shown += [f'<span class="default">default {inline(known.default, self.names, links, message.name)}</span>'] if known.default else []
        shown += [f'<span class="number">field {field.number}</span>']
        shown += ["<b>deprecated</b>"] if field.deprecated else []
        return (f'<div class="field" id="{message.name}.{field.name}">\n'
                f'<p class="name"><code>{field.name}</code> <span class="kind">{repeated}'
                f"{link(links(field.type_name), escape(field.type_name))}</span></p>\n"
                f'<p class="facts">{" ".join(shown)}</p>\n'
                f'<div class="text">{blocks(field.comment, self.names, links, message.name)}</div>\n</div>\n')

    def _message(self, message: Message, links: Links, shown: set[str]) -> str:
        out = self._head("message", message.name, message.file, message.comment, links, shown)
        for oneof, fields in itertools.groupby(message.fields, key=lambda f: f.oneof):
            rows = "".join(self._field(message, field, links) for field in fields)
            if oneof:
                comment = inline(message.oneofs[oneof], self.names, links, message.name)
                rows = f'<div class="oneof">\n<p>One of <code>{oneof}</code>: {comment}</p>\n{rows}</div>\n'
            out += rows
        return out + ("" if message.fields else "<p>No fields.</p>\n") + "</section>\n"

    def _enum(self, enum: Enum, links: Links, shown: set[str]) -> str:
        out = self._head("enum", enum.name, enum.file, enum.comment, links, shown)
        for value in enum.values:
            out += (f'<div class="field" id="{enum.name}.{value.name}">\n'
                    f'<p class="name"><code>{value.name}</code> <span class="kind">= {value.number}</span></p>\n'
                    f'<div class="text">{blocks(value.comment, self.names, links)}</div>\n</div>\n')
        return out + "</section>\n"

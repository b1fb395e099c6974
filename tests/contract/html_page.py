"""A page as a reader's browser has to understand it: its elements, its links, and what is not valid in it."""
import pathlib
from html import entities, unescape
from html.parser import HTMLParser

VOID = {"meta", "input", "br", "hr", "link", "img"}
# A paragraph ends where one of these begins, whatever the author meant.
BLOCKS = {"p", "div", "section", "pre", "ul", "ol", "dl", "h1", "h2", "h3", "details", "nav", "header", "main"}
CHILDREN = {"ul": {"li"}, "ol": {"li"}, "dl": {"dt", "dd"}, "html": {"head", "body"}}
PARENTS = {"li": {"ul", "ol"}, "dt": {"dl"}, "dd": {"dl"}, "summary": {"details"}}


class HtmlPage(HTMLParser):
    def __init__(self, path: pathlib.Path) -> None:
        super().__init__(convert_charrefs=False)
        self.name = path.name
        self.faults: list[str] = []
        self.links: list[str] = []
        self.sources: list[str] = []  # what a browser would load
        self.titles: list[str] = []
        self.texts: dict[str, str] = {}  # text of each element with an id
        self.pre: dict[str, list[str]] = {}  # text of the <pre> of each class
        self.style = ""
        self.links_in: dict[str, list[str]] = {}  # links in each element with an id
        self._open: list[tuple[str, str, int, str]] = []  # tag, id, start of its text, class
        self._text: list[str] = []
        self.feed(path.read_text())
        self.close()
        self._check(not self._open, f"not closed: {[tag for tag, *_ in self._open]}")

    def _check(self, good: bool, fault: str) -> None:
        if not good:
            self.faults.append(f"{self.name}:{self.getpos()[0]}: {fault}")

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self._check(len(given) == len(attrs), f"<{tag}> has an attribute twice")
        tags = [open_tag for open_tag, *_ in self._open]
        parent = tags[-1] if tags else ""
        self._check(not (tag in BLOCKS and ("p" in tags or "a" in tags)), f"<{tag}> within {tags}")
        self._check(not (tag == "a" and "a" in tags), "<a> within <a>")
        self._check(parent not in CHILDREN or tag in CHILDREN[parent], f"<{tag}> within <{parent}>")
        self._check(tag not in PARENTS or parent in PARENTS[tag], f"<{tag}> within <{parent}>")
        if "id" in given:
            self._check(given["id"] not in self.texts, f"the id {given['id']} is there twice")
            self.texts[given["id"]] = ""
        if tag == "a":
            self.links.append(given.get("href", ""))
            for _, name, *_ in self._open:
                if name:
                    self.links_in.setdefault(name, []).append(given.get("href", ""))
        self.sources += [given[name] for name in ("src", "srcset", "data", "action") if name in given]
        self.sources += [given["href"]] if tag == "link" else []
        if tag not in VOID:
            self._open.append((tag, given.get("id", ""), len(self._text), given.get("class", "")))

    def handle_endtag(self, tag: str) -> None:
        if not self._open or self._open[-1][0] != tag:
            self._check(False, f"</{tag}> closes {self._open[-1][0] if self._open else 'nothing'}")
            return
        _, name, start, kind = self._open.pop()
        text = "".join(self._text[start:])
        if name:
            self.texts[name] = text
        if tag == "pre":
            self.pre.setdefault(kind, []).append(text)
        if tag == "title":
            self.titles.append(text)

    def handle_data(self, data: str) -> None:
        if self._open and self._open[-1][0] == "style":
            self.style += data
        elif not self._open or self._open[-1][0] != "script":
            self._check("<" not in data and "&" not in data, f"a bare sign of HTML in {data!r}")
            self._text.append(data)

    def handle_entityref(self, name: str) -> None:
        self._check(f"{name};" in entities.html5, f"no such entity: {name}")
        self._text.append(entities.html5.get(f"{name};", ""))

    def handle_charref(self, name: str) -> None:
        self._text.append(unescape(f"&#{name};"))

    @property
    def text(self) -> str:
        return "".join(self._text)

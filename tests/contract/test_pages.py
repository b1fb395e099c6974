"""The pages have every RPC, field and enum value with its comment; links resolve, and the HTML is valid."""
import pathlib
import re
import subprocess
import tempfile
import unittest

from google.protobuf import descriptor_pb2

from html_page import HtmlPage
from support import PATCHMILLD, ROOT, SCRIPT, Runtime, closure, comments, protoc

from contract_pages import request_text

FILES = protoc()
CONTRACT = Runtime(FILES)
OTHERS = {"index.html", "errors.html", "types.html"}
PAGES: dict[str, HtmlPage] = {}


def setUpModule() -> None:
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "made/contract"
        run = subprocess.run([SCRIPT, out, "--server", PATCHMILLD], capture_output=True, text=True)
        assert run.returncode == 0, run.stderr
        assert run.stdout == f"{out / 'index.html'}\n", run.stdout
        PAGES.update({path.name: HtmlPage(path) for path in out.iterdir()})


def missing(pages: dict[str, HtmlPage], contract: Runtime) -> list[str]:
    """What the contract has and the pages lack: the page of an RPC has all that it carries."""
    lost = []
    anywhere = {name for page in pages.values() for name in page.texts}
    for method in contract.methods:
        page = pages.get(f"{method.name}.html")
        if page is None:
            lost.append(method.name)
            continue
        messages, enums = closure(method.input_type, method.output_type)
        lost += [f"{method.name}: {name}" for name in names(messages.values(), enums.values()) if name not in page.texts]
    return lost + [name for name in names(contract.messages, contract.enums) if name not in anywhere]


def names(messages, enums):
    for message in messages:
        yield message.name
        yield from (f"{message.name}.{field.name}" for field in message.fields)
    for enum in enums:
        yield enum.name
        yield from (f"{enum.name}.{value.name}" for value in enum.values)


def letters(text: str) -> str:
    """The text without white space and the marks of lists and code."""
    return re.sub(r"\s|`|(?<=\s)- |^- ", "", text)


class Coverage(unittest.TestCase):
    def test_nothing_is_missing(self):
        self.assertEqual(missing(PAGES, CONTRACT), [])
        self.assertEqual(set(PAGES), {f"{method.name}.html" for method in CONTRACT.methods} | OTHERS)
        self.assertGreaterEqual(len(CONTRACT.methods), 13)

    def test_a_new_rpc_field_or_value_would_be_missed(self):
        files = descriptor_pb2.FileDescriptorSet.FromString(FILES.SerializeToString())
        by_name = {file.name.rpartition("/")[2]: file for file in files.file}
        tool = next(m for m in by_name["tool.proto"].message_type if m.name == "Tool")
        tool.field.add(name="corner_radius_mm", number=999, type=1, label=1)
        by_name["region.proto"].enum_type[0].value.add(name="BORDER_KIND_NEW", number=999)
        by_name["import.proto"].message_type[0].field.add(name="alone", number=999, type=1, label=1)
        by_name["toolpath_service.proto"].service[0].method.add(
            name="SimulateProgram", input_type=".patchmill.v1.ListPostsRequest", output_type=".patchmill.v1.ListPostsResponse")
        enum = by_name["region.proto"].enum_type[0].name
        lost = missing(PAGES, Runtime(files))
        for name in ("SimulateProgram", "CheckModel: Tool.corner_radius_mm", "Tool.corner_radius_mm",
                     f"GenerateProgram: {enum}.BORDER_KIND_NEW", "ImportResult.alone"):
            self.assertIn(name, lost)

    def test_comments_are_whole(self):
        count = 0
        for name, comment in comments(FILES):
            if f"{name}.html" in PAGES:  # an RPC: the sections of its page have the parts of its comment
                continue
            self.assertTrue(comment.strip(), name)
            for page in PAGES.values():
                if name in page.texts:
                    self.assertIn(letters(comment), letters(page.texts[name]), f"{page.name}: {name}")
                    count += 1
        self.assertGreater(count, 1000)

    def test_the_comment_of_an_rpc(self):
        of = dict(comments(FILES))
        for method in CONTRACT.methods:
            comment, page = " ".join(of[method.name].split()), PAGES[f"{method.name}.html"]
            before, _, errors = comment.partition("Errors:")
            self.assertTrue(errors, method.name)
            for code in re.findall(r"\b[A-Z]{4,}(?:_[A-Z]+)*\b", errors):
                self.assertIn(code, page.texts["errors"], method.name)
            words = set(re.findall(r"\w+", errors)) - {"as", "ToolpathService", "ModelService"}
            self.assertLessEqual(words, set(re.findall(r"\w+", page.texts["errors"])), method.name)
            if re.match(r"\s*as (ToolpathService\.)?GenerateProgram\.", errors):
                self.assertIn("FAILED_PRECONDITION, REGIONS_STALE", page.texts["errors"], method.name)
            text = re.sub(r"\s*Order of the stream:[^.]*\.", "", " ".join(before.split()))
            self.assertIn(letters(text), letters(page.text), method.name)

    def test_the_worked_request_of_an_rpc(self):
        for method in CONTRACT.methods:
            page = PAGES[f"{method.name}.html"]
            file = f"docs/requests/{method.name}.json"
            self.assertEqual(page.pre["request"], [(ROOT / file).read_text().rstrip()])
            self.assertEqual(len(page.pre["answer"]), 1)
            self.assertIn(f"@{file} http://127.0.0.1:50051/{method.containing_service.full_name}/{method.name}", page.pre["command"][0])
        self.assertIn("G21", "".join(PAGES["GenerateProgram.html"].pre["decoded"]))  # the program, which JSON has as base64

    def test_the_order_of_a_stream(self):
        self.assertRegex(" ".join(PAGES["GenerateProgram.html"].text.split()),
                         "in this order: accepted, once progress or regions or paths or arc or path_block or mesh, any number of times "
                         "artifact, any number of times program, any number of times report, once")
        self.assertIn("One request, one answer.", PAGES["CheckModel.html"].text)


class Fields(unittest.TestCase):
    def facts(self, page: str, name: str) -> str:
        return " ".join(PAGES[page].texts[name].split())

    def test_what_a_field_states(self):
        for page, name, facts in (
            ("GenerateProgram.html", "Operation.scallop_mm", "double required mm (0, ball radius) field 3"),
            ("GenerateProgram.html", "Stock.allowance_mm",
             "double may be left out mm [0, 100] default 0.5, or the stock to leave if that is more field 2"),
            ("GenerateProgram.html", "Job.operations", "list of Operation list field 3"),
            ("GenerateProgram.html", "Post.unit", "LengthUnit LENGTH_UNIT_UNSPECIFIED when left out default millimetres field 3"),
            ("GenerateProgram.html", "MachineAxis.acceleration_mm_per_s2", "double 0 when left out mm/s^2 [0.1, 1e6] field 5"),
            ("GenerateProgram.html", "Heights.low_rapids", "bool false when left out field 6 deprecated"),
            ("CheckModel.html", "ModelSource.file", "ModelFile choice of source, one is required field 3"),
            ("EditModel.html", "BendSection.curvature", "double 0 when left out 1/length_unit field 4"),
            ("FairNet.html", "CurvePoints.points_mm", "list of double list mm 2 to 100,000 field 1"),
            ("FairNet.html", "FairNetRequest.line_count", "int32 required 2 or more field 3"),
            ("errors.html", "ErrorInfo.field_violations", "list of FieldViolation list at most 20 field 2"),
        ):
            self.assertEqual(self.facts(page, name).partition(" ")[2][:len(facts)], facts, name)

    def test_units_and_ranges_of_all_fields(self):
        units, ranges = 0, 0
        for name, comment in comments(FILES):
            where = next((page.name for page in PAGES.values() if name in page.texts), None)
            if where is None or "." not in name:
                continue
            head = self.facts(where, name).partition(" field ")[0]
            for ending, unit in (("_mm", "mm"), ("_deg", "degrees"), ("_mm2", "mm2"), ("_mm_per_min", "mm/min"), ("_rpm", "1/min")):
                if name.endswith(ending) and not name.endswith("_per_mm"):
                    self.assertRegex(head, rf" {re.escape(unit)}( |$)", name)
                    units += 1
            if name.partition(".")[2].isupper():  # a value of an enum
                continue
            for interval in re.findall(r"[\[(]-?[\d.e-]+, (?:-?[\d.e]+|(?:half the )?ball radius)[\])]", " ".join(comment.split())):
                self.assertIn(interval, head, name)
                ranges += 1
        self.assertGreater(units, 150)
        self.assertGreater(ranges, 80)


class Html(unittest.TestCase):
    def test_valid(self):
        for page in PAGES.values():
            self.assertEqual(page.faults, [])
            self.assertEqual(len(page.titles), 1, page.name)

    def test_links_resolve(self):
        count = 0
        for page in PAGES.values():
            for address in page.links:
                name, _, anchor = address.partition("#")
                target = PAGES.get(name) if name else page
                self.assertIsNotNone(target, f"{page.name}: {address}")
                if anchor:
                    self.assertIn(anchor, target.texts, f"{page.name}: {address}")
                count += 1
        self.assertGreater(count, 3000)

    def test_types_are_links_on_the_same_page(self):
        for method in CONTRACT.methods:
            page = PAGES[f"{method.name}.html"]
            for message in closure(method.input_type, method.output_type)[0].values():
                for field in message.fields:
                    kind = field.message_type or field.enum_type
                    if kind is not None:
                        self.assertIn(f"#{kind.name}", page.links_in[f"{message.name}.{field.name}"])

    def test_no_network(self):
        for page in PAGES.values():
            self.assertEqual(page.sources, [])
            self.assertIn("prefers-color-scheme: dark", page.style)
            self.assertNotRegex(page.style, r"url\(|@import")
            self.assertFalse([a for a in page.links if ":" in a], page.name)

    def test_the_index_without_a_script(self):
        index = PAGES["index.html"]
        for method in CONTRACT.methods:
            self.assertIn(f"{method.name}.html", index.links)
        for message in CONTRACT.messages:
            for field in message.fields:
                self.assertIn(f"{message.name}.{field.name}", index.texts["names"])


class Script(unittest.TestCase):
    def test_without_answers(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([SCRIPT, folder, "--no-answers"], check=True, capture_output=True)
            page = HtmlPage(pathlib.Path(folder) / "ListPosts.html")
        self.assertNotIn("answer", page.pre)
        self.assertIn("answer", PAGES["ListPosts.html"].pre)
        self.assertIn("the answer is not shown", page.texts["example"])

    def test_an_rpc_without_a_request(self):
        with self.assertRaisesRegex(SystemExit, "docs/requests/SimulateProgram.json is missing: each RPC needs"):
            request_text("SimulateProgram")

    def test_no_such_server(self):
        with tempfile.TemporaryDirectory() as folder:
            run = subprocess.run([SCRIPT, folder, "--server", f"{folder}/patchmilld"], capture_output=True, text=True)
            self.assertEqual(run.returncode, 2)
            self.assertIn(f"--server {folder}/patchmilld: there is no such program; build it", run.stderr)
            self.assertEqual(list(pathlib.Path(folder).iterdir()), [])


if __name__ == "__main__":
    unittest.main()

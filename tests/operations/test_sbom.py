"""The bill of materials: valid SPDX 2.3, and the libraries that the loader really takes."""
import base64
import json
import os
import re
import subprocess
import unittest

from support import BIN, PATCHMILL, PATCHMILLD, ROOT, Folder

SCRIPT = ROOT / "scripts/sbom.py"
LOCK = ROOT / "clients/viewer/package-lock.json"
PROGRAMS = [program for program in (PATCHMILL, PATCHMILLD, BIN / "patchmill-import") if program.exists()]
# The required fields of https://github.com/spdx/spdx-spec, v2.3, schemas/spdx-schema.json.
REQUIRED = {"": {"SPDXID", "creationInfo", "dataLicense", "documentNamespace", "name", "spdxVersion"},
            "creationInfo": {"created", "creators"}, "packages": {"SPDXID", "downloadLocation", "name"},
            "files": {"SPDXID", "checksums", "fileName"}, "checksums": {"algorithm", "checksumValue"},
            "externalRefs": {"referenceCategory", "referenceLocator", "referenceType"},
            "relationships": {"relatedSpdxElement", "relationshipType", "spdxElementId"}}
KINDS = {"DESCRIBES", "CONTAINS", "DYNAMIC_LINK", "STATIC_LINK"}


def made(*words, **env):
    run = subprocess.run(["/usr/bin/python3", SCRIPT, *map(str, words)], capture_output=True, text=True, env={**os.environ, **env})
    assert run.returncode == 0, run.stderr
    return run.stdout


def objects(value, name=""):
    """All objects of a document, with the name of the field in which each stands."""
    if isinstance(value, list):
        for one in value:
            yield from objects(one, name)
    elif isinstance(value, dict):
        yield name, value
        for field, one in value.items():
            yield from objects(one, field)


def owners(paths):
    """The packages of files, by way of the links that lead to them."""
    ways = {way for path in paths for way in (path, os.path.realpath(path), "/usr" + path, os.path.realpath(path).removeprefix("/usr"))}
    said = subprocess.run(["dpkg", "-S", *sorted(ways)], capture_output=True, text=True).stdout
    return {line.split(":")[0] for line in said.splitlines()}


class Sbom(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.document = json.loads(made(*PROGRAMS, "--lock", LOCK))
        cls.packages = {package["SPDXID"]: package for package in cls.document["packages"]}

    def related(self, kind, one):
        return [r["relatedSpdxElement"] for r in self.document["relationships"]
                if r["relationshipType"] == kind and r["spdxElementId"] == one]

    def test_it_has_what_the_schema_requires(self):
        for name, stated in objects(self.document):
            self.assertIn(name, REQUIRED)
            self.assertLessEqual(REQUIRED[name], stated.keys(), name)
        self.assertEqual((self.document["spdxVersion"], self.document["dataLicense"], self.document["SPDXID"]),
                         ("SPDX-2.3", "CC0-1.0", "SPDXRef-DOCUMENT"))
        self.assertRegex(self.document["creationInfo"]["created"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        known = ["SPDXRef-DOCUMENT", *self.packages, *(file["SPDXID"] for file in self.document["files"])]
        self.assertEqual(len(known), len(set(known)))
        for name in known:
            self.assertRegex(name, r"^SPDXRef-[A-Za-z0-9.-]+$")
        for relation in self.document["relationships"]:
            self.assertIn(relation["relationshipType"], KINDS)
            self.assertLessEqual({relation["spdxElementId"], relation["relatedSpdxElement"]}, set(known))
        for package in self.packages.values():
            self.assertRegex(package["supplier"] if "supplier" in package else "Organization: x", r"^(Organization|Person): .+")

    def test_the_libraries_are_those_of_ldd(self):
        for program in PROGRAMS:
            loaded = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
            paths = set(re.findall(r"(?:=> |^\t)(/\S+) \(0x", loaded, re.MULTILINE))
            self.assertGreater(len(paths), 5)
            stated = [self.packages[i]["name"] for i in self.related("DYNAMIC_LINK", f"SPDXRef-file-{program.name}")]
            self.assertEqual(sorted(stated), sorted(owners(paths)), program.name)

    def test_versions_are_those_of_the_package_database(self):
        debian = [p for p in self.packages.values() if p["SPDXID"].startswith("SPDXRef-deb-")]
        names = [p["name"] for p in debian]
        installed = subprocess.run(["dpkg-query", "-W", "-f", "${Package} ${Version}\n", *names], capture_output=True, text=True,
                                   check=True).stdout.splitlines()
        self.assertEqual(sorted(f"{p['name']} {p['versionInfo']}" for p in debian), sorted(set(installed)))
        for package in debian:
            self.assertIn(f"/usr/share/doc/{package['name']}/copyright", package["comment"])

    def test_what_is_compiled_in_is_named_as_the_third_party_page_has_it(self):
        compiled = {self.packages[i]["name"] for i in self.related("STATIC_LINK", "SPDXRef-patchmill")}
        table = (ROOT / "THIRD_PARTY.md").read_text().split("## In the 3-D pages")[0]
        headers = {re.findall(r"[\w+.-]+", line.split("|")[2])[0] for line in table.splitlines()
                   if "headers only" in line or "the font of pictures" in line}
        self.assertEqual(compiled, headers)

    def test_the_page_has_the_package_of_its_lock_file(self):
        lock = json.loads(LOCK.read_text())["packages"]
        [page] = [p for p in self.packages.values() if p["SPDXID"].startswith("SPDXRef-npm-")]
        stated = lock["node_modules/" + page["name"]]
        self.assertEqual((page["name"], page["versionInfo"]), ("three", stated["version"]))
        digest = base64.b64encode(bytes.fromhex(page["checksums"][0]["checksumValue"])).decode()
        self.assertEqual("sha512-" + digest, stated["integrity"])

    def test_the_same_packages_give_the_same_bytes(self):
        time = {"SOURCE_DATE_EPOCH": "1700000000"}
        one = made(PATCHMILLD, **time)
        self.assertEqual(one, made(PATCHMILLD, **time))
        self.assertEqual(json.loads(one)["creationInfo"]["created"], "2023-11-14T22:13:20Z")

    def test_an_image_has_all_of_its_packages(self):
        document = json.loads(made(PATCHMILLD, "--image", "/var/lib/dpkg"))
        installed = subprocess.run(["dpkg-query", "-W", "-f", "${db:Status-Abbrev} ${Package}\n"], capture_output=True, text=True,
                                   check=True).stdout
        names = set(re.findall(r"^ii\s+(\S+)$", installed, re.MULTILINE))
        image = {r["relatedSpdxElement"] for r in document["relationships"] if r["spdxElementId"] == "SPDXRef-image"}
        contained = {p["name"] for p in document["packages"] if p["SPDXID"] in image}
        self.assertEqual(contained, names | {"patchmill"})

    def test_a_program_that_is_none_is_refused(self):
        with Folder() as folder:
            run = subprocess.run(["/usr/bin/python3", SCRIPT, folder.write("program", "text")], capture_output=True, text=True)
        self.assertNotEqual(run.returncode, 0)


if __name__ == "__main__":
    unittest.main()

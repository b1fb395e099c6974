#!/usr/bin/python3
"""Writes what programs consist of as SPDX 2.3 (JSON): sbom.py [options] PROGRAM...

  -o FILE          where to write; default: standard output
  --lock FILE      a package-lock.json whose packages are part of the programs (clients/viewer: of the page)
  --image FOLDER   all packages of this database of dpkg, too: those of an image (its /var/lib/dpkg)
  --version TEXT   of the programs; default: that of CMakeLists.txt

The libraries of a program are those that it and its libraries name (DT_NEEDED), as the loader's cache finds
them; dpkg says whose they are. Packages of headers and the font are compiled in. Needs dpkg, ldconfig and
readelf. The same programs and packages give the same bytes where SOURCE_DATE_EPOCH is set.
"""
from __future__ import annotations

import argparse
import base64
import datetime
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import quote

ROOT = pathlib.Path(__file__).resolve().parents[1]
# Compiled into the programs; THIRD_PARTY.md says what each is for.
COMPILED_IN = ("libeigen3-dev", "libstb-dev", "libcli11-dev", "fonts-dejavu-core")
DOCUMENT = "SPDXRef-DOCUMENT"


def output_of(*command: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True, env={**os.environ, "LC_ALL": "C"}).stdout


def spdx_id(*words: str) -> str:
    """An identifier of letters, digits, dots and hyphens. libgrpc-dev and libgrpc++-dev stay apart."""
    return "SPDXRef-" + "-".join(re.sub(r"[^A-Za-z0-9.]+", "-", word.replace("+", "plus")).strip("-") for word in words)


class Loader:
    """Where the loader finds libraries."""

    def __init__(self) -> None:
        self._found: dict[str, str] = {}
        for name, path in re.findall(r"^\t(\S+) \([^)]*\) => (\S+)$", output_of("/sbin/ldconfig", "-p"), re.MULTILINE):
            self._found.setdefault(name, path)

    def libraries(self, program: str) -> set[str]:
        """The paths of all libraries of a program."""
        found: set[str] = set()
        waiting = [program]
        while waiting:
            for name in re.findall(r"\(NEEDED\).*\[(.+)\]", output_of("readelf", "-d", waiting.pop())):
                path = self._found.get(name)
                if path is None:
                    raise SystemExit(f"sbom.py: the loader does not find {name}, which {program} needs; install its package")
                if path not in found:
                    found.add(path)
                    waiting.append(path)
        return found


@dataclass(frozen=True)
class Package:
    """A package of Debian."""

    name: str
    version: str
    architecture: str
    source: str
    homepage: str
    maintainer: str

    @property
    def id(self) -> str:
        return spdx_id("deb", self.name, self.architecture)

    def spdx(self) -> dict[str, Any]:
        purl = f"pkg:deb/debian/{quote(self.name)}@{quote(self.version, safe='.-~')}?arch={self.architecture}"
        made = {"SPDXID": self.id, "name": self.name, "versionInfo": self.version, "supplier": f"Organization: {self.maintainer}",
                "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "licenseConcluded": "NOASSERTION",
                "licenseDeclared": "NOASSERTION", "copyrightText": "NOASSERTION",
                "comment": f"Licences: /usr/share/doc/{self.name}/copyright. Made from the source package {self.source}.",
                "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": purl}]}
        if re.fullmatch(r"https?://\S+", self.homepage):
            made["homepage"] = self.homepage
        return made


class Database:
    """A database of dpkg."""

    FORMAT = "\t".join(["${db:Status-Abbrev}", "${Package}", "${Version}", "${Architecture}", "${source:Package} ${source:Version}",
                        "${Homepage}", "${Maintainer}"]) + "\n"

    HERE = "/var/lib/dpkg"

    def __init__(self, folder: str = HERE) -> None:
        self._query = ("dpkg-query", f"--admindir={folder}")
        lines = [line.split("\t") for line in output_of(*self._query, "-W", "-f", self.FORMAT).splitlines()]
        self._all = {line[1]: Package(*line[1:]) for line in lines if line[0].startswith("ii")}

    def all(self) -> list[Package]:
        return list(self._all.values())

    def named(self, name: str) -> Package:
        if name not in self._all:
            raise SystemExit(f"sbom.py: the package {name} is not installed, but the programs have parts of it")
        return self._all[name]

    def owners(self, paths: Iterable[str]) -> set[Package]:
        """The packages of these files."""
        # A package may name a file with /usr or without it, since /lib is a link there, or by a link to it.
        names = {path: {path, os.path.realpath(path), "/usr" + path, os.path.realpath(path).removeprefix("/usr")} for path in paths}
        asked = subprocess.run([*self._query, "-S", *sorted(set().union(*names.values()))], capture_output=True, text=True)
        owner = {path: package for package, path in re.findall(r"^([^:,\s]+)\S*: (/.+)$", asked.stdout, re.MULTILINE)}
        for path, ways in names.items():
            if not ways & owner.keys():
                raise SystemExit(f"sbom.py: no package has {path}")
        return {self.named(package) for package in owner.values()}


@dataclass
class Document:
    """What stands in the document."""

    packages: dict[str, dict[str, Any]] = field(default_factory=dict)
    files: list[dict[str, Any]] = field(default_factory=list)
    relationships: list[dict[str, str]] = field(default_factory=list)

    def relate(self, one: str, kind: str, other: str) -> None:
        self.relationships.append({"spdxElementId": one, "relationshipType": kind, "relatedSpdxElement": other})

    def add_package(self, package: Package) -> None:
        self.packages.setdefault(package.id, package.spdx())


def product(version: str) -> dict[str, Any]:
    return {"SPDXID": spdx_id("patchmill"), "name": "patchmill", "versionInfo": version, "downloadLocation": "NOASSERTION",
            "filesAnalyzed": False, "licenseConcluded": "Apache-2.0", "licenseDeclared": "Apache-2.0",
            "copyrightText": "2026 the Patchmill authors", "supplier": "Organization: the Patchmill authors"}


def npm_packages(lock: pathlib.Path) -> list[dict[str, Any]]:
    """Packages that a page carries: those of the lock file which are no tools."""
    made = []
    for path, stated in json.loads(lock.read_text())["packages"].items():
        if not path or stated.get("dev") or stated.get("optional"):
            continue
        name, version = path.rpartition("node_modules/")[2], stated["version"]
        algorithm, _, digest = stated["integrity"].partition("-")
        made.append({
            "SPDXID": spdx_id("npm", name), "name": name, "versionInfo": version, "filesAnalyzed": False,
            "downloadLocation": stated.get("resolved", f"https://registry.npmjs.org/{name}/-/{name.split('/')[-1]}-{version}.tgz"),
            "licenseConcluded": "NOASSERTION", "licenseDeclared": stated.get("license", "NOASSERTION").strip("()"),
            "copyrightText": "NOASSERTION",
            "checksums": [{"algorithm": algorithm.upper(), "checksumValue": base64.b64decode(digest).hex()}],
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                              "referenceLocator": f"pkg:npm/{quote(name, safe='/')}@{version}"}]})
    return made


def program_file(program: pathlib.Path) -> dict[str, Any]:
    content = program.read_bytes()
    return {"SPDXID": spdx_id("file", program.name), "fileName": f"./{program.name}", "fileTypes": ["BINARY"],
            "checksums": [{"algorithm": "SHA1", "checksumValue": hashlib.sha1(content).hexdigest()},
                          {"algorithm": "SHA256", "checksumValue": hashlib.sha256(content).hexdigest()}],
            "licenseConcluded": "NOASSERTION", "copyrightText": "NOASSERTION"}


def add_programs(document: Document, programs: list[pathlib.Path], database: Database) -> None:
    loader, here = Loader(), Database()
    for program in programs:
        stated = program_file(program)
        document.files.append(stated)
        document.relate(spdx_id("patchmill"), "CONTAINS", stated["SPDXID"])
        for package in sorted(database.owners(loader.libraries(str(program))), key=lambda p: p.id):
            document.add_package(package)
            document.relate(stated["SPDXID"], "DYNAMIC_LINK", package.id)
    for name in COMPILED_IN:
        document.add_package(here.named(name))
        document.relate(spdx_id("patchmill"), "STATIC_LINK", here.named(name).id)


def version_of_tree() -> str:
    found = re.search(r"project\(patchmill VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())
    assert found is not None, "CMakeLists.txt states no version"
    return found[1]


def finished(document: Document, version: str) -> dict[str, Any]:
    """The whole document. Its name space depends on what stands in it."""
    time = datetime.datetime.fromtimestamp(int(os.environ.get("SOURCE_DATE_EPOCH", datetime.datetime.now().timestamp())),
                                           datetime.timezone.utc)
    made: dict[str, Any] = {
        "packages": sorted(document.packages.values(), key=lambda p: p["SPDXID"]), "files": document.files,
        "relationships": document.relationships}
    digest = hashlib.sha256(json.dumps(made, sort_keys=True).encode()).hexdigest()
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": DOCUMENT, "name": f"patchmill-{version}",
            "documentNamespace": f"https://patchmill.example/spdx/patchmill-{version}-{digest}",
            "creationInfo": {"created": time.strftime("%Y-%m-%dT%H:%M:%SZ"), "creators": ["Tool: patchmill-sbom.py"]}, **made}


def main() -> None:
    parser = argparse.ArgumentParser(usage=str(__doc__).split("\n\n")[0], description=str(__doc__).split("\n\n", 1)[1],
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+", type=pathlib.Path)
    parser.add_argument("-o", dest="out", type=pathlib.Path)
    parser.add_argument("--lock", type=pathlib.Path, action="append", default=[])
    parser.add_argument("--image")
    parser.add_argument("--version", default=version_of_tree())
    options = parser.parse_args()

    document = Document({spdx_id("patchmill"): product(options.version)})
    document.relate(DOCUMENT, "DESCRIBES", spdx_id("patchmill"))
    database = Database(options.image or Database.HERE)
    add_programs(document, options.programs, database)
    for lock in options.lock:
        for package in npm_packages(lock):
            document.packages[package["SPDXID"]] = package
            document.relate(spdx_id("patchmill"), "CONTAINS", package["SPDXID"])
    if options.image is not None:
        image = {**product(options.version), "SPDXID": spdx_id("image"), "name": "patchmill-image", "licenseConcluded": "NOASSERTION",
                 "licenseDeclared": "NOASSERTION", "copyrightText": "NOASSERTION"}
        document.packages[image["SPDXID"]] = image
        document.relate(DOCUMENT, "DESCRIBES", image["SPDXID"])
        document.relate(image["SPDXID"], "CONTAINS", spdx_id("patchmill"))
        for package in database.all():
            document.add_package(package)
            document.relate(image["SPDXID"], "CONTAINS", package.id)
    text = json.dumps(finished(document, options.version), indent=1) + "\n"
    if options.out is None:
        sys.stdout.write(text)
    else:
        options.out.write_text(text)


if __name__ == "__main__":
    main()

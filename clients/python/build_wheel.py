#!/usr/bin/python3
"""Builds the wheel: build_wheel.py [--without-page] [--keep FOLDER] OUT

Copies the package to a folder, makes there what follows from other sources, and runs
`python3 -m build --no-isolation`:
  patchmill/v1           stubs of proto/patchmill/v1, by protoc
  patchmill/messages.py  dataclasses of the same, by generate.py
  patchmill/viewer.html  the 3-D page of clients/viewer, by Node.js

Needs (Debian): python3-build, python3-setuptools, python3-wheel, python3-protobuf, protobuf-compiler; Node.js
with the tools of clients/viewer (scripts/setup.sh page).
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]


def run(*command: object, cwd: pathlib.Path | None = None) -> None:
    subprocess.run([str(word) for word in command], check=True, cwd=cwd)


def make_stubs(package: pathlib.Path) -> None:
    protos = sorted((ROOT / "proto/patchmill/v1").glob("*.proto"))
    descriptors = package.parent / "contract.binpb"
    run("protoc", "-I", ROOT / "proto", f"--python_out={package.parent}", f"--pyi_out={package.parent}", "--include_imports",
        "--include_source_info", f"--descriptor_set_out={descriptors}", *protos)
    (package / "v1" / "__init__.py").write_text('"""The messages of the contract, made by protoc."""\n')
    run(sys.executable, HERE / "generate.py", descriptors, package / "messages.py")
    descriptors.unlink()


def make_page(package: pathlib.Path) -> None:
    viewer = ROOT / "clients/viewer"
    node = shutil.which("node")
    if node is None or not (viewer / "node_modules/esbuild").is_dir():
        raise SystemExit("build_wheel.py: the 3-D page needs Node.js and the tools of clients/viewer: run scripts/setup.sh page, "
                         "or build without the page: --without-page")
    run(node, viewer / "build.mjs", package / "viewer.html", cwd=viewer)


def version() -> str:
    found = re.search(r"project\(patchmill VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())
    assert found is not None, "CMakeLists.txt states no version"
    return found[1]


def build(out: pathlib.Path, folder: pathlib.Path, with_page: bool) -> None:
    for name in ("pyproject.toml", "README.md", ".flake8"):
        shutil.copy(HERE / name, folder / name)
    shutil.copy(ROOT / "LICENSE", folder / "LICENSE")
    shutil.copytree(HERE / "src", folder / "src", ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "VERSION").write_text(version() + "\n")
    package = folder / "src/patchmill"
    make_stubs(package)
    if with_page:
        make_page(package)
    # The same sources give the same bytes: the wheel states no time of its own.
    os.environ.setdefault("SOURCE_DATE_EPOCH", "315532800")
    run(sys.executable, "-m", "build", "--no-isolation", "--wheel", "--outdir", out.resolve(), folder)


def main() -> None:
    parser = argparse.ArgumentParser(description="Builds the wheel of the Python package.")
    parser.add_argument("out", type=pathlib.Path, help="folder for the wheel")
    parser.add_argument("--without-page", action="store_true", help="results then show no 3-D page in notebooks")
    parser.add_argument("--keep", type=pathlib.Path, help="a new folder for the whole source of the wheel, for linters")
    options = parser.parse_args()
    if options.keep is not None:
        options.keep.mkdir(parents=True)
        build(options.out, options.keep, not options.without_page)
        return
    with tempfile.TemporaryDirectory() as folder:
        build(options.out, pathlib.Path(folder), not options.without_page)


if __name__ == "__main__":
    main()

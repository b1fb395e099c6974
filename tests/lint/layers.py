#!/usr/bin/env python3
"""Fails on an #include that goes up or sideways (README.md, Layout: which folder may see which), and on one of CGAL: parts of
it are under the GPL, which tests alone may use (THIRD_PARTY.md).

usage: layers.py ROOT
"""
import pathlib
import re
import sys

# Each folder and the folders it may include from, itself always.
CORE = ["base", "math", "curve", "patch", "diffgeo", "spatial", "network", "surface", "lines"]
# The rooms of cam in their order; region and path are siblings: neither sees the other.
CAM = ["tool", "limits", "toolpath", "location", "location/limits", "location/simd"]
REGION = ["map", "reach", "split", "watershed", "merge", "border", "figures", ""]
PATH = ["stepover", "chord", "edge", "zlevel", "reach", "parallel", "contour", "rest"]
JUDGES = ["post", "verify", "picture"]  # see only tool, limits, toolpath and core, so that verify stays independent


def rooms(top, names):
    return [f"{top}/{name}".rstrip("/") for name in names]


def in_order(names, below):
    """Each name may see `below` and the names before it."""
    return {name: below | set(names[:i]) for i, name in enumerate(names)}


core = rooms("core", CORE)
ALLOWED = in_order(core, set())
UP_TO_NETWORK = set(core[: CORE.index("network") + 1])
ALLOWED["core/io"] = set(UP_TO_NETWORK)
ALLOWED["core/joining"] = set(UP_TO_NETWORK)
ALLOWED["core/crossing"] = UP_TO_NETWORK | {"core/joining"}
ALLOWED["core/division"] = UP_TO_NETWORK | {"core/joining"}
ALLOWED["core/exchange"] = set(core[: CORE.index("surface") + 1])
ALLOWED["core/editing"] = set(core[: CORE.index("surface") + 1]) | {"core/joining"}
ALLOWED["core/preview"] = set(core[: CORE.index("diffgeo") + 1])
ALLOWED["core/fairing"] = {"core/base"}
ALLOWED["core/brep"] = set(core[: CORE.index("patch") + 1])
ALLOWED["core/trim"] = UP_TO_NETWORK | {"core/brep"}
ALL_CORE = set(core)
cam, region, path = rooms("cam", CAM), rooms("cam/region", REGION), rooms("cam/path", PATH)
ALLOWED |= in_order(cam, ALL_CORE)
ALLOWED |= in_order(region, ALL_CORE | set(cam))
ALLOWED |= in_order(path, ALL_CORE | set(cam))
ALLOWED["cam/link"] = ALL_CORE | set(cam + region + path)
for name in rooms("cam", JUDGES):
    ALLOWED[name] = ALL_CORE | {"cam/tool", "cam/limits", "cam/toolpath"}
ALLOWED["cam/picture"].add("core/fairing")
ALLOWED["cam/post/words"] = {"cam/post"}  # tables of words, which cam/post declares
ALLOWED["cam/plan"] = ALLOWED["cam/link"] | {"cam/link"} | set(rooms("cam", JUDGES))

ALLOWED["proto/json"] = set()
PROTO = {"proto/patchmill/v1", "patchmill/v1", "proto/json"}
SERVER = ["server", "server/convert", "server/handlers", "server/operate"]
BELOW_SERVER = set(ALLOWED) | PROTO
for name in SERVER:
    ALLOWED[name] = BELOW_SERVER | set(SERVER)
# What an operator meets sees nothing of the domain.
ALLOWED["server/operate"] = {"core/base"} | PROTO
# The importer reads CAD files in a process of its own: geometry and the contract, nothing of planning or serving.
for name in ["import", "import/occt"]:
    ALLOWED[name] = UP_TO_NETWORK | {"core/brep", "core/trim", "import", "import/occt"} | PROTO
# Clients speak proto. The command line may start the server inside its own process, through these headers, and nothing else. SHA-256
# names what it uploads.
ALLOWED["clients/render"] = set()
ALLOWED["clients/cli"] = set(PROTO) | {"clients/render"}
EXTRA_FILES = {"server/operate": {"server/limits.h"},
               "clients/cli": {"core/base/digest.h", "server/server.h", "server/options.h", "server/serve_flags.h",
                               "server/operate/serve_words.h"}}

INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)
CGAL = re.compile(r'^\s*#\s*include\s+[<"]CGAL/', re.M)


def folder(path):
    return str(pathlib.PurePosixPath(path).parent)


def main():
    root = pathlib.Path(sys.argv[1])
    faults, seen = [], 0
    for top in ["core", "cam", "proto", "server", "clients", "import"]:
        for source in sorted((root / top).rglob("*")):
            if "node_modules" in source.parts:  # installed, not ours
                continue
            if source.suffix not in {".h", ".cc"}:
                continue
            seen += 1
            own = folder(source.relative_to(root).as_posix())
            if own not in ALLOWED:
                faults.append(f"{own}: folder is in no layer; add it to tests/lint/layers.py")
                continue
            text = source.read_text()
            if CGAL.search(text):
                faults.append(f"{source.relative_to(root)}: includes CGAL; only tests may (THIRD_PARTY.md)")
            for include in INCLUDE.findall(text):
                target = folder(include)
                if target == own or target in ALLOWED[own] or include in EXTRA_FILES.get(own, set()):
                    continue
                faults.append(f"{source.relative_to(root)}: includes {include}; {own} may not see {target}")
    for fault in faults:
        print(fault)
    print(f"layers: {seen} files, {len(faults)} faults")
    return 1 if faults or seen == 0 else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Fails on an #include that goes up or sideways (README.md, Layout: which folder may see which), and on one of CGAL: parts of
it are under the GPL, which tests alone may use (THIRD_PARTY.md).

usage: layers.py ROOT
"""
import pathlib
import re
import sys

# Each folder and the folders it may include from, itself always.
CORE = ["base", "math", "curve", "patch", "diffgeo", "network", "surface", "lines"]
CAM = ["tool", "toolpath", "location", "region", "path", "link"]
JUDGES = ["post", "verify", "picture"]  # see only tool, toolpath and core, so that verify is an independent judge

ALLOWED = {}
for i, name in enumerate(CORE):
    ALLOWED["core/" + name] = {"core/" + below for below in CORE[:i]}
ALLOWED["core/io"] = {"core/" + below for below in CORE[: CORE.index("network") + 1]}
ALLOWED["core/joining"] = {"core/" + below for below in CORE[: CORE.index("network") + 1]}
ALLOWED["core/editing"] = {"core/" + below for below in CORE[: CORE.index("surface") + 1]} | {"core/joining"}
ALLOWED["core/fairing"] = {"core/base"}
ALL_CORE = {"core/" + name for name in CORE}
for i, name in enumerate(CAM):
    ALLOWED["cam/" + name] = ALL_CORE | {"cam/" + below for below in CAM[:i]}
for name in JUDGES:
    ALLOWED["cam/" + name] = ALL_CORE | {"cam/tool", "cam/toolpath"}
ALLOWED["cam/picture"].add("core/fairing")
ALLOWED["cam/plan"] = ALL_CORE | {"cam/" + n for n in CAM + JUDGES}

ALLOWED["proto/json"] = set()
PROTO = {"proto/patchmill/v1", "patchmill/v1", "proto/json"}
SERVER = ["server", "server/convert", "server/handlers"]
BELOW_SERVER = set(ALLOWED) | PROTO
for name in SERVER:
    ALLOWED[name] = BELOW_SERVER | set(SERVER)
# Clients speak proto. The command line may start the server inside its own process, through these headers, and nothing else.
ALLOWED["clients/cli"] = set(PROTO)
EXTRA_FILES = {"clients/cli": {"server/server.h", "server/options.h", "server/serve_flags.h"}}

INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)
CGAL = re.compile(r'^\s*#\s*include\s+[<"]CGAL/', re.M)


def folder(path):
    return str(pathlib.PurePosixPath(path).parent)


def main():
    root = pathlib.Path(sys.argv[1])
    faults, seen = [], 0
    for top in ["core", "cam", "proto", "server", "clients"]:
        for source in sorted((root / top).rglob("*")):
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

#!/usr/bin/env bash
# clang-tidy-14 with the checks of .clang-tidy, all of them errors.
#   scripts/tidy.sh             the whole tree
#   scripts/tidy.sh COMMIT      sources that changed since the commit, and those that include a header that did
# Needs build/release, configured and built (scripts/test.sh): the generated messages among the headers.
set -euo pipefail
cd "$(dirname "$0")/.."
since="${1:-}"
[ -f build/release/compile_commands.json ] || { echo "tidy: build/release is not configured: cmake --preset release" >&2; exit 2; }
command -v clang-tidy-14 > /dev/null || scripts/setup.sh
mkdir -p build/tidy

# The compiler's own switches are taken out: warnings of g++ that clang does not know, and headers that g++ compiled. Prints the files to
# look at.
files=$(python3 - "$since" <<'PY'
import json, pathlib, re, subprocess, sys

root, since = pathlib.Path.cwd(), sys.argv[1]
commands = []
for entry in json.loads(pathlib.Path("build/release/compile_commands.json").read_text()):
    path = pathlib.Path(entry["file"])
    if not path.is_relative_to(root) or path.is_relative_to(root / "build") or path.name.startswith("cmake_pch"):
        continue
    command = re.sub(r" -Winvalid-pch| -include \S*cmake_pch\S*| -Werror| -Wno-\S+| -f(no-)?tree-\S+", "", entry["command"])
    # What the precompiled header brings; the dev preset holds every file to its own includes.
    if "cmake_pch" in entry["command"]:
        pch = re.search(r"-include (\S*cmake_pch\.hxx)", entry["command"]).group(1)
        commands.append(dict(entry, command=command + f" -include {root}/build/tidy/common.h"))
        text = pathlib.Path(pch).read_text() if pathlib.Path(pch).exists() else ""
        includes = re.findall(r"^#include .*$", text, re.M)
        pathlib.Path("build/tidy/common.h").write_text("\n".join(["#pragma once"] + includes) + "\n")
    else:
        commands.append(dict(entry, command=command))
pathlib.Path("build/tidy/compile_commands.json").write_text(json.dumps(commands))
sources = sorted({pathlib.Path(c["file"]).relative_to(root).as_posix() for c in commands})
if since:
    def git(*words):
        return subprocess.run(["git", *words], check=True, capture_output=True, text=True).stdout.split()
    changed = set(git("diff", "--name-only", since)) | set(git("ls-files", "--others", "--exclude-standard"))
    include = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)
    seen = {}
    def touches(name):
        """Whether a file, or a header that it includes, changed."""
        if name not in seen:
            seen[name] = name in changed
            path = root / name
            if not seen[name] and path.exists():
                seen[name] = any(touches(other) for other in include.findall(path.read_text()))
        return seen[name]
    sources = [source for source in sources if touches(source)]
print("\n".join(sources))
PY
)
[ -n "$files" ] || { echo "tidy: nothing changed since $since"; exit 0; }
count=$(wc -l <<< "$files")
status=0
xargs -r -P "$(nproc)" -n 4 nice clang-tidy-14 --quiet -p build/tidy <<< "$files" 2> build/tidy/progress | tee build/tidy/findings || status=1
if grep -q "Error while processing" build/tidy/progress; then status=1; fi
echo "tidy: $count files, $(grep -cE '(error|warning):' build/tidy/findings || true) findings"
exit "$status"

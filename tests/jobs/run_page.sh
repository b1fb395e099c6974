#!/bin/bash
# run_page.sh PATCHMILL SOURCE_DIR PAGE.md: every command of a page, from a folder that looks like the repository's root.
# Blocks that call scripts/ or a bare `patchmill` (with files of the reader's) are left out.
set -euo pipefail
patchmill=$1 source=$2 page=$3
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
mkdir -p "$root/build/release/bin"
ln -s "$patchmill" "$root/build/release/bin/patchmill"
for folder in docs examples tests; do ln -s "$source/$folder" "$root/$folder"; done
awk '/^```sh/ { block = ""; within = 1; next }
     /^```/ && within { within = 0; if (block !~ /(^|\n)(scripts\/|patchmill )/) printf "%s", block; next }
     within { block = block $0 "\n" }' "$source/$page" > "$root/commands.sh"
[ -s "$root/commands.sh" ] || { echo "$page has no commands"; exit 1; }
cd "$root"
bash -euxo pipefail commands.sh

#!/usr/bin/env bash
# Sets up, builds, and mills the Newell teapot: leaves a program, a report, a picture and a 3-D page in out/demo/.
#   scripts/demo.sh [MODEL [patchmill mill options]]     mill a model of your own instead
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh build
scripts/setup.sh page || echo "demo: the 3-D page is left out: its tools could not be installed" >&2
cmake --preset release -DPATCHMILL_TESTS=OFF -DPATCHMILL_BENCH=OFF  # scripts/test.sh switches them on again
cmake --build --preset release --target patchmill patchmilld
out=out/demo
mkdir -p "$out"
if [ "$#" -eq 0 ]; then
  set -- examples/teapot.bpt --up y --scale 50 --tool-diameter 6 --scallop 0.02
fi
model="$1"
shift
name="$(basename "${model%.*}")"
page=()
[ ! -e clients/viewer/node_modules/esbuild ] || page=(--preview "$out/$name.html")
build/release/bin/patchmill mill "$model" -o "$out/$name.ngc" --report "$out/$name.json" --preview "$out/$name.svg" \
  "${page[@]}" "$@"
echo
echo "program: $out/$name.ngc"
echo "report:  $out/$name.json"
echo "picture: $out/$name.svg"
[ "${#page[@]}" -eq 0 ] || echo "3-D:     $out/$name.html (open it in a browser)"

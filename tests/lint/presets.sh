#!/usr/bin/env bash
# Every preset of CMakePresets.json that needs no other compiler configures: those that only long tests use, too.
# usage: presets.sh SOURCE_FOLDER
set -euo pipefail
cd "$1"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
status=0
for preset in dev asan tsan coverage; do
  cmake --preset "$preset" -B "$work/$preset" > "$work/log" 2>&1 || { echo "presets: $preset"; grep -A4 Error "$work/log" || tail -5 "$work/log"; status=1; }
done
exit "$status"

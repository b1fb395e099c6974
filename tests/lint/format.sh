#!/usr/bin/env bash
# Fails when a source file is not formatted as .clang-format says. usage: format.sh ROOT [--fix]
set -euo pipefail
cd "$1"
mapfile -t files < <(find core cam server clients import proto tests -name '*.h' -o -name '*.cc' | sort)
[ "${#files[@]}" -gt 0 ] || { echo "format: no files found"; exit 1; }
if [ "${2:-}" = --fix ]; then
  clang-format-14 -i "${files[@]}"
else
  clang-format-14 --dry-run -Werror "${files[@]}"
fi
# clang-format leaves comments alone (ReflowComments), so that pictures stay. Their width is checked here.
if awk '/(^| )\/\/ / && length > 110 { print FILENAME ":" FNR ": comment of " length " columns"; bad = 1 } END { exit !bad }' \
     "${files[@]}"; then
  echo "format: lines with comments are at most 110 columns wide"; exit 1
fi
echo "format: ${#files[@]} files"

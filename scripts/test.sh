#!/usr/bin/env bash
# Sets up, builds and runs all tests.
#   scripts/test.sh            release build
#   scripts/test.sh asan       the same under AddressSanitizer and UndefinedBehaviorSanitizer
set -euo pipefail
cd "$(dirname "$0")/.."
preset="${1:-release}"
case "$preset" in release|dev|asan) ;; *) echo "usage: scripts/test.sh [release|dev|asan]" >&2; exit 2 ;; esac
scripts/setup.sh
cmake --preset "$preset"
cmake --build --preset "$preset"
ctest --preset "$preset" -j "$(nproc)"

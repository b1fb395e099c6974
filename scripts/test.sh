#!/usr/bin/env bash
# Sets up, builds and runs all tests.
#   scripts/test.sh            release build
#   scripts/test.sh asan       the same under AddressSanitizer and UndefinedBehaviorSanitizer
#   scripts/test.sh tsan       whatever runs on several threads, jobs, cancels and the server among it, under ThreadSanitizer
set -euo pipefail
cd "$(dirname "$0")/.."
preset="${1:-release}"
case "$preset" in release|dev|asan|tsan) ;; *) echo "usage: scripts/test.sh [release|dev|asan|tsan]" >&2; exit 2 ;; esac
scripts/setup.sh
cmake --preset "$preset"
cmake --build --preset "$preset"
ctest --preset "$preset" -j "$(nproc)"

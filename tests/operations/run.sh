#!/usr/bin/env bash
# run.sh BIN [MODULE...]: runs the tests of this folder, or these of them, against the patchmilld and patchmill of BIN.
set -euo pipefail
PATCHMILL_BIN=$(cd "$1" && pwd)
export PATCHMILL_BIN PYTHONDONTWRITEBYTECODE=1
shift
cd "$(dirname "$0")"
python=/usr/bin/python3  # Debian's: it has protobuf and gRPC
"$python" -m flake8 --config ../../clients/python/.flake8 .
tests=("$@")
if [ "${#tests[@]}" -eq 0 ]; then
  for file in test_*.py; do
    [ "$file" = test_many.py ] || tests+=("${file%.py}")  # a test of its own
  done
fi
"$python" -X dev -W error::ResourceWarning -m unittest --buffer "${tests[@]}"

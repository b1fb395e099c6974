#!/usr/bin/env bash
# run.sh BIN: runs the tests of this folder against the patchmilld and patchmill of BIN.
set -euo pipefail
export PATCHMILL_BIN=$1 PYTHONDONTWRITEBYTECODE=1
cd "$(dirname "$0")"
python=/usr/bin/python3  # Debian's: it has protobuf and gRPC
"$python" -m flake8 --config ../../clients/python/.flake8 .
tests=(test_*.py)
"$python" -X dev -W error::ResourceWarning -m unittest --buffer "${tests[@]%.py}"

#!/usr/bin/env bash
# run.sh PATCHMILLD: sends every worked request to that server, makes the pages of the contract, and checks them.
set -euo pipefail
export PATCHMILLD=$1 PYTHONDONTWRITEBYTECODE=1
cd "$(dirname "$0")"
python=/usr/bin/python3  # Debian's: it has protobuf and gRPC
"$python" -m flake8 --config ../../clients/python/.flake8 . ../../scripts/contract ../../scripts/contract_pages.py
"$python" -X dev -W error::ResourceWarning -m unittest --buffer test_requests test_pages test_command_lines

#!/usr/bin/env bash
# run.sh BIN: builds the wheel of clients/python, installs it into a virtual environment as a user would, holds it against mypy and
# flake8, and runs the tests of this folder with the programs of BIN.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
bin=$(cd "$1" && pwd)
export PATCHMILL_BIN=$bin PATCHMILLD=$bin/patchmilld PYTHONDONTWRITEBYTECODE=1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python=/usr/bin/python3  # Debian's: its packages are the only ones that the wheel may need

"$python" "$here/../../clients/python/build_wheel.py" --keep "$folder/source" "$folder/dist" >"$folder/build.log" 2>&1 ||
  { cat "$folder/build.log"; exit 1; }
cd "$folder/source"
"$python" -m mypy --cache-dir "$folder/mypy"
"$python" -m flake8 src
"$python" -m flake8 --config .flake8 "$here" "$here/../../clients/python"/*.py "$here/../../docs/front_end.py" "$here/../cad"/*.py \
  "$here/../../clients/freecad" "$here/../freecad"

"$python" -m venv --system-site-packages "$folder/venv"
"$folder/venv/bin/pip" install --quiet --no-index --disable-pip-version-check "$folder"/dist/patchmill-*.whl
"$python" -m mypy --strict --python-executable "$folder/venv/bin/python" --cache-dir "$folder/mypy" "$here/typed_use.py"
cd "$here"
tests=("$folder/venv/bin/python" -X dev -W error::ResourceWarning -m unittest --buffer)
"${tests[@]}" test_asyncio  # alone: a process has clients of one kind
for file in test_*.py; do [ "$file" = test_asyncio.py ] || others+=("${file%.py}"); done
"${tests[@]}" "${others[@]}"

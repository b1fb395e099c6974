#!/usr/bin/env bash
# install.sh [--bin FOLDER] [MOD]: installs the add-on for this user, with the Python package and the server inside.
#   --bin FOLDER   where patchmilld and patchmill-import are; default: build/release/bin
#   MOD            folder of FreeCAD's add-ons; default: the one of FreeCAD 0.20 and later on Linux
# Running it again replaces what it installed before.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$here/../..
bin=$root/build/release/bin
if [ "${1:-}" = --bin ]; then
  bin=$2
  shift 2
fi
mod=${1:-${FREECAD_USER_HOME:-${XDG_DATA_HOME:-$HOME/.local/share}/FreeCAD}/Mod}
for program in patchmilld patchmill-import; do
  [ -x "$bin/$program" ] || { echo "install.sh: $bin/$program is not there: build it (cmake --build --preset release), or name its folder: --bin FOLDER" >&2; exit 1; }
done

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
/usr/bin/python3 "$here/../python/build_wheel.py" "$folder/dist" >"$folder/log" 2>&1 || { cat "$folder/log" >&2; exit 1; }
addon=$folder/Patchmill
mkdir -p "$addon/packages" "$addon/bin"
cp -r "$here/Init.py" "$here/InitGui.py" "$here/package.xml" "$here/README.md" "$here/patchmill_freecad" "$root/LICENSE" "$addon"
find "$addon" -name __pycache__ -prune -exec rm -rf {} +
/usr/bin/python3 -m zipfile -e "$folder"/dist/patchmill-*.whl "$addon/packages"
cp "$bin/patchmilld" "$bin/patchmill-import" "$addon/bin"
mkdir -p "$mod"
rm -rf "$mod/Patchmill"
cp -r "$addon" "$mod/Patchmill"
echo "installed: $mod/Patchmill"

#!/usr/bin/env bash
# run.sh BIN [TEST...]: installs the add-on as a user would, into a home of its own, and runs the tests of this folder in
# FreeCAD, without a window, and those of the window in one that nobody sees. FreeCAD has to be there (scripts/long_tests.sh
# freecad installs it): nothing is skipped.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
bin=$(cd "$1" && pwd)
shift
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/user"
# The start page needs a browser, and a browser no root.
cat >"$folder/user/user.cfg" <<'XML'
<?xml version="1.0" encoding="UTF-8" standalone="no" ?>
<FCParameters><FCParamGroup Name="Root"><FCParamGroup Name="BaseApp"><FCParamGroup Name="Preferences">
  <FCParamGroup Name="General"><FCText Name="AutoloadModule">PartWorkbench</FCText></FCParamGroup>
  <FCParamGroup Name="Mod"><FCParamGroup Name="Start"><FCBool Name="ShowOnStartup" Value="0"/></FCParamGroup></FCParamGroup>
</FCParamGroup></FCParamGroup></FCParamGroup></FCParameters>
XML
export FREECAD_USER_HOME=$folder/user PATCHMILL_BIN=$bin PATCHMILL_FREECAD_TESTS=$here PYTHONDONTWRITEBYTECODE=1
unset PATCHMILLD  # the add-on has a server of its own
"$here/../../clients/freecad/install.sh" --bin "$bin"

# FreeCAD says nothing with its exit status. A test writes its figures to a file at its end.
run() {  # run TEST COMMAND...
  export PATCHMILL_TEST=$1 PATCHMILL_TEST_RESULT=$folder/$1.result
  shift
  timeout 900 "$@" "$here/runner.py" </dev/null >"$folder/log" 2>&1 || true
  if ! grep -q '^passed ' "$PATCHMILL_TEST_RESULT" 2>/dev/null; then
    cat "$folder/log" "$PATCHMILL_TEST_RESULT" || true
    echo "freecad: $PATCHMILL_TEST failed"
    exit 1
  fi
  echo "freecad: $PATCHMILL_TEST $(cat "$PATCHMILL_TEST_RESULT")"
  total=$((total + $(sed -n 's/^passed \([0-9]*\) tests.*/\1/p' "$PATCHMILL_TEST_RESULT")))
}
total=0
[ $# -gt 0 ] || { cd "$here"; set -- test_*.py; }
for file; do
  name=$(basename "${file%.py}")
  case "$name" in
    *window | picture) run "$name" xvfb-run -a -s "-screen 0 1400x900x24" freecad ;;
    *) run "$name" freecadcmd ;;
  esac
done
echo "freecad: $total tests passed in FreeCAD $(dpkg-query -W -f '${Version}' freecad)"

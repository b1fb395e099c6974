#!/usr/bin/env bash
# Runs one of the long tests of docs/long_tests.md, each in less than an hour, and writes its row of that page.
#   scripts/long_tests.sh NAME
# NAME: soak, clients, many, requests, whole, asan, asan_passes, asan_jobs, tsan, random, posts, certificates, fuzz, container, coverage, linuxcnc_times, freecad, cad_parts.
# LIMIT: minutes after which a test is ended, 60 unless it is set; more for a machine that does other work beside.
# PATCHMILL_BIN: of freecad, cad_parts, many and container, a folder with built programs; unset: they are built.
# SEED: of soak, random, posts, certificates and cad_parts; another one each day unless it is set. MINUTES: of soak, 30 unless it is set.
set -euo pipefail
cd "$(dirname "$0")/.."
name="${1:-}"
seed="${SEED:-$(date +%y%m%d)}"
minutes="${MINUTES:-30}"
page=docs/long_tests.md

as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)
install() { "${as_root[@]}" apt-get update -qq && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" > /dev/null; }
build() {  # build PRESET [targets]
  local preset=$1
  shift
  scripts/setup.sh
  cmake --preset "$preset"
  cmake --build --preset "$preset" ${1:+--target "$@"}
}
programs() {  # patchmill and patchmilld, where PATCHMILL_BIN does not say that they are there
  if [ -n "${PATCHMILL_BIN:-}" ]; then scripts/setup.sh; else build release patchmill patchmilld patchmill-import; fi
}

soak() {
  build release patchmill patchmilld
  tests/service/soak.sh build/release/bin "$minutes" "$seed"
}
clients() {  # 64 clients of one server
  build release patchmilld
  tests/service/mixed_clients.py build/release/bin/patchmilld --seed "$seed"
}
many() {  # three servers behind nginx, two hundred jobs
  programs
  PATCHMILL_LONG=1 tests/operations/run.sh "${PATCHMILL_BIN:-build/release/bin}" test_many
}
requests() {  # ten thousand random requests, under the sanitizers
  build asan service_tests
  PATCHMILL_FUZZ_JOBS=10000 PATCHMILL_FUZZ_SEED="$seed" build/asan/tests/service_tests --gtest_filter='RandomRequests.*'
}
whole() {  # the tests of CI with every value of their lists
  build release
  PATCHMILL_LONG=1 ctest --preset release -j "$(nproc)"
}
jobs='^(cam_plan|property|golden|job_)'  # tests of whole jobs take half of the time
passes='^cam_(path|location|oracle)'      # and those of passes and heights half of the rest
asan() {
  build asan
  ctest --preset asan -j "$(nproc)" -E "$jobs|$passes"
}
asan_passes() {
  build asan
  ctest --preset asan -j "$(nproc)" -R "$passes"
}
asan_jobs() {
  build asan
  ctest --preset asan -j "$(nproc)" -R "$jobs"
}
tsan() { scripts/test.sh tsan; }
random() {  # a hundred parts of each kind, ten thousand loops on CAD faces, a thousand damaged CAD files
  local file failed=0
  build release property_tests core_trim_tests service_tests
  for file in tests/property/random_*_test.cc; do
    [ "$file" != tests/property/random_posts_test.cc ] || continue  # a test of its own
    echo "$file"
    PATCHMILL_FUZZ_JOBS=100 PATCHMILL_FUZZ_SEED="$seed" build/release/tests/property_tests --file="$file" --gtest_brief=1 || failed=1
  done
  PATCHMILL_FUZZ_JOBS=1700 PATCHMILL_FUZZ_SEED="$seed" build/release/tests/core_trim_tests --gtest_filter='BothSides.*' --gtest_brief=1 || failed=1
  PATCHMILL_FUZZ_JOBS=1000 PATCHMILL_FUZZ_SEED="$seed" build/release/tests/service_tests --gtest_filter=Importer.DamagedFiles --gtest_brief=1 || failed=1
  return "$failed"
}
posts() {  # a hundred parts in every dialect, with arcs and without, in mm and in inches
  build release property_tests
  PATCHMILL_LONG=1 PATCHMILL_FUZZ_JOBS=100 PATCHMILL_FUZZ_SEED="$seed" \
    build/release/tests/property_tests --file=tests/property/random_posts_test.cc --gtest_brief=1
}
certificates() {  # ten million heights
  build release cam_location_tests
  PATCHMILL_FUZZ_QUERIES=10000000 PATCHMILL_FUZZ_SEED="$seed" \
    build/release/tests/cam_location_tests --file=tests/cam/location/simd/heights_certificate_fuzz_test.cc
}
fuzz() {  # a minute of each target
  command -v clang++ > /dev/null || install clang llvm
  build fuzz
  local target found corpus=build/fuzz/corpus failed=0
  for target in build/fuzz/fuzz/*_fuzz; do
    found="$corpus/$(basename "$target")"
    mkdir -p "$found"
    echo "$target"
    "$target" -max_total_time=60 -print_final_stats=1 -artifact_prefix="$found/" "$found" tests/models tests/models/malformed \
      tests/models/curves tests/models/networks tests/golden cam/post/dialects examples docs > "$found.log" 2>&1 || { tail -30 "$found.log"; failed=1; }
    grep -E 'number_of_executed_units|new_units_added' "$found.log" || true
  done
  return "$failed"
}
container() {
  programs
  scripts/container_test.sh
}
coverage() {  # lines of core, cam, server and clients that the tests reach, those of random jobs left out
  command -v gcovr > /dev/null || install gcovr
  build coverage
  find build/coverage -name '*.gcda' -delete
  local status=0
  ctest --preset coverage -j "$(nproc)" || status=1
  gcovr --root . --object-directory build/coverage --filter 'core/' --filter 'cam/' --filter 'server/' --filter 'clients/' \
    --exclude-unreachable-branches --txt build/coverage/coverage.txt --html build/coverage/coverage.html
  tail -4 build/coverage/coverage.txt
  return "$status"
}
linuxcnc_times() {  # five programs in LinuxCNC, without a display
  build release patchmill
  python3 tests/bench/linuxcnc_times.py build/release/bin/patchmill docs/machine.json --limit 5
}
cad_parts() {  # parts of fourteen kinds of operations, made with FreeCAD, as STEP and IGES
  programs
  install freecad
  local folder
  folder=$(mktemp -d)
  SEED="$seed" COUNT=12 FOLDER="$folder" freecadcmd tests/cad/make_parts.py > /dev/null
  tests/cad/check_files.py "${PATCHMILL_BIN:-build/release/bin}/patchmill" "$folder" --valid "$folder/parts.json"
  rm -r "$folder"
}
freecad() {  # the add-on in Debian's FreeCAD
  programs
  install freecad xvfb xauth
  tests/freecad/run.sh "${PATCHMILL_BIN:-build/release/bin}"
}

case "$name" in
  soak) command="MINUTES=$minutes SEED=$seed scripts/long_tests.sh soak" ;;
  clients | requests | random | posts | certificates | cad_parts) command="SEED=$seed scripts/long_tests.sh $name" ;;
  many | whole | asan | asan_passes | asan_jobs | tsan | fuzz | container | coverage | linuxcnc_times | freecad) command="scripts/long_tests.sh $name" ;;
  *)
    sed -n '2,7s/^# \?//p' "$0" >&2
    exit 2
    ;;
esac

# A second shell does the work, so that its time can be limited.
if [ "${LONG_TESTS_INNER:-}" != "$name" ]; then
  started=$(date +%s)
  log=$(mktemp)
  status=0
  LONG_TESTS_INNER="$name" SEED="$seed" timeout "${LIMIT:-60}m" "$0" "$name" 2>&1 | tee "$log" || status=${PIPESTATUS[0]}
  took=$((($(date +%s) - started + 30) / 60))
  case "$status" in
    0) result="passed, $took min" ;;
    124) result="**not done within ${LIMIT:-60} minutes**" ;;
    *) result="**failed**, $took min" ;;
  esac
  # What the test says about itself in its last line, where it has one.
  said=$(grep -E '^(soak|mixed_clients|check_files|container: passed|lines|TOTAL|linuxcnc_times|freecad)' "$log" | tail -1 | tr -s ' |' ' ' || true)
  commit=$(git rev-parse --short HEAD)
  [ -z "$(git status --porcelain --untracked-files=no)" ] || commit="$commit, changed"
  row="| $name | \`$command\` | $commit | $(date +%F) | $result${said:+; $said} |"
  awk -v name="$name" -v row="$row" '
    /^## Last runs/ { runs = 1 }
    runs && index($0, "| " name " |") == 1 { print row; next }
    { print }' "$page" > "$log" && cp "$log" "$page"
  rm -f "$log"
  echo "$row"
  exit "$status"
fi
"$name"

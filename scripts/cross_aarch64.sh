#!/usr/bin/env bash
# Builds core and cam for aarch64 and compares what they compute with this machine's build, to the bit: digests of
# heights and of what is in the way of balls. Tests run under qemu. For developers; nothing else needs it.
#
#   scripts/cross_aarch64.sh [TEST...]      TEST: a target of build/aarch64/tests, run as well (see below)
#
# Needs on a Debian 12 of another kind: g++-aarch64-linux-gnu qemu-user-static, and cmake --preset release. The
# libraries for aarch64 go to build/aarch64-sysroot, by an apt of its own: the system's packages stay as they are.
set -euo pipefail
cd "$(dirname "$0")/.."

libraries=(
  libabsl-dev libtbb-dev libfmt-dev libssl-dev libopenmesh-dev libeigen3-dev libcgal-dev
  libgtest-dev libgmock-dev librapidcheck-dev
)
# Arithmetic, patches, every height, and what differs between instruction sets.
tests=(
  core_patch_bicubic_sums_test core_patch_piece_test
  cam_location_simd_heights_test cam_location_locator_closed_forms_test "$@"
)
# These record digests (RecordProperty "digest"): the same from both builds.
compared=(cam_location_simd_heights_test)

for tool in aarch64-linux-gnu-g++ qemu-aarch64-static; do
  command -v "$tool" >/dev/null || { echo "cross_aarch64.sh: $tool is missing" >&2; exit 2; }
done

export PATCHMILL_AARCH64_SYSROOT="$PWD/build/aarch64-sysroot"
if [ ! -e "$PATCHMILL_AARCH64_SYSROOT/complete" ]; then
  apt="$PWD/build/aarch64-apt"
  mkdir -p "$apt"/{lists,cache/archives}/partial "$PATCHMILL_AARCH64_SYSROOT"
  touch "$apt/status"
  echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian bookworm main" \
    >"$apt/sources.list"
  cat >"$apt/apt.conf" <<EOF
Dir::State "$apt"; Dir::State::lists "$apt/lists"; Dir::State::status "$apt/status"; Dir::Cache "$apt/cache";
Dir::Etc::sourcelist "$apt/sources.list"; Dir::Etc::sourceparts "-";
APT::Architecture "arm64"; APT::Architectures { "arm64"; }; APT::Sandbox::User "root";
EOF
  export APT_CONFIG="$apt/apt.conf"
  apt-get -qq update
  apt-get -qq install --yes --no-install-recommends --download-only "${libraries[@]}"
  for package in "$apt"/cache/archives/*.deb; do dpkg -x "$package" "$PATCHMILL_AARCH64_SYSROOT"; done
  unset APT_CONFIG
  touch "$PATCHMILL_AARCH64_SYSROOT/complete"
fi

cmake -B build/aarch64 -G Ninja -DCMAKE_TOOLCHAIN_FILE="$PWD/cmake/aarch64.cmake" -DCMAKE_BUILD_TYPE=Release \
  -DPATCHMILL_SERVICE=OFF -DPATCHMILL_BENCH=OFF >/dev/null
ninja -C build/aarch64 "${tests[@]/#/tests/}"  # links all of core and cam
ninja -C build/release "${compared[@]/#/tests/}"

# No multiplication and addition may have become one, in all of core and cam: x86-64 rounds twice, and so must aarch64.
# Eigen's product of large matrices asks for such instructions in any case; only core/joining reaches it, and joined
# networks may therefore differ from those of x86-64 in their last bits.
for library in build/aarch64/core/*.a build/aarch64/cam/*.a; do
  aarch64-linux-gnu-objdump -dC "$library" | awk -v library="$library" '
    /^[0-9a-f]+ <.*>:$/ { name = $0 }
    /\t(fn?m(add|sub)|fml[as])\t/ && name !~ /Eigen::internal::(gebp_kernel|lhs_process_one_packet)/ { print library ": fused: " name; bad = 1 }
    END { exit bad }' | sort | uniq -c >&2
done

run=(qemu-aarch64-static -L "$PATCHMILL_AARCH64_SYSROOT")
for test in "${tests[@]}"; do
  echo "== $test"
  "${run[@]}" "build/aarch64/tests/$test" --gtest_brief=1 --gtest_output="xml:build/aarch64/$test.xml"
done
digests() { grep -oE 'name="digest[^"]*" value="[0-9a-f]{64}"' "$1"; }
for test in "${compared[@]}"; do
  "build/release/tests/$test" --gtest_brief=1 --gtest_output="xml:build/release/$test.xml"
  diff <(digests "build/release/$test.xml") <(digests "build/aarch64/$test.xml")
  echo "== $test: the same $(digests "build/aarch64/$test.xml" | wc -l) digests on both"
done

#!/usr/bin/env bash
# Installs everything Patchmill needs on a bare Debian 12. Safe to run again: what is there already is left alone.
# Used by scripts/demo.sh, scripts/test.sh, CI and the Dockerfile. Needs root, or sudo.
#
#   scripts/setup.sh            all that building and testing needs
#   scripts/setup.sh build      compiler and libraries only (what scripts/demo.sh and the container's build stage use)
#   scripts/setup.sh cad        the same with Open CASCADE, for STEP and IGES
#   scripts/setup.sh page       Node.js with what makes the 3-D page; without it `--preview FILE.html` is not built in
set -euo pipefail
cd "$(dirname "$0")/.."

what="${1:-all}"
build_packages=(
  g++ cmake ninja-build ccache pkg-config git ca-certificates
  libgrpc++-dev libgrpc-dev protobuf-compiler-grpc protobuf-compiler libprotobuf-dev libabsl-dev
  libeigen3-dev libopenmesh-dev libtbb-dev libcli11-dev libfmt-dev libspdlog-dev libssl-dev prometheus-cpp-dev libstb-dev fonts-dejavu-core
)
test_packages=(
  libgtest-dev libgmock-dev libbenchmark-dev librapidcheck-dev libcgal-dev
  python3 clang-format-14 linuxcnc-uspace librsvg2-bin python3-grpcio python3-protobuf chromium
  python3-numpy python3-yaml curl python3-build python3-setuptools python3-wheel python3-venv mypy flake8 openssl libfaketime nginx-light
)
# Open CASCADE reads STEP and IGES; without it patchmill-import is not built. libseccomp limits what that may do.
cad_packages=(libocct-data-exchange-dev libseccomp-dev)
case "$what" in
  all) packages=("${build_packages[@]}" "${cad_packages[@]}" "${test_packages[@]}") ;;
  build) packages=("${build_packages[@]}") ;;
  cad) packages=("${build_packages[@]}" "${cad_packages[@]}") ;;
  page) packages=(ca-certificates) ;;
  *) echo "setup.sh: unknown argument '$what' (all, build, cad, page)" >&2; exit 2 ;;
esac
# Node.js and npm carry buf, the linter of the contract, and the tools of the 3-D page; a newer Node.js than Debian's
# brings its own npm.
if [ "$what" = all ] || [ "$what" = page ]; then
  command -v node >/dev/null || packages+=(nodejs)
  command -v npm >/dev/null || packages+=(npm)
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "setup.sh: run as root, or install sudo" >&2; exit 1; }
  as_root=(sudo)
fi

missing=()
for package in "${packages[@]}"; do
  [ "$(dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2>/dev/null || true)" = "ii " ] || missing+=("$package")
done
if [ "${#missing[@]}" -gt 0 ]; then
  echo "setup: installing ${missing[*]}"
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi

if [ "$what" = all ] && [ ! -x node_modules/.bin/buf ]; then
  echo "setup: installing buf (version pinned in package.json)"
  npm install --no-save --no-package-lock --no-audit --no-fund --loglevel=error
fi
# What is installed is what package-lock.json says, by its hashes.
tools() {
  cmp -s "$1/package-lock.json" "$1/node_modules/.installed-lock" && return
  echo "setup: installing the tools of $1 (versions pinned in its package-lock.json)"
  npm ci --prefix "$1" --no-audit --no-fund --loglevel=error
  cp "$1/package-lock.json" "$1/node_modules/.installed-lock"
}
case "$what" in all | page) tools clients/viewer ;; esac
case "$what" in all) tools clients/web ;; esac
echo "setup: done"

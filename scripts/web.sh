#!/usr/bin/env bash
# Starts Patchmill's web page: patchmilld on a free port of this machine, and the web server in front of it. It prints the
# address of the page. Ctrl-C ends both.
#
#   scripts/web.sh                        http://127.0.0.1:8080, or a free port if 8080 is taken
#   scripts/web.sh --listen 127.0.0.1:0   options of the web server; --help lists them
#   PATCHMILL_BIN=FOLDER scripts/web.sh   patchmilld of another folder than build/release/bin
#
# patchmilld must have been built before. Page and server are built here when they are missing or older than their sources.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
web=$root/clients/web
bin=${PATCHMILL_BIN:-$root/build/release/bin}

say() { echo "web.sh: $*" >&2; }

for argument in "$@"; do
  case $argument in
    --backend | --backend=* | --backend-ca | --backend-ca=*)
      say "this script starts its own patchmilld; for another one, run clients/web/dist/server.mjs $argument ..."
      exit 2
      ;;
  esac
done

if [ ! -x "$bin/patchmilld" ]; then
  say "$bin/patchmilld is missing."
  say "Build it with scripts/test.sh, or with: cmake --preset release && cmake --build --preset release --target patchmilld"
  say "Or name the folder of another one: PATCHMILL_BIN=FOLDER scripts/web.sh"
  exit 1
fi

[ -x "$bin/patchmill-import" ] || say "$bin/patchmill-import is missing: STEP and IGES files cannot be read (scripts/setup.sh cad, then build)"

# Installs what a lock file names, if that was not done yet.
install() {
  if cmp -s "$1/package-lock.json" "$1/node_modules/.installed-lock"; then return; fi
  command -v npm >/dev/null || { say "npm is missing; install it with: apt-get install npm"; exit 1; }
  say "installing ${1#"$root"/} (npm ci)"
  npm ci --prefix "$1" --no-audit --no-fund --loglevel=error >&2
  cp "$1/package-lock.json" "$1/node_modules/.installed-lock"
}
install "$root/clients/viewer"
install "$web"

# Debian's Node.js only installs; everything runs under the one that the lock file names.
node=
for machine in x64 arm64; do
  if "$web/node_modules/node-linux-$machine/bin/node" --version >/dev/null 2>&1; then
    node=$web/node_modules/node-linux-$machine/bin/node
  fi
done
[ -n "$node" ] || { say "no Node.js for this machine in clients/web/node_modules; only Linux on x86-64 and arm64 is known"; exit 1; }

sources=("$web"/{page,server,build.mjs,package-lock.json} "$root/clients/viewer"/{src,page.html,page.css,build.mjs} "$root/proto")
if [ ! -f "$web/dist/server.mjs" ] || [ -n "$(find "${sources[@]}" -newer "$web/dist/server.mjs" -type f -print -quit)" ]; then
  say "building the page"
  (cd "$web" && "$node" build.mjs >&2)
fi
if [ "${1-}" = --help ] || [ "${1-}" = -h ]; then
  exec "$node" "$web/dist/server.mjs" --help
fi

# A port that is free now. Both programs say so if another takes it first.
free_port() {
  "$node" -e 'const s = require("net").createServer(); s.on("error", () => process.exit(1)); s.listen(Number(process.argv[1]), "127.0.0.1", () => { console.log(s.address().port); s.close(); })' "$1"
}

children=()
finish() {
  trap - EXIT INT TERM
  for child in "${children[@]}"; do kill -TERM "$child" 2>/dev/null || true; done
  wait
}
trap finish EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

port=$(free_port 0)
# In a session of its own, so that Ctrl-C reaches it through this script alone.
setsid "$bin/patchmilld" --listen "127.0.0.1:$port" &
children+=($!)
for ((i = 0; i < 100; i++)); do
  if "$bin/patchmilld" --check-health "127.0.0.1:$port" >/dev/null 2>&1; then break; fi
  if ! kill -0 "${children[0]}" 2>/dev/null; then
    say "patchmilld ended at its start"
    exit 1
  fi
  sleep 0.1
done

listen=()
case " $* " in
  *" --listen"*) ;;
  *)
    listen=(--listen "127.0.0.1:$(free_port 8080 2>/dev/null || free_port 0)")
    ;;
esac
setsid "$node" "$web/dist/server.mjs" --backend "127.0.0.1:$port" ${listen[@]+"${listen[@]}"} "$@" &
children+=($!)
say "open the address below in a browser; Ctrl-C ends"
wait -n

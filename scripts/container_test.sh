#!/usr/bin/env bash
# Builds the image around the programs of a release build, runs it as docs/operations.md says, and looks at it from outside: TLS, token,
# metrics, log, a read-only file system, limit of memory, a job with the bytes of the command line, a drain under load, what the image
# consists of. Uses docker where an engine runs, else podman, and makes a base image where no registry is at hand.
#   scripts/container_test.sh
# PATCHMILL_BIN: folder with patchmill, patchmilld and patchmill-import, built on Debian 12; unset: build/release/bin.
# BASE: the base image; unset: debian:bookworm-slim.
set -euo pipefail
cd "$(dirname "$0")/.."
bin="${PATCHMILL_BIN:-build/release/bin}"
image=patchmill:test
name="patchmill-test-$$"
work="$(mktemp -d)"
fail() {
  echo "container: $*" >&2
  "$engine" logs "$name" 2>&1 | tail -20 >&2 || true
  exit 1
}
step() { echo "container: $*, $SECONDS s"; }
as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)
for program in patchmill patchmilld patchmill-import; do
  [ -x "$bin/$program" ] || { echo "container: there is no $bin/$program; build it first (cmake --build --preset release)" >&2; exit 2; }
done

if command -v docker >/dev/null && docker info >/dev/null 2>&1; then
  engine=docker
  read_only=(--read-only)
  build=(docker build)
  base="${BASE:-debian:bookworm-slim}"
else
  engine=podman
  read_only=(--read-only --read-only-tmpfs=false)  # podman would give it a /tmp to write to
  build=(podman build --format docker)  # the default format has no health check
  base="${BASE:-docker.io/library/debian:bookworm-slim}"
  if ! command -v podman >/dev/null || ! command -v mmdebstrap >/dev/null; then
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
      podman buildah runc mmdebstrap fuse-overlayfs netavark aardvark-dns uidmap >/dev/null
  fi
  # crun fails on hybrid cgroups, and the default limits fail without CAP_SYS_RESOURCE.
  cat > "$work/containers.conf" <<'CONF'
[containers]
default_ulimits = ["nofile=20000:20000","nproc=10000:10000"]
[network]
network_backend = "netavark"
[engine]
runtime = "runc"
cgroup_manager = "cgroupfs"
CONF
  export CONTAINERS_CONF="$work/containers.conf"
  if ! podman image exists "$base"; then
    step "no registry is assumed; the base image is made of the system's own package sources"
    sources=()
    for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources; do
      if [ -f "$file" ] && grep -q debian "$file"; then sources+=("$file"); fi
    done
    # As the slim images of Debian are made: without manuals, translations and documents.
    slim=(--dpkgopt='path-exclude=/usr/share/doc/*' --dpkgopt='path-include=/usr/share/doc/*/copyright')
    for folder in man locale info groff lintian; do slim+=("--dpkgopt=path-exclude=/usr/share/$folder/*"); done
    # shellcheck disable=SC2016  # the hook is expanded by mmdebstrap
    slim+=('--customize-hook=rm -rf "$1"/var/lib/apt/lists/* "$1"/var/cache/apt/*')
    mmdebstrap --quiet --variant=minbase "${slim[@]}" bookworm "$work/base.tar" "${sources[@]}"
    podman import --quiet "$work/base.tar" "$base" >/dev/null
    rm "$work/base.tar"
  fi
fi
cleanup() {
  "$engine" rm -f "$name" >/dev/null 2>&1 || true
  rm -rf "$work"
}
trap cleanup EXIT

# The image, from a context that has the programs and little else.
context="$work/context"
mkdir -p "$context/programs" "$context/scripts"
cp "$bin/patchmill" "$bin/patchmilld" "$bin/patchmill-import" "$context/programs/"
cp Dockerfile CMakeLists.txt LICENSE THIRD_PARTY.md "$context/"
cp scripts/sbom.py scripts/setup.sh "$context/scripts/"
version=$("$bin/patchmilld" --version | awk '{ print $2 }')
"${build[@]}" -q -t "$image" --build-arg BASE="$base" --build-arg PROGRAMS=prebuilt --build-arg VERSION="$version" \
  --build-arg REVISION="$(git rev-parse HEAD 2>/dev/null || echo unknown)" --build-arg CREATED="$(date -u +%FT%TZ)" "$context" >/dev/null
step "the image is built"

bytes=$("$engine" image inspect -f '{{.Size}}' "$image")
[ "$bytes" -lt 300000000 ] || fail "the image has $bytes bytes; it must have fewer than 300,000,000"
label() { "$engine" image inspect -f "{{index .Config.Labels \"org.opencontainers.image.$1\"}}" "$image"; }
[ "$(label version)" = "$version" ] && [ "$(label licenses)" = Apache-2.0 ] && [ "$(label base.name)" = "$base" ] && [ -n "$(label revision)" ] \
  || fail "its labels do not say what it is"
[ "$("$engine" image inspect -f '{{.Config.User}}' "$image")" = 10001:10001 ] || fail "it does not name its user"
"$engine" run --rm --entrypoint cat "$image" /usr/share/doc/patchmill/sbom.spdx.json > "$work/sbom.json"
"$engine" run --rm --entrypoint dpkg-query "$image" -W -f '${Package} ${Version}\n' > "$work/installed"
/usr/bin/python3 - "$work/sbom.json" "$work/installed" <<'PY' || fail "its bill of materials is not what is installed"
import json, sys
packages = json.load(open(sys.argv[1]))["packages"]
stated = {f"{p['name']} {p['versionInfo']}" for p in packages if p["SPDXID"].startswith("SPDXRef-deb-")}
missing = set(open(sys.argv[2]).read().splitlines()) - stated
assert not missing and len(stated) > 50, missing
PY

"$engine" run --rm --entrypoint dpkg-query "$image" -W -f '${Package}\n' > "$work/packages"
if grep -qE '^(libx11|libgl1|libocct-visualization)' "$work/packages"; then fail "it has X11 or what draws with it"; fi
"$engine" run --rm --entrypoint dpkg "$image" --audit > "$work/audit" && [ ! -s "$work/audit" ] || { cat "$work/audit" >&2; fail "a package of it is broken"; }

status=0
"$engine" run --rm --name "$name" "$image" 2>"$work/bare" || status=$?
[ "$status" -eq 2 ] && grep -q -e "--cert and --key" "$work/bare" && grep -q -e "--insecure" "$work/bare" \
  || { cat "$work/bare" >&2; fail "the bare image ended with $status and did not name both ways"; }

# Certificates and a token, as docs/operations.md makes them.
files="$work/files"
mkdir "$files"
(
  cd "$files"
  openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 2 -subj /CN=workshop -keyout ../ca.key -out ca.crt
  openssl req -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -subj /CN=cam.example -keyout tls.key -out ../tls.csr
  printf 'subjectAltName = DNS:cam.example, DNS:localhost\n' > ../names
  openssl x509 -req -in ../tls.csr -CA ca.crt -CAkey ../ca.key -CAcreateserial -CAserial ../serial -days 2 -extfile ../names -out tls.crt
) 2>"$work/openssl.log" || { cat "$work/openssl.log" >&2; fail "openssl failed"; }
openssl rand -hex 32 > "$work/shop.token"
printf '[shop]\ntoken = sha256:%s\n' "$(tr -d '\n' < "$work/shop.token" | sha256sum | cut -d ' ' -f 1)" > "$files/tokens.conf"
chmod -R a+rX "$files"

free_port() { /usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }
start() {  # start MEMORY: the container, over TLS and for callers with a token; nothing of it can be written
  port=$(free_port)
  metrics=$(free_port)
  "$engine" rm -f "$name" >/dev/null 2>&1 || true
  "$engine" run -d --name "$name" -p "127.0.0.1:$port:50051" -p "127.0.0.1:$metrics:9464" "${read_only[@]}" --cap-drop ALL \
    --security-opt no-new-privileges --memory "$1" -v "$files:/etc/patchmill:ro" \
    -e PATCHMILLD_CERT=/etc/patchmill/tls.crt -e PATCHMILLD_KEY=/etc/patchmill/tls.key -e PATCHMILLD_TOKENS=/etc/patchmill/tokens.conf \
    -e PATCHMILLD_METRICS_LISTEN=0.0.0.0:9464 -e PATCHMILLD_LOG_FORMAT=json -e PATCHMILLD_DRAIN_SECONDS=60 -e PATCHMILLD_MAX_JOBS=4 \
    "$image" >/dev/null
  for _ in $(seq 100); do
    if "$engine" exec "$name" patchmilld --check-health localhost:50051 --ca /etc/patchmill/ca.crt 2>/dev/null; then return; fi
    sleep 0.2
  done
  fail "it never became healthy"
}
metric() { curl --silent --show-error "http://127.0.0.1:$metrics/metrics" | awk -v name="$1" '$1 == name { printf "%.0f\n", $2 }'; }
remote=(--ca "$files/ca.crt" --token-file "$work/shop.token")
mill() {  # mill SCALLOP OUT [options]
  local scallop=$1 out=$2
  shift 2
  "$bin/patchmill" mill examples/teapot.bpt --up y --scale 50 --tool-diameter 6 --scallop "$scallop" -o "$out" --quiet "$@" 2>"$out.err"
}

start 2g
[ "$("$engine" exec "$name" id -u)" = 10001 ] || fail "it does not run as its own user"
if "$engine" exec "$name" touch /var/file 2>/dev/null || "$engine" exec "$name" touch /tmp/file 2>/dev/null; then fail "it can write files"; fi
if [ "$engine" = podman ]; then
  podman healthcheck run "$name" >/dev/null || fail "the health check of the image does not find it healthy"
fi
limit=$(metric patchmill_memory_limit_bytes)
[ "${limit:-0}" -gt 0 ] && [ "$limit" -le $((2 << 30)) ] || fail "the limit of memory is ${limit:-unknown}; that of the container is 2 GiB"
step "it is healthy, read-only, and knows its limit of memory"

if mill 0.05 "$work/none.ngc" --server "localhost:$port" --ca "$files/ca.crt"; then fail "it took a job without a token"; fi
grep -q "does not know the caller" "$work/none.ngc.err" || { cat "$work/none.ngc.err" >&2; fail "it did not say that the token is missing"; }
if mill 0.05 "$work/none.ngc" --server "127.0.0.1:$port"; then fail "it took a job without TLS"; fi
mill 0.02 "$work/remote.ngc" --server "localhost:$port" "${remote[@]}"
mill 0.02 "$work/local.ngc"
cmp "$work/remote.ngc" "$work/local.ngc" || fail "the program differs from that of the command line"
printf '5161\t0.0\n5221\t0.0\n5222\t0.0\n5223\t-200.0\n5220\t1.0\n' | sort -n > "$work/rs274.var"
printf 'T1 P1 D6\n' > "$work/tool.tbl"
(cd "$work" && HOME="$work" rs274 -g -t tool.tbl -v rs274.var remote.ngc > canonical 2> errors) || { head "$work/errors" >&2; fail "rs274 refused the program"; }
grep -q STRAIGHT_FEED "$work/canonical" || fail "rs274 saw no feed in the program"
[ "$(metric 'patchmill_calls_total{code="OK",method="GenerateProgram"}')" = 1 ] || fail "its metrics do not count the job"
[ "$(metric patchmill_token_failures_total)" -ge 1 ] || fail "its metrics do not count the call without a token"
"$engine" logs "$name" 2>&1 | /usr/bin/python3 -c '
import json, sys
lines = [json.loads(line) for line in sys.stdin]
assert any("call ends" in json.dumps(line) and "shop" in json.dumps(line) for line in lines), lines' || fail "its log is not JSON with the caller"
step "the job has the bytes of the command line, rs274 reads it, metrics and log have it"

part=tests/models/cad/dome.step
"$bin/patchmill" convert "$part" "$work/remote.pb" --server "localhost:$port" "${remote[@]}" 2>"$work/convert.err" \
  || { cat "$work/convert.err" >&2; fail "it does not read a STEP file"; }
"$bin/patchmill" convert "$part" "$work/local.pb" 2>/dev/null
cmp "$work/remote.pb" "$work/local.pb" || fail "it reads a STEP file otherwise than the command line"
step "it reads a STEP file"

jobs=()
for k in 1 2 3 4; do
  mill "0.00$k" "$work/drain-$k.ngc" --server "localhost:$port" "${remote[@]}" &
  jobs+=($!)
done
for _ in $(seq 200); do
  [ "$(metric patchmill_jobs_running)" != 4 ] || { busy=yes; break; }
  sleep 0.02
done
[ "${busy:-no}" = yes ] || fail "its four places were never taken"
"$engine" stop -t 70 "$name" >/dev/null
for job in "${jobs[@]}"; do
  wait "$job" || { cat "$work"/drain-*.ngc.err >&2; fail "a job was lost while it drained"; }
done
[ "$("$engine" inspect -f '{{.State.ExitCode}}' "$name")" = 0 ] || fail "it did not end with status 0"
for k in 1 4; do
  mill "0.00$k" "$work/alone.ngc"
  cmp "$work/alone.ngc" "$work/drain-$k.ngc" || fail "a program of the drained server differs"
done
step "it drained four jobs"

start 256m
/usr/bin/python3 - "$work/large.pb.json" <<'PY'
import json, sys
points = [c for i in range(16) for j in range(16) for c in (i, j, (i * j % 7) / 7)]
patch = {"bezier": {"degree_u": 15, "degree_v": 15, "points": points}}
json.dump({"length_unit": "LENGTH_UNIT_MILLIMETER", "patches": [patch] * 6000}, open(sys.argv[1], "w"))
PY
status=0
"$bin/patchmill" check "$work/large.pb.json" --server "localhost:$port" "${remote[@]}" >"$work/large" 2>&1 || status=$?
[ "$status" -ne 0 ] || fail "256 MiB were enough for a model that takes more"
grep -qiE 'memory|bytes' "$work/large" || { cat "$work/large" >&2; fail "it did not say that the memory is not enough"; }
"$engine" exec "$name" patchmilld --check-health localhost:50051 --ca /etc/patchmill/ca.crt || fail "it does not live on after that"
[ "$("$engine" inspect -f '{{.State.OOMKilled}}' "$name")" = false ] || fail "the kernel had to end it"
mill 0.05 "$work/after.ngc" --server "localhost:$port" "${remote[@]}" || fail "it makes no job after that"
echo "container: passed in $SECONDS s; the image has $((bytes / 1000000)) MB, limit $limit bytes of memory, bytes equal to the command line's"

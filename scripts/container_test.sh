#!/usr/bin/env bash
# Builds the container, runs the service in it and the main job from outside. Uses docker where an engine runs, else podman.
# Needs build/release/bin/patchmill (scripts/demo.sh or scripts/test.sh build it).
set -euo pipefail
cd "$(dirname "$0")/.."
image=patchmill:test
name="patchmill-test-$$"
port="${PORT:-50951}"
work="$(mktemp -d)"

if command -v docker >/dev/null && docker info >/dev/null 2>&1; then
  engine=docker
  build=(docker build)
else
  engine=podman
  build=(podman build --format docker)  # the default format has no health check
  as_root=()
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  if ! command -v podman >/dev/null || ! command -v mmdebstrap >/dev/null; then
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
      podman buildah runc mmdebstrap fuse-overlayfs netavark aardvark-dns uidmap >/dev/null
  fi
  # crun fails on hybrid cgroups, and the default limits fail without CAP_SYS_RESOURCE.
  cat > "$work/containers.conf" <<'CONF'
[containers]
default_ulimits = ["nofile=20000:20000","nproc=10000:10000"]
[engine]
runtime = "runc"
cgroup_manager = "cgroupfs"
CONF
  export CONTAINERS_CONF="$work/containers.conf"
  if ! podman image exists docker.io/library/debian:bookworm-slim; then
    echo "container: no registry assumed, making the base image from the system's own package sources"
    sources=(/etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources)
    mmdebstrap --quiet --variant=minbase bookworm "$work/base.tar" $(ls "${sources[@]}" 2>/dev/null | grep -i debian || ls "${sources[@]}" 2>/dev/null)
    podman import --quiet "$work/base.tar" docker.io/library/debian:bookworm-slim >/dev/null
  fi
fi

cleanup() {
  "$engine" rm -f "$name" >/dev/null 2>&1 || true
  rm -rf "$work"
}
trap cleanup EXIT

"${build[@]}" -t "$image" .
status=0
"$engine" run --rm --name "$name" "$image" 2>"$work/bare" || status=$?
[ "$status" -eq 2 ] && grep -q -e "--cert and --key" "$work/bare" && grep -q -e "--insecure" "$work/bare" \
  || { echo "container: the bare image ended with $status and did not name both ways"; cat "$work/bare"; exit 1; }

"$engine" run -d --name "$name" -p "127.0.0.1:$port:50051" --read-only --cap-drop ALL "$image" --insecure >/dev/null
[ "$("$engine" exec "$name" id -u)" != 0 ] || { echo "container: runs as root"; exit 1; }
for _ in $(seq 50); do
  if "$engine" exec "$name" patchmilld --check-health 127.0.0.1:50051; then healthy=yes; break; fi
  sleep 0.2
done
[ "${healthy:-no}" = yes ] || { echo "container: never became healthy"; "$engine" logs "$name"; exit 1; }

build/release/bin/patchmill mill examples/teapot.bpt --up y --scale 50 --tool-diameter 6 --scallop 0.02 \
  --server "127.0.0.1:$port" -o "$work/remote.ngc" --quiet
build/release/bin/patchmill mill examples/teapot.bpt --up y --scale 50 --tool-diameter 6 --scallop 0.02 -o "$work/local.ngc" --quiet
cmp "$work/remote.ngc" "$work/local.ngc"
"$engine" stop -t 10 "$name" >/dev/null
echo "container: the service in the container gives the same bytes as the program on its own"

#!/usr/bin/env bash
# The Python example against a running daemon. usage: python_client.sh ROOT PATCHMILLD. Status 77: Python's gRPC is not here.
set -euo pipefail
root=$1 daemon=$2
/usr/bin/python3 -c 'import grpc, google.protobuf' 2>/dev/null || { echo "python3-grpcio is not installed; skipped"; exit 77; }
command -v grpc_python_plugin >/dev/null || { echo "grpc_python_plugin is not installed; skipped"; exit 77; }
dir=$(mktemp -d)
"$daemon" --listen 127.0.0.1:0 2>"$dir/log" &
pid=$!
trap 'kill $pid 2>/dev/null || true; wait $pid 2>/dev/null || true; rm -rf "$dir"' EXIT
for _ in $(seq 100); do
  port=$(sed -n 's/.*listens on .*, port \([0-9]*\)$/\1/p' "$dir/log")
  [ -n "$port" ] && break
  sleep 0.1
done
cat >"$dir/plane.json" <<'MODEL'
{"length_unit": "LENGTH_UNIT_MILLIMETER",
 "patches": [{"id": "plane", "bezier": {"degree_u": 1, "degree_v": 1, "points": [0,0,0, 0,8,0, 8,0,0, 8,8,0]}}]}
MODEL
/usr/bin/python3 "$root/clients/python/mill.py" "127.0.0.1:$port" "$dir/plane.json" "$dir/plane.ngc" | tee "$dir/out"
grep -q '^OUTCOME_COMPLETE' "$dir/out"
grep -q 'G53 G0 Z0' "$dir/plane.ngc"
# A wrong field comes back with its path.
if /usr/bin/python3 "$root/clients/python/mill.py" "127.0.0.1:$port" "$dir/plane.json" "$dir/no.ngc" --scallop 9 2>"$dir/err"; then
  echo "a scallop above the radius was accepted"; exit 1
fi
grep -q 'INVALID_ARGUMENT: job.operations\[0\].scallop_mm = 9' "$dir/err"
[ ! -e "$dir/no.ngc" ]
# SIGTERM drains and ends with 0.
kill -TERM $pid
wait $pid

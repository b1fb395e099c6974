#!/usr/bin/env bash
# Three clients keep one server busy for a while: jobs, maps, checks, lines, verifications, cancels and broken models in random
# order. Every answer must have the bytes of the same command without a server, the server must stay healthy, and its memory
# must not grow once it is warm. usage: soak.sh FOLDER_OF_THE_PROGRAMS MINUTES [SEED]
set -euo pipefail
bin=$(realpath "$1")
minutes=$2
seed=${3:-1}
cd "$(dirname "$0")/../.."
work=$(mktemp -d)
server=
cleanup() {
  if [ -n "$server" ]; then kill "$server" 2>/dev/null || true; fi
  rm -rf "$work"
}
trap cleanup EXIT

# The file that it writes, and the arguments of `patchmill`.
commands=(
  "hills.ngc   mill examples/two_hills.bv --scallop 0.03"
  "teapot.ngc  mill examples/teapot.bpt --up y --scale 30 --scallop 0.03"
  "bonnet.ngc  mill examples/bonnet.json --scallop 0.05"
  "map.json    regions examples/teapot.bpt --up y --scale 30"
  "lines.json  lines examples/two_hills.bv --kind contour --count 20"
)
name_of() { cut -d' ' -f1 <<< "${commands[$1]}"; }
run() {  # run NUMBER FOLDER [options]
  local words folder=$2
  read -ra words <<< "${commands[$1]}"
  shift 2
  "$bin/patchmill" "${words[@]:1}" -o "$folder/${words[0]}" --quiet "$@" > "$folder/${words[0]}.log" 2>&1 < /dev/null
}
mkdir "$work/expected"
for k in "${!commands[@]}"; do
  run "$k" "$work/expected" || { echo "soak: ${commands[k]}"; cat "$work/expected/$(name_of "$k").log"; exit 1; }
done

"$bin/patchmilld" --listen 127.0.0.1:0 --max-jobs 6 --store-mib 0 2> "$work/server.log" &
server=$!
port=
for _ in $(seq 100); do
  port=$(sed -nE 's/.*, port ([0-9]+)$/\1/p' "$work/server.log" | head -1)
  [ -n "$port" ] && break
  sleep 0.1
done
[ -n "$port" ] || { echo "soak: the server did not start"; cat "$work/server.log"; exit 1; }
address="127.0.0.1:$port"
memory() { awk '/VmRSS/ {print int($2 / 1024)}' "/proc/$server/status"; }

end=$(($(date +%s) + 60 * minutes))
client() {  # client NUMBER: until the end, random commands; the first wrong answer ends it
  local folder="$work/client$1" k name status
  mkdir "$folder"
  RANDOM=$((seed * 10 + $1))
  while [ "$(date +%s)" -lt "$end" ]; do
    case $((RANDOM % 8)) in
      0)  # cancelled somewhere on the way
        timeout -s INT "0.$((RANDOM % 9 + 1))" "$bin/patchmill" mill examples/teapot.bpt --up y --scale 54.8 --scallop 0.01 \
          --server "$address" -o "$folder/cancelled.ngc" --quiet > /dev/null 2>&1 < /dev/null || true
        rm -f "$folder/cancelled.ngc"
        ;;
      1)  # a broken model: refused, and nothing else
        status=0
        "$bin/patchmill" check tests/models/malformed/truncated.bpt --server "$address" > "$folder/broken.log" 2>&1 || status=$?
        [ "$status" -ne 0 ] || { echo "soak: a broken model was accepted"; return 1; }
        ;;
      2)  # judged once more, from the file
        "$bin/patchmill" verify examples/bonnet.json "$work/expected/bonnet.ngc" --tool-diameter 6 --scallop 0.05 \
          --server "$address" > "$folder/verify.log" 2>&1 || { cat "$folder/verify.log"; return 1; }
        ;;
      *)
        k=$((RANDOM % ${#commands[@]}))
        name=$(name_of "$k")
        run "$k" "$folder" --server "$address" || { echo "soak: ${commands[k]}"; cat "$folder/$name.log"; return 1; }
        cmp "$folder/$name" "$work/expected/$name" || return 1
        ;;
    esac
    echo x >> "$folder/count"
  done
}
clients=()
for number in 1 2 3; do
  client "$number" &
  clients+=($!)
done

# Warm after a quarter of the time.
sleep $((15 * minutes))
warm=$(memory)
status=0
for pid in "${clients[@]}"; do wait "$pid" || status=1; done
[ "$status" -eq 0 ] || { echo "soak: a client had a wrong answer"; tail -5 "$work/server.log"; exit 1; }
"$bin/patchmilld" --check-health "$address" || { echo "soak: not healthy at the end"; exit 1; }
last=$(memory)
calls=$(cat "$work"/client*/count | wc -l)
kill -TERM "$server"
wait "$server" || { echo "soak: the server did not stop cleanly"; exit 1; }
server=
echo "soak: $calls calls in $minutes min, memory of the server $warm MB when warm, $last MB at the end"
[ "$last" -le $((warm + warm / 4 + 32)) ] || { echo "soak: the memory grew"; exit 1; }

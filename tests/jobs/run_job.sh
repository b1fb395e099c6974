#!/usr/bin/env bash
# Mills a model with the real command line, lets LinuxCNC's interpreter run the program, and verifies it once more from its file.
# usage: run_job.sh PATCHMILL MODEL [mill options]     MUST_CONTAIN=text: the picture must mention it
set -euo pipefail
patchmill=$1 model=$2
shift 2
command -v rs274 >/dev/null || { echo "rs274 is not installed (scripts/setup.sh does that)"; exit 1; }
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
"$patchmill" mill "$model" -o "$dir/job.ngc" --report "$dir/job.json" --preview "$dir/job.svg" "$@"

# A machine whose zero lies above the part: G54 with a Z offset. The tool table is in inches.
printf '5161\t0.0\n5221\t0.0\n5222\t0.0\n5223\t-200.0\n5220\t1.0\n' | sort -n > "$dir/rs274.var"
printf 'T1 P1 D0.23622 Z0.0\n' > "$dir/tool.tbl"
# The interpreter keeps its tools in a file of the home folder: a run beside others needs a home of its own.
(cd "$dir" && HOME="$dir" rs274 -g -t tool.tbl -v rs274.var job.ngc > canonical 2> errors) || { echo "rs274 refused the program:"; head "$dir/errors"; exit 1; }
if [ -s "$dir/errors" ] && grep -qiE 'error|unknown|bad' "$dir/errors"; then echo "rs274 complained:"; head "$dir/errors"; exit 1; fi
feeds=$(grep -c STRAIGHT_FEED "$dir/canonical")
written=$(grep -cE '^ *(G1|X|Y|Z)' "$dir/job.ngc")
[ "$feeds" -gt 100 ] || { echo "only $feeds feed moves reached the interpreter"; exit 1; }
echo "rs274: $feeds feed moves from $written lines"

if grep -qE 'E[-+]?[0-9]|-0\.0000' <(grep -v '^(' "$dir/job.ngc"); then echo "exponent or -0.0000 in the program"; exit 1; fi
grep -q '"outcome": *"OUTCOME_COMPLETE' "$dir/job.json"
grep -q '</svg>' "$dir/job.svg"
if [ -n "${MUST_CONTAIN:-}" ]; then grep -q "$MUST_CONTAIN" "$dir/job.svg" || { echo "the picture does not show: $MUST_CONTAIN"; exit 1; }; fi

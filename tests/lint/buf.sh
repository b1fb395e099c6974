#!/usr/bin/env bash
# buf lint, and buf breaking against the last commit on main. usage: buf.sh ROOT. Status 77: buf is not installed.
set -euo pipefail
cd "$1"
buf=node_modules/.bin/buf
[ -x "$buf" ] || { echo "buf: not installed (scripts/setup.sh does); skipped"; exit 77; }
"$buf" lint

# The last commit on main that is not this one: on main itself the commit before.
against=
for ref in refs/remotes/origin/main refs/heads/main; do
  commit=$(git rev-parse --verify --quiet "$ref^{commit}" || true)
  [ -n "$commit" ] || continue
  if [ "$commit" = "$(git rev-parse HEAD)" ]; then commit=$(git rev-parse --verify --quiet "$commit^" || true); fi
  against=$commit
  break
done
if [ -z "$against" ] || [ -z "$(git ls-tree --name-only "$against" proto/patchmill 2>/dev/null)" ]; then
  echo "buf: lint clean; no earlier contract to compare with"
  exit 0
fi
before=$(mktemp -d)
trap 'rm -rf "$before"' EXIT
git archive "$against" buf.yaml proto | tar -x -C "$before"
"$buf" breaking --against "$before"
echo "buf: lint clean; compatible with $against"

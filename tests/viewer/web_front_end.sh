#!/usr/bin/env bash
# web_front_end.sh NODE FOLDER: checks the types of the web front end, builds it and runs its tests.
set -euo pipefail
node=$1
cd "$2"
"$node" build.mjs
"$node" node_modules/typescript/bin/tsc --noEmit
exec "$node" --test --test-force-exit "test/*.test.mjs"

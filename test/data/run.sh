#!/usr/bin/env bash
# The objects in data/ are sound meshes with sound annotations. usage: run.sh PROJECT COMMAND
set -euo pipefail
count=0
for annotations in "$1"/data/*.ant.json; do
    mesh=${annotations%.ant.json}.ply
    "$2" mesh info "$mesh" --quiet >/dev/null || { echo "$mesh: not a sound mesh" >&2; exit 1; }
    "$2" annotation check "$mesh" "$annotations" || { echo "$annotations: not sound" >&2; exit 1; }
    count=$((count + 1))
done
[ $count -ge 5 ] || { echo "only $count annotated objects in data/" >&2; exit 1; }

#!/usr/bin/env bash
# Installs a build into a tree of its own, builds the consumer and the example of doc/operations.md against that tree and runs both.
# usage: run.sh BUILD SCRATCH [cmake options of the consumer...]
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$1
scratch=$2
shift 2
rm -rf "$scratch"
cmake --install "$build" --prefix "$scratch/tree" >/dev/null
"$scratch/tree/bin/ostraka" --version
# Programs that only the command needs must not be asked for: CLI11 is hidden from the consumer.
cmake -S "$here" -B "$scratch/consumer" -G Ninja -DCMAKE_BUILD_TYPE=Release --no-warn-unused-cli -DCMAKE_PREFIX_PATH="$scratch/tree" \
    -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON "$@" >"$scratch/configure.log" ||
    { cat "$scratch/configure.log" >&2; exit 1; }
cmake --build "$scratch/consumer"
"$scratch/consumer/consumer"
"$scratch/consumer/add_operation"
rm -rf "$scratch"

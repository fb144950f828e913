#!/usr/bin/env bash
# The version stands in CMakeLists.txt; what else names one says the same.
# usage: run.sh SOURCE_FOLDER COMMAND
set -euo pipefail
version=$(sed -n 's/^project(ostraka VERSION \([0-9.]*\).*/\1/p' "$1/CMakeLists.txt")
fail() { echo "version: $1 does not say $version" >&2; exit 1; }
[ -n "$version" ] || fail CMakeLists.txt
[ "$("$2" --version)" = "$version" ] || fail "the command"
grep -qx "version: $version" "$1/CITATION.cff" || fail CITATION.cff
[ "$(grep -m1 '^## ' "$1/CHANGELOG.md")" = "## $version" ] || fail CHANGELOG.md

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
# A commit that is tagged as a version is that one.
tag=$(git -C "$1" tag --points-at HEAD 2>/dev/null | grep -x 'v[0-9.]*' | head -1 || true)
[ -z "$tag" ] || [ "$tag" = "v$version" ] || fail "the tag $tag"

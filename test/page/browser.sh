#!/usr/bin/env bash
# The viewer built anew is the one that is kept, and pages work in a real browser; 77 (skipped) where Node, the packages of web/ or
# the browser are missing.
# usage: browser.sh PROJECT COMMAND viewer|browser
set -euo pipefail
project=$1 command=$2 what=$3
[ "$what" != viewer ] || (cd "$project/web" && sha256sum --quiet -c pages.sha256)
skip() { echo "SKIPPED: $1; scripts/test --browser installs it" >&2; exit 77; }
command -v node >/dev/null || skip "Node is missing"
[ -d "$project/web/node_modules/three" ] || skip "the packages of web/ are missing"
cd "$project/web"
if [ "$what" = viewer ]; then
    npx tsc --noEmit
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
    npx vite build --outDir "$folder" --emptyOutDir >/dev/null
    cmp "$folder/report.html" viewer.html || { echo "web/viewer.html is not what its sources make: npm run build" >&2; exit 1; }
    exit
fi
export OSTRAKA_CHROMIUM=${OSTRAKA_CHROMIUM:-$(command -v chromium || true)}
[ -n "$OSTRAKA_CHROMIUM" ] || skip "Chromium is missing"
exec node test/report.test.mjs "$command" "$project"

#!/usr/bin/env bash
# The stored pages are what their sources build, and they work in a real browser; 77 (skipped) where Node, the packages of web/ or the
# browser are missing.
# usage: browser.sh PROJECT COMMAND built|report|workbench
set -euo pipefail
project=$1 command=$2 what=$3
[ "$what" != built ] || (cd "$project/web" && sha256sum --quiet -c pages.sha256)
skip() { echo "SKIPPED: $1; scripts/test --browser installs it" >&2; exit 77; }
command -v node >/dev/null || skip "Node is missing"
[ -d "$project/web/node_modules/three" ] || skip "the packages of web/ are missing"
cd "$project/web"
if [ "$what" = built ]; then
    npm run check --silent
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
    npx vite build --outDir "$folder" --emptyOutDir >/dev/null
    npx vite build --mode workbench --outDir "$folder" --emptyOutDir false >/dev/null
    cmp "$folder/report.html" viewer.html || { echo "web/viewer.html differs from what its sources build: run npm run build in web/" >&2; exit 1; }
    cmp "$folder/workbench.page.html" workbench.html || { echo "web/workbench.html differs from what its sources build: run npm run build in web/" >&2; exit 1; }
    exit
fi
export OSTRAKA_CHROMIUM=${OSTRAKA_CHROMIUM:-$(command -v chromium || true)}
[ -n "$OSTRAKA_CHROMIUM" ] || skip "Chromium is missing"
exec node "test/$what.test.mjs" "$command" "$project"

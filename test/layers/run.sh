#!/usr/bin/env bash
# scripts/check-layers accepts the project and finds what is wrong in a copy that breaks the rules.
# usage: run.sh PROJECT SCRATCH
set -euo pipefail
project=$1
scratch=$2
"$project/scripts/check-layers" "$project"
rm -rf "$scratch"
mkdir -p "$scratch"/{doc,src/core,src/io,src/render,include/ostraka/core}
cp "$project/doc/architecture.md" "$scratch/doc"

refuses() {  # refuses FILE LINE MESSAGE: the line in the file makes the check fail with this message
    mkdir -p "$(dirname "$scratch/$1")"
    echo "$2" >"$scratch/$1"
    if "$project/scripts/check-layers" "$scratch" >/dev/null 2>"$scratch/message"; then
        echo "not found: $2 in $1" >&2; exit 1
    fi
    grep -q -- "$3" "$scratch/message" || { echo "expected '$3', got:" >&2; cat "$scratch/message" >&2; exit 1; }
    rm "$scratch/$1"
}
accepts() {
    echo "$2" >"$scratch/$1"
    "$project/scripts/check-layers" "$scratch" >/dev/null
    rm "$scratch/$1"
}
refuses src/core/a.cpp '#include "ostraka/io/mesh_file.h"' 'src/core/a.cpp:1: core (floor 0) includes'
refuses src/render/a.cpp '#include "ostraka/io/mesh_file.h"' 'only lower floors'
refuses include/ostraka/core/a.h '  #  include <ostraka/geom/surface_search.h>' 'include/ostraka/core/a.h:1'
refuses src/io/a.cpp '#include "ostraka/nowhere/a.h"' 'module nowhere is not in the table'
refuses src/io/a.cpp '#include "../render/canvas.h"' 'by a path'
refuses src/nowhere/a.cpp '#include <vector>' 'module nowhere is not in the table'
refuses src/a.cpp '#include <vector>' 'belongs to no module'
refuses src/io/a.cpp '#include "render/canvas.h"' 'src/io/a.cpp:1: includes render/canvas.h, a private header of render'
refuses src/io/a.cpp '#include "formats.h"' 'write "io/formats.h"'
accepts src/io/a.cpp '#include "io/formats.h"'
mkdir -p "$scratch/include/ostraka/io"
printf 'namespace ostraka {\nstruct Same {\n};\n}\n' >"$scratch/include/ostraka/core/same.h"
refuses src/io/same.h 'namespace ostraka {
struct Same : Other {' 'ostraka::Same is also defined in include/ostraka/core/same.h'
accepts src/io/same.h 'namespace ostraka::io {
struct Same {'
accepts src/io/same.h 'namespace ostraka {
struct Same;'
rm "$scratch/include/ostraka/core/same.h"
accepts src/io/a.cpp '#include "ostraka/geom/surface_search.h"'
accepts src/io/a.cpp '#include "ostraka/io/mesh_file.h"'
echo "all found"
rm -rf "$scratch"

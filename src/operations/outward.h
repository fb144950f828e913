// Objects that are inside out, turned over in memory.
#pragma once

#include "operations/operations.h"

#include "ostraka/mesh/orientation.h"
#include "ostraka/transfer/moved_annotations.h"

#include <fmt/core.h>

#include <optional>
#include <string>

namespace ostraka {

/// The object with its faces turned over, and a note, if it is inside out; else nothing.
inline std::optional<AnnotatedMesh> outward(AnnotatedMeshView object, const std::string& file, Report& report) {
    if (!is_inside_out(object.mesh)) return std::nullopt;
    report.note(
        fmt::format("{} is inside out: its faces were turned over in memory (ostraka mesh repair corrects the file)", file));
    return turned_over(object);
}

}  // namespace ostraka

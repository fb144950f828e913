// Groups, objects and materials that an OBJ file assigns to its faces.
#pragma once

#include "ostraka/files/file.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

/// Statement of an OBJ file that divides its faces.
enum class ObjStatement { group, object, material };

/// The parts of an OBJ file.
struct ObjParts {
    std::vector<std::string> names;        ///< names of the parts, in the order of their first face
    std::vector<std::int32_t> of_polygon;  ///< for each polygon of the file: index of its part; -1: before the first statement
};

/// Reads the parts of an OBJ file: by its statements g (a face in several groups belongs to the group of all their names), o or
/// usemtl, whether or not an MTL file describes the material. Polygons are numbered as by `read_polygons`. Throws Error (input)
/// if the file cannot be read.
ObjParts read_obj_parts(const Path& file, ObjStatement statement);

}  // namespace ostraka

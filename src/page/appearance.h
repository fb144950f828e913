// Colours and textures of objects in the data of a page.
#pragma once

#include "ostraka/files/json.h"
#include "ostraka/io/surface_look.h"
#include "ostraka/io/textured_vertices.h"
#include "ostraka/page/page.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

using KeepBytes = std::function<std::size_t(std::string_view)>;  ///< stores bytes in the page and returns their index

/// Encodes ascending numbers as gaps and runs, seven bits per byte.
std::string runs_of(const std::vector<Index>& faces);

/// Throws Error (input), naming the object, for lists that do not fit the mesh.
void check_extras(const MeshExtras& extras, const TriangleSoup& soup, const std::string& name);

/// Own colours: red, green and blue of each vertex, or of each face. Null if there are none.
JsonValue colours_json(const MeshExtras& extras, const KeepBytes& keep, JsonAllocator& allocator);

/// Materials with their faces, and images reduced to the budget of a page. `notes`: images that were reduced. `name`: the object.
JsonValue materials_json(const MeshExtras& extras, const std::string& name, const KeepBytes& keep, JsonAllocator& allocator,
                         std::vector<std::string>& notes);

}  // namespace ostraka

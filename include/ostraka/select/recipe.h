// Recipes: how annotations are made, step by step, so that they can be made again on any resolution of an object
// (doc/recipes.md).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/file.h"

namespace ostraka {

/// Follows a recipe (*.recipe.json). `face_labels` are the labels of the mesh's faces, if it has any. Measures are taken and
/// known descriptors computed. Where the recipe names a class, the whole object is annotated too. The same recipe and mesh give
/// the same set to the bit. Throws Error (input) that names the file, the JSON pointer of the step and the remedy.
AnnotationSet apply_recipe(const Path& file, const Mesh& mesh, const std::vector<std::int32_t>& face_labels = {});
AnnotationSet apply_recipe(const JsonValue& recipe, const Mesh& mesh, const std::vector<std::int32_t>& face_labels,
                           const std::string& where);

}  // namespace ostraka

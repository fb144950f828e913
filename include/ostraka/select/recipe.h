// Recipes: how annotations are made, step by step, so that they can be made again on any resolution of an object
// (doc/recipes.md).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/file.h"

namespace ostraka {

/// What a recipe is followed with.
struct RecipeStart {
    std::vector<std::int32_t> face_labels;  ///< of the mesh's faces, if it has any
    AnnotationSet annotations;              ///< that the recipe's steps edit, and to which they add
    Path folder;                            ///< where files that the recipe names lie
};

/// Follows a recipe (*.recipe.json). Measures are taken and known descriptors computed. Where the recipe names a class, the whole
/// object is annotated too. The same recipe, start and mesh give the same set to the bit. Throws Error (input) that names the
/// file, the JSON pointer of the step and the remedy.
AnnotationSet follow_recipe(const JsonValue& recipe, const Mesh& mesh, RecipeStart start, const std::string& where);

/// The files that a recipe's thresholds read, in its order, each once.
std::vector<Path> files_named_by(const JsonValue& recipe, const Path& folder);

/// The same from nothing; files that the recipe names lie in its own folder (in the current one).
AnnotationSet apply_recipe(const Path& file, const Mesh& mesh, const std::vector<std::int32_t>& face_labels = {});
AnnotationSet apply_recipe(const JsonValue& recipe, const Mesh& mesh, const std::vector<std::int32_t>& face_labels,
                           const std::string& where);

}  // namespace ostraka

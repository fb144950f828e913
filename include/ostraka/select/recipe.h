// Recipes: annotations described step by step, so that they can be reproduced on any resolution of an object (doc/recipes.md).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/files/file.h"

namespace ostraka {

/// Initial state for a recipe.
struct RecipeStart {
    std::vector<std::int32_t> face_labels;  ///< labels of the mesh's faces, if any
    AnnotationSet annotations;              ///< annotations that the steps of the recipe edit and extend
    Path folder;                            ///< folder that file names in the recipe are relative to
};

/// Executes a recipe (*.recipe.json). Measures are taken and known descriptors computed. If the recipe names a class, the whole
/// object is annotated too. The same recipe, start and mesh give the same set to the bit. Throws Error (input) that names the
/// file, the JSON pointer of the step and the remedy.
AnnotationSet follow_recipe(const JsonValue& recipe, const Mesh& mesh, RecipeStart start, const std::string& where);

/// The files that a recipe's thresholds read, in the recipe's order without duplicates.
std::vector<Path> files_named_by(const JsonValue& recipe, const Path& folder);

/// Executes a recipe without initial annotations. File names in the recipe are relative to the recipe's folder (second form: to
/// the current folder).
AnnotationSet apply_recipe(const Path& file, const Mesh& mesh, const std::vector<std::int32_t>& face_labels = {});
AnnotationSet apply_recipe(const JsonValue& recipe, const Mesh& mesh, const std::vector<std::int32_t>& face_labels,
                           const std::string& where);

}  // namespace ostraka

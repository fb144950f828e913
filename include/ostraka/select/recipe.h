// Recipes: descriptions of annotations step by step, so that the annotations can be reproduced at any resolution of an object
// (doc/recipes.md).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/files/file.h"
#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// Initial state for executing a recipe.
struct RecipeStart {
    std::vector<std::int32_t> face_labels;  ///< label of each face of the mesh; empty: none
    AnnotationSet annotations;              ///< annotations that the steps of the recipe extend and edit
    Path folder;                            ///< folder to which file names in the recipe are relative
    /// Colours, texture and values of the mesh, for selections by them; must outlive the call; null: none.
    const MeshExtras* attributes = nullptr;
};

/// Executes a recipe (*.recipe.json). Measures and known descriptors are computed. If the recipe names a class, the whole object
/// is annotated too. The same recipe, start and mesh give the same annotations to the bit. `where` names the recipe file in
/// errors. Throws Error (input) that names the file, the JSON pointer of the step and the remedy.
AnnotationSet follow_recipe(const JsonValue& recipe, const Mesh& mesh, RecipeStart start, const std::string& where);

/// Files that the thresholds of a recipe read, in the order of the recipe, without duplicates.
std::vector<Path> files_named_by(const JsonValue& recipe, const Path& folder);

/// Executes a recipe file without initial annotations. File names in the recipe are relative to the recipe's folder.
AnnotationSet apply_recipe(const Path& file, const Mesh& mesh, const std::vector<std::int32_t>& face_labels = {});
/// Executes a recipe without initial annotations. File names in the recipe are relative to the current folder.
AnnotationSet apply_recipe(const JsonValue& recipe, const Mesh& mesh, const std::vector<std::int32_t>& face_labels,
                           const std::string& where);

}  // namespace ostraka

// The colours of a mesh file in pictures: which of them are shown, and which are not.
#pragma once

#include "ostraka/annotation/curves.h"
#include "ostraka/core/options.h"
#include "ostraka/io/surface_look.h"
#include "ostraka/render/scene.h"

#include <string>
#include <vector>

namespace ostraka {

/// What colours a surface: the texture of the file, the colours of its vertices or faces, annotations, values, labels, or nothing
/// (the colour of clay). Automatic: the first of values, annotations, texture, labels and own colours that there is.
enum class SurfaceColouring { automatic, texture, own, annotations, values, labels, plain };

/// Names of the colourings, in this order, for an option.
Choices colouring_names();
std::string to_string(SurfaceColouring colouring);  ///< name of a colouring

/// What a page shows first; the viewer of the page switches.
enum class PageColouring { automatic, texture, own, annotations, values, plain };
Choices page_colouring_names();                       ///< names of these, in this order, for an option
std::string page_colouring(PageColouring colouring);  ///< as PageObject::colouring
inline constexpr const char* page_colouring_help =
    "colours that the page initially shows: texture or own (colours of vertices or faces) in the file, annotations, values (the "
    "first map) or clay (one neutral colour); auto: annotations if there are any, otherwise the texture, otherwise the colours "
    "of vertices or faces";

bool has_labels(const MeshExtras& extras);  ///< true if vertices or faces have labels

/// Whether the object has what this colouring shows. `values`, `annotated`: whether it has values or annotations.
bool is_available(SurfaceColouring colouring, const MeshExtras& extras, bool values, bool annotated);

/// The colouring that is shown for `wanted`. Throws Error (usage or input), naming `file`, for a colouring that is not available.
SurfaceColouring chosen_colouring(SurfaceColouring wanted, const MeshExtras& extras, bool values, bool annotated,
                                  const std::string& file);

/// A remark on the texture or colours in the file that this colouring does not show; empty: all are shown.
std::string hidden_colours(SurfaceColouring colouring, const MeshExtras& extras);

/// Colours the scene by the texture and the colours, which multiply it. Images are decoded. `where`: file for messages.
void show_texture(Scene& scene, const MeshExtras& extras, const std::string& where);
/// Colours the scene by the colours of faces, or else of vertices.
void show_own_colours(Scene& scene, const MeshExtras& extras);
/// Adapts texture and colours of the scene to its mesh after the mesh was cut.
void cut_scene_colours(Scene& scene, const CutMesh& cut, const Mesh& before);

}  // namespace ostraka

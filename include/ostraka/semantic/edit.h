// Edits of a shape through handles: selection of handles and operations on them (thesis, section 5.2.3; doc/deformation.md).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/core/json.h"

namespace ostraka {

/// The handles of a shape: the vertices of a cage with weights for the mesh, or without a cage the vertices of the mesh itself.
struct HandleSpace {
    const Mesh& mesh;
    const AnnotationSet& set;
    const Mesh* cage = nullptr;
    const Coordinates* coordinates = nullptr;  ///< coordinates of the mesh in the cage
};

/// State after a step: positions of all handles, and the handles selected so far.
struct EditState {
    std::vector<Point> handles;
    std::vector<bool> touched;    ///< handles selected so far; vertices of nested cages that are only carried along do not
                                  ///< count
    std::vector<Index> selected;  ///< handles selected by this step
    std::vector<bool> named;      ///< vertices of the mesh that steps so far referred to, by annotation or index
    bool by_handles = false;      ///< true if a step so far selected vertices of the cage directly
    double threshold = 0;         ///< influence threshold by which cage vertices were selected; 0 if none was
};

/// The influence threshold from which cage vertices are assigned to a part (section 5.2.3): "auto-mesh" is the smallest row
/// maximum, so that each mesh vertex has a cage vertex; "auto-cage" is the smallest column maximum, so that each cage vertex
/// has a mesh vertex. `rows` restricts it to some mesh vertices (all if empty). Throws Error (usage) for another rule.
double influence_threshold(const WeightMatrix& weights, const std::string& rule, const std::vector<Index>& rows = {});
/// Cage vertices with a weight of at least `threshold` on one of the mesh vertices, ascending.
std::vector<Index> influential(const Coordinates& coordinates, const std::vector<Index>& rows, double threshold);

/// Cage vertices with at least `share` of the largest weight of one of the mesh vertices (a separate threshold for each mesh
/// vertex), ascending.
std::vector<Index> strongest(const Coordinates& coordinates, const std::vector<Index>& rows, double share = 0.999999);

/// Vertices of an annotation, ascending.
std::vector<Index> vertices_of(const Mesh& mesh, const Annotation& annotation);

/// True if the annotation selects all faces.
bool is_whole(const Mesh& mesh, const Annotation& annotation);

/// Validates and executes an edit; returns a state for each step. Throws Error (input) that names the step: schema not met,
/// missing annotation or tag shared by several, indices out of range, nothing selected (with the largest influence available),
/// no operation or several, zero axes and directions, numbers that are not finite, a wrong number of positions.
std::vector<EditState> follow_edit(const JsonValue& edit, const HandleSpace& space, const std::string& where);

}  // namespace ostraka

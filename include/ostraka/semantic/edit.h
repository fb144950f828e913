// Edits of a shape by its handles: which, and what is done to them (thesis, section 5.2.3; doc/deformation.md).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/core/json.h"

namespace ostraka {

/// What handles are: the vertices of a cage with weights for the mesh, or without a cage the vertices of the mesh itself.
struct HandleSpace {
    const Mesh& mesh;
    const AnnotationSet& set;
    const Mesh* cage = nullptr;
    const Coordinates* coordinates = nullptr;  ///< of the mesh in the cage
};

/// After a step: where all handles are, and which of them steps have selected so far.
struct EditState {
    std::vector<Point> handles;
    std::vector<bool> touched;    ///< vertices of cages within a cage that are carried along do not count
    std::vector<Index> selected;  ///< by this step
    std::vector<bool> named;      ///< vertices of the mesh that steps so far named, by annotation or index
    bool by_handles = false;      ///< a step so far selected handles of a cage themselves
    double threshold = 0;         ///< that selected cage vertices by influence, 0 if none did
};

/// The threshold of influence above which cage vertices count as those of a part (section 5.2.3): "auto-mesh" the smallest row
/// maximum, so that each mesh vertex has a cage vertex; "auto-cage" the smallest column maximum, so that each cage vertex has a
/// mesh vertex. `rows` restricts it to some mesh vertices; all if empty. Throws Error (usage) for another rule.
double influence_threshold(const WeightMatrix& weights, const std::string& rule, const std::vector<Index>& rows = {});
/// Cage vertices with a weight of at least `threshold` on one of the mesh vertices, ascending.
std::vector<Index> influential(const Coordinates& coordinates, const std::vector<Index>& rows, double threshold);

/// For each of the mesh vertices its own threshold: the cage vertices with at least `share` of its largest weight, ascending.
std::vector<Index> strongest(const Coordinates& coordinates, const std::vector<Index>& rows, double share = 0.999999);

/// Vertices of an annotation's selection, ascending.
std::vector<Index> vertices_of(const Mesh& mesh, const Annotation& annotation);

/// Whether it selects all faces.
bool is_whole(const Mesh& mesh, const Annotation& annotation);

/// Validates and follows an edit; a state for each step. Throws Error (input) naming the step: a schema that is not met, a
/// missing annotation or one that several have the tag of, indices out of range, nothing selected (with the largest influence
/// there is), no or several operations, zero axes and directions, numbers that are not finite, a wrong number of positions.
std::vector<EditState> follow_edit(const JsonValue& edit, const HandleSpace& space, const std::string& where);

}  // namespace ostraka

// Edits of a shape through handles: selection of handles and operations on them (thesis, section 5.2.3; doc/deformation.md).
// Files: doc/schema/edit.schema.json.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/files/json.h"

#include <Eigen/Core>

#include <variant>

namespace ostraka {

/// One step of an edit: an operation on selected handles.
struct EditStep {
    /// An annotation by its id or tag.
    using AnnotationName = std::variant<int, std::string>;
    struct Annotations {
        std::vector<AnnotationName> names;
    };
    struct MeshVertices {
        std::vector<Index> indices;
    };
    struct CageVertices {
        std::vector<Index> indices;
    };
    struct Box {
        Eigen::Vector3d min, max;
    };
    struct All {};
    std::variant<Annotations, MeshVertices, CageVertices, Box, All> select;

    /// How much influence on a selected mesh vertex selects a cage vertex: a number or a rule (influence_threshold);
    /// per_point: that of the largest weight of each vertex. Default: 0.4, or lower if a vertex would have no handle.
    enum class Rule { auto_mesh, auto_cage, per_point };
    std::optional<std::variant<double, Rule>> threshold = {};
    bool rule_within_selection = false;  ///< the rule considers the selected vertices only, not all of the mesh
    std::optional<std::size_t> level =
        {};  ///< level of nested cages, 0: the outermost; default: the innermost around the vertices

    struct Translate {
        Eigen::Vector3d by;
    };
    struct Rotate {
        Eigen::Vector3d axis;                        ///< unit vector
        double angle;                                ///< degrees
        std::optional<Eigen::Vector3d> centre = {};  ///< default: the mean of the handles
    };
    struct Scale {
        double factor;
        std::optional<Eigen::Vector3d> centre = {};  ///< default: the mean of the handles
    };
    struct Stretch {
        Eigen::Vector3d direction;  ///< unit vector
        double factor;
        struct Base {};                                         ///< the lowest handle along the direction
        struct Middle {};                                       ///< the mean of the handles
        std::variant<Base, Middle, Eigen::Vector3d> from = {};  ///< position that stays in place
    };
    struct MoveTo {
        std::vector<Eigen::Vector3d> places;  ///< one for each handle, in the order of the vertices
    };
    std::variant<Translate, Rotate, Scale, Stretch, MoveTo> operation;
};

struct Edit {
    std::vector<EditStep> steps;
};

/// Reads an edit. Throws Error (input) that names the step: schema not met, no way or several ways of selecting, no operation or
/// several, zero axes and directions, numbers that are not finite or too large.
Edit edit_from_json(const JsonValue& document, const std::string& where);

/// A direction of any length as a unit vector, as files are read.
Eigen::Vector3d unit_direction(const Eigen::Vector3d& direction);

/// The handles of a shape: the vertices of a cage with weights for the mesh, or without a cage the vertices of the mesh itself.
struct HandleSpace : AnnotatedMeshView {
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

/// Executes an edit; returns a state for each step. Throws Error (input) that names the step: missing annotation or tag shared by
/// several, indices out of range, nothing selected (with the largest influence available), handles moved too far, a wrong number
/// of positions.
std::vector<EditState> follow_edit(const Edit& edit, const HandleSpace& space, const std::string& where);

}  // namespace ostraka

// Edits of a shape through handles: selection of handles and operations on the handles (thesis, section 5.2.3;
// doc/deformation.md). File format: doc/schema/edit.schema.json.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/files/json.h"

#include <Eigen/Core>

#include <variant>

namespace ostraka {

/// One step of an edit: an operation on selected handles.
struct EditStep {
    /// An annotation, given by its id or tag.
    using AnnotationName = std::variant<int, std::string>;
    /// Selects the mesh vertices of annotations or, with a cage, the cage vertices that influence these vertices.
    struct Annotations {
        std::vector<AnnotationName> names;  ///< ids or tags of the annotations
    };
    /// Selects mesh vertices or, with a cage, the cage vertices that influence these vertices.
    struct MeshVertices {
        std::vector<Index> indices;  ///< indices of mesh vertices
    };
    /// Selects vertices of the cage.
    struct CageVertices {
        std::vector<Index> indices;  ///< indices of cage vertices
    };
    /// Selects the handles within an axis-parallel box.
    struct Box {
        Eigen::Vector3d min, max;  ///< opposite corners of the box
    };
    /// Selects all handles.
    struct All {};
    /// Selection of the handles.
    std::variant<Annotations, MeshVertices, CageVertices, Box, All> select;

    /// A cage vertex is selected if its weight at a selected mesh vertex is at least this threshold: a number, a rule
    /// (influence_threshold), or per_point (only the cage vertices with the largest weight at each mesh vertex). Empty: 0.4, or
    /// a lower threshold if a mesh vertex would have no handle.
    enum class Rule { cover_mesh, cover_cage, per_point };
    std::optional<std::variant<double, Rule>> threshold = {};
    bool rule_within_selection = false;  ///< true: the rule considers the selected vertices only; false: all vertices of the mesh
    /// Number of the cage in which handles are selected: 0 is the outermost cage, inner cages count from 1 in the order of the
    /// file, after the cage that contains them; empty: the innermost cage that contains the vertices.
    std::optional<std::size_t> level = {};

    /// Moves the handles by a vector.
    struct Translate {
        Eigen::Vector3d by;  ///< displacement
    };
    struct Rotate {
        Eigen::Vector3d axis;                        ///< unit vector
        double angle;                                ///< degrees
        std::optional<Eigen::Vector3d> centre = {};  ///< empty: the mean of the handles
    };
    /// Scales the handles about a centre.
    struct Scale {
        double factor;                               ///< scale factor
        std::optional<Eigen::Vector3d> centre = {};  ///< empty: the mean of the handles
    };
    /// Stretches the handles along a direction.
    struct Stretch {
        Eigen::Vector3d direction;                              ///< unit vector
        double factor;                                          ///< stretch factor
        struct Base {};                                         ///< the lowest handle along the direction
        struct Middle {};                                       ///< the mean of the handles
        std::variant<Base, Middle, Eigen::Vector3d> from = {};  ///< the position that stays in place
    };
    /// Moves each handle to a given position.
    struct MoveTo {
        std::vector<Eigen::Vector3d> places;  ///< one position per handle, in the order of the vertices
    };
    /// Operation on the selected handles.
    std::variant<Translate, Rotate, Scale, Stretch, MoveTo> operation;
};

/// A sequence of steps.
struct Edit {
    std::vector<EditStep> steps;  ///< steps in the order of execution
};

/// Reads an edit from JSON. Throws Error (input) that names the step: schema violated, no selection or several selections, no
/// operation or several operations, axes and directions of length zero, numbers that are not finite or too large.
Edit edit_from_json(const JsonValue& document, const std::string& where);

/// The unit vector of a direction of any length, computed as for directions in files.
Eigen::Vector3d unit_direction(const Eigen::Vector3d& direction);

/// The handles of a shape: the vertices of a cage with weights for the mesh, or without a cage the vertices of the mesh itself.
struct HandleSpace : AnnotatedMeshView {
    const Mesh* cage = nullptr;                ///< null: the handles are the mesh's vertices
    const Coordinates* coordinates = nullptr;  ///< coordinates of the mesh in the cage; null without a cage
};

/// State after a step of an edit: positions of all handles, and the handles selected so far.
struct EditState {
    std::vector<Point> handles;  ///< positions of all handles
    /// For each handle: true if this or an earlier step selected it; vertices of nested cages that only follow their parent
    /// cage are not marked.
    std::vector<bool> touched;
    std::vector<Index> selected;  ///< indices of the handles selected by this step
    /// For each vertex of the mesh: true if this or an earlier step referred to it by annotation or index.
    std::vector<bool> is_referenced;
    bool by_handles = false;  ///< true: this or an earlier step selected vertices of the cage directly
    double threshold = 0;     ///< min influence with which cage vertices were selected; 0 if no threshold was used
};

/// Computes the threshold on weights by which cage vertices are assigned to a part (section 5.2.3). Rule "auto-mesh": the
/// smallest row maximum of the weights, so that each mesh vertex is influenced by at least one cage vertex; "auto-cage": the
/// smallest column maximum, so that each cage vertex influences at least one mesh vertex. `rows` restricts the rule to these
/// mesh vertices (all if empty). Throws Error (usage) for another rule.
double influence_threshold(const WeightMatrix& weights, const std::string& rule, const std::vector<Index>& rows = {});
/// Cage vertices with a weight of at least `threshold` on one of the mesh vertices in `rows`, ascending.
std::vector<Index> influential(const Coordinates& coordinates, const std::vector<Index>& rows, double threshold);

/// Cage vertices with at least `share` of the largest weight on one of the mesh vertices in `rows` (each mesh vertex has its own
/// largest weight), ascending.
std::vector<Index> strongest(const Coordinates& coordinates, const std::vector<Index>& rows, double share = 0.999999);

/// Indices of the vertices of an annotation, ascending.
std::vector<Index> vertices_of(const Mesh& mesh, const Annotation& annotation);

/// True if the annotation selects all faces.
bool is_whole(const Mesh& mesh, const Annotation& annotation);

/// Executes an edit; returns the state after each step. `where` names the edit in errors. Throws Error (input) that names the
/// step: missing annotation or tag shared by several annotations, indices out of range, no handle selected (the message gives
/// the largest weight), handles moved too far, a wrong number of positions.
std::vector<EditState> follow_edit(const Edit& edit, const HandleSpace& space, const std::string& where);

}  // namespace ostraka

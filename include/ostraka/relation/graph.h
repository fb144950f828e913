// The graph of relationships among annotations (thesis, section 2.3) and its file (Appendix B.2).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/files/provenance.h"

#include <memory>
#include <optional>

namespace ostraka {

/// Types of relationships that follow from geometry.
enum class GeometricRelation {
    containment,
    equal_selections,
    adjacency,
    mirror_symmetry,
    co_axiality,
    co_linearity,
    co_planarity,
    same_level,
    parallel_axes,
    perpendicular_axes,
    horizontal_support,
    side_contact,
    part_similarity,
    equal_attributes
};

/// Properties of a type of relationship.
struct RelationType {
    std::string name;              ///< canonical name of the type
    std::size_t minimum, maximum;  ///< min and max number of members; maximum = 0: any number
    /// The geometric type; empty for the constraints of the thesis, which cannot be extracted from the geometry.
    std::optional<GeometricRelation> geometric;
    bool directed = false;  ///< for geometric types: true if the first annotation is the subject of the relationship
    std::vector<std::string> quantities = {};  ///< names of the quantities that RelationMeter measures
};
/// All known types: the geometric ones in the order of GeometricRelation, then the others.
const std::vector<RelationType>& relation_types();
/// Properties of a geometric type.
const RelationType& relation_type(GeometricRelation kind);
/// The type of that name, ignoring case; nullptr for any other name, which is a user-defined type.
const RelationType* find_relation_type(const std::string& name);
/// The name of a known type with the most similar spelling.
std::string nearest_relation_type(const std::string& name);

/// A line given by a point and its direction, or a plane given by a point and its normal; `direction` is a unit vector.
struct PointAndDirection {
    std::array<double, 3> point{0, 0, 0}, direction{0, 0, 1};  ///< a point of the line or plane, and the direction
};

/// One measured quantity of a geometric relationship, e.g. the angle between two axes.
struct Deviation {
    std::string quantity;         ///< name of the quantity
    std::optional<double> value;  ///< measured value; empty in a relationship that was stated but not checked
    /// Max value with which the relationship holds, in `unit`, at least 0; empty: the default tolerance.
    std::optional<double> tolerance;
    std::string unit;  ///< "mm", "degree", "%" ...
};

/// Measured properties of a geometric relationship.
struct RelationParameters {
    std::vector<Deviation> deviations;             ///< measured quantities of the relationship
    std::optional<PointAndDirection> plane, axis;  ///< mirror plane or common plane, and common axis; empty: not applicable
    std::optional<std::array<double, 3>> up;       ///< upward direction; empty if the relationship does not depend on one
    std::string attribute;                         ///< name of the attribute with equal values, for "equal attributes"
    /// True if no property was measured.
    [[nodiscard]] bool empty() const { return deviations.empty() && !plane && !axis && !up && attribute.empty(); }
};

/// A relationship between annotations.
struct Relationship {
    int id = 0;
    std::string type;               ///< name of the type
    bool directed = false;          ///< true: the first annotation is the subject, the second the object
    std::vector<int> annotations;   ///< ids of the annotations, distinct; for containment [container, contained]
    bool is_constraint = false;     ///< true: the relationship is a constraint that a deformation preserves
    double weight = 1;              ///< weight of a constraint
    std::string constraint;         ///< parameters of a constraint as the text of a JSON object; empty: no parameters
    std::string origin;             ///< "extracted", "stated", or empty if the file does not specify it
    RelationParameters parameters;  ///< measured properties of a geometric relationship
};

/// Creates a relationship of a geometric type, with the origin "extracted".
Relationship extracted_relationship(GeometricRelation kind, int id, std::vector<int> annotations);

/// Relationships among the annotations of one object.
struct RelationGraph {
    std::vector<Relationship> relationships;
    Json provenance;  ///< provenance as read from the file; null if absent
};

/// An id that no relationship of the graph has (core/ids.h).
int free_id(const RelationGraph& graph);

/// The relationship of `graph` equivalent to `relationship`: same type, members (in any order if undirected), constraint and
/// attribute; nullptr if there is none. Tolerances and origin are ignored.
const Relationship* find_equivalent(const RelationGraph& graph, const Relationship& relationship);

/// Index of a graph's relationships for repeated searches of equivalent relationships. The graph may change after the index is
/// built.
class RelationshipIndex {
public:
    explicit RelationshipIndex(const RelationGraph& graph);  ///< builds the index
    ~RelationshipIndex();
    /// The id of the first relationship in the index that is equivalent to this one; empty: there is none.
    [[nodiscard]] std::optional<int> find(const Relationship& relationship) const;

private:
    struct Said;
    std::unique_ptr<Said> said_;
};

/// Checks one relationship in the same way as `check_graph`; `place` names the relationship in errors. Throws Error (input).
void check_relationship(const Relationship& relationship, const AnnotationSet& set, const std::string& place);

/// Checks a graph on its annotations; `where` names the file in errors. Throws Error (input) that names the relationship and the
/// remedy: duplicate id, missing annotation, annotation twice in one relationship, too few or too many members for the type,
/// direction that contradicts the type, negative or non-finite weight or tolerance, constraint that is not a JSON object,
/// duplicate relationship. User-defined types are allowed.
void check_graph(const RelationGraph& graph, const AnnotationSet& set, const std::string& where);

/// Reads the relationship graph (*.graph.json) of these annotations, in Ostraka's format or the thesis's (which has no format
/// member). Known types get their canonical spelling. Throws Error (input) that names the file and the JSON pointer or the
/// relationship.
RelationGraph read_graph(const Path& file, const AnnotationSet& set);
/// Reads a graph from JSON, with the checks of read_graph; `where` names the file in errors.
RelationGraph graph_from_json(const JsonValue& document, const AnnotationSet& set, const std::string& where);

/// Writes a graph that `check_graph` accepts, atomically; the same graph and provenance give the same bytes.
void write_graph(const Path& file, const RelationGraph& graph, const AnnotationSet& set, const Provenance& provenance);
Json graph_to_json(const RelationGraph& graph, const Provenance& provenance);                ///< the graph as a JSON document
JsonValue relationship_to_json(const Relationship& relationship, JsonAllocator& allocator);  ///< one relationship as JSON

/// The graph in Graphviz DOT: a node for each annotation in the annotation's colour, an arc for each relationship of two
/// annotations, a small node for each relationship of one or of more than two annotations. Text of annotations is untrusted:
/// quotes, backslashes, angle brackets and ampersands are escaped, so that they remain text in DOT and in its renderings (SVG,
/// HTML).
std::string graph_to_dot(const RelationGraph& graph, const AnnotationSet& set);

}  // namespace ostraka

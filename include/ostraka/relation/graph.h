// The graph of relationships among annotations (thesis, section 2.3) and its file (Appendix B.2).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/files/provenance.h"

#include <memory>
#include <optional>

namespace ostraka {

/// Relationships that follow from geometry.
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
    std::string name;
    std::size_t minimum, maximum;                ///< number of members; maximum = 0: any number
    std::optional<GeometricRelation> geometric;  ///< the geometric type; empty for a constraint of the thesis, which can only
                                                 ///< be stated
    bool directed = false;                       ///< for geometric types: the first annotation is the subject
    std::vector<std::string> quantities = {};    ///< quantities measured by RelationMeter
};
/// All known types: the geometric ones in the order of GeometricRelation, then the others.
const std::vector<RelationType>& relation_types();
const RelationType& relation_type(GeometricRelation kind);
/// The type of that name, ignoring case; nullptr if there is none: experts may define further types.
const RelationType* find_relation_type(const std::string& name);
/// The known name with the most similar spelling.
std::string nearest_relation_type(const std::string& name);

/// A line, or a plane given by its normal as direction. The direction is a unit vector.
struct PointAndDirection {
    std::array<double, 3> point{0, 0, 0}, direction{0, 0, 1};
};

/// One measured quantity of a geometric relationship, e.g. the angle between two axes.
struct Deviation {
    std::string quantity;
    std::optional<double> value;      ///< measured value; absent in a relationship that was stated but not checked
    std::optional<double> tolerance;  ///< in `unit`, at least 0; the relationship holds if value <= tolerance
    std::string unit;                 ///< "mm", "degree", "%" ...
};

struct RelationParameters {
    std::vector<Deviation> deviations;
    std::optional<PointAndDirection> plane, axis;
    std::optional<std::array<double, 3>> up;  ///< upward direction, if the relationship depends on it
    std::string attribute;                    ///< name of the attribute, for "equal attributes"
    [[nodiscard]] bool empty() const { return deviations.empty() && !plane && !axis && !up && attribute.empty(); }
};

struct Relationship {
    int id = 0;
    std::string type;
    bool directed = false;         ///< the first annotation is the subject
    std::vector<int> annotations;  ///< distinct ids; containment is [container, contained]
    bool is_constraint = false;
    double weight = 1;       ///< weight of a constraint
    std::string constraint;  ///< parameters of a constraint as the text of a JSON object; empty for {}
    std::string origin;      ///< "extracted", "stated", or empty if the file does not specify it
    RelationParameters parameters;
};

/// A relationship of a geometric type, marked as extracted.
Relationship extracted_relationship(GeometricRelation kind, int id, std::vector<int> annotations);

struct RelationGraph {
    std::vector<Relationship> relationships;
    Json provenance;  ///< as read; null if absent
};

/// A fresh id (core/ids.h).
int free_id(const RelationGraph& graph);

/// The relationship of `graph` equivalent to this one: same type, members (in any order if undirected), constraint and
/// attribute; nullptr if there is none. Tolerances and origin are ignored.
const Relationship* find_twin(const RelationGraph& graph, const Relationship& relationship);

/// Index of a graph's relationships for repeated searches of equivalent ones. The graph may change meanwhile.
class Twins {
public:
    explicit Twins(const RelationGraph& graph);
    ~Twins();
    /// The id of the first equivalent relationship.
    [[nodiscard]] std::optional<int> find(const Relationship& relationship) const;

private:
    struct Said;
    std::unique_ptr<Said> said_;
};

/// Checks a single relationship as `check_graph` does; `place` is named in errors.
void check_relationship(const Relationship& relationship, const AnnotationSet& set, const std::string& place);

/// Throws Error (input) that names the relationship and the remedy: duplicate id, missing annotation, annotation twice in one
/// relationship, too few or too many members for the type, direction that contradicts the type, negative or non-finite weight
/// or tolerance, constraint that is not a JSON object, duplicate relationship. User-defined types are allowed.
void check_graph(const RelationGraph& graph, const AnnotationSet& set, const std::string& where);

/// Reads a *.graph.json of these annotations, in our format or the thesis's (which has no format member). Known types get their
/// canonical spelling. Throws Error (input) that names the file and the JSON pointer or the relationship.
RelationGraph read_graph(const Path& file, const AnnotationSet& set);
RelationGraph graph_from_json(const JsonValue& document, const AnnotationSet& set, const std::string& where);

/// Writes a graph that `check_graph` accepts, atomically; the same graph and provenance give the same bytes.
void write_graph(const Path& file, const RelationGraph& graph, const AnnotationSet& set, const Provenance& provenance);
Json graph_to_json(const RelationGraph& graph, const Provenance& provenance);
JsonValue relationship_to_json(const Relationship& relationship, JsonAllocator& allocator);

/// The graph in Graphviz DOT: a node for each annotation in its colour, an arc for each relationship of two annotations, a
/// small node for each relationship of another number. Text of annotations is untrusted: quotes, backslashes, angle brackets
/// and ampersands are escaped, so that it remains text in DOT and in its renderings (SVG, HTML).
std::string graph_to_dot(const RelationGraph& graph, const AnnotationSet& set);

}  // namespace ostraka

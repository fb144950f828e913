// The graph of relationships among annotations (thesis, section 2.3) and its file (Appendix B.2).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/provenance.h"

#include <memory>
#include <optional>

namespace ostraka {

/// What geometry tells of annotations.
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

/// What the toolkit knows of a type of relationship by its name.
struct RelationType {
    std::string name;
    std::size_t minimum, maximum;                ///< members; maximum = 0: any number
    std::optional<GeometricRelation> geometric;  ///< told by the mesh; none: a constraint of the thesis, stated only
    bool directed = false;                       ///< of a geometric type: the first annotation is the subject
    std::vector<std::string> quantities = {};    ///< that RelationMeter measures
};
/// All of them: the geometric ones in the order of GeometricRelation, then the others.
const std::vector<RelationType>& relation_types();
const RelationType& relation_type(GeometricRelation kind);
/// The type of that name, capital letters or not; nullptr if there is none: experts may have types of their own.
const RelationType* find_relation_type(const std::string& name);
/// The known name nearest to `name` in spelling.
std::string nearest_relation_type(const std::string& name);

/// A line or, with its normal as direction, a plane. The direction is a unit vector.
struct PointAndDirection {
    std::array<double, 3> point{0, 0, 0}, direction{0, 0, 1};
};

/// One measured quantity of a geometric relationship, e.g. the angle between two axes.
struct Deviation {
    std::string quantity;
    std::optional<double> value;      ///< as measured; nothing in a relationship that was stated and not checked
    std::optional<double> tolerance;  ///< in `unit`, at least 0; the relationship holds while value <= tolerance
    std::string unit;                 ///< "mm", "degree", "%" ...
};

struct RelationParameters {
    std::vector<Deviation> deviations;
    std::optional<PointAndDirection> plane, axis;
    std::optional<std::array<double, 3>> up;  ///< where the relationship depends on it
    std::string attribute;                    ///< of "equal attributes": its name
    [[nodiscard]] bool empty() const { return deviations.empty() && !plane && !axis && !up && attribute.empty(); }
};

struct Relationship {
    int id = 0;
    std::string type;
    bool directed = false;         ///< the first annotation is the subject
    std::vector<int> annotations;  ///< ids, none twice; containment is [container, contained]
    bool is_constraint = false;
    double weight = 1;       ///< of a constraint
    std::string constraint;  ///< of a constraint: its parameters, the text of a JSON object; empty for {}
    std::string origin;      ///< "extracted", "stated", or empty if the file does not tell
    RelationParameters parameters;
};

/// As geometry tells it.
Relationship extracted_relationship(GeometricRelation kind, int id, std::vector<int> annotations);

struct RelationGraph {
    std::vector<Relationship> relationships;
    Json provenance;  ///< as read; null if none
};

/// A fresh id (core/ids.h).
int free_id(const RelationGraph& graph);

/// The relationship of `graph` that says the same as this one: type, members (in any order where there is no direction), the
/// constraint, the attribute; nullptr if there is none. Tolerances and origin do not count.
const Relationship* find_twin(const RelationGraph& graph, const Relationship& relationship);

/// The same for many: a graph's relationships by what they say. The graph may change meanwhile.
class Twins {
public:
    explicit Twins(const RelationGraph& graph);
    ~Twins();
    /// The id of the first relationship that said the same.
    [[nodiscard]] std::optional<int> find(const Relationship& relationship) const;

private:
    struct Said;
    std::unique_ptr<Said> said_;
};

/// What `check_graph` demands of one relationship by itself; `place` is named in errors.
void check_relationship(const Relationship& relationship, const AnnotationSet& set, const std::string& place);

/// Throws Error (input) that names the relationship and the remedy: an id used twice, a missing annotation, an annotation twice
/// in one relationship, too few or too many members for the type, a direction that is not the type's, a negative or non-finite
/// weight or tolerance, a constraint that is no JSON object, a relationship that stands there twice. Own types are allowed.
void check_graph(const RelationGraph& graph, const AnnotationSet& set, const std::string& where);

/// Reads a *.graph.json of these annotations: our files and the thesis's (which have no format member). Known types are given
/// their own spelling. Throws Error (input) that names the file and the JSON pointer or the relationship.
RelationGraph read_graph(const Path& file, const AnnotationSet& set);
RelationGraph graph_from_json(const JsonValue& document, const AnnotationSet& set, const std::string& where);

/// Writes atomically what `check_graph` accepts; the same graph and provenance give the same bytes.
void write_graph(const Path& file, const RelationGraph& graph, const AnnotationSet& set, const Provenance& provenance);
Json graph_to_json(const RelationGraph& graph, const Provenance& provenance);
JsonValue relationship_to_json(const Relationship& relationship, JsonAllocator& allocator);

/// Graphviz DOT: a node for each annotation in its colour, an arc for each relationship of two, a small node for one of another
/// number. Text of annotations is data: quotes, backslashes, angle brackets and ampersands are escaped, so that it stays text in
/// DOT and in what is made of it (SVG, HTML).
std::string graph_to_dot(const RelationGraph& graph, const AnnotationSet& set);

}  // namespace ostraka

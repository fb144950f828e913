// The annotated members of a constraint on a shape, and the properties of the members that statements use.
#pragma once

#include "semantic/constraint_spec.h"
#include "semantic/statement.h"

#include <memory>

namespace ostraka::semantic {

/// Vertex indices as ids of the solver's points.
inline std::vector<int> ids_of(const std::vector<Index>& vertices) { return {vertices.begin(), vertices.end()}; }
/// The positions of these vertices, one per column.
Points columns_at(const Points& points, const std::vector<Index>& vertices);

/// A relationship that is a constraint, on a shape. Errors (input) name the file and the constraint.
class ConstraintMembers {
public:
    ConstraintMembers(Shape shape, const Relationship& relationship, std::string place)
        : shape_(shape), relationship_(relationship), place_(std::move(place)) {}

    /// Throws Error (input) with the problem and the remedy.
    [[noreturn]] void fail(const std::string& what, const std::string& remedy) const;

    [[nodiscard]] const Shape& shape() const { return shape_; }                       ///< shape on which the constraint is stated
    [[nodiscard]] const Relationship& relationship() const { return relationship_; }  ///< the relationship that is a constraint
    [[nodiscard]] std::size_t count() const { return relationship_.annotations.size(); }  ///< number of members
    [[nodiscard]] const Annotation& member(std::size_t i) const;                          ///< annotation of member i
    /// The vertices of member i, at least one, ascending.
    [[nodiscard]] std::vector<Index> vertices(std::size_t i) const;
    /// The vertices of all members, without duplicates.
    [[nodiscard]] std::vector<int> all_vertices() const;
    [[nodiscard]] const std::vector<Index>& faces(std::size_t i) const;  ///< faces of member i

    /// Throws Error (input) if the number of members is not between the minimum and the maximum (0: any number).
    void need(std::size_t minimum, std::size_t maximum) const;
    /// Throws Error (input) if member i is not a region.
    void need_region(std::size_t i) const;

    /// The direction in `stated`, otherwise the upward direction of the annotations. Throws Error (input) if there is neither.
    [[nodiscard]] Vector3d up(const std::optional<Vector3d>& stated) const;
    /// The measure of a member that has this name or id; without a name, the only measure of the member. Throws Error (input) if
    /// no measure or several measures match.
    [[nodiscard]] const Measure& measure(const MeasureName& name, std::size_t member) const;
    /// The tolerance that the relationship states for a quantity, otherwise the tolerance `for_all`.
    [[nodiscard]] double tolerance(const std::string& quantity, double for_all) const;

    /// Index of the leader, the member that the others follow: the member named in `stated`, otherwise the member with the
    /// largest share of vertices moved by the edit (the first of several equal ones). Nothing if no member is to be followed, or
    /// if the edit moves no member. Throws Error (input) if no member has the name.
    [[nodiscard]] std::optional<std::size_t> leader(const Leader& stated, const State& edited) const;
    /// Throws Error (input) if no member has the name of the leader.
    void check_leader(const Leader& stated) const { static_cast<void>(leader(stated, State(shape_.mesh))); }

    /// A low-level constraint on the points `ids`, whose weight is the share `share` of the constraint's weight.
    [[nodiscard]] std::unique_ptr<Constraint> make(const ConstraintKind& kind, std::vector<int> ids, double share = 1) const;
    /// A low-level constraint that keeps the shape of member i as the edit leaves it.
    [[nodiscard]] std::unique_ptr<Constraint> as_edited(std::size_t i, const State& edited) const;
    /// Diagonal of the bounding box of a low-level constraint's points at rest.
    [[nodiscard]] double size_at_rest(const Constraint& constraint) const;

private:
    Shape shape_;
    const Relationship& relationship_;
    std::string place_;
};
/// Members of a constraint, shared by the functions of its statement.
using MembersPtr = std::shared_ptr<const ConstraintMembers>;

}  // namespace ostraka::semantic

// The members of a constraint on a shape, and what its statements need of them.
#pragma once

#include "semantic/constraint_spec.h"
#include "semantic/statement.h"

#include <memory>

namespace ostraka::semantic {

/// Indices as the solver's ids.
inline std::vector<int> ids_of(const std::vector<Index>& vertices) { return {vertices.begin(), vertices.end()}; }
/// The points of some vertices.
Points columns_at(const Points& points, const std::vector<Index>& vertices);

/// A relationship that is a constraint, on a shape. Errors (input) name the file and the constraint.
class ConstraintMembers {
public:
    ConstraintMembers(Shape shape, const Relationship& relationship, std::string place)
        : shape_(shape), relationship_(relationship), place_(std::move(place)) {}

    [[noreturn]] void fail(const std::string& what, const std::string& remedy) const;

    [[nodiscard]] const Shape& shape() const { return shape_; }
    [[nodiscard]] const Relationship& relationship() const { return relationship_; }
    [[nodiscard]] std::size_t count() const { return relationship_.annotations.size(); }
    [[nodiscard]] const Annotation& member(std::size_t i) const;
    /// The vertices of a member, at least one, ascending.
    [[nodiscard]] std::vector<Index> vertices(std::size_t i) const;
    /// The vertices of all members together.
    [[nodiscard]] std::vector<int> all_vertices() const;
    [[nodiscard]] const std::vector<Index>& faces(std::size_t i) const;

    /// Throw Error (input) for another number of members (maximum 0: any), and for a member that is not a region.
    void need(std::size_t minimum, std::size_t maximum) const;
    void need_region(std::size_t i) const;

    /// The stated direction, otherwise the upward direction of the annotations. Throws Error (input) if there is neither.
    [[nodiscard]] Vector3d up(const std::optional<Vector3d>& stated) const;
    /// The measure of a member that has this name or id; without it, its only measure. Throws Error (input) if none or several
    /// have it.
    [[nodiscard]] const Measure& measure(const MeasureName& name, std::size_t member) const;
    /// The tolerance stated for a quantity, otherwise the default.
    [[nodiscard]] double tolerance(const std::string& quantity, double for_all) const;

    /// The member that the others follow: the named one, otherwise the one with the largest share of vertices moved by the edit
    /// (of equals, the first). Nothing if they follow none, or if the edit moves none of them. Throws Error (input) if the name
    /// is none of a member.
    [[nodiscard]] std::optional<std::size_t> leader(const Leader& stated, const State& edited) const;
    void check_leader(const Leader& stated) const { static_cast<void>(leader(stated, State(shape_.mesh))); }

    /// A low-level constraint whose weight is a share of the constraint's.
    [[nodiscard]] std::unique_ptr<Constraint> make(const ConstraintKind& kind, std::vector<int> ids, double share = 1) const;
    /// A constraint that keeps a member as the edit leaves it.
    [[nodiscard]] std::unique_ptr<Constraint> as_edited(std::size_t i, const State& edited) const;
    /// Diagonal of the bounding box of a constraint's points at rest.
    [[nodiscard]] double size_at_rest(const Constraint& constraint) const;

private:
    Shape shape_;
    const Relationship& relationship_;
    std::string place_;
};
using MembersPtr = std::shared_ptr<const ConstraintMembers>;  ///< shared by statements

}  // namespace ostraka::semantic

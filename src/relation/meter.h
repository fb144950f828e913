// The parts of a set and the contacts between them, computed on demand.
#pragma once

#include "relation/parts.h"

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/relation/geometric.h"

#include <list>
#include <unordered_map>

namespace ostraka {

/// For each pair of regions without a common face, the edges between them: midpoints, weighted by length.
using Contacts = std::map<std::pair<int, int>, detail::Cloud>;

namespace detail {

/// Thrown if a relationship cannot be determined; not an error, since others can.
struct Unknown {
    std::string text;
};

/// The measured quantities of one relationship with the applicable tolerances.
class Findings {
public:
    Findings(const Relationship& stated, const RelationOptions& options, double diagonal, const std::string& unit,
             RelationParameters& parameters);
    /// Adds a length with a tolerance relative to the diagonal.
    void add_length(const std::string& quantity, double value) { add(quantity, value, options_.distance * diagonal_, unit_); }
    void add_height_below_0(double value) { add("height", value, 0, unit_); }
    void add_angle(double degrees) { add("angle", degrees, options_.angle, "degree"); }
    void add_tilt(double degrees) { add("tilt", degrees, options_.tilt, "degree"); }
    void add_ratio(const std::string& quantity, double per_cent) { add(quantity, per_cent, options_.ratio, "%"); }
    [[nodiscard]] bool holds() const { return holds_; }

    const Relationship& stated;
    RelationParameters& parameters;

private:
    void add(const std::string& quantity, double value, double tolerance, const std::string& unit);

    const RelationOptions& options_;
    double diagonal_;
    const std::string& unit_;
    bool holds_ = true;
};

}  // namespace detail

struct RelationMeter::State : AnnotatedMeshView {
    RelationOptions options;
    double diagonal = 0;
    std::map<int, detail::Part> parts;
    std::optional<Contacts> contacts;
    bool contacts_left_out = false;  ///< true if the pairs with the shortest borders were omitted
    std::list<int> recent;           ///< parts in use, most recently used last
    std::unordered_map<int, std::list<int>::iterator> recent_place;
    std::size_t recent_faces = 0;

    detail::Part& part(int id);
    const detail::Cloud* contact(int a, int b);  ///< nullptr if not adjacent
    /// The contacts of all pairs or, beyond the limits, of those with the longest shared borders.
    const Contacts& all_contacts();
    /// Must be called before parts are measured: frees the memory of the least recently used parts, so that memory stays
    /// bounded for many overlapping regions.
    void used(const std::vector<int>& ids);
    /// The value of an attribute by name, followed by its unit; nothing if it is not a single number.
    [[nodiscard]] std::optional<double> attribute(const Annotation& annotation, const std::string& name) const;
    /// The values of the stated attribute. Throws Unknown.
    [[nodiscard]] std::vector<double> values(const Relationship& stated) const;
    /// Measures a relationship of this type. Throws Unknown.
    void measure(GeometricRelation kind, detail::Findings& findings);
};

}  // namespace ostraka

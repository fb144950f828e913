// The annotated parts of a set and the contacts between the parts, computed on demand.
#pragma once

#include "relation/parts.h"

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/relation/geometric.h"

#include <list>
#include <unordered_map>

namespace ostraka {

/// From the ids of two regions without a common face to the edges between them: midpoints, weighted by length.
using Contacts = std::map<std::pair<int, int>, detail::Cloud>;

namespace detail {

/// Thrown if a relationship cannot be determined; not an error, since other relationships may be determined.
struct Unknown {
    std::string text;  ///< why the relationship cannot be determined
};

/// The measured quantities of one relationship with the tolerances that apply.
class Findings {
public:
    Findings(const Relationship& stated, const RelationOptions& options, double diagonal, const std::string& unit,
             RelationParameters& parameters);
    /// Adds a length with a tolerance relative to the diagonal.
    void add_length(const std::string& quantity, double value) { add(quantity, value, options_.distance * diagonal_, unit_); }
    /// Adds the height by which a part lies on the wrong side of a contact; the tolerance is 0.
    void add_height_below_0(double value) { add("height", value, 0, unit_); }
    /// Adds an angle between axes.
    void add_angle(double degrees) { add("angle", degrees, options_.angle, "degree"); }
    void add_tilt(double degrees) { add("tilt", degrees, options_.tilt, "degree"); }  ///< adds the tilt of a contact
    /// Adds a relative difference.
    void add_ratio(const std::string& quantity, double per_cent) { add(quantity, per_cent, options_.max_difference, "%"); }
    [[nodiscard]] bool holds() const { return holds_; }  ///< whether all quantities are within their tolerances

    const Relationship& stated;      ///< the relationship that is measured
    RelationParameters& parameters;  ///< gets the measured quantities

private:
    /// Adds a quantity; a tolerance stated in the relationship overrides `tolerance`.
    void add(const std::string& quantity, double value, double tolerance, const std::string& unit);

    const RelationOptions& options_;
    double diagonal_;
    const std::string& unit_;
    bool holds_ = true;
};

}  // namespace detail

struct RelationMeter::State : AnnotatedMeshView {
    RelationOptions options;
    double diagonal = 0;                ///< diagonal of the mesh
    std::map<int, detail::Part> parts;  ///< from the id of an annotation to its part
    std::optional<Contacts> contacts;   ///< contacts of all pairs of regions; empty: not computed yet
    bool contacts_left_out = false;     ///< true if the pairs with the shortest borders were omitted
    std::list<int> recent;              ///< ids of the parts whose data are in memory, most recently used last
    std::unordered_map<int, std::list<int>::iterator> recent_place;  ///< from the id of a part to its position in `recent`
    std::size_t recent_faces = 0;                                    ///< total number of faces of the parts in `recent`

    detail::Part& part(int id);                  ///< part of the annotation with this id
    const detail::Cloud* contact(int a, int b);  ///< edges between two regions; nullptr if they are not adjacent
    /// The contacts of all pairs of regions or, beyond the limits, of the pairs with the longest shared borders.
    const Contacts& all_contacts();
    /// Marks parts as used and frees the memory of the least recently used parts, so that memory stays bounded for many
    /// overlapping regions. Must be called before the parts with these ids are measured.
    void used(const std::vector<int>& ids);
    /// The numeric value of the attribute with this name (computed for measures and known descriptors); nothing if it is not a
    /// single number.
    [[nodiscard]] std::optional<double> attribute(const Annotation& annotation, const std::string& name) const;
    /// The values that the members of the relationship have for its attribute. Throws Unknown.
    [[nodiscard]] std::vector<double> values(const Relationship& stated) const;
    /// Measures a relationship of this geometric type. Throws Unknown.
    void measure(GeometricRelation kind, detail::Findings& findings);
};

}  // namespace ostraka

// The parts of a set and the contacts between them, made when first asked for.
#pragma once

#include "parts.h"

#include "ostraka/relation/geometric.h"

#include <list>
#include <unordered_map>

namespace ostraka {

/// Edges between two regions without a common face: their middles, weighted by length.
using Contacts = std::map<std::pair<int, int>, detail::Cloud>;

namespace detail {

/// Why a relationship cannot be determined; not an error: other relationships can.
struct Unknown {
    std::string text;
};

/// The measured quantities of one relationship with the tolerances that apply.
class Findings {
public:
    Findings(const Relationship& stated, const RelationOptions& options, double diagonal, const std::string& unit,
             RelationParameters& parameters);
    /// Within a share of the diagonal.
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

struct RelationMeter::State {
    const Mesh& mesh;
    const AnnotationSet& set;
    RelationOptions options;
    double diagonal = 0;
    std::map<int, detail::Part> parts;
    std::optional<Contacts> contacts;
    bool contacts_left_out = false;  ///< of the many there are, those of the shortest borders
    std::list<int> recent;           ///< parts in use, the last used at the end
    std::unordered_map<int, std::list<int>::iterator> recent_place;
    std::size_t recent_faces = 0;

    detail::Part& part(int id);
    const detail::Cloud* contact(int a, int b);  ///< nullptr: not adjacent
    /// Of the pairs with the longest shared borders, where there are very many.
    const Contacts& all_contacts();
    /// To be called before parts are measured: frees what others used longest ago hold, so that many regions that overlap take no
    /// more memory than a few.
    void used(const std::vector<int>& ids);
    /// The value of an attribute by its name, its unit after it; nothing if there is no single number.
    [[nodiscard]] std::optional<double> attribute(const Annotation& annotation, const std::string& name) const;
    /// Of the stated attribute. Throws Unknown.
    [[nodiscard]] std::vector<double> values(const Relationship& stated) const;
    /// Throws Unknown.
    void measure(GeometricRelation kind, detail::Findings& findings);
};

}  // namespace ostraka

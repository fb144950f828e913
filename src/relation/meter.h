// The parts of a set and the contacts between them, made when first asked for.
#pragma once

#include "parts.h"

#include "ostraka/relation/geometric.h"

namespace ostraka {

/// Edges between two regions without a common face: their middles, weighted by length.
using Contacts = std::map<std::pair<int, int>, detail::Cloud>;

struct RelationMeter::State {
    const Mesh& mesh;
    const AnnotationSet& set;
    RelationOptions options;
    double diagonal = 0;
    std::map<int, detail::Part> parts;
    std::optional<Contacts> contacts;

    detail::Part& part(int id);
    const detail::Cloud* contact(int a, int b);  ///< nullptr: not adjacent
    const Contacts& all_contacts();
    /// The value of an attribute by its name, its unit after it; nothing if there is no single number.
    [[nodiscard]] std::optional<double> attribute(int id, const std::string& name) const;
};

}  // namespace ostraka

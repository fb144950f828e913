// Constraints of a deformation in reports.
#pragma once

#include "operations/operations.h"

#include "ostraka/semantic/deform.h"

namespace ostraka {

/// Text for each deviation of a constraint: "angle 3 (was 7, at most 5) degree".
inline std::vector<std::string> deviation_texts(const ConstraintReport& constraint) {
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < constraint.deviations.size(); ++i) {
        const Deviation& d = constraint.deviations[i];
        const double before = i < constraint.before_values.size() ? constraint.before_values[i] : 0;
        texts.push_back(d.quantity + " " + number(d.value.value_or(0), 4) + " (was " + number(before, 4) + ", at most " +
                        number(d.tolerance.value_or(0), 4) + ")" + (d.unit.empty() ? "" : " " + d.unit));
    }
    return texts;
}

}  // namespace ostraka

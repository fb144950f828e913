// Transfer of attributes of annotations to the target, including the pins of measures.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "transfer/path_tracer.h"

#include <optional>
#include <tuple>
#include <vector>

namespace ostraka {

/// Copies attributes and maps the pins of measures to the target.
class AttributeCarrier {
public:
    /// `refined`: true if the target has new faces, and only its vertices keep their indices.
    AttributeCarrier(const PathTracer& tracer, bool refined) : tracer_(tracer), refined_(refined) {}

    /// Transfers the attributes of annotation `from` to annotation `to`.
    void carry(const Annotation& from, Annotation& to);
    /// Restores the old value, marked stale, of measures that lost a pin and cannot be recomputed. Must be called after measures
    /// were refreshed.
    void keep_old_values(AnnotationSet& set) const;

private:
    /// Maps the pins of a measure to the target. False if a pin has no counterpart.
    bool carry_pins(const Measure& measure, Measure& moved) const;

    const PathTracer& tracer_;
    bool refined_;
    /// For each measure that lost a pin: annotation id, attribute id, old value.
    std::vector<std::tuple<int, int, std::optional<double>>> lost_pins_;
};

}  // namespace ostraka

// Transfer of attributes to the target, including the pins of measures.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "transfer/path_tracer.h"

#include <optional>
#include <tuple>
#include <vector>

namespace ostraka {

class AttributeCarrier {
public:
    /// `refined`: the target has new faces, and only vertices keep their indices.
    AttributeCarrier(const PathTracer& tracer, bool refined) : tracer_(tracer), refined_(refined) {}

    void carry(const Annotation& from, Annotation& to);
    /// Restores the old value, marked stale, of measures that lost a pin and cannot be recomputed. To be called after measures
    /// were refreshed.
    void keep_old_values(AnnotationSet& set) const;

private:
    const PathTracer& tracer_;
    bool refined_;
    std::vector<std::tuple<int, int, std::optional<double>>> lost_pins_;  ///< annotation id, attribute id, old value
};

}  // namespace ostraka

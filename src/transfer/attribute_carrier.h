// Attributes carried to the target; the pins of measures find their places there.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "path_tracer.h"

#include <optional>
#include <tuple>
#include <vector>

namespace ostraka {

class AttributeCarrier {
public:
    /// `refined`: the target gets new faces, where only vertices keep their numbers.
    AttributeCarrier(const PathTracer& tracer, bool refined) : tracer_(tracer), refined_(refined) {}

    void carry(const Annotation& from, Annotation& to);
    /// What lost a pin cannot be measured anew: the old value stays, marked. To be called after measures were refreshed.
    void keep_old_values(AnnotationSet& set) const;

private:
    const PathTracer& tracer_;
    bool refined_;
    std::vector<std::tuple<int, int, std::optional<double>>> lost_pins_;  ///< annotation, attribute, value before
};

}  // namespace ostraka

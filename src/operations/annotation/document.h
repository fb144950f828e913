// Annotations or labels: which of them an input of annotations holds.
#pragma once

#include "operations/operations.h"

namespace ostraka {

/// Whether the file is a recipe or annotations, as opposed to labels.
inline bool is_document(const Slot& slot) {
    const std::string ending = extension(slot.file());
    return ending == ".json" || ending == ".ant" || (slot && slot.sources.front().object.as<AnnotationSet>() != nullptr);
}

}  // namespace ostraka

// A completed object as a file whose colours and labels say what was seen.
#pragma once

#include "operations.h"

#include "ostraka/reconstruction/complete.h"

namespace ostraka {

/// Face labels: what was observed, interpolated, is a hypothesis; values: fragment, distance, confidence.
void write_completed(const FolderOutput& folder, const std::string& name, const CompletedObject& object);

}  // namespace ostraka

// Writes a completed object with colours and labels for the origin of its surface.
#pragma once

#include "operations/operations.h"

#include "ostraka/reconstruction/complete.h"

namespace ostraka {

/// Face labels: observed, interpolated or hypothesis; face values: fragment, distance, confidence.
void write_completed(const FolderOutput& folder, const std::string& name, const CompletedObject& object);

}  // namespace ostraka

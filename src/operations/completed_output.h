// Writes a completed object with colours and labels for the origin of its surface.
#pragma once

#include "operations/operations.h"

#include "ostraka/reconstruction/complete.h"

namespace ostraka {

/// Writes the mesh of a completed object as `name`. Face labels: observed, interpolated or hypothesis; face values: index of the
/// fragment, distance, confidence.
void write_completed(const FolderOutput& folder, const std::string& name, const CompletedObject& object);

}  // namespace ostraka

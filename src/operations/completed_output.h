// Writes a completed object with colours and labels for the origin of its surface.
#pragma once

#include "operations/operations.h"

#include "ostraka/reconstruction/complete.h"

namespace ostraka {

/// Writes the mesh of a completed object as `name`. Face labels: observed, interpolated or hypothesis; face values: index of the
/// fragment, distance, confidence. Faces of a fragment with colours (`fragment_colours`: for each fragment the colours of its
/// faces, empty: none) have these; then all that is not observed is neutral grey, hypotheses lighter. Without colours the tones
/// show the origin.
void write_completed(const FolderOutput& folder, const std::string& name, const CompletedObject& object,
                     const std::vector<std::vector<Colour>>& fragment_colours = {});

}  // namespace ostraka

// Transfer of free annotations.
#pragma once

#include "ostraka/geom/surface_search.h"
#include "ostraka/transfer/transfer.h"

#include <chrono>
#include <vector>

namespace ostraka {

class Clock {
public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        return seconds;
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Adds the annotations marked in `free` to the result of a transfer of the others: projects them by their curves, computes
/// their scores, and inserts them at their positions in the set. Times are added to those of the result.
void transfer_free(const Mesh& source, const AnnotationSet& set, const std::vector<bool>& free, const SurfaceSearch& target,
                   const TransferOptions& options, Clock& clock, TransferResult& result);

}  // namespace ostraka

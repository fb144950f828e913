// The free annotations of a transfer.
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

/// Adds the annotations marked `free` to a transfer of the others, whose result is there: laid by their curves, scored, and put
/// in their places in the set. Times are added to the result's.
void transfer_free(const Mesh& source, const AnnotationSet& set, const std::vector<bool>& free, const SurfaceSearch& target,
                   const TransferOptions& options, Clock& clock, TransferResult& result);

}  // namespace ostraka

#include "ostraka/core/error.h"
#include "ostraka/select/scalars.h"

#include <CGAL/mesh_segmentation.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

std::vector<Index> segment(const Mesh& mesh, const std::vector<double>& thickness, const SegmentOptions& options) {
    check_options(options, "segment");
    const std::size_t count = mesh.number_of_faces();
    if (count == 0) fail_input("mesh", "has no faces to cut into segments", "give another mesh");
    if (thickness.size() != count)
        throw Error(ErrorKind::usage, "segment",
                    std::to_string(thickness.size()) + " values for " + std::to_string(count) + " faces", "give one a face");
    Mesh work = mesh;
    auto values = work.add_property_map<Face, double>("f:segment-thickness", 0).first;
    auto segments = work.add_property_map<Face, std::size_t>("f:segment", 0).first;
    double low = std::numeric_limits<double>::infinity(), high = 0;
    for (const Face face : work.faces()) {
        const double x = thickness[face];
        values[face] = std::isfinite(x) && x > 0 ? x : -1;  // without a value: that of the neighbours is taken
        if (values[face] > 0) low = std::min(low, x), high = std::max(high, x);
    }
    if (!(high > 0)) fail_input("mesh", "has no thickness anywhere", "is it closed, and does it face outwards?");
    std::size_t number = 1;
    if (high > low) {
        CGAL::sdf_values_postprocessing(work, values);
        const auto clusters = std::min<std::size_t>(static_cast<std::size_t>(options.clusters), count);
        number = CGAL::segmentation_from_sdf_values(work, values, segments, clusters, options.smoothing);
    }
    std::vector<double> area(number, 0);
    for (const Face face : work.faces()) area[segments[face]] += face_area(work, face);
    std::vector<Index> order(number), rank(number);
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return area[a] > area[b]; });
    for (std::size_t i = 0; i < number; ++i) rank[order[i]] = static_cast<Index>(i);
    std::vector<Index> result(count);
    for (const Face face : work.faces()) result[face] = rank[segments[face]];
    return result;
}

}  // namespace ostraka

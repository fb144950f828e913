#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/run_interruptibly.h"
#include "ostraka/select/scalars.h"

#include <CGAL/mesh_segmentation.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

namespace {

/// Input and output of the library's segmentation.
struct Cut {
    Mesh mesh;
    std::vector<double> values;  ///< one per face; -1 if there is none
    std::size_t clusters = 0, number = 1;
    double smoothing = 0;
    std::vector<std::size_t> segments;  ///< one per face

    void make() {
        auto value = mesh.add_property_map<Face, double>("f:segment-thickness", 0).first;
        auto segment = mesh.add_property_map<Face, std::size_t>("f:segment", 0).first;
        for (const Face face : mesh.faces()) value[face] = values[face];
        CGAL::sdf_values_postprocessing(mesh, value);
        check_cancelled();
        number = CGAL::segmentation_from_sdf_values(mesh, value, segment, clusters, smoothing);
        for (const Face face : mesh.faces()) segments[face] = segment[face];
    }
};

}  // namespace

std::vector<Index> segment(const Mesh& mesh, const std::vector<double>& thickness, const SegmentOptions& options) {
    check_options(options, "segment");
    const std::size_t count = mesh.number_of_faces();
    if (count == 0) fail_input("mesh", "has no faces to cut into segments", "give another mesh");
    if (thickness.size() != count)
        throw Error(ErrorKind::usage, "segment",
                    std::to_string(thickness.size()) + " values for " + std::to_string(count) + " faces", "give one a face");
    Cut cut{mesh,
            std::vector<double>(count, -1),
            std::min<std::size_t>(static_cast<std::size_t>(options.clusters), count),
            1,
            options.smoothing,
            std::vector<std::size_t>(count, 0)};
    double low = std::numeric_limits<double>::infinity(), high = 0;
    for (const Face face : mesh.faces()) {
        const double x = thickness[face];
        cut.values[face] = std::isfinite(x) && x > 0 ? x : -1;  // faces without a value take that of their neighbours
        if (cut.values[face] > 0) low = std::min(low, x), high = std::max(high, x);
    }
    if (!(high > 0)) fail_input("mesh", "has no thickness anywhere", "is it closed, and does it face outwards?");
    // The library's graph cut does not check for cancellation.
    if (high > low) cut = run_interruptibly_on(std::move(cut), [](Cut& own) { own.make(); });
    const std::size_t number = cut.number;
    const std::vector<std::size_t>& segments = cut.segments;
    std::vector<double> area(number, 0);
    for (const Face face : mesh.faces()) area[segments[face]] += face_area(mesh, face);
    std::vector<Index> order(number), rank(number);
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return area[a] > area[b]; });
    for (std::size_t i = 0; i < number; ++i) rank[order[i]] = static_cast<Index>(i);
    std::vector<Index> result(count);
    for (const Face face : mesh.faces()) result[face] = rank[segments[face]];
    return result;
}

}  // namespace ostraka

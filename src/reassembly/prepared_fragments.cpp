#include "reassembly/prepared_fragments.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

PreparedFragments::PreparedFragments(const std::vector<Fragment>& fragments, const ReassemblyOptions& options,
                                     const PairEffort& effort, std::vector<std::string>& alone)
    : options_(options),
      effort_(effort),
      prepared_(fragments.size()),
      middle_(fragments.size(), Vector3d::Zero()),
      radius_(fragments.size(), 0) {
    Progress progress("prepare fragments", fragments.size());
    parallel_for(fragments.size(), 1, [&](std::size_t k) {
        prepare(fragments[k], k, alone[k]);
        progress.advance();
    });
}

std::size_t PreparedFragments::matched_count() const {
    return static_cast<std::size_t>(
        std::count_if(prepared_.begin(), prepared_.end(), [](const auto& fragment) { return fragment != nullptr; }));
}

void PreparedFragments::prepare(const Fragment& fragment, std::size_t k, std::string& alone) {
    const Mesh& mesh = fragment.mesh;
    if (mesh.number_of_faces() < static_cast<std::size_t>(options_.min_faces)) {
        alone = fmt::format("it has {} faces, too few to show its fracture", mesh.number_of_faces());
        return;
    }
    try {
        prepared_[k] = std::make_unique<PreparedFracture>(fragment, effort_.prepared);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input) throw;
        alone = "it " + error.problem();
        return;
    }
    alone = fracture_problem(*prepared_[k]);
    if (!alone.empty()) {
        prepared_[k].reset();
        return;
    }
    for (const Vertex v : mesh.vertices()) middle_[k] += eigen(mesh.point(v)) / static_cast<double>(mesh.number_of_vertices());
    for (const Vertex v : mesh.vertices()) radius_[k] = std::max(radius_[k], (eigen(mesh.point(v)) - middle_[k]).norm());
}

/// Why a fracture cannot be matched with any other; empty: it can.
std::string PreparedFragments::fracture_problem(const PreparedFracture& fragment) const {
    constexpr std::size_t min_fracture_faces = 30;  // coarse sherds of a thousand faces have about a hundred fracture faces
    if (fragment.fracture_faces() < min_fracture_faces)
        return fmt::format("its fracture surface has {} faces, too few to be matched", fragment.fracture_faces());
    constexpr double min_relief = 0.7;  // in tolerances
    if (!effort_.all_pairs && fragment.relief() < min_relief * options_.pairs.last_search_radius * join_scale(fragment, fragment))
        return "its fracture surface is so smooth that it fits too many of the fragments";
    return "";
}

double PreparedFragments::tolerance(std::size_t a, std::size_t b) const {
    return options_.pairs.last_search_radius * join_scale(*prepared_[a], *prepared_[b]);
}

bool PreparedFragments::agree(const Motion& x, const Motion& y, std::size_t k, double length) const {
    constexpr double angle = 0.2;  // radians
    return (x(middle_[k]) - y(middle_[k])).norm() < length &&
           Eigen::AngleAxisd(x.rotation.transpose() * y.rotation).angle() < angle;
}

double PreparedFragments::loop_length(std::size_t i, std::size_t j, std::size_t k) const {
    return 0.1 * std::min({prepared_[i]->size(), prepared_[j]->size(), prepared_[k]->size()});
}

}  // namespace ostraka

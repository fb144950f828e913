#include "ostraka/reconstruction/open_rotations.h"

#include "ostraka/axis/axis.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

namespace {

/// Whether the motions that the search left open include a rotation about the axis. For a small or nearly round part it is one
/// of several.
bool rotates_about(const SlippableMotions& slippable, const Vector3d& direction) {
    switch (slippable.kind) {
        case SlippableKind::none:
        case SlippableKind::translation:
            return false;
        case SlippableKind::rotation:
        case SlippableKind::cylinder:
        case SlippableKind::helix:
            return std::abs(slippable.direction.dot(direction)) > std::cos(0.2);
        default:
            return true;
    }
}

bool broken(const Fragment& fragment) {
    return std::find(fragment.facets.begin(), fragment.facets.end(), Facet::fracture) != fragment.facets.end();
}

}  // namespace

std::optional<RotationMatch> decide_open_rotations(const Mesh& scaled, const std::vector<const Fragment*>& fragments,
                                                   const std::vector<std::optional<PoseSearchResult>>& searched,
                                                   std::vector<FragmentPlacement>& placed, const RotationMatchOptions& options) {
    const auto open = [&](std::size_t k) {
        return k < searched.size() && searched[k] && searched[k]->decided && searched[k]->slippable.kind != SlippableKind::none;
    };
    std::vector<std::size_t> placed_indices;
    std::size_t open_count = 0, broken_count = 0;
    for (std::size_t k = 0; k < fragments.size(); ++k) {
        if (!placed[k].problem.empty()) continue;
        placed_indices.push_back(k);
        open_count += open(k) ? 1 : 0;
        broken_count += broken(*fragments[k]) ? 1 : 0;
    }
    if (options.rotations == RotationMatchOptions::Turns::never || placed_indices.size() < 2 || open_count == 0 ||
        broken_count == 0)
        return std::nullopt;
    std::vector<Index> faces(scaled.number_of_faces());
    std::iota(faces.begin(), faces.end(), Index(0));
    const Axis axis = rotation_axis(scaled, faces);
    if (!axis.found) return std::nullopt;
    const Vector3d direction = eigen(axis.direction);
    std::vector<SherdOnAxis> sherds;
    open_count = 0;
    for (const std::size_t k : placed_indices) {
        const bool rotates = open(k) && rotates_about(searched[k]->slippable, direction);
        open_count += rotates ? 1 : 0;
        sherds.push_back({fragments[k], placed[k].pose, !rotates});
    }
    if (open_count == 0) return std::nullopt;
    RotationMatch match = match_rotations(scaled, eigen(axis.point), direction, sherds, options), result;
    result.wall = match.wall;
    result.group.assign(fragments.size(), -1);
    result.poses.resize(fragments.size());
    result.overlap.assign(fragments.size(), 0);
    result.notes.resize(fragments.size());
    for (std::size_t i = 0; i < placed_indices.size(); ++i) {
        const std::size_t k = placed_indices[i];
        placed[k].pose = result.poses[k] = match.poses[i];
        result.group[k] = static_cast<int>(placed_indices[static_cast<std::size_t>(match.group[i])]);
        result.overlap[k] = match.overlap[i];
        result.notes[k] = std::move(match.notes[i]);
    }
    for (FractureJoint& joint : match.joints) {
        joint.first = static_cast<int>(placed_indices[static_cast<std::size_t>(joint.first)]);
        joint.second = static_cast<int>(placed_indices[static_cast<std::size_t>(joint.second)]);
        result.joints.push_back(joint);
    }
    return result;
}

}  // namespace ostraka

// Search for the faces near a plane.
#include "slicing/plane_search.h"

#include "ostraka/geom/eigen.h"

#include <algorithm>

namespace ostraka::detail {

namespace {

/// Spreads the bits of a 21-bit number to every third bit.
std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

/// The minimum and maximum height of a box.
std::pair<double, double> heights(const Eigen::AlignedBox3d& box, const SliceFrame& frame) {
    const double middle = eigen(frame.normal).dot(box.center() - eigen(frame.origin));
    const double half = eigen(frame.normal).cwiseAbs().dot(box.sizes()) / 2;
    return {middle - half, middle + half};
}

}  // namespace

PlaneSearch::Box PlaneSearch::box_of(const Mesh& mesh, Index face) {
    Box box;
    for (const Vertex v : corners(mesh, Face(face))) box.extend(eigen(mesh.point(v)));
    return box;
}

PlaneSearch::PlaneSearch(const Mesh& mesh, const std::vector<Index>& faces) : mesh_(mesh), faces_(faces) {
    std::sort(faces_.begin(), faces_.end());
    faces_.erase(std::unique(faces_.begin(), faces_.end()), faces_.end());
    if (faces.empty())
        for (const Face f : mesh.faces()) faces_.push_back(f.idx());
    Box mesh_box;
    for (const Index f : faces_) mesh_box.extend(box_of(mesh, f));
    const double scale = 2097151 / std::max(mesh_box.sizes().maxCoeff(), std::numeric_limits<double>::min());
    std::vector<std::pair<std::uint64_t, Index>> order;  // in Morton order
    for (const Index f : faces_) {
        const Vector3d cell = scale * (box_of(mesh, f).center() - mesh_box.min());
        std::uint64_t code = 0;
        for (int k = 0; k < 3; ++k) code |= spread(static_cast<std::uint64_t>(std::clamp(cell[k], 0.0, 2097151.0))) << k;
        order.emplace_back(code, f);
    }
    std::sort(order.begin(), order.end());
    std::transform(order.begin(), order.end(), faces_.begin(), [](const auto& entry) { return entry.second; });
    while (leaves_ * leaf < faces_.size()) leaves_ *= 2;
    boxes_.resize(2 * leaves_);
    for (std::size_t i = 0; i < faces_.size(); ++i) boxes_[leaves_ + i / leaf].extend(box_of(mesh, faces_[i]));
    for (std::size_t n = leaves_ - 1; n > 0; --n) boxes_[n] = boxes_[2 * n].merged(boxes_[2 * n + 1]);
}

template <class Enter, class Visit>
void PlaneSearch::each_face(const Enter& enter, const Visit& visit) const {
    std::vector<std::size_t> stack{1};
    while (!stack.empty()) {
        const std::size_t node = stack.back();
        stack.pop_back();
        if (boxes_[node].isEmpty() || !enter(boxes_[node])) continue;
        if (node < leaves_) {
            stack.push_back(2 * node), stack.push_back(2 * node + 1);
            continue;
        }
        const std::size_t first = (node - leaves_) * leaf;
        for (std::size_t i = first; i < std::min(first + leaf, faces_.size()); ++i) visit(faces_[i]);
    }
}

std::vector<Index> PlaneSearch::near(const SliceFrame& frame, double search_radius) const {
    std::vector<Index> near_faces;
    const auto meets = [&](const Box& box) {
        const auto [low, high] = heights(box, frame);
        return low <= search_radius && high >= -search_radius;
    };
    each_face(meets, [&](Index face) {
        if (meets(box_of(mesh_, face))) near_faces.push_back(face);
    });
    std::sort(near_faces.begin(), near_faces.end());
    return near_faces;
}

double PlaneSearch::lowest(const SliceFrame& frame) const {
    double minimum = std::numeric_limits<double>::infinity();
    each_face([&](const Box& box) { return heights(box, frame).first < minimum; },
              [&](Index face) {
                  for (const Vertex v : corners(mesh_, Face(face))) minimum = std::min(minimum, frame.height(mesh_.point(v)));
              });
    return minimum;
}

}  // namespace ostraka::detail

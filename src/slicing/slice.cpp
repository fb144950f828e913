// Faces are sorted into the planes that cross them and joined by their halfedges.
#include "ostraka/slicing/slice.h"

#include "slicing/contour_classification.h"
#include "slicing/joining.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/limits.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>

namespace ostraka {

namespace {

void check(const Mesh& mesh, const SliceFrame& frame, const std::vector<double>& heights, const std::vector<Index>& faces) {
    const Vector cross = CGAL::cross_product(frame.u, frame.v) - frame.normal;
    const bool right_handed = is_place(frame.origin) && std::abs(frame.u.squared_length() - 1) < 1e-9 &&
                              std::abs(frame.v.squared_length() - 1) < 1e-9 && std::abs(frame.u * frame.v) < 1e-9 &&
                              cross.squared_length() < 1e-18;
    if (!right_handed)
        fail_usage("the frame of the slices is not right-handed with unit vectors", "construct the frame with slice_frame");
    for (const double height : heights)
        if (!(std::abs(height) <= max_coordinate))
            fail_usage(fmt::format("the height {} of a slice is not finite or too large", std::to_string(height)),
                       "give finite heights");
    detail::check_faces(mesh, faces);
}

/// A plane; heights of at least `threshold` count as above it.
struct Plane {
    double height = 0, threshold = 0;
    std::size_t place = 0;  ///< index in the input order
};

/// All planes by increasing threshold, each with the faces that cross it in ascending order.
class Sweep {
public:
    Sweep(const Mesh& mesh, const SliceFrame& frame, const std::vector<double>& heights, const std::vector<Index>& faces)
        : mesh_(mesh), frame_(frame), faces_(faces), height_(mesh.num_vertices()), level_(mesh.num_vertices()) {
        std::sort(faces_.begin(), faces_.end());
        faces_.erase(std::unique(faces_.begin(), faces_.end()), faces_.end());
        if (faces.empty()) {
            faces_.resize(mesh.num_faces());
            std::iota(faces_.begin(), faces_.end(), Index{0});
        }
        set_heights(heights);
        sort_faces();
    }

    [[nodiscard]] const std::vector<Plane>& planes() const { return planes_; }
    [[nodiscard]] std::vector<Contour> contours(std::size_t plane) const;

private:
    void set_heights(const std::vector<double>& heights);
    void sort_faces();
    [[nodiscard]] std::pair<Index, Index> levels(Index f) const {
        Index low = no_index, high = 0;
        for (const Vertex v : CGAL::vertices_around_face(mesh_.halfedge(Face(f)), mesh_)) {
            low = std::min(low, level_[v.idx()]), high = std::max(high, level_[v.idx()]);
        }
        return {low, high};
    }

    const Mesh& mesh_;
    const SliceFrame& frame_;
    std::vector<Index> faces_;
    std::vector<double> height_;  ///< one per vertex
    std::vector<Index> level_;    ///< one per vertex: number of planes below it
    double tolerance_ = 0;
    std::vector<Plane> planes_;
    std::vector<std::size_t> first_;  ///< one per plane: start of its range in crossed_
    std::vector<Index> crossed_;
};

void Sweep::set_heights(const std::vector<double>& heights) {
    parallel_for(height_.size(), 4096, [&](std::size_t v) {
        const Vertex vertex(static_cast<Index>(v));
        height_[v] = mesh_.is_removed(vertex) ? 0 : frame_.height(mesh_.point(vertex));
    });
    tolerance_ = on_plane_share * box_diagonal(mesh_);
    double lowest = std::numeric_limits<double>::infinity();
    if (faces_.size() == mesh_.num_faces()) {
        for (const Vertex v : mesh_.vertices())
            if (!mesh_.is_isolated(v)) lowest = std::min(lowest, height_[v.idx()]);
    } else {
        for (const Index f : faces_)
            for (const Vertex v : CGAL::vertices_around_face(mesh_.halfedge(Face(f)), mesh_))
                lowest = std::min(lowest, height_[v.idx()]);
    }
    for (std::size_t i = 0; i < heights.size(); ++i) {
        const bool base = std::abs(heights[i] - lowest) <= tolerance_;
        // On the lowest plane, ON counts as below.
        const double threshold =
            base ? std::nextafter(heights[i] + tolerance_, std::numeric_limits<double>::infinity()) : heights[i] - tolerance_;
        planes_.push_back({heights[i], threshold, i});
    }
    std::stable_sort(planes_.begin(), planes_.end(), [](const Plane& a, const Plane& b) { return a.threshold < b.threshold; });
    parallel_for(level_.size(), 4096, [&](std::size_t v) {
        const auto above = std::upper_bound(planes_.begin(), planes_.end(), height_[v],
                                            [](double h, const Plane& plane) { return h < plane.threshold; });
        level_[v] = static_cast<Index>(above - planes_.begin());
    });
}

void Sweep::sort_faces() {
    // Counting sort in blocks: find the crossing faces of each block, count them per plane, then place them.
    struct Crossing {
        Index face, low, high;
    };
    const std::size_t block = std::max<std::size_t>(65536, faces_.size() / 32 + 1);
    const std::size_t blocks = (faces_.size() + block - 1) / block, count = planes_.size();
    std::vector<std::vector<Crossing>> crossings(blocks);
    std::vector<std::vector<std::size_t>> next(blocks, std::vector<std::size_t>(count, 0));
    parallel_for(blocks, 1, [&](std::size_t b) {
        for (std::size_t i = b * block; i < std::min(faces_.size(), (b + 1) * block); ++i) {
            if (mesh_.is_removed(Face(faces_[i]))) continue;
            const auto [low, high] = levels(faces_[i]);
            if (low == high) continue;
            crossings[b].push_back({faces_[i], low, high});
            for (Index plane = low; plane < high; ++plane) ++next[b][plane];
        }
    });
    first_.assign(count + 1, 0);
    for (std::size_t plane = 0; plane < count; ++plane) {
        first_[plane + 1] = first_[plane];
        for (auto& counts : next) first_[plane + 1] += std::exchange(counts[plane], first_[plane + 1]);
    }
    crossed_.resize(first_.back());
    parallel_for(blocks, 1, [&](std::size_t b) {
        for (const auto& [face, low, high] : crossings[b])
            for (Index plane = low; plane < high; ++plane) crossed_[next[b][plane]++] = face;
    });
}

std::vector<Contour> Sweep::contours(std::size_t plane) const {
    const auto begin = crossed_.begin() + static_cast<long>(first_[plane]),
               end = crossed_.begin() + static_cast<long>(first_[plane + 1]);
    return detail::join(
        mesh_, begin, end, [&](Vertex v) { return level_[v.idx()] > plane; },
        [&](Halfedge h) {
            return detail::crossing(mesh_, frame_, h, planes_[plane].height, tolerance_,
                                    [&](Vertex v) { return height_[v.idx()]; });
        });
}

}  // namespace

SliceStack slice_mesh(const Mesh& mesh, const SliceFrame& frame, const std::vector<double>& heights,
                      const std::vector<Index>& faces) {
    check(mesh, frame, heights, faces);
    const Sweep sweep(mesh, frame, heights, faces);
    SliceStack stack{frame, std::vector<Slice>(heights.size()), false};
    parallel_for(heights.size(), 1, [&](std::size_t plane) {
        Slice& slice = stack.slices[sweep.planes()[plane].place];
        slice.height = sweep.planes()[plane].height;
        slice.contours = sweep.contours(plane);
    });
    stack.reversed = detail::classify_contours(stack.slices, mesh, faces.empty());
    return stack;
}

std::vector<Slice> components(const Slice& slice) {
    std::vector<Slice> parts;
    std::vector<std::size_t> component_of(slice.contours.size());
    for (std::size_t i = 0; i < slice.contours.size(); ++i) {
        const Contour& contour = slice.contours[i];
        if (!contour.closed) continue;
        if (!contour.hole) {
            component_of[i] = parts.size();
            parts.push_back({slice.height, {contour}, {}});
            parts.back().contours[0].parent = -1, parts.back().contours[0].depth = 0;
            continue;
        }
        // The nearest outer contour that contains it.
        int outer = contour.parent;
        while (outer >= 0 && slice.contours[static_cast<std::size_t>(outer)].hole)
            outer = slice.contours[static_cast<std::size_t>(outer)].parent;
        if (outer < 0) continue;
        Slice& component = parts[component_of[static_cast<std::size_t>(outer)]];
        component.contours.push_back(contour);
        component.contours.back().parent = 0, component.contours.back().depth = 1;
    }
    return parts;
}

}  // namespace ostraka

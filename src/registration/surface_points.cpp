#include "registration/surface_points.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/stats/random.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// Dense samples of the faces, more than needed: each represents an area.
struct DenseSamples {
    std::vector<Vector3d> places, normals;
    std::vector<double> areas;
};

DenseSamples dense_samples(const Mesh& mesh, const std::vector<bool>& faces, double patch) {
    constexpr double maximum = 4096;  // per face
    DenseSamples dense;
    for (const Face face : mesh.faces()) {
        if (!faces.empty() && !faces[face]) continue;
        const Vector3d across = eigen(area_vector(mesh, face));
        const double area = across.norm();
        if (!(area > 0)) continue;
        const auto c = corners(mesh, face);
        const Vector3d a = eigen(mesh.point(c[0])), u = eigen(mesh.point(c[1])) - a, v = eigen(mesh.point(c[2])) - a;
        const auto count = static_cast<int>(std::clamp(std::ceil(area / patch), 1.0, maximum));
        for (int k = 0; k < count; ++k) {
            // A low-discrepancy sequence (Roberts 2018), folded into the triangle; the first point is the centroid.
            double s = 1.0 / 3, t = 1.0 / 3;
            if (k > 0) {
                double integer_part = 0;
                s = std::modf(0.5 + 0.7548776662466927 * k, &integer_part);
                t = std::modf(0.5 + 0.5698402909980532 * k, &integer_part);
                if (s + t > 1) s = 1 - s, t = 1 - t;
            }
            dense.places.push_back(a + s * u + t * v);
            dense.normals.push_back(across / area);
            dense.areas.push_back(area / count);
        }
    }
    return dense;
}

/// Points by the cells of a grid, with the number of cells bounded by that of the points.
class Cells {
public:
    Cells(const std::vector<Vector3d>& places, double side) : places_(places) {
        Eigen::AlignedBox3d box;
        for (const Vector3d& p : places) box.extend(p);
        low_ = box.min();
        side_ = std::max(side, box.sizes().maxCoeff() / 100);
        for (int k = 0; k < 3; ++k) count_[k] = static_cast<int>(box.sizes()[k] / side_) + 1;
        starts_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2] + 1, 0);
        std::vector<std::size_t> cell(places.size());
        for (std::size_t i = 0; i < places.size(); ++i) ++starts_[(cell[i] = index(at(places[i]))) + 1];
        for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
        members_.resize(places.size());
        std::vector<Index> next(starts_.begin(), starts_.end() - 1);
        for (std::size_t i = 0; i < places.size(); ++i) members_[next[cell[i]]++] = static_cast<Index>(i);
    }

    /// Visits the points nearer than `radius`, which must not exceed the requested side of a cell.
    template <class Visit>
    void near(const Vector3d& p, double radius, Visit&& visit) const {
        const Eigen::Vector3i c = at(p);
        for (int x = std::max(0, c[0] - 1); x <= std::min(count_[0] - 1, c[0] + 1); ++x)
            for (int y = std::max(0, c[1] - 1); y <= std::min(count_[1] - 1, c[1] + 1); ++y)
                for (int z = std::max(0, c[2] - 1); z <= std::min(count_[2] - 1, c[2] + 1); ++z) {
                    const std::size_t cell = index({x, y, z});
                    for (Index i = starts_[cell]; i < starts_[cell + 1]; ++i)
                        if ((places_[members_[i]] - p).squaredNorm() < radius * radius) visit(members_[i]);
                }
    }

private:
    [[nodiscard]] Eigen::Vector3i at(const Vector3d& p) const {
        Eigen::Vector3i c;
        for (int k = 0; k < 3; ++k) c[k] = std::clamp(static_cast<int>((p[k] - low_[k]) / side_), 0, count_[k] - 1);
        return c;
    }
    [[nodiscard]] std::size_t index(const Eigen::Vector3i& c) const {
        return (static_cast<std::size_t>(c[0]) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(c[1])) *
                   static_cast<std::size_t>(count_[2]) +
               static_cast<std::size_t>(c[2]);
    }
    const std::vector<Vector3d>& places_;
    Vector3d low_;
    double side_ = 0;
    Eigen::Vector3i count_;
    std::vector<Index> starts_, members_;
};

}  // namespace

double marked_area(const Mesh& mesh, const std::vector<bool>& faces) {
    double area = 0;
    for (const Face face : mesh.faces())
        if (faces.empty() || faces[face]) area += face_area(mesh, face);
    return area;
}

SurfacePoints spread_points(const Mesh& mesh, const std::vector<bool>& faces, double spacing, double radius, std::uint64_t seed) {
    if (!(spacing > 0 && radius > 0))
        fail_usage("points cannot be spread without a distance between them", "give lengths above 0");
    if (!faces.empty() && faces.size() != mesh.number_of_faces())
        fail_usage(fmt::format("there are {} marks for {} faces", faces.size(), mesh.number_of_faces()));
    SurfacePoints points;
    points.spacing = spacing;
    const DenseSamples dense = dense_samples(mesh, faces, spacing * spacing / 6);
    if (dense.places.empty()) return points;
    const Cells cells(dense.places, std::max(spacing, radius));
    std::vector<Index> chosen;
    std::vector<bool> is_chosen(dense.places.size(), false);
    for (const std::size_t i : Random(seed).permutation(dense.places.size())) {
        bool has_room = true;
        cells.near(dense.places[i], spacing,
                   [&](Index j) { has_room = has_room && !(is_chosen[j] && dense.normals[j].dot(dense.normals[i]) > 0); });
        if (!has_room) continue;
        is_chosen[i] = true;
        chosen.push_back(static_cast<Index>(i));
    }
    std::sort(chosen.begin(), chosen.end());
    points.places.resize(chosen.size());
    points.normals.resize(chosen.size());
    parallel_for(chosen.size(), [&](std::size_t k) {
        const Vector3d p = dense.places[chosen[k]];
        Vector3d normal = dense.normals[chosen[k]];
        for (const double cosine : {0.0, 0.3}) {
            Vector3d sum = Vector3d::Zero();
            cells.near(p, radius, [&](Index j) {
                if (dense.normals[j].dot(normal) > cosine) sum += dense.areas[j] * dense.normals[j];
            });
            if (sum.norm() > 0) normal = sum.normalized();
        }
        double height = 0, area = 0;
        cells.near(p, radius, [&](Index j) {
            if (dense.normals[j].dot(normal) <= 0.3) return;
            height += dense.areas[j] * normal.dot(dense.places[j] - p);
            area += dense.areas[j];
        });
        points.places[k] = area > 0 ? Vector3d(p + height / area * normal) : p;
        points.normals[k] = normal;
    });
    return points;
}

}  // namespace ostraka

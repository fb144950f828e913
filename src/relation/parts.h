// What relationships ask of an annotated part.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/axis/axis.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"

#include <memory>

namespace ostraka::detail {

using Eigen::Matrix3d;
using Eigen::Vector3d;

inline std::array<double, 3> array_of(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// Points with weights: centroids of faces by area, middles of edges by length, or vertices.
struct Cloud {
    std::vector<Vector3d> points;
    std::vector<double> weights;
    [[nodiscard]] Vector3d mean() const;
    /// Plane of least squares: its unit normal and the rms distance from it; `spread` is the middle standard deviation: 0 where
    /// the points lie on a line.
    struct Plane {
        Vector3d point, normal;
        double rms = 0, spread = 0;
    };
    [[nodiscard]] Plane plane() const;
};

/// A straight axis, or why there is none.
struct PartAxis {
    bool found = false;
    std::string reason;
    Vector3d point, direction;
};

class Part {
public:
    Part(const Mesh& mesh, const Annotation& annotation) : mesh_(mesh), annotation_(annotation) {}

    [[nodiscard]] const Annotation& annotation() const { return annotation_; }
    [[nodiscard]] bool empty() const;
    const Cloud& cloud();                    ///< all of it
    const std::vector<Vector3d>& samples();  ///< of a region: 500 at most, spread by area
    const Vector3d& centroid();
    double area();
    /// Of slices where the part is longer than wide, else of rotation; bent axes do not count.
    const PartAxis& axis();
    /// Distances between all pairs of samples, at 64 quantiles (Osada et al. 2002, D2).
    const std::vector<double>& shape();
    /// The region's nearest point.
    Vector3d closest(const Vector3d& query);
    /// Frees what takes as much memory as the region; it is made again when asked for.
    void forget();

private:
    const Mesh& mesh_;
    const Annotation& annotation_;
    std::optional<Cloud> cloud_;
    std::optional<Vector3d> centroid_;
    std::optional<double> area_;
    std::optional<std::vector<Vector3d>> samples_;
    std::optional<std::vector<double>> shape_;
    std::optional<PartAxis> axis_;
    std::unique_ptr<Mesh> own_;
    std::unique_ptr<SurfaceSearch> search_;
};

/// A reflection that carries part `a` to part `b` (which may be the same), refined from the planes that suggest themselves.
struct Mirror {
    Vector3d point, normal;
    double rms = 0;  ///< of the distances of reflected samples of each to the other
};
Mirror find_mirror(Part& a, Part& b);

}  // namespace ostraka::detail

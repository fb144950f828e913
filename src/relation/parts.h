// Geometric properties of an annotated part that relationships use.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/axis/axis.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"

#include <memory>

namespace ostraka::detail {

inline std::array<double, 3> array_of(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// Weighted points: centroids of faces by area, midpoints of edges by length, or vertices.
struct Cloud {
    std::vector<Vector3d> points;
    std::vector<double> weights;
    [[nodiscard]] Vector3d mean() const;
    /// Least-squares plane: unit normal and rms distance. `spread` is the middle standard deviation, 0 if the points lie on a
    /// line.
    struct Plane {
        Vector3d point, normal;
        double rms = 0, spread = 0;
    };
    [[nodiscard]] Plane plane() const;
};

/// A straight axis, or the reason why there is none.
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
    const Cloud& cloud();                    ///< all points of the part
    const std::vector<Vector3d>& samples();  ///< for regions: at most 500, distributed by area
    const Vector3d& centroid();
    double area();
    /// The axis of slices if the part is longer than wide, otherwise of rotation; bent axes are rejected.
    const PartAxis& axis();
    /// Distances between all pairs of samples, at 64 quantiles (D2 distribution, Osada et al. 2002).
    const std::vector<double>& shape();
    /// The closest point of the region.
    Vector3d closest(const Vector3d& query);
    /// Frees data whose memory is proportional to the region; it is computed again on demand.
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

/// A reflection that maps part `a` to part `b` (which may be the same), refined from several initial planes.
struct Mirror {
    Vector3d point, normal;
    double rms = 0;  ///< rms distance from the reflected samples of each part to the other
};
Mirror find_mirror(Part& a, Part& b);

}  // namespace ostraka::detail

// Geometric properties of an annotated part that relationships compare.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/axis/axis.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"

#include <memory>

namespace ostraka::detail {

inline std::array<double, 3> array_of(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// Weighted points of a part: centroids of faces by area, midpoints of edges by length, or vertices.
struct Cloud {
    std::vector<Vector3d> points;
    std::vector<double> weights;          ///< one weight per point
    [[nodiscard]] Vector3d mean() const;  ///< weighted mean of the points
    /// Least-squares plane of the points: a point, the unit normal, and the root mean square distance of the points. `spread`:
    /// middle standard deviation along the principal axes, 0 if the points lie on a line.
    struct Plane {
        Vector3d point, normal;
        double rms = 0, spread = 0;  ///< root mean square distance; middle standard deviation
    };
    [[nodiscard]] Plane plane() const;  ///< least-squares plane
};

/// The straight axis of a part, or the reason why there is none.
struct PartAxis {
    bool found = false;         ///< true: the part has an axis
    std::string reason;         ///< why the part has no axis
    Vector3d point, direction;  ///< point and unit direction of the axis
};

/// Geometric properties of one annotated part, computed on demand.
class Part {
public:
    Part(const Mesh& mesh, const Annotation& annotation) : mesh_(mesh), annotation_(annotation) {}

    [[nodiscard]] const Annotation& annotation() const { return annotation_; }
    [[nodiscard]] bool empty() const;        ///< true: the part selects nothing
    const Cloud& cloud();                    ///< all points of the part
    const std::vector<Vector3d>& samples();  ///< points spread over a region by area, at most 500
    const Vector3d& centroid();              ///< centroid of the part
    double area();                           ///< area of a region
    /// The axis of the part's slices if the part is longer than wide, otherwise its axis of rotation; a bent axis is rejected.
    const PartAxis& axis();
    /// Distances between all pairs of samples, at 64 quantiles (D2 shape distribution, Osada et al. 2002).
    const std::vector<double>& shape();
    /// The point of the region closest to `query`.
    Vector3d closest(const Vector3d& query);
    /// Frees the data whose memory is proportional to the region; the data are computed again on demand.
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
    std::unique_ptr<Mesh> own_;              ///< mesh of the region alone
    std::unique_ptr<SurfaceSearch> search_;  ///< search tree over the region's mesh
};

/// A reflection that maps part `a` to part `b` (which may be the same part), refined from several initial planes.
struct Mirror {
    Vector3d point, normal;  ///< point and normal of the mirror plane
    double rms = 0;          ///< root mean square distance of the reflected samples of each part from the other part
};
/// Finds the mirror plane with the smallest residual.
Mirror find_mirror(Part& a, Part& b);

}  // namespace ostraka::detail

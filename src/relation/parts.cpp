#include "relation/parts.h"
#include "ostraka/algebra/dense.h"
#include "ostraka/annotation/curves.h"

#include <map>

namespace ostraka::detail {

Vector3d Cloud::mean() const {
    Vector3d sum = Vector3d::Zero();
    double total = 0;
    for (std::size_t i = 0; i < points.size(); ++i) sum += weights[i] * (points[i] - points[0]), total += weights[i];
    return total > 0 ? Vector3d(points[0] + sum / total) : sum;
}

Cloud::Plane Cloud::plane() const {
    Plane plane{mean(), Vector3d::UnitZ()};
    Matrix3d covariance = Matrix3d::Zero();
    double total = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        covariance += weights[i] * (points[i] - plane.point) * (points[i] - plane.point).transpose();
        total += weights[i];
    }
    if (!(total > 0)) return plane;
    const SymmetricEigen3 solver(covariance / total);
    plane.normal = solver.eigenvectors().col(0);
    plane.rms = std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
    plane.spread = std::sqrt(std::max(0.0, solver.eigenvalues()[1]));
    return plane;
}

bool Part::empty() const {
    return annotation_.faces.empty() && annotation_.points.empty() &&
           std::all_of(annotation_.polylines.begin(), annotation_.polylines.end(),
                       [](const auto& polyline) { return polyline.size() < 2; });
}

const Cloud& Part::cloud() {
    if (cloud_) return *cloud_;
    Cloud cloud;
    for (const Index f : annotation_.faces) {
        cloud.points.push_back(eigen(ostraka::centroid(mesh_, Face(f))));
        cloud.weights.push_back(face_area(mesh_, Face(f)));
    }
    for (const auto& polyline : annotation_.polylines)
        for (std::size_t i = 1; i < polyline.size(); ++i) {
            const Vector3d p = eigen(mesh_.point(Vertex(polyline[i - 1]))), q = eigen(mesh_.point(Vertex(polyline[i])));
            cloud.points.emplace_back((p + q) / 2);
            cloud.weights.push_back((q - p).norm());
        }
    for (const Index v : annotation_.points) {
        cloud.points.push_back(eigen(mesh_.point(Vertex(v))));
        cloud.weights.push_back(1);
    }
    return cloud_.emplace(std::move(cloud));
}

const Vector3d& Part::centroid() {
    return centroid_ ? *centroid_ : centroid_.emplace(cloud().points.empty() ? Vector3d::Zero() : cloud().mean());
}

double Part::area() {
    if (area_) return *area_;
    return area_.emplace(area_of(mesh_, annotation_));
}

const std::vector<Vector3d>& Part::samples() {
    if (samples_) return *samples_;
    const std::size_t maximum = 500;
    std::vector<Vector3d> list;
    double total = 0, passed = 0;
    if (annotation_.type == AnnotationType::region)
        for (const double weight : cloud().weights) total += weight;
    for (std::size_t i = 0; i < cloud().points.size() && total > 0; ++i) {
        passed += cloud().weights[i];
        if (cloud().points.size() <= maximum || passed / total * double(maximum) >= double(list.size()) + 0.5)
            list.push_back(cloud().points[i]);
    }
    return samples_.emplace(std::move(list));
}

const PartAxis& Part::axis() {
    if (axis_) return *axis_;
    PartAxis result;
    if (annotation_.type != AnnotationType::region || !(area() > 0)) {
        result.reason = "only regions have axes";
        return axis_.emplace(result);
    }
    Axis axis = slice_axis(mesh_, annotation_.faces);
    if (!axis.found) axis = rotation_axis(mesh_, annotation_.faces);
    else if (const double length = axis.figure("length")->value; axis.figure("rms distance")->value > 0.08 * length) {
        axis.found = false;
        axis.reason = "its axis is bent";
    }
    if (const AreaMoments m = area_moments(mesh_, annotation_.faces);
        !axis.found && axis.quality > 0.4 && m.variances[1] > 0.8 * m.variances[0] && m.variances[2] < 0.6 * m.variances[1]) {
        // A revolved disc or dome with noise: its shortest principal axis is more stable than an axis fitted to normals.
        axis.found = true;
        axis.point = m.centroid;
        axis.direction = m.directions[2];
    }
    result = {axis.found, axis.reason, eigen(axis.point), eigen(axis.direction)};
    return axis_.emplace(result);
}

const std::vector<double>& Part::shape() {
    if (shape_) return *shape_;
    const auto& points = samples();
    std::vector<double> distances, quantiles;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) distances.push_back((points[i] - points[j]).norm());
    std::sort(distances.begin(), distances.end());
    for (std::size_t k = 0; k < 64 && !distances.empty(); ++k)
        quantiles.push_back(distances[(2 * k + 1) * (distances.size() - 1) / 128]);
    return shape_.emplace(std::move(quantiles));
}

Vector3d Part::closest(const Vector3d& query) {
    if (!search_) {
        std::map<Index, Index> number;
        TriangleSoup soup;
        own_ = std::make_unique<Mesh>();
        // A patch that touches itself at a vertex is not manifold; the search does not need connectivity, so that faces are
        // added separately.
        for (const Index f : annotation_.faces) {
            std::array<Index, 3> triangle{};
            std::size_t k = 0;
            for (const Vertex v : corners(mesh_, Face(f))) {
                triangle.at(k++) = static_cast<Index>(soup.points.size());
                const Point& p = mesh_.point(v);
                soup.points.push_back({p.x(), p.y(), p.z()});
            }
            soup.triangles.push_back(triangle);
        }
        *own_ = build_mesh(soup);
        search_ = std::make_unique<SurfaceSearch>(*own_);
    }
    return eigen(search_->closest(point_of(query)).point);
}

void Part::forget() {
    cloud_.reset();
    samples_.reset();
    search_.reset();
    own_.reset();
}

namespace {

struct Pairs {
    std::vector<Vector3d> p, q;
};

/// Pairs of each reflected sample of `a` with the closest point of `b`; each pair in the order (of a, of b).
void pair_up(Part& a, Part& b, const Mirror& mirror, bool swapped, Pairs& pairs) {
    for (const Vector3d& p : a.samples()) {
        const Vector3d reflected = p - 2 * mirror.normal.dot(p - mirror.point) * mirror.normal;
        const Vector3d q = b.closest(reflected);
        pairs.p.push_back(swapped ? q : p);
        pairs.q.push_back(swapped ? p : q);
    }
}

/// The reflection that best maps the p onto the q (least squares): with S the covariance of the pairs and d the difference of
/// their means, the normal is the eigenvector of 2 (S + S^T) - d d^T for the smallest eigenvalue.
Mirror fit(const Pairs& pairs) {
    const double count = double(pairs.p.size());
    Vector3d mean_p = Vector3d::Zero(), mean_q = Vector3d::Zero();
    for (std::size_t i = 0; i < pairs.p.size(); ++i) mean_p += pairs.p[i] / count, mean_q += pairs.q[i] / count;
    Matrix3d S = Matrix3d::Zero();
    for (std::size_t i = 0; i < pairs.p.size(); ++i) S += (pairs.p[i] - mean_p) * (pairs.q[i] - mean_q).transpose() / count;
    const Vector3d d = mean_q - mean_p;
    const SymmetricEigen3 solver(2 * (S + S.transpose()) - d * d.transpose());
    return {(mean_p + mean_q) / 2, solver.eigenvectors().col(0)};
}

double rms_of(const Pairs& pairs, const Mirror& mirror) {
    double sum = 0;
    for (std::size_t i = 0; i < pairs.p.size(); ++i) {
        const Vector3d& p = pairs.p[i];
        sum += (p - 2 * mirror.normal.dot(p - mirror.point) * mirror.normal - pairs.q[i]).squaredNorm();
    }
    return std::sqrt(sum / double(std::max<std::size_t>(1, pairs.p.size())));
}

}  // namespace

Mirror find_mirror(Part& a, Part& b) {
    const bool same = &a == &b;
    std::vector<Mirror> starts;
    const Vector3d between = b.centroid() - a.centroid();
    if (!same && between.norm() > 0) {
        starts.push_back({(a.centroid() + b.centroid()) / 2, between.normalized()});
    } else {
        Cloud cloud{a.samples(), std::vector<double>(a.samples().size(), 1)};
        Matrix3d covariance = Matrix3d::Zero();
        for (const auto& p : cloud.points) covariance += (p - a.centroid()) * (p - a.centroid()).transpose();
        const SymmetricEigen3 solver(covariance);
        for (int k = 0; k < 3; ++k) starts.push_back({a.centroid(), solver.eigenvectors().col(k)});
    }
    Mirror best;
    best.rms = std::numeric_limits<double>::infinity();
    for (Mirror mirror : starts)
        for (int round = 0; round < 12; ++round) {
            Pairs pairs;
            pair_up(a, b, mirror, false, pairs);
            if (!same) pair_up(b, a, mirror, true, pairs);
            mirror.rms = rms_of(pairs, mirror);
            if (mirror.rms < best.rms) best = mirror;
            mirror = fit(pairs);
        }
    return best;
}

}  // namespace ostraka::detail

#include "ostraka/transfer/misalignment.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

namespace {

constexpr std::size_t sample_size = 400;
constexpr int rounds = 8;

Eigen::Vector3d vector_of(const Point& p) { return {p.x(), p.y(), p.z()}; }

std::vector<Eigen::Vector3d> sample_of(const Mesh& mesh) {
    std::vector<Eigen::Vector3d> points;
    const std::size_t n = mesh.number_of_vertices(), count = std::min(n, sample_size);
    for (std::size_t i = 0; i < count; ++i)
        if (const Vertex v(static_cast<Index>(i * n / count)); !mesh.is_isolated(v)) points.push_back(vector_of(mesh.point(v)));
    return points;
}

/// The sample, registered to the target step by step: each step minimises the distances of the points from the planes of their
/// nearest faces.
class Fit {
public:
    Fit(const Mesh& source, const SurfaceSearch& target) : target_(target), points_(sample_of(source)), hits_(points_.size()) {
        for (const auto& p : points_) middle_ += p / static_cast<double>(points_.size());
        find_nearest();
    }

    /// Mean of the smallest nine tenths of the distances.
    [[nodiscard]] double distance() const {
        double sum = 0;
        for (const std::size_t i : kept_) sum += hits_[i].distance;
        return kept_.empty() ? 0 : sum / static_cast<double>(kept_.size());
    }

    void step(bool scaling) {
        const double size = target_.diagonal();
        Eigen::MatrixXd a = Eigen::MatrixXd::Zero(7, 7);
        Eigen::VectorXd b = Eigen::VectorXd::Zero(7);
        const Eigen::Vector3d centre = middle_ + shift_;
        for (const std::size_t i : kept_) {
            const Vector n = target_.normal(hits_[i].face);
            const Eigen::Vector3d normal(n.x(), n.y(), n.z()), arm = (points_[i] - centre) / size;
            Eigen::Matrix<double, 7, 1> row;
            row << arm.cross(normal), normal, scaling ? arm.dot(normal) : 0;
            a += row * row.transpose();
            b += row * normal.dot(vector_of(hits_[i].point) - points_[i]) / size;
        }
        // Damping suppresses motions that the surface does not determine, such as rotations of a sphere.
        a.diagonal().array() += 1e-4 * static_cast<double>(kept_.size());
        const Eigen::VectorXd x = solve_ldlt<Eigen::Dynamic>(a, b);
        const Eigen::Vector3d turn = x.head<3>(), move = size * x.segment<3>(3);
        const double angle = turn.norm(), scale = std::exp(x[6]);
        const Eigen::Matrix3d rotation =
            angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Eigen::Matrix3d::Identity();
        for (auto& p : points_) p = centre + move + scale * (rotation * (p - centre));
        rotation_ = rotation * rotation_;
        shift_ += move;
        scale_ *= scale;
        find_nearest();
    }

    void tell(Misalignment& found) const {
        found.distance_left = distance();
        found.rotation = Eigen::AngleAxisd(rotation_).angle() * 180 / pi;
        found.shift = shift_.norm();
        found.scale = scale_;
    }

private:
    void find_nearest() {
        parallel_for(points_.size(), 16, [&](std::size_t i) {
            hits_[i] = target_.closest({points_[i].x(), points_[i].y(), points_[i].z()});
        });
        kept_.resize(points_.size());
        std::iota(kept_.begin(), kept_.end(), std::size_t{0});
        std::stable_sort(kept_.begin(), kept_.end(),
                         [&](std::size_t i, std::size_t j) { return hits_[i].distance < hits_[j].distance; });
        kept_.resize((9 * kept_.size() + 9) / 10);
    }

    const SurfaceSearch& target_;
    std::vector<Eigen::Vector3d> points_;
    std::vector<SurfaceHit> hits_;
    std::vector<std::size_t> kept_;
    Eigen::Vector3d middle_ = Eigen::Vector3d::Zero(), shift_ = Eigen::Vector3d::Zero();
    Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();
    double scale_ = 1;
};

}  // namespace

Misalignment find_misalignment(const Mesh& source, const SurfaceSearch& target) {
    Fit fit(source, target);
    Misalignment found;
    found.distance = fit.distance();
    const double size = target.diagonal(), edge = std::max(mean_edge_length(source), target.typical_edge());
    if (!(found.distance > 0.0003 * size)) return found;
    // Flat faces deviate from a surface of radius r by h^2 / 8r, always to its inner side, as for a smaller surface; parts of
    // objects are assumed to have radii of a fifth of the diagonal. A distance explained by this gives no evidence of a
    // different scale.
    const bool scaling = found.distance > 0.0003 * size + edge * edge / (1.6 * size);
    for (int round = 0; round < rounds; ++round) fit.step(scaling);
    Misalignment mended = found;
    fit.tell(mended);
    mended.is_significant = mended.distance_left < 0.6 * found.distance;
    return mended.is_significant ? mended : found;
}

std::string message_about(const Misalignment& found, double diagonal, const std::string& unit) {
    const auto length = [&](double x) { return digits(x, 3) + (unit.empty() ? "" : " " + unit); };
    std::vector<std::string> motion;
    if (found.rotation >= 0.1) motion.push_back("turned by " + digits(found.rotation, 2) + " degrees");
    if (found.shift >= 0.0005 * diagonal) motion.push_back("moved by " + length(found.shift));
    if (std::abs(found.scale - 1) >= 0.002) motion.push_back("scaled by " + digits(found.scale, 3));
    return "the meshes do not lie on each other: they are " + length(found.distance) + " apart on average (" +
           digits(100 * found.distance / diagonal, 2) + " % of the diagonal), and " + length(found.distance_left) +
           " if the source is " + joined(motion) + "; transferred data have errors of this size: align the meshes first";
}

}  // namespace ostraka

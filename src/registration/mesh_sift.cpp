#include "ostraka/registration/mesh_sift.h"
#include "ostraka/core/angles.h"

#include "ostraka/execution/parallel.h"
#include "ostraka/fields/curvature.h"
#include "ostraka/geom/diffusion.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/geodesic.h"
#include "ostraka/geom/neighbourhood.h"

#include <cmath>

namespace ostraka {

namespace {

/// A level of the scale space: the smoothed surface and the inputs of the descriptors.
struct Level {
    double sigma = 0;
    Mesh mesh;
    std::vector<double> mean, shape_index, curvedness, area;
    std::vector<Vector3d> normals;
};

Level smoothed_level(const Mesh& mesh, const Diffusion& diffusion, const Eigen::MatrixXd& start, double sigma) {
    Level level;
    level.sigma = sigma;
    level.mesh = mesh;
    set_positions(level.mesh, diffusion.smoothed(start, sigma, 2));
    // Curvature is averaged over a radius that grows with the scale, so that it does not depend on the triangulation.
    CurvatureOptions options;
    const double diagonal = box_diagonal(level.mesh);
    options.scale = diagonal > 0 ? std::min(1.0, 1.5 * sigma / diagonal) : 0;
    Curvature curvature = ostraka::curvature(level.mesh, options);
    for (auto* values : {&curvature.mean, &curvature.gaussian})
        for (double& value : *values)
            if (std::isnan(value)) value = 0;  // the border has no salient points
    const std::size_t count = mesh.number_of_vertices();
    level.mean = curvature.mean;
    level.shape_index.resize(count), level.curvedness.resize(count), level.area.assign(count, 0), level.normals.resize(count);
    parallel_for(count, [&](std::size_t i) {
        const Vertex v(static_cast<Index>(i));
        const double h = curvature.mean[i], half = std::sqrt(std::max(h * h - curvature.gaussian[i], 0.0));
        // Koenderink and van Doorn 1992; 1 on a cap, -1 in a cup.
        level.shape_index[i] = 2 / pi * std::atan2(h, half);
        level.curvedness[i] = std::sqrt(h * h + half * half);
        if (mesh.is_isolated(v)) {
            level.normals[i] = Vector3d::Zero();
            return;
        }
        level.normals[i] = eigen(vertex_normal(level.mesh, v));
        for (const Face face : mesh.faces_around_target(mesh.halfedge(v)))
            if (face != Mesh::null_face()) level.area[i] += face_area(level.mesh, face) / 3;
    });
    return level;
}

/// Distance of each vertex to the border along edges; infinite on closed meshes.
std::vector<double> border_distances(const Mesh& mesh) {
    std::vector<std::pair<Vertex, double>> border;
    for (const Vertex v : mesh.vertices())
        if (mesh.is_isolated(v) || mesh.is_border(v)) border.emplace_back(v, 0.0);
    return edge_distances(mesh, border);
}

struct Salient {
    Index vertex;
    std::size_t level;
};

/// Vertices where the difference of two levels is larger, or smaller, than at all neighbours on this and the two adjacent
/// levels.
std::vector<Salient> extrema(const Mesh& mesh, const std::vector<Level>& levels, const std::vector<double>& to_border,
                             const SiftOptions& options) {
    std::vector<std::vector<double>> differences;
    for (std::size_t s = 0; s + 1 < levels.size(); ++s) {
        auto& d = differences.emplace_back(mesh.number_of_vertices());
        for (std::size_t v = 0; v < d.size(); ++v) d[v] = levels[s].sigma * (levels[s + 1].mean[v] - levels[s].mean[v]);
    }
    std::vector<Salient> salient_points;
    for (std::size_t s = 1; s + 1 < differences.size(); ++s) {
        for (const Vertex v : mesh.vertices()) {
            const double value = differences[s][v];
            if (std::abs(value) < options.contrast || to_border[v] < options.border * levels[s].sigma || mesh.is_isolated(v))
                continue;
            bool largest = true, smallest = true;
            const auto compare = [&](double other) { largest = largest && value > other, smallest = smallest && value < other; };
            for (const std::size_t t : {s - 1, s, s + 1}) {
                if (t != s) compare(differences[t][v]);
                for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v))) {
                    compare(differences[t][mesh.source(h)]);
                    if (!largest && !smallest) break;
                }
            }
            if (largest || smallest) salient_points.push_back({v, s});
        }
    }
    return salient_points;
}

/// Neighbours of a salient point, projected to its tangent plane, with weights.
struct TangentNeighbourhood {
    std::vector<Vector2d> place, tilt;  ///< in units of sigma; projection of the normal
    std::vector<Index> vertex;
};

class Describer {
public:
    Describer(const Level& level, Index vertex) : level_(level), vertex_(vertex) {
        normal_ = level.normals[vertex];
        const Vector3d other = std::abs(normal_.x()) < 0.6 ? Vector3d::UnitX() : Vector3d::UnitY();
        u_ = other.cross(normal_).normalized();
        v_ = normal_.cross(u_);
        const Vector3d centre = eigen(level.mesh.point(Vertex(vertex)));
        this_threads_neighbourhood().walk(level.mesh, Vertex(vertex), search_radius * level.sigma, [&](Vertex w, double squared) {
            if (level.normals[w].isZero()) return;
            const Vector3d offset = eigen(level.mesh.point(w)) - centre;
            Vector2d flat(u_.dot(offset), v_.dot(offset));
            const double length = flat.norm();
            if (length > 0) flat *= std::sqrt(squared) / length / level.sigma;
            around_.place.push_back(flat);
            around_.tilt.emplace_back(u_.dot(level.normals[w]), v_.dot(level.normals[w]));
            around_.vertex.push_back(w);
        });
    }

    /// Peaks of the histogram of the directions in which the normals are tilted, highest first.
    [[nodiscard]] std::vector<double> directions(double share) const {
        constexpr int bins = 360;
        std::vector<double> histogram(bins, 0), smooth(bins, 0);
        for (std::size_t i = 0; i < around_.place.size(); ++i) {
            const double weight = std::exp(-around_.place[i].squaredNorm() / (2 * 4.5 * 4.5)) * around_.tilt[i].norm() *
                                  level_.area[around_.vertex[i]];
            const double position = bins * (std::atan2(around_.tilt[i].y(), around_.tilt[i].x()) / (2 * pi) + 0.5);
            const int low = static_cast<int>(std::floor(position));
            histogram[static_cast<std::size_t>(low % bins)] += weight * (1 - (position - low));
            histogram[static_cast<std::size_t>((low + 1) % bins)] += weight * (position - low);
        }
        constexpr int half = 51;  // three standard deviations of 17 degrees
        for (int i = 0; i < bins; ++i)
            for (int k = -half; k <= half; ++k)
                smooth[static_cast<std::size_t>(i)] +=
                    std::exp(-k * k / (2 * 17.0 * 17.0)) * histogram[static_cast<std::size_t>((i + k + bins) % bins)];
        const double highest = *std::max_element(smooth.begin(), smooth.end());
        std::vector<std::pair<double, double>> peaks;  // height (negative), direction
        for (int i = 0; i < bins; ++i) {
            const double value = smooth[static_cast<std::size_t>(i)],
                         before = smooth[static_cast<std::size_t>((i + bins - 1) % bins)],
                         after = smooth[static_cast<std::size_t>((i + 1) % bins)];
            if (!(value > 0) || value < share * highest || value <= before || value < after) continue;
            const double shift = 0.5 * (before - after) / (before - 2 * value + after);
            peaks.emplace_back(-value, (i + shift) / bins * 2 * pi - pi);
        }
        std::sort(peaks.begin(), peaks.end());
        std::vector<double> directions;
        for (const auto& [height, direction] : peaks) directions.push_back(direction);
        return directions;
    }

    void describe(double direction, Feature& feature, Eigen::Ref<Eigen::VectorXf> descriptor) const {
        const Vector2d x(std::cos(direction), std::sin(direction)), y(-x.y(), x.x());
        feature.vertex = vertex_;
        feature.scale = level_.sigma;
        feature.point = eigen(level_.mesh.point(Vertex(vertex_)));
        feature.normal = normal_;
        feature.direction = x.x() * u_ + x.y() * v_;
        Eigen::Matrix<double, 2 * FeatureSet::bins, FeatureSet::discs> histograms;
        histograms.setZero();
        Eigen::Matrix<double, FeatureSet::discs, 1> covered = Eigen::Matrix<double, FeatureSet::discs, 1>::Zero();
        for (std::size_t i = 0; i < around_.place.size(); ++i) {
            const Vector2d place(x.dot(around_.place[i]), y.dot(around_.place[i]));
            const Index w = around_.vertex[i];
            const double area = level_.area[w] / (level_.sigma * level_.sigma);
            const double tilt = around_.tilt[i].norm();
            const double slant = std::atan2(y.dot(around_.tilt[i]), x.dot(around_.tilt[i]));
            for (int disc = 0; disc < FeatureSet::discs; ++disc) {
                const double squared = (place - centre(disc)).squaredNorm();
                if (squared >= disc_radius * disc_radius) continue;
                covered[disc] += area;
                const double weight = area * std::exp(-squared / (2 * 0.25 * disc_radius * disc_radius));
                // Shape index from -1 to 1, slant angle around the circle; distributed over the two nearest bins.
                const double s =
                    std::clamp((level_.shape_index[w] + 1) / 2 * FeatureSet::bins - 0.5, 0.0, FeatureSet::bins - 1.0);
                const int low = std::min(static_cast<int>(s), FeatureSet::bins - 2);
                const double curved = weight * level_.curvedness[w] * level_.sigma;
                histograms(low, disc) += curved * (1 - (s - low));
                histograms(low + 1, disc) += curved * (s - low);
                const double a = (slant / (2 * pi) + 1) * FeatureSet::bins;
                const int first = static_cast<int>(a);
                histograms(FeatureSet::bins + first % FeatureSet::bins, disc) += weight * tilt * (1 - (a - first));
                histograms(FeatureSet::bins + (first + 1) % FeatureSet::bins, disc) += weight * tilt * (a - first);
            }
        }
        const double maximum = 1 / std::sqrt(static_cast<double>(FeatureSet::bins));
        for (int disc = 0; disc < FeatureSet::discs; ++disc) {
            const bool is_covered = covered[disc] > 0.5 * pi * disc_radius * disc_radius;
            for (int part = 0; part < 2; ++part) {
                auto h = histograms.col(disc).segment<FeatureSet::bins>(part * FeatureSet::bins);
                const double norm = h.norm();
                if (norm > 0) h /= norm;
                h = h.cwiseMin(maximum);
                if (!is_covered) h.setZero();
            }
            descriptor.segment<2 * FeatureSet::bins>(disc * 2 * FeatureSet::bins) = histograms.col(disc).cast<float>();
        }
    }

private:
    static constexpr double disc_radius = 3.75, ring_radius = 4.5, search_radius = 9;  ///< in sigma
    static Vector2d centre(int disc) {
        if (disc == 0) return Vector2d::Zero();
        const double angle = (disc - 1) * pi / 4;
        return ring_radius * Vector2d(std::cos(angle), std::sin(angle));
    }
    const Level& level_;
    Index vertex_;
    Vector3d normal_, u_, v_;
    TangentNeighbourhood around_;
};

}  // namespace

FeatureSet mesh_sift(const Mesh& mesh, const SiftOptions& options) {
    check_options(options, "features");
    const double area = surface_area(mesh);
    if (!(area > 0)) fail_input("mesh", "it has no area and thus no salient points", "check that it is the right file");
    FeatureSet set;
    set.size = options.size > 0 ? options.size : std::sqrt(area);
    const Diffusion diffusion(mesh);
    const Eigen::MatrixXd start = positions(mesh);
    std::vector<Level> levels;
    for (int s = 0; s < options.scales; ++s)
        levels.push_back(smoothed_level(mesh, diffusion, start,
                                        options.first_scale * set.size * std::exp2(static_cast<double>(s) / options.per_octave)));
    const std::vector<Salient> salient = extrema(mesh, levels, border_distances(mesh), options);

    std::vector<std::vector<Feature>> features(salient.size());
    std::vector<Eigen::MatrixXf> descriptors(salient.size());
    parallel_for(salient.size(), 8, [&](std::size_t i) {
        const Level& level = levels[salient[i].level];
        if (level.normals[salient[i].vertex].isZero()) return;
        const Describer describer(level, salient[i].vertex);
        const std::vector<double> directions = describer.directions(options.second_direction);
        features[i].resize(directions.size());
        descriptors[i].resize(FeatureSet::length, static_cast<Eigen::Index>(directions.size()));
        for (std::size_t k = 0; k < directions.size(); ++k) {
            const auto column = static_cast<Eigen::Index>(k);
            describer.describe(directions[k], features[i][k], descriptors[i].col(column));
        }
    });
    for (const auto& point_features : features)
        set.features.insert(set.features.end(), point_features.begin(), point_features.end());
    set.descriptors.resize(FeatureSet::length, static_cast<Eigen::Index>(set.features.size()));
    Eigen::Index column = 0;
    for (std::size_t i = 0; i < salient.size(); ++i) {
        set.descriptors.middleCols(column, descriptors[i].cols()) = descriptors[i];
        column += descriptors[i].cols();
    }
    return set;
}

std::vector<FeatureMatch> match_features(const FeatureSet& a, const FeatureSet& b, const MatchOptions& options) {
    check_options(options, "matches");
    std::vector<FeatureMatch> matches;
    if (a.features.empty() || b.features.size() < 2) return matches;
    const auto norms = [](const FeatureSet& set) {
        Eigen::VectorXf result = set.descriptors.colwise().norm().transpose();
        return result;
    };
    const Eigen::VectorXf na = norms(a), nb = norms(b);
    const Eigen::MatrixXf dots = b.descriptors.transpose() * a.descriptors;
    for (Eigen::Index i = 0; i < dots.cols(); ++i) {
        Eigen::Index best = -1;
        double first = pi, second = pi;
        for (Eigen::Index j = 0; j < dots.rows(); ++j) {
            const double size = static_cast<double>(na[i]) * nb[j];
            const double angle = size > 0 ? std::acos(std::clamp(dots(j, i) / size, -1.0, 1.0)) : pi;
            if (angle < first) second = first, first = angle, best = j;
            else if (angle < second) second = angle;
        }
        if (best < 0 || !(first <= options.ratio * second)) continue;
        matches.push_back({static_cast<Index>(i), static_cast<Index>(best), first, second > 0 ? first / second : 0});
    }
    return matches;
}

void SiftOptions::declare_options(OptionList& list) {
    list("feature-size", size, "length to which --first-scale is relative; 0: square root of the area", Range{0, 1e60},
         "the mesh's unit");
    list("first-scale", first_scale, "standard deviation of the Gaussian of the first smoothing", Range{1e-4, 0.5},
         "share of the size");
    list("scales", scales, "number of smoothing levels", Range{4, 20});
    list("scales-per-octave", per_octave, "number of smoothing levels over which the standard deviation doubles", Range{1, 8});
    list("border", border, "minimum distance of features from the mesh border, in standard deviations of their level",
         Range{0, 10});
    list("contrast", contrast,
         "minimum contrast of a feature: difference of curvature between two smoothing levels, times the standard deviation",
         Range{0, 10});
    list("second-direction", second_direction,
         "minimum height of a further peak in the histogram of directions, as a share of the highest peak; each such peak gives "
         "another feature",
         Range{0.1, 1});
}

void MatchOptions::declare_options(OptionList& list) {
    list("ratio", ratio, "maximum ratio of the descriptor angles of the best and the second best match", Range{0, 1});
}

}  // namespace ostraka

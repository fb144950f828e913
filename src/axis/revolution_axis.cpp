// Axis of a surface of revolution with the intervals of its posterior.
#include "ostraka/axis/revolution_axis.h"

#include "axis/axis_methods.h"
#include "axis/revolution_posterior.h"
#include "axis/revolved_profile.h"
#include "axis/wall_rings.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/text.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

namespace ostraka {

using namespace detail;

namespace {

constexpr std::size_t max_vertices = 40000;

/// Keeps one vertex per small cube and octant of the normal.
WallVertices thinned(const WallVertices& all, double side) {
    std::map<std::array<int, 4>, std::size_t> kept;
    std::vector<std::size_t> index(all.points.size());
    WallVertices few;
    for (std::size_t i = 0; i < all.points.size(); ++i) {
        const Vector3d &p = all.points[i], &n = all.normals[i];
        const auto cube = [&](double x) { return static_cast<int>(std::floor(x / side)); };
        const int octant = (n.x() < 0 ? 1 : 0) + (n.y() < 0 ? 2 : 0) + (n.z() < 0 ? 4 : 0);
        const auto [place, added] = kept.emplace(std::array{cube(p.x()), cube(p.y()), cube(p.z()), octant}, few.points.size());
        index[i] = place->second;
        if (added) few.points.push_back(p), few.normals.push_back(n);
    }
    for (const auto& [a, b] : all.edges)
        if (index[a] != index[b]) few.edges.emplace_back(std::minmax(index[a], index[b]));
    std::sort(few.edges.begin(), few.edges.end());
    few.edges.erase(std::unique(few.edges.begin(), few.edges.end()), few.edges.end());
    return few;
}

/// Vertices of the faces in the part's frame, with normals averaged over `rounds` rings of neighbours.
WallVertices wall_vertices(const Mesh& mesh, const std::vector<Index>& faces, int rounds, const Vector3d& centre, double scale) {
    std::vector<Index> names;
    for (const Index f : faces)
        for (const Vertex v : corners(mesh, Face(f))) names.push_back(v.idx());
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    const auto index_of = [&](Vertex v) {
        return static_cast<std::size_t>(std::lower_bound(names.begin(), names.end(), v.idx()) - names.begin());
    };
    WallVertices wall;
    for (const Index name : names) wall.points.push_back((eigen(mesh.point(Vertex(name))) - centre) / scale);
    wall.normals.assign(names.size(), Vector3d::Zero());
    double area = 0;
    for (const Index f : faces) {
        const auto c = corners(mesh, Face(f));
        const std::array<std::size_t, 3> v{index_of(c[0]), index_of(c[1]), index_of(c[2])};
        const Vector3d n = (wall.points[v[1]] - wall.points[v[0]]).cross(wall.points[v[2]] - wall.points[v[0]]);
        area += n.norm() / 2;
        for (std::size_t k = 0; k < 3; ++k) {
            wall.normals[v.at(k)] += n;
            wall.edges.emplace_back(std::minmax(v.at(k), v.at((k + 1) % 3)));
        }
    }
    std::sort(wall.edges.begin(), wall.edges.end());
    wall.edges.erase(std::unique(wall.edges.begin(), wall.edges.end()), wall.edges.end());
    for (int round = 0; round <= rounds; ++round) {
        for (Vector3d& n : wall.normals)
            if (n.norm() > 0) n.normalize();
        if (round == rounds) break;
        std::vector<Vector3d> sums = wall.normals;
        for (const auto& [a, b] : wall.edges) sums[a] += wall.normals[b], sums[b] += wall.normals[a];
        wall.normals = std::move(sums);
    }
    return wall.points.size() > max_vertices ? thinned(wall, std::sqrt(area / (0.6 * double(max_vertices)))) : wall;
}

/// Adds lines in several directions on which the normals of the samples meet; returns the mean direction of the normals.
Vector3d add_lines(const std::vector<RoundSample>& samples, std::vector<SpaceLine>& lines) {
    Matrix3d moments = Matrix3d::Zero();
    for (const RoundSample& s : samples) moments += s.weight * s.n * s.n.transpose();
    const SymmetricEigen3 solver(moments);
    const Vector3d along = solver.eigenvectors().col(0), around = solver.eigenvectors().col(1),
                   out = solver.eigenvectors().col(2);
    std::vector<Vector3d> directions{along, around, along + around, along - around};
    for (const double tilt : {-0.7, 0.7}) directions.push_back(along + tilt * out);
    for (const Vector3d& direction : directions) {
        const AxisLine line = axis_along(samples, direction.normalized());
        if (line.point.allFinite()) lines.push_back({line.point, line.direction});
    }
    return out;
}

/// Lines from which the axis is improved: the axis of the search, and tilted lines on which the normals meet: all normals, and
/// those near the normal of the wall, without fractures at its sides.
std::vector<SpaceLine> starting_lines(const RotationSearch& search) {
    std::vector<SpaceLine> lines{{search.line.point, search.line.direction}};
    const Vector3d out = add_lines(search.samples, lines);
    std::vector<RoundSample> walls;
    for (const RoundSample& sample : search.samples)
        if (std::abs(sample.n.dot(out)) > 0.8) walls.push_back(sample);
    if (walls.size() < 40) return lines;
    add_lines(walls, lines);
    // Normals of a narrow sherd hardly show its curvature: lines at several distances on both sides of the wall too.
    const Vector3d along = lines[lines.size() - 6].direction;
    Vector3d middle = Vector3d::Zero();
    for (const RoundSample& sample : walls) middle += sample.p / double(walls.size());
    for (const double distance : {-2.5, -1.0, -0.4, 0.4, 1.0, 2.5}) lines.push_back({middle + distance * out, along});
    return lines;
}

DiameterEstimate estimate(const std::string& name, const RevolutionPosterior& posterior, const std::vector<double>& diameters,
                          double scale, bool round) {
    DiameterEstimate result{name, scale * posterior.quantile(diameters, 0.5), scale * posterior.quantile(diameters, 0.025),
                            scale * posterior.quantile(diameters, 0.975)};
    if (!std::isfinite(result.value)) {
        result.value = result.low;
        return result;
    }
    // Vessels deviate from roundness in more ways than the model has: of simulated sherds, the interval of the posterior alone
    // held the truth in too few draws.
    const double widening = round ? 1 : 1.3;
    result.low = std::max(0.0, result.value - widening * (result.value - result.low));
    result.high = result.value + widening * (result.high - result.value);
    return result;
}

/// Angle and distance of the sampled axes from the best axis.
struct AxisSpread {
    double angle = 0, distance = 0;  ///< within which 95 % of the axes lie: radians; shares of the diagonal
    double deviation = 0;            ///< root mean square angle, radians
};
AxisSpread spread_of(const RevolutionPosterior& posterior) {
    const SpaceLine best = posterior.model->line(posterior.best);
    const Vector3d foot = best.point - best.point.dot(best.direction) * best.direction;
    std::vector<double> angles, distances;
    AxisSpread spread;
    for (std::size_t k = 0; k < posterior.samples.size(); ++k) {
        const SpaceLine line = posterior.model->line(posterior.samples[k]);
        const double cosine = line.direction.dot(best.direction);
        angles.push_back(std::atan2(line.direction.cross(best.direction).norm(), std::abs(cosine)));
        const double run = (foot - line.point).dot(best.direction) / (std::abs(cosine) > 1e-6 ? cosine : 1e-6);
        distances.push_back((line.point + run * line.direction - foot).norm());
        spread.deviation += posterior.weights[k] * angles.back() * angles.back();
    }
    spread.deviation = std::sqrt(spread.deviation);
    spread.angle = posterior.quantile(angles, 0.95);
    spread.distance = posterior.quantile(distances, 0.95);
    return spread;
}

/// Root mean square noise of the used walls.
double noise_of(const RevolutionModel& model) {
    double sum = 0, count = 0;
    for (const WallSheet& sheet : model.sheets())
        if (sheet.used) sum += sheet.vertices * sheet.sigma * sheet.sigma, count += sheet.vertices;
    return count > 0 ? std::sqrt(sum / count) : 0;
}

void set_extent(Axis& axis, const Mesh& mesh, const std::vector<Index>& faces) {
    const Vector3d a = eigen(axis.direction), origin = eigen(axis.point);
    double low = 1e300, high = -1e300;
    for (const Index f : faces)
        for (const Vertex v : corners(mesh, Face(f))) {
            const double h = a.dot(eigen(mesh.point(v)) - origin);
            low = std::min(low, h), high = std::max(high, h);
        }
    axis.lines = {{point_of(origin + low * a), point_of(origin + high * a)}};
}

/// Why the posterior is not that of one axis; empty if it is. An axis in another direction may fit nearly as well: a narrow sherd
/// has two directions of curvature, and a rim is evidence of the axis that has it. A narrow sherd may also be as good as flat.
std::string reason_against(const RevolutionPosterior& posterior, const WallRing& ring) {
    constexpr double least_arc = 4 * degree;
    if (posterior.margin < (ring.rim ? 0.15 : 0.4))
        return "axes in several directions fit, and no rim shows which of them is right";
    if (posterior.model->arc() < least_arc) return "too little of its circumference is preserved: it is as good as flat";
    return {};
}

/// Sets the reason why the axis of the posterior is not determined, if it is not.
void judge(RevolutionAxis& result, const RevolutionPosterior& posterior, const AxisSpread& spread,
           const RevolutionAxisOptions& options) {
    constexpr double widest_angle = 30 * degree;
    constexpr double fewest_samples = 12;
    const DiameterEstimate& diameter = result.diameters.front();
    result.undetermined = !(diameter.high - diameter.low <= options.max_interval * diameter.value);
    if (result.undetermined && std::isfinite(diameter.high))
        result.axis.reason = fmt::format("the {} cannot be told: between {} and {}", diameter.name, digits(diameter.low, 3),
                                         digits(diameter.high, 3));
    else if (result.undetermined)
        result.axis.reason = fmt::format("the {} cannot be told: at least {}", diameter.name, digits(diameter.low, 3));
    else if (spread.angle > widest_angle)
        result.axis.reason = fmt::format("the direction is not determined: 95 % of the axes that fit lie within {} degrees",
                                         digits(spread.angle / degree, 2));
    else if (posterior.effective < fewest_samples)
        result.axis.reason = "several axes fit: too little of its circumference is preserved to distinguish them";
}

}  // namespace

RevolutionAxis revolution_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& axis_options,
                               const RevolutionAxisOptions& options) {
    check_options(options, "axis");
    const RotationSearch search = search_rotation(mesh, faces, axis_options);
    RevolutionAxis result;
    result.axis = search.axis;
    // Intervals are those of sherds: where most of the circle is there, the deviations of the object from a surface of revolution
    // count more than what an arc leaves open, and the model of an arc does not describe them.
    constexpr double widest_sherd = 50;
    const auto preserved = std::find_if(search.axis.figures.begin(), search.axis.figures.end(),
                                        [](const AxisFigure& figure) { return figure.name == "circle preserved"; });
    if (!search.determined || (preserved != search.axis.figures.end() && preserved->value > widest_sherd)) return result;
    const WallVertices vertices = wall_vertices(mesh, faces, axis_options.smoothing, search.centroid, search.scale);
    const RevolutionPosterior posterior =
        revolution_posterior(vertices, starting_lines(search), {.out_of_round = options.out_of_round, .seed = axis_options.seed});
    if (!posterior.model) return result;
    const WallRing ring = diameter_ring(posterior), widest = ring.rim ? widest_ring(posterior) : ring;
    // Without a lip, an axis of a sphere is determined by nothing but noise.
    if (search.sphere && !ring.rim) return result;
    if (std::string reason = reason_against(posterior, ring); !reason.empty()) {
        const double quality = result.axis.quality;
        result.axis = {};
        result.axis.quality = quality;
        result.axis.reason = std::move(reason);
        return result;
    }
    const AxisSpread spread = spread_of(posterior);
    const double scale = search.scale;
    const bool round = !(options.out_of_round > 0);
    const std::vector<double> diameters = ring_diameters(posterior, ring);
    if (ring.rim) result.diameters.push_back(estimate("rim diameter", posterior, diameters, scale, round));
    result.diameters.push_back(estimate("largest diameter", posterior, ring_diameters(posterior, widest), scale, round));
    Axis& axis = result.axis;
    axis = {};
    axis.quality = search.axis.quality;
    judge(result, posterior, spread, options);
    const double error = (posterior.quantile(diameters, 0.8413) - posterior.quantile(diameters, 0.1587)) / 2,
                 share = ring.rim ? ring.share : std::max(ring.share, posterior.model->arc() / (2 * pi));
    for (const DiameterEstimate& diameter : result.diameters) axis.figures.push_back({diameter.name, diameter.value, "length"});
    axis.figures.push_back({"circle preserved", 100 * std::min(1.0, share), "%"});
    axis.figures.push_back({"rms distance", noise_of(*posterior.model) * scale, "length"});
    axis.figures.push_back({"direction error", std::min(90.0, spread.deviation / degree), "degree"});
    axis.figures.push_back({"diameter error", (std::isfinite(error) ? error : 1e6) * scale, "length"});
    axis.figures.push_back({"direction within", spread.angle / degree, "degree"});
    axis.figures.push_back({"position within", spread.distance * scale, "length"});
    if (!axis.reason.empty()) return result;
    axis.found = true;
    const SpaceLine line = posterior.model->line(posterior.best);
    set_line(axis, search.centroid + scale * line.point, line.direction, search.centroid);
    set_extent(axis, mesh, faces);
    if (ring.rim) {
        const Vector3d along = ring.height < 0 ? -line.direction : line.direction;
        result.rim_direction = Vector(along.x(), along.y(), along.z());
    }
    return result;
}

void RevolutionAxisOptions::declare_options(OptionList& list) {
    list("out-of-round", out_of_round,
         "rotation: typical deviation of such vessels from roundness; 0 if they are perfectly round", Range{0, 0.2},
         "share of the radius");
    list("max-interval", max_interval, "rotation: widest 95 % interval of the diameter with which the axis counts as found",
         Range{0, 10}, "share of the diameter");
}

}  // namespace ostraka

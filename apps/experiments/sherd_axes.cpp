// Axis and rim diameter of single sherds: do the intervals contain the truth, and how large are the errors?
#include "harness.h"

#include "ostraka/axis/revolution_axis.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/stats/random.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace ostraka::experiments {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

struct SherdAxesOptions {
    std::string output = "experiments-output/sherd-axes";
    int draws = 40, first = 0;
    std::vector<double> arcs{10, 15, 25, 40, 60, 90}, noise{0.02, 0.05, 0.2}, out_of_round{0, 0.005};
    std::vector<std::string> profiles{"bowl", "jar", "cup"};
    double height = 50, step = 1, assumed = 0.005, max_interval = 0.1, roughness = 0.4;
    bool open = false, facets = false, smooth = false;
    void declare_options(OptionList& list) {
        list("output", output, "folder for tables").positional();
        list("draws", draws, "number of sherds of each kind", Range{1, 100000});
        list("first", first, "number of sherds to skip", Range{0, 1000000});
        list("arcs", arcs, "arcs, degrees");
        list("noise", noise, "standard deviations of the noise, mm");
        list("out-of-round", out_of_round, "amplitudes of the deviation from roundness, shares of the radius");
        list("profiles", profiles, "bowl, jar, cup");
        list("height", height, "height of a sherd below the rim, mm", Range{5, 1000});
        list("step", step, "distance of vertices, mm", Range{0.1, 100});
        list("assumed", assumed, "deviation from roundness assumed by the estimator, share of the radius", Range{0, 0.2});
        list("max-interval", max_interval, "widest interval that counts as determined, share of the diameter", Range{0, 1e6});
        list("roughness", roughness, "roughness of fracture surfaces, mm", Range{0, 10});
        list("open", open, "outer and inner side and rim only, without fracture surfaces");
        list("facets", facets, "with fracture surfaces that are known");
        list("smooth", smooth, "a rim without lip: the sherd has no rim");
    }
};

/// Outer side of a vessel: radius and height at a depth below the rim.
struct VesselProfile {
    double wall;
    Vector2d (*outside)(double depth);
};
VesselProfile profile_named(const std::string& name) {
    if (name == "bowl") return {7, [](double s) { return Vector2d(123 - 0.35 * s - 0.004 * s * s, -0.85 * s); }};
    if (name == "jar")
        return {6, [](double s) { return Vector2d(72 + 14 * std::exp(-s / 9) + 25 * (1 - std::exp(-s * s / 2025)), -s); }};
    if (name == "cup") return {4, [](double s) { return Vector2d(45 - 0.03 * s, -s); }};
    fail_usage("profile '" + name + "' is not known", "use bowl, jar or cup");
}

/// A closed profile, from the foot of the outer side over the lip to the foot of the inner side.
struct WallOutline {
    std::vector<Vector2d> points;
    double rim_radius = 0, widest = 0;
};
WallOutline outline_of(const VesselProfile& profile, const SherdAxesOptions& options) {
    WallOutline outline;
    std::vector<Vector2d> inner;
    for (double s = profile.wall / 2; s <= options.height; s += 0.05) {
        const Vector2d p = profile.outside(s), along = (profile.outside(s + 1e-3) - p).normalized();
        outline.points.push_back(p);
        inner.push_back(p + profile.wall * Vector2d(along.y(), -along.x()));
    }
    std::reverse(outline.points.begin(), outline.points.end());
    if (!options.smooth) {
        // A half circle from the outer to the inner side.
        const Vector2d middle = (outline.points.back() + inner.front()) / 2, out = outline.points.back() - middle,
                       up(-out.y(), out.x());
        for (int k = 1; k < 200; ++k) {
            const double angle = pi * k / 200;
            outline.points.emplace_back(middle + std::cos(angle) * out + std::sin(angle) * up);
        }
    }
    outline.points.insert(outline.points.end(), inner.begin(), inner.end());
    double top = -1e300;
    for (const Vector2d& p : outline.points) {
        if (p.y() > top) top = p.y(), outline.rim_radius = p.x();
        outline.widest = std::max(outline.widest, p.x());
    }
    return outline;
}

/// A sherd with a known axis.
struct KnownSherd {
    Mesh mesh;
    std::vector<Index> faces;  ///< of the walls, or all
    Vector3d direction, place;
    double rim = 0, widest = 0;
};

/// Points at equal distances along an outline, displaced at random along it.
std::vector<Vector2d> spaced_points(const WallOutline& outline, double step, Random& random, std::vector<Vector2d>& normals) {
    std::vector<double> length{0};
    for (std::size_t i = 1; i < outline.points.size(); ++i)
        length.push_back(length.back() + (outline.points[i] - outline.points[i - 1]).norm());
    const int count = std::max(12, static_cast<int>(length.back() / step));
    std::vector<Vector2d> points;
    for (int i = 0; i <= count; ++i) {
        const double shift = i == 0 || i == count ? 0 : random.uniform(-0.2, 0.2);
        const double at = std::min(length.back() * (i + shift) / count, length.back() * (1 - 1e-12));
        const auto k = static_cast<std::size_t>(std::upper_bound(length.begin(), length.end(), at) - length.begin() - 1);
        const Vector2d edge = outline.points[k + 1] - outline.points[k];
        points.emplace_back(outline.points[k] + (at - length[k]) / (length[k + 1] - length[k]) * edge);
        normals.emplace_back(Vector2d(edge.y(), -edge.x()).normalized());
    }
    return points;
}

KnownSherd make_sherd(const VesselProfile& profile, double arc, double noise, double out_of_round, std::uint64_t seed,
                      const SherdAxesOptions& options) {
    Random random(seed, 11);
    const WallOutline outline = outline_of(profile, options);
    KnownSherd sherd;
    sherd.rim = 2 * outline.rim_radius, sherd.widest = 2 * outline.widest;
    const int columns = std::max(4, static_cast<int>(arc * outline.rim_radius / options.step)) + 1;
    const double phase = random.uniform(0, 2 * pi);
    std::vector<Vector2d> normals;
    const std::vector<Vector2d> line = spaced_points(outline, options.step, random, normals);
    const auto n = static_cast<Index>(line.size());
    Motion motion;
    motion.rotation =
        Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal()).normalized().toRotationMatrix();
    motion.translation = 100 * Vector3d(random.normal(), random.normal(), random.normal());
    TriangleSoup soup;
    const auto add = [&](const Vector3d& p) {
        const Vector3d q = motion(p);
        soup.points.push_back({q.x(), q.y(), q.z()});
    };
    for (int j = 0; j < columns; ++j)
        for (std::size_t i = 0; i < line.size(); ++i) {
            const bool cut = j == 0 || j == columns - 1;
            double angle = arc * ((j + (cut ? 0 : random.uniform(-0.2, 0.2))) / (columns - 1) - 0.5);
            if (cut && !options.open) angle += options.roughness * random.normal() / outline.rim_radius;
            const Vector3d out(std::cos(angle), std::sin(angle), 0);
            const double radius = line[i].x() * (1 + out_of_round * std::cos(2 * angle + phase));
            add(radius * out + Vector3d(0, 0, line[i].y()) +
                noise * random.normal() * (normals[i].x() * out + Vector3d(0, 0, normals[i].y())));
        }
    const auto quad = [&](Index a, Index b, Index c, Index d) {
        soup.triangles.push_back({a, c, b});
        soup.triangles.push_back({b, c, d});
    };
    for (Index j = 0; j + 1 < static_cast<Index>(columns); ++j)
        for (Index i = 0; i + 1 < n; ++i) quad(j * n + i, j * n + i + 1, (j + 1) * n + i, (j + 1) * n + i + 1);
    const std::size_t walls = soup.triangles.size();
    if (!options.open) {
        // Fracture surfaces: the lower end, and both sides across the wall.
        for (Index j = 0; j + 1 < static_cast<Index>(columns); ++j) quad(j * n + n - 1, j * n, (j + 1) * n + n - 1, (j + 1) * n);
        const Index last = static_cast<Index>(columns - 1) * n;
        for (Index i = 0; 2 * i + 2 < n; ++i) {
            const Index a = i, b = i + 1, c = n - 1 - i, d = n - 2 - i;
            soup.triangles.push_back({a, b, c});
            soup.triangles.push_back({last + a, last + c, last + b});
            if (b == d) continue;
            soup.triangles.push_back({b, d, c});
            soup.triangles.push_back({last + b, last + c, last + d});
        }
    }
    sherd.mesh = build_mesh(soup);
    sherd.faces.resize(options.facets ? walls : soup.triangles.size());
    std::iota(sherd.faces.begin(), sherd.faces.end(), Index{0});
    sherd.direction = motion.rotation.col(2), sherd.place = motion.translation;
    return sherd;
}

/// Results of the sherds of one kind.
struct SherdScores {
    Hits axis, diameter, found, undetermined, none, rim;
    std::vector<double> angles, errors, widths;
    double seconds = 0;
};
double median_or_zero(const std::vector<double>& values) { return values.empty() ? 0 : upper_median(values); }

/// True diameter of the kind of the estimate.
double true_diameter(const KnownSherd& sherd, const DiameterEstimate& estimate) {
    return estimate.name == "rim diameter" ? sherd.rim : sherd.widest;
}

void score_sherd(const KnownSherd& sherd, const RevolutionAxis& result, SherdScores& scores) {
    const Axis& axis = result.axis;
    scores.found.add(axis.found), scores.undetermined.add(result.undetermined);
    scores.none.add(!axis.found && !result.undetermined);
    if (result.diameters.empty()) return;
    const DiameterEstimate& diameter = result.diameters.front();
    const double truth = true_diameter(sherd, diameter);
    scores.rim.add(diameter.name == "rim diameter");
    scores.diameter.add(truth >= diameter.low && truth <= diameter.high);
    scores.errors.push_back(std::abs(diameter.value - truth));
    scores.widths.push_back(diameter.high - diameter.low);
    if (!axis.found) return;
    scores.angles.push_back(std::acos(std::min(1.0, std::abs(eigen(axis.direction).dot(sherd.direction)))) / degree);
    scores.axis.add(scores.angles.back() <= axis.figure("direction within")->value);
}

void sherd_axes(const SherdAxesOptions& options) {
    Rows csv("profile,out_of_round,noise,arc,draw,found,kind,angle,within,diameter,low,high,truth,seconds");
    Table table(
        "profile | out of round % | noise mm | arc | found, cannot be told, none | rim found | axis in its interval | diameter "
        "in its "
        "interval | median error: degrees, mm | median width of the interval mm | s each");
    for (const std::string& name : options.profiles)
        for (const double out_of_round : options.out_of_round)
            for (const double noise : options.noise)
                for (const double arc : options.arcs) {
                    SherdScores scores;
                    for (int draw = options.first; draw < options.first + options.draws; ++draw) {
                        const KnownSherd sherd = make_sherd(profile_named(name), arc * degree, noise, out_of_round,
                                                            static_cast<std::uint64_t>(draw) + 1, options);
                        const RevolutionAxisOptions axis_options{options.assumed, options.max_interval};
                        const Stopwatch watch;
                        const RevolutionAxis result = revolution_axis(sherd.mesh, sherd.faces, {}, axis_options);
                        const double seconds = watch.seconds().processor;
                        scores.seconds += seconds;
                        score_sherd(sherd, result, scores);
                        if (result.diameters.empty()) continue;
                        const DiameterEstimate& diameter = result.diameters.front();
                        csv(name, out_of_round, noise, arc, draw, result.axis.found, diameter.name,
                            result.axis.found ? std::optional(scores.angles.back()) : std::nullopt,
                            result.axis.figure("direction within")->value, diameter.value, diameter.low, diameter.high,
                            true_diameter(sherd, diameter), seconds);
                    }
                    table.row("{} | {:g} | {:g} | {:g} | {}, {}, {} | {} | {} | {} | {:.2f}, {:.2f} | {:.2f} | {:.2f}", name,
                              100 * out_of_round, noise, arc, scores.found.hits, scores.undetermined.hits, scores.none.hits,
                              scores.rim.hits, scores.axis.text(), scores.diameter.text(), median_or_zero(scores.angles),
                              median_or_zero(scores.errors), median_or_zero(scores.widths), scores.seconds / options.draws);
                }
    csv.write(Path(options.output) / "sherd-axes.csv");
}

const Registration registered_sherd_axes("sherd-axes", "axis and rim diameter of single sherds, with intervals", sherd_axes);

}  // namespace
}  // namespace ostraka::experiments

// Axis and rim diameter of single sherds: do the intervals contain the truth, and how large are the errors?
#include "harness.h"

#include "ostraka/axis/revolution_axis.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/io/mesh_file.h"
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
    double height = 50, step = 1, assumed = 0.005, max_interval = 0.1, roughness = 0.4, waviness = 4;
    bool write = false, open = false, facets = false, smooth = false;
    void declare_options(OptionList& list) {
        list("output", output, "folder for tables").positional();
        list("draws", draws, "number of sherds of each kind", Range{1, 100000});
        list("first", first, "number of sherds to skip", Range{0, 1000000});
        list("arcs", arcs, "arcs, degrees");
        list("noise", noise, "standard deviations of the noise, mm");
        list("out-of-round", out_of_round, "amplitudes of the deviation from roundness, shares of the radius");
        list("profiles", profiles, "bowl, jar, cup, plate");
        list("height", height, "height of a sherd below the rim, mm", Range{5, 1000});
        list("step", step, "distance of vertices, mm", Range{0.1, 100});
        list("assumed", assumed, "deviation from roundness assumed by the estimator, share of the radius", Range{0, 0.2});
        list("max-interval", max_interval, "widest interval that counts as determined, share of the diameter", Range{0, 1e6});
        list("roughness", roughness, "roughness of fracture surfaces, mm", Range{0, 10});
        list("waviness", waviness, "how far fractures leave meridians and parallels, mm", Range{0, 100});
        list("write", write, "writes the first sherd of each kind to the folder");
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
    if (name == "plate") return {6, [](double s) { return Vector2d(140 - 0.9 * s - 0.002 * s * s, -0.6 * s); }};
    fail_usage("profile '" + name + "' is not known", "use bowl, jar, cup or plate");
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
        for (int k = 1; k < 4000; ++k) {
            const double angle = pi * k / 4000;
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

/// An irregular edge: displacement as a smooth function of a parameter from 0 to 1, at most about `size`.
class WavyEdge {
public:
    WavyEdge(Random& random, double size) {
        for (std::size_t k = 0; k < 4; ++k) {
            phase_.at(k) = random.uniform(0, 2 * pi);
            size_.at(k) = size * random.uniform(0.3, 1) / double(k + 1) / 2;
        }
    }
    [[nodiscard]] double at(double parameter) const {
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k) sum += size_.at(k) * std::sin(2.1 * double(k + 1) * parameter + phase_.at(k));
        return sum;
    }

private:
    std::array<double, 4> phase_{}, size_{};
};

/// Makes one sherd: both sides of the wall with the lip as a grid of columns, closed by fracture surfaces.
class SherdMaker {
public:
    SherdMaker(const VesselProfile& profile, double arc, double noise, double out_of_round, std::uint64_t seed,
               const SherdAxesOptions& options)
        : options_(options),
          outline_(outline_of(profile, options)),
          random_(seed, 11),
          arc_(arc),
          noise_(noise),
          out_of_round_(out_of_round),
          phase_(random_.uniform(0, 2 * pi)),
          across_(std::max(1, static_cast<int>(std::lround(profile.wall / options.step)) - 1)) {
        motion_.rotation = Eigen::Quaterniond(random_.normal(), random_.normal(), random_.normal(), random_.normal())
                               .normalized()
                               .toRotationMatrix();
        motion_.translation = 100 * Vector3d(random_.normal(), random_.normal(), random_.normal());
        for (std::size_t i = 0; i < outline_.points.size(); ++i)
            length_.push_back(i == 0 ? 0 : length_.back() + (outline_.points[i] - outline_.points[i - 1]).norm());
    }

    KnownSherd make() {
        add_walls();
        const std::size_t walls = soup_.triangles.size();
        if (!options_.open) add_breaks();
        KnownSherd sherd;
        sherd.rim = 2 * outline_.rim_radius, sherd.widest = 2 * outline_.widest;
        for (const Vector3d& p : points_) {
            const Vector3d q = motion_(p);
            soup_.points.push_back({q.x(), q.y(), q.z()});
        }
        sherd.mesh = build_mesh(soup_);
        sherd.faces.resize(options_.facets ? walls : soup_.triangles.size());
        std::iota(sherd.faces.begin(), sherd.faces.end(), Index{0});
        sherd.direction = motion_.rotation.col(2), sherd.place = motion_.translation;
        return sherd;
    }

private:
    /// Point and normal of the outline at an arc length.
    [[nodiscard]] std::pair<Vector2d, Vector2d> outline_at(double length) const {
        const double at = std::clamp(length, 0.0, length_.back() * (1 - 1e-12));
        const auto k = static_cast<std::size_t>(std::upper_bound(length_.begin(), length_.end(), at) - length_.begin() - 1);
        const Vector2d edge = outline_.points[k + 1] - outline_.points[k];
        return {outline_.points[k] + (at - length_[k]) / (length_[k + 1] - length_[k]) * edge,
                Vector2d(edge.y(), -edge.x()).normalized()};
    }
    void add_walls() {
        const double wave = options_.open ? 0 : options_.waviness;
        const WavyEdge left(random_, wave / outline_.rim_radius), right(random_, wave / outline_.rim_radius), foot(random_, wave);
        columns_ = static_cast<Index>(std::max(4, static_cast<int>(arc_ * outline_.rim_radius / options_.step)) + 1);
        rows_ = static_cast<Index>(std::max(12, static_cast<int>(length_.back() / options_.step)) + 1);
        for (Index j = 0; j < columns_; ++j)
            for (Index i = 0; i < rows_; ++i) {
                const double shift = i == 0 || i == rows_ - 1 ? 0 : random_.uniform(-0.2, 0.2),
                             row = (double(i) + shift) / (double(rows_) - 1);
                const bool cut = j == 0 || j == columns_ - 1;
                const double column = (double(j) + (cut ? 0 : random_.uniform(-0.2, 0.2))) / (double(columns_) - 1);
                // Both sides of the wall end at the same place.
                const double end = std::abs(wave) + foot.at(column), depth = std::abs(2 * row - 1);
                double angle = arc_ * (column - 0.5) + (1 - column) * left.at(depth) + column * right.at(depth);
                if (cut && !options_.open) angle += options_.roughness * random_.normal() / outline_.rim_radius;
                add_wall_point(angle, end + row * (length_.back() - 2 * end));
            }
        for (Index j = 0; j + 1 < columns_; ++j)
            for (Index i = 0; i + 1 < rows_; ++i) quad(at(j, i), at(j, i + 1), at(j + 1, i), at(j + 1, i + 1));
    }
    void add_wall_point(double angle, double length) {
        const auto [p, normal] = outline_at(length);
        const Vector3d out(std::cos(angle), std::sin(angle), 0);
        points_.emplace_back(p.x() * (1 + out_of_round_ * std::cos(2 * angle + phase_)) * out + Vector3d(0, 0, p.y()) +
                             noise_ * random_.normal() * (normal.x() * out + Vector3d(0, 0, normal.y())));
    }
    [[nodiscard]] Index at(Index column, Index row) const { return column * rows_ + row; }
    void quad(Index a, Index b, Index c, Index d) {
        soup_.triangles.push_back({a, c, b});
        soup_.triangles.push_back({b, c, d});
    }
    /// Points across the wall between two points, ends included, displaced along the normal of the fracture.
    std::vector<Index> rung(Index a, Index b, const Vector3d& normal) {
        std::vector<Index> line{a};
        const Vector3d p = points_[a], q = points_[b];
        for (int k = 1; k <= across_; ++k) {
            line.push_back(static_cast<Index>(points_.size()));
            points_.emplace_back(p + k / (across_ + 1.0) * (q - p) + options_.roughness * random_.normal() * normal);
        }
        line.push_back(b);
        return line;
    }
    /// Triangles between two rungs; `turned`: seen from the other side.
    void strip(const std::vector<Index>& a, const std::vector<Index>& b, bool turned) {
        for (std::size_t k = 0; k + 1 < a.size(); ++k)
            if (turned) quad(b[k], b[k + 1], a[k], a[k + 1]);
            else quad(a[k], a[k + 1], b[k], b[k + 1]);
    }
    void add_breaks() {
        // The fracture at the foot of both sides.
        std::vector<Index> last;
        for (Index j = 0; j < columns_; ++j) {
            const Index a = at(j, 0), b = at(j, rows_ - 1);
            const Vector3d along = (points_[at(j, 1)] - points_[a]).normalized();
            std::vector<Index> next = rung(b, a, along);
            if (j == 0) first_foot_ = next;
            else strip(last, next, false);
            last = std::move(next);
        }
        add_side(0, first_foot_, false);
        add_side(columns_ - 1, last, true);
    }
    /// A fracture across the wall at an end of the arc, from the foot to the lip.
    void add_side(Index column, std::vector<Index> last, bool turned) {
        std::reverse(last.begin(), last.end());
        Index i = 0;
        const Index next_column = column == 0 ? 1 : column - 1;
        const double wall = (points_[last.front()] - points_[last.back()]).norm();
        for (++i; 2 * i + 2 < rows_; ++i) {
            const Index a = at(column, i), b = at(column, rows_ - 1 - i);
            if ((points_[a] - points_[b]).norm() < 0.8 * wall) break;
            const Vector3d along = (points_[at(next_column, i)] - points_[a]).normalized();
            std::vector<Index> next = rung(a, b, along);
            strip(last, next, turned);
            last = std::move(next);
        }
        // The half round of the lip: from the last rung to the row of vertices over it.
        std::vector<Index> arch;
        for (Index k = i - 1; k <= rows_ - i; ++k) arch.push_back(at(column, k));
        std::size_t a = 0, b = 0;
        while (a + 1 < last.size() || b + 1 < arch.size()) {
            const bool step = b + 1 == arch.size() || (a + 1 < last.size() && a * arch.size() < b * last.size());
            const std::array<Index, 3> t =
                step ? std::array{last[a], last[a + 1], arch[b]} : std::array{last[a], arch[b + 1], arch[b]};
            step ? ++a : ++b;
            if (t[0] == t[1] || t[1] == t[2] || t[0] == t[2]) continue;
            if (turned) soup_.triangles.push_back({t[0], t[1], t[2]});
            else soup_.triangles.push_back({t[0], t[2], t[1]});
        }
    }

    const SherdAxesOptions& options_;
    WallOutline outline_;
    Random random_;
    double arc_, noise_, out_of_round_, phase_;
    int across_;
    Motion motion_;
    std::vector<double> length_;
    std::vector<Vector3d> points_;
    std::vector<Index> first_foot_;
    TriangleSoup soup_;
    Index columns_ = 0, rows_ = 0;
};

KnownSherd make_sherd(const VesselProfile& profile, double arc, double noise, double out_of_round, std::uint64_t seed,
                      const SherdAxesOptions& options) {
    return SherdMaker(profile, arc, noise, out_of_round, seed, options).make();
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
    make_folder(options.output);
    Rows csv("profile,out_of_round,noise,arc,draw,found,kind,angle,within,diameter,low,high,truth,seconds");
    Table table(
        "profile | out of round % | noise mm | arc | found, cannot be told, none | rim found | axis in its interval | diameter "
        "in its "
        "interval | median error: degrees, mm | median width of the interval mm | s each");
    std::uint64_t kind = 0;  // each kind has its own draws
    for (const std::string& name : options.profiles)
        for (const double out_of_round : options.out_of_round)
            for (const double noise : options.noise)
                for (const double arc : options.arcs) {
                    SherdScores scores;
                    ++kind;
                    for (int draw = options.first; draw < options.first + options.draws; ++draw) {
                        const KnownSherd sherd = make_sherd(profile_named(name), arc * degree, noise, out_of_round,
                                                            static_cast<std::uint64_t>(draw) + 1000000 * kind, options);
                        if (options.write && draw == options.first)
                            write_mesh(
                                Path(options.output) / fmt::format("{}-{:g}-{:g}-{:g}.ply", name, out_of_round, noise, arc),
                                sherd.mesh);
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

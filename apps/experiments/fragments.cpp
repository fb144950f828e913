// Fits fragments broken off deformed copies of a template: errors of pose, observed part and missing part.
#include "harness.h"
#include "scenes.h"

#include "ostraka/collection/statuette_annotations.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/reconstruction/template_cage.h"
#include "ostraka/shape_classes/shape_class.h"
#include "ostraka/stats/scores.h"
#include "ostraka/synthetic/fragments.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace ostraka::experiments {

namespace {

using Eigen::Vector3d;

struct ExperimentOptions {
    std::string output = "experiments-output/fragments", space = "mesh";
    std::vector<double> shares{0.1, 0.25, 0.5};
    int seeds = 4;
    std::uint64_t vertices = 12000;
    void declare_options(OptionList& list) {
        list("output", output, "folder for the table").positional();
        list("seeds", seeds, "number of fragments of each kind", Range{1, 1000});
        list("shares", shares, "sizes of fragments, as shares of the surface");
        list("vertices", vertices, "number of vertices of the template", Range{4000, 1000000});
        list("space", space, "space of the fit; with another than mesh no class is learnt", Choices{"mesh", "cage", "both"});
    }
};

struct VerdictOptions {
    std::string output = "experiments-output/fragments";
    std::uint64_t vertices = 12000, seed = 1;
    int pairs = 200;
    void declare_options(OptionList& list) {
        list("output", output, "folder for the table").positional();
        list("pairs", pairs, "number of pairs, half of them of one object", Range{4, 100000});
        list("vertices", vertices, "number of vertices of the template", Range{4000, 1000000});
        list("seed", seed, "random seed of members and fractures");
    }
};

/// A statuette with landmarks all over, and the canon: constant ratios of the heights of parts.
struct Canon {
    Subject statuette;
    RelationGraph graph;
};

Canon make_canon(std::uint64_t vertices) {
    StatuetteParameters parameters;
    parameters.wall = 0;
    parameters.vertices = vertices;
    Statuette made = generate_statuette(parameters);
    AnnotationSet set = annotate_statuette(made);
    Canon canon{{{std::move(made.mesh), std::move(set)}}, {}};
    auto& [mesh, annotations] = canon.statuette;
    constexpr Index landmarks = 60;
    for (Index i = 0; i < landmarks; ++i)
        annotations.annotations.push_back(
            landmark(free_id(annotations), "place " + std::to_string(i),
                     static_cast<Index>(static_cast<std::uint64_t>(i) * 7919U % mesh.number_of_vertices())));
    std::map<std::string, double> heights;
    const std::vector<std::string> parts{"head", "body", "hat"};
    for (const std::string& part : parts) heights[part] = add_height(mesh, *annotations.find(canon.statuette.id(part)), "height");
    for (const auto& [part, reference] : {std::pair("body", "head"), std::pair("hat", "head")}) {
        const double ratio = heights[part] / heights[reference];
        canon.graph.relationships.push_back(
            constraint(free_id(canon.graph), "proportion", {canon.statuette.id(part), canon.statuette.id(reference)},
                       fmt::format(R"({{"measure1": "height", "measure2": "height", "minValue": {:.9g}, "maxValue": {:.9g}}})",
                                   0.99 * ratio, 1.01 * ratio),
                       100));
    }
    return canon;
}

struct Case {
    std::string deformation, at;
    double share, noise, erosion;
};

/// The result of a fit: error of the pose, in degrees and as a share of the diagonal; root mean square errors of the observed
/// part, of the missing one, and of that with the template moved rigidly, as shares of the diagonal; largest constraint
/// violation, in per cent.
enum Quantity { angle, shift, observed, missing, rigid, before, after, crossings, seconds, quantities };
using Row = Eigen::Array<double, quantities, 1>;

/// Learns the class from twenty members: taller and shorter, wider and narrower, leaning forward or back.
ShapePrior learn_canon(const Canon& canon) {
    Random random(7);
    std::vector<Landmarks> members;
    const Mesh& mesh = canon.statuette.mesh;
    const double high = bounding_box(mesh).zmax();
    constexpr int count = 20;
    for (int i = 0; i < count; ++i) {
        const double tall = 1 + 0.1 * random.normal(), wide = 1 + 0.05 * random.normal(), lean = 0.08 * random.normal();
        const Mesh member = warped(mesh, [&](const Vector3d& p) {
            const double t = p.z() / high;
            return Vector3d(wide * p.x() + lean * high * t * t, wide * p.y(), tall * p.z());
        });
        members.push_back(landmarks_of(points_of(member)));
    }
    return prior_of(learn_modes(members, members.front()));
}

/// A piece of `whole` around a part, with its landmarks.
struct Broken {
    SyntheticFragment piece;
    Fragment fragment;
};

Broken make_fragment(const Canon& canon, const Mesh& whole, const std::string& name, const std::string& at,
                     const FragmentOptions& options) {
    const std::vector<Index>& faces = canon.statuette.part(at).faces;
    Vector3d centre = Vector3d::Zero();
    for (const Index f : faces) centre += eigen(centroid(whole, Face(f))) / static_cast<double>(faces.size());
    Broken broken{generate_fragment(whole, point_of(centre), options), {}};
    broken.fragment.name = name;
    broken.fragment.mesh = broken.piece.mesh;
    std::map<Index, Index> of_piece;
    for (Index i = 0; i < broken.piece.vertices.size(); ++i) of_piece.emplace(broken.piece.vertices[i], i);
    for (const Annotation& mark : canon.statuette.annotations.annotations)
        if (mark.type == AnnotationType::point && of_piece.contains(mark.points.front()))
            broken.fragment.annotations.annotations.push_back(landmark(mark.id, mark.tag, of_piece.at(mark.points.front())));
    return broken;
}

/// Nothing if the fragment is not placed.
std::optional<Row> run(const Canon& canon, const ShapePrior* prior, const TemplateCage* cage, const ReconstructOptions& how,
                       const Case& test, std::uint64_t seed) {
    const Mesh& mesh = canon.statuette.mesh;
    const double high = bounding_box(mesh).zmax(), strength = 1 + 0.25 * (static_cast<double>(seed % 4) - 1.5);
    const Mesh whole = warped(mesh, [&](Vector3d p) {
        const double t = p.z() / high;
        if (test.deformation == "stretch") p.z() *= 1 + 0.15 * strength;
        if (test.deformation == "squash") p.z() *= 1 - 0.12 * strength;
        if (test.deformation == "bend") p.x() += 0.12 * strength * high * t * t;
        return p;
    });
    const double diagonal = box_diagonal(whole);
    FragmentOptions options;
    options.share = test.share;
    options.noise = test.noise;
    options.erosion = test.erosion;
    options.seed = seed;
    const Broken broken = make_fragment(canon, whole, "fragment", test.at, options);
    std::vector<bool> seen(mesh.number_of_vertices(), false);
    for (const Index v : broken.piece.vertices) seen[v] = true;
    const Stopwatch watch;
    const Reconstruction result = reconstruct(canon.statuette, canon.graph, {&broken.fragment}, how, {}, prior, cage);
    Row row = Row::Zero();
    row[seconds] = watch.seconds().wall;
    if (!result.placement.any()) return {};
    row[crossings] = static_cast<double>(result.crossings);
    // The truth in the frame of the placed fragment.
    const Motion frame = result.placement.fragments[0].pose.after(broken.piece.pose.inverse());
    std::vector<Vector3d> truth, aligned;
    Vector3d mean = Vector3d::Zero();
    for (const Vertex v : mesh.vertices()) {
        truth.push_back(frame(eigen(whole.point(v))));
        aligned.push_back(result.placement.scale * eigen(mesh.point(v)));
        mean += truth.back() / static_cast<double>(mesh.number_of_vertices());
    }
    // Best rigid fit of the whole.
    const Motion best = fit_motion(truth, aligned);
    row[angle] = degrees_of(best);
    row[shift] = (best(mean) - mean).norm() / diagonal;
    const SurfaceSearch completed(result.object.mesh);
    for (const Vertex v : mesh.vertices()) {
        if (seen[v]) {
            const double d = completed.closest(point_of(truth[v])).distance;
            row[observed] += d * d;
        } else {
            row[missing] += (eigen(result.points[v]) - truth[v]).squaredNorm();
            row[rigid] += (aligned[v] - truth[v]).squaredNorm();
        }
    }
    const auto count_seen = static_cast<double>(std::count(seen.begin(), seen.end(), true)),
               count_missing = static_cast<double>(seen.size()) - count_seen;
    row[observed] = std::sqrt(row[observed] / count_seen) / diagonal;
    for (const Quantity q : {missing, rigid}) row[q] = std::sqrt(row[q] / count_missing) / diagonal;
    for (const ConstraintReport& report : result.constraints) {
        if (!report.before_values.empty()) row[before] = std::max(row[before], report.before_values.front());
        if (!report.deviations.empty()) row[after] = std::max(row[after], report.deviations.front().value.value_or(0));
    }
    return row;
}

/// The difference planted in a pair of fragments.
enum class Planted { nothing, size, proportion };

/// A member of the canon with random size and shape within the canon; with another canon its head is one and a half times as
/// tall.
Mesh make_member(const Canon& canon, Random& random, double size, bool other_canon) {
    const Mesh& mesh = canon.statuette.mesh;
    double brim = 0;
    for (const Index f : canon.statuette.part("head").faces)
        for (const Vertex v : corners(mesh, Face(f))) brim = std::max(brim, mesh.point(v).z());
    const double high = bounding_box(mesh).zmax(), wide = 1 + 0.04 * random.normal(), tall = 1 + 0.03 * random.normal(),
                 bend = 0.02 * random.normal();
    return warped(mesh, [&](Vector3d p) {
        if (other_canon) p.z() += 0.5 * std::max(p.z() - brim, 0.0);
        const double t = p.z() / high;
        return Vector3d(size * Vector3d(wide * p.x() + bend * high * t * t, wide * p.y(), tall * p.z()));
    });
}

/// Pairs of fragments of one object, of two sizes, or of another canon: verdicts on their compatibility, and the objections.
void verdicts(const VerdictOptions& options) {
    const Canon canon = make_canon(options.vertices);
    const int head_canon = canon.graph.relationships[1].id;  // hat against head
    Random random(options.seed);
    std::vector<bool> truth;       // whether both are of one object
    std::vector<double> evidence;  // negative strain
    ConfusionScores scores;        // positive: compatible
    Hits named;                    // planted mismatches named, of those rejected
    TextTable table({"pair", "planted", "verdict", "strain", "named first"});
    for (int pair = 0; pair < options.pairs; ++pair) {
        const Planted planted = pair % 2 == 0 ? Planted::nothing : pair % 4 == 1 ? Planted::size : Planted::proportion;
        const double size = std::exp(0.15 * random.normal());
        // Incompatible sizes differ by at least 15 per cent.
        const double factor = std::exp((random.uniform() < 0.5 ? -1 : 1) * (0.14 + 0.2 * random.uniform()));
        const Mesh first = make_member(canon, random, size, planted == Planted::proportion);
        const Mesh second = planted == Planted::size ? make_member(canon, random, size * factor, false) : first;
        FragmentOptions top_options;
        top_options.share = 0.3;
        top_options.noise = 0.001;
        top_options.seed = static_cast<std::uint64_t>(pair) + 1;
        FragmentOptions bottom_options = top_options;
        bottom_options.seed += 100000;
        const Broken top = make_fragment(canon, first, "top", "head", top_options),
                     bottom = make_fragment(canon, second, "bottom", "base", bottom_options);
        const Reconstruction result = reconstruct(canon.statuette, canon.graph, {&top.fragment, &bottom.fragment});
        const bool compatible = result.verdict == Compatibility::compatible;
        truth.push_back(planted == Planted::nothing);
        evidence.push_back(-result.strain);
        scores.add(compatible, truth.back());
        // Causes precede consequences: sizes before constraints, and of these the one with the largest violation.
        const Objection* worst = nullptr;
        for (const Objection& objection : result.objections)
            if (worst == nullptr || objection.kind < worst->kind ||
                (objection.kind == worst->kind && objection.strain > worst->strain))
                worst = &objection;
        if (!compatible && !truth.back())
            named.add(worst != nullptr &&
                      (planted == Planted::size ? worst->kind == ObjectionKind::size
                                                : worst->kind == ObjectionKind::constraint && worst->constraint == head_canon));
        const char* const names[] = {"nothing", "size", "proportion"};
        table.add({std::to_string(pair + 1), names[static_cast<int>(planted)], to_string(result.verdict),
                   fixed_cell(result.strain, 2),
                   worst == nullptr ? std::string("-") : to_string(worst->kind) + " " + std::to_string(worst->constraint)});
    }
    write_file(Path(options.output) / "verdicts.csv", table.csv());
    TextTable summary(
        {"pairs", "right", "precision", "recall", "F1 of compatible", "area under ROC", "rejected", "planted mismatch named"});
    summary.add({std::to_string(options.pairs), std::to_string(scores.true_positive + scores.true_negative),
                 fixed_cell(scores.precision(), 3), fixed_cell(scores.recall(), 3), fixed_cell(scores.f1(), 3),
                 fixed_cell(roc_curve(evidence, truth).area, 3), std::to_string(scores.false_negative + scores.true_negative),
                 named.text()});
    fmt::print("{}", summary.markdown());
}

/// Fits fragments of deformed copies of a synthetic template: errors of pose, observed and missing part, constraints.
void fragments(const ExperimentOptions& options) {
    const Canon canon = make_canon(options.vertices);
    ReconstructOptions how;
    set_option(how.fit, "space", options.space);
    const bool in_mesh = how.fit.space == NonRigidOptions::Space::mesh;
    const std::optional<ShapePrior> prior = in_mesh ? std::optional(learn_canon(canon)) : std::nullopt;
    const std::optional<TemplateCage> made = in_mesh ? std::nullopt : std::optional(generated_cage(canon.statuette.mesh));
    TextTable table({"deformation", "at", "share", "noise", "erosion", "placed", "angle", "shift", "observed", "missing", "rigid",
                     "missing/rigid", "missing with class", "with class/rigid", "constraint before", "after", "crossings",
                     "seconds"});
    for (const std::string deformation : {"none", "stretch", "squash", "bend"})
        for (const std::string at : {"head", "base"})
            for (const double share : options.shares)
                for (const double noise : {0.001, 0.005}) {
                    const Case test{deformation, at, share, noise, noise == 0.005 ? 0.01 : 0.0};
                    Row sum = Row::Zero();
                    double with_class = 0;
                    Hits placed;
                    for (int k = 1; k <= options.seeds; ++k) {
                        const auto seed = static_cast<std::uint64_t>(k);
                        const std::optional<Row> row = run(canon, nullptr, made ? &*made : nullptr, how, test, seed);
                        placed.add(row.has_value());
                        if (!row) continue;
                        sum += *row;
                        if (prior)
                            if (const auto other = run(canon, &*prior, nullptr, how, test, seed)) with_class += (*other)[missing];
                    }
                    const double n = std::max<double>(1, static_cast<double>(placed.hits));
                    const Row mean = sum / n;
                    table.add({deformation, at, percent_cell(share, 0), percent_cell(noise), percent_cell(test.erosion),
                               placed.text(), fixed_cell(mean[angle], 2), percent_cell(mean[shift], 2),
                               percent_cell(mean[observed], 3), percent_cell(mean[missing], 2), percent_cell(mean[rigid], 2),
                               fixed_cell(sum[missing] / sum[rigid], 2), prior ? percent_cell(with_class / n, 2) : "-",
                               prior ? fixed_cell(with_class / sum[rigid], 2) : "-", fixed_cell(mean[before], 2),
                               fixed_cell(mean[after], 2), fixed_cell(mean[crossings], 1), fixed_cell(mean[seconds], 2)});
                }
    fmt::print("{}", table.markdown());
    write_file(Path(options.output) / "fragments.csv", table.csv());
}

const Registration registered_fragments("fragments", "fragments of deformed copies of a template, fitted", fragments);
const Registration registered_verdicts("verdicts", "pairs of fragments that belong together, or do not", verdicts);

}  // namespace

}  // namespace ostraka::experiments

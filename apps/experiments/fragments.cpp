// Fits fragments broken off deformed copies of a template: errors of pose, observed part and missing part.
#include "harness.h"
#include "scenes.h"

#include "ostraka/collection/statuette_annotations.h"
#include "ostraka/figures/table.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/measure/measure.h"
#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/reconstruction/template_cage.h"
#include "ostraka/shape_classes/shape_class.h"
#include "ostraka/stats/scores.h"
#include "ostraka/synthetic/fragments.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>

namespace ostraka::experiments {

namespace {

using Eigen::Vector3d;

struct ExperimentOptions {
    std::string output = "experiments-output/fragments", space = "mesh";
    std::vector<double> shares{0.1, 0.25, 0.5};
    int seeds = 4;
    std::uint64_t vertices = 12000;
    void list_options(OptionList& list) {
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
    void list_options(OptionList& list) {
        list("output", output, "folder for the table").positional();
        list("pairs", pairs, "number of pairs, half of them of one object", Range{4, 100000});
        list("vertices", vertices, "number of vertices of the template", Range{4000, 1000000});
        list("seed", seed, "random seed of members and fractures");
    }
};

/// A statuette with landmarks all over, and the canon: constant ratios of the heights of parts.
struct Canon {
    Statuette statuette;
    AnnotationSet set;
    RelationGraph graph;
};

double add_height(const Mesh& mesh, Annotation& part) {
    Attribute height;
    height.id = static_cast<int>(part.attributes.size());
    height.name = "height";
    height.type = AttributeType::measure;
    height.measure.tool = "bounding";
    height.measure.direction = {0, 0, 1};
    height.measure.unit = "mm";
    for (const Index pin : extremes(mesh, part, *height.measure.direction)) height.measure.points.push_back(pin);
    height.measure.value = evaluate(mesh, part, height.measure);
    part.attributes.push_back(height);
    return *height.measure.value;
}

Canon make_canon(std::uint64_t vertices) {
    StatuetteParameters parameters;
    parameters.wall = 0;
    parameters.vertices = vertices;
    Canon canon{generate_statuette(parameters), {}, {}};
    canon.set = annotate_statuette(canon.statuette);
    const Mesh& mesh = canon.statuette.mesh;
    constexpr Index landmarks = 60;
    for (Index i = 0; i < landmarks; ++i)
        canon.set.annotations.push_back(
            landmark(free_id(canon.set), "place " + std::to_string(i),
                     static_cast<Index>(static_cast<std::uint64_t>(i) * 7919U % mesh.number_of_vertices())));
    std::map<std::string, double> heights;
    const std::vector<std::string> parts{"head", "body", "hat"};
    for (const std::string& part : parts) heights[part] = add_height(mesh, *canon.set.find(tagged(canon.set, part).id));
    for (const auto& [part, reference] : {std::pair("body", "head"), std::pair("hat", "head")}) {
        Relationship one;
        one.id = free_id(canon.graph);
        one.type = "proportion";
        one.annotations = {tagged(canon.set, part).id, tagged(canon.set, reference).id};
        one.is_constraint = true;
        const double ratio = heights[part] / heights[reference];
        one.weight = 100;
        one.constraint = fmt::format(R"({{"measure1": "height", "measure2": "height", "minValue": {:.9g}, "maxValue": {:.9g}}})",
                                     0.99 * ratio, 1.01 * ratio);
        canon.graph.relationships.push_back(std::move(one));
    }
    return canon;
}

struct Case {
    std::string deformation, at;
    double share, noise, erosion;
};

struct Row {
    bool placed = false;
    double angle = 0, shift = 0;                  ///< error of the pose, in degrees and as a share of the diagonal
    double observed = 0, missing = 0, rigid = 0;  ///< root mean square errors, as shares of the diagonal
    double before = 0, after = 0;                 ///< largest constraint violation, in per cent
    std::size_t crossings = 0;
    double seconds = 0;
};

/// Learns the class from twenty members: taller and shorter, wider and narrower, leaning forward or back.
ShapePrior learn_canon(const Canon& canon) {
    Random random(7);
    std::vector<Landmarks> members;
    const Mesh& mesh = canon.statuette.mesh;
    const double high = bounding_box(mesh).zmax();
    constexpr int count = 20;
    for (int i = 0; i < count; ++i) {
        const double tall = 1 + 0.1 * random.normal(), wide = 1 + 0.05 * random.normal(), lean = 0.08 * random.normal();
        Landmarks shape(static_cast<Eigen::Index>(mesh.number_of_vertices()), 3);
        for (const Vertex v : mesh.vertices()) {
            const Vector3d p = eigen(mesh.point(v));
            const double t = p.z() / high;
            shape.row(static_cast<Eigen::Index>(v)) =
                Eigen::RowVector3d(wide * p.x() + lean * high * t * t, wide * p.y(), tall * p.z());
        }
        members.push_back(std::move(shape));
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
    const std::vector<Index>& faces = tagged(canon.set, at).faces;
    Vector3d centre = Vector3d::Zero();
    for (const Index f : faces) centre += eigen(centroid(whole, Face(f))) / static_cast<double>(faces.size());
    Broken broken{generate_fragment(whole, point_of(centre), options), {}};
    broken.fragment.name = name;
    broken.fragment.mesh = broken.piece.mesh;
    std::map<Index, Index> of_piece;
    for (Index i = 0; i < broken.piece.vertices.size(); ++i) of_piece.emplace(broken.piece.vertices[i], i);
    for (const Annotation& one : canon.set.annotations)
        if (one.type == AnnotationType::point && of_piece.contains(one.points.front()))
            broken.fragment.annotations.annotations.push_back(landmark(one.id, one.tag, of_piece.at(one.points.front())));
    return broken;
}

Row run(const Canon& canon, const ShapePrior* prior, const TemplateCage* cage, const ReconstructOptions& how, const Case& what,
        std::uint64_t seed) {
    const Mesh& mesh = canon.statuette.mesh;
    const double high = bounding_box(mesh).zmax(), strength = 1 + 0.25 * (static_cast<double>(seed % 4) - 1.5);
    const Mesh whole = warped(mesh, [&](Vector3d p) {
        const double t = p.z() / high;
        if (what.deformation == "stretch") p.z() *= 1 + 0.15 * strength;
        if (what.deformation == "squash") p.z() *= 1 - 0.12 * strength;
        if (what.deformation == "bend") p.x() += 0.12 * strength * high * t * t;
        return p;
    });
    const double diagonal = box_diagonal(whole);
    FragmentOptions options;
    options.share = what.share;
    options.noise = what.noise;
    options.erosion = what.erosion;
    options.seed = seed;
    const Broken broken = make_fragment(canon, whole, "fragment", what.at, options);
    const SyntheticFragment& piece = broken.piece;
    std::vector<bool> seen(mesh.number_of_vertices(), false);
    for (const Index v : piece.vertices) seen[v] = true;
    const Stopwatch watch;
    const Reconstruction result = reconstruct({mesh, canon.set}, canon.graph, {&broken.fragment}, how, {}, prior, cage);
    Row row;
    row.seconds = watch.seconds().wall;
    row.placed = result.placement.any();
    if (!row.placed) return row;
    row.crossings = result.crossings;
    // The truth in the frame of the placed fragment.
    const Motion frame = result.placement.fragments[0].pose.after(piece.pose.inverse());
    std::vector<Vector3d> truth, aligned;
    for (const Vertex v : mesh.vertices()) {
        truth.push_back(frame(eigen(whole.point(v))));
        aligned.push_back(result.placement.scale * eigen(mesh.point(v)));
    }
    // Best rigid fit of the whole.
    const Motion best = fit_motion(truth, aligned);
    row.angle = degrees_of(best);
    Vector3d mean = Vector3d::Zero();
    for (const Vector3d& p : truth) mean += p / static_cast<double>(truth.size());
    row.shift = (best(mean) - mean).norm() / diagonal;
    const SurfaceSearch completed(result.object.mesh);
    double observed = 0, missing = 0, rigid = 0, count_seen = 0, count_missing = 0;
    for (const Vertex v : mesh.vertices()) {
        if (seen[v]) {
            const double d = completed.closest(point_of(truth[v])).distance;
            observed += d * d;
            ++count_seen;
        } else {
            missing += (eigen(result.points[v]) - truth[v]).squaredNorm();
            rigid += (aligned[v] - truth[v]).squaredNorm();
            ++count_missing;
        }
    }
    row.observed = std::sqrt(observed / count_seen) / diagonal;
    row.missing = std::sqrt(missing / count_missing) / diagonal;
    row.rigid = std::sqrt(rigid / count_missing) / diagonal;
    for (const ConstraintReport& one : result.constraints) {
        if (!one.before_values.empty()) row.before = std::max(row.before, one.before_values.front());
        if (!one.deviations.empty()) row.after = std::max(row.after, one.deviations.front().value.value_or(0));
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
    for (const Index f : tagged(canon.set, "head").faces)
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
    int right = 0, rejected = 0, called = 0, hit = 0, planted_named = 0, correctly_rejected = 0;
    TextTable table({"pair", "planted", "verdict", "strain", "named first"});
    for (int pair = 0; pair < options.pairs; ++pair) {
        const Planted planted = pair % 2 == 0 ? Planted::nothing : pair % 4 == 1 ? Planted::size : Planted::proportion;
        const double size = std::exp(0.15 * random.normal());
        // Incompatible sizes differ by at least 15 per cent.
        const double factor = std::exp((random.uniform() < 0.5 ? -1 : 1) * (0.14 + 0.2 * random.uniform()));
        const Mesh first = make_member(canon, random, size, planted == Planted::proportion);
        Mesh second = planted == Planted::size ? make_member(canon, random, size * factor, false) : first;
        const auto seed = static_cast<std::uint64_t>(pair) + 1;
        FragmentOptions options_top;
        options_top.share = 0.3;
        options_top.noise = 0.001;
        options_top.seed = seed;
        FragmentOptions options_bottom = options_top;
        options_bottom.seed = seed + 100000;
        const Broken top = make_fragment(canon, first, "top", "head", options_top),
                     bottom = make_fragment(canon, second, "bottom", "base", options_bottom);
        const Reconstruction result =
            reconstruct({canon.statuette.mesh, canon.set}, canon.graph, {&top.fragment, &bottom.fragment});
        const bool compatible = result.verdict == Compatibility::compatible;
        truth.push_back(planted == Planted::nothing);
        evidence.push_back(-result.strain);
        // Causes precede consequences: sizes before constraints, and of these the one with the largest violation.
        const Objection* worst = nullptr;
        for (const Objection& one : result.objections)
            if (worst == nullptr || one.kind < worst->kind || (one.kind == worst->kind && one.strain > worst->strain))
                worst = &one;
        called += compatible ? 1 : 0;
        hit += compatible && planted == Planted::nothing ? 1 : 0;
        right += compatible == (planted == Planted::nothing) ? 1 : 0;
        rejected += compatible ? 0 : 1;
        if (!compatible && planted != Planted::nothing) {
            ++correctly_rejected;
            planted_named += worst != nullptr && (planted == Planted::size ? worst->kind == ObjectionKind::size
                                                                           : worst->kind == ObjectionKind::constraint &&
                                                                                 worst->constraint == head_canon)
                                 ? 1
                                 : 0;
        }
        const char* const names[] = {"nothing", "size", "proportion"};
        table.add({std::to_string(pair + 1), names[static_cast<int>(planted)], to_string(result.verdict),
                   fixed_cell(result.strain, 2),
                   worst == nullptr ? std::string("-") : to_string(worst->kind) + " " + std::to_string(worst->constraint)});
    }
    write_file(Path(options.output) / "verdicts.csv", table.csv());
    const double positives = static_cast<double>(std::count(truth.begin(), truth.end(), true));
    const double precision = called > 0 ? static_cast<double>(hit) / called : 0, recall = hit / positives;
    TextTable summary(
        {"pairs", "right", "precision", "recall", "F1 of compatible", "area under ROC", "rejected", "planted mismatch named"});
    summary.add({std::to_string(options.pairs), std::to_string(right), fixed_cell(precision, 3), fixed_cell(recall, 3),
                 fixed_cell(precision + recall > 0 ? 2 * precision * recall / (precision + recall) : 0, 3),
                 fixed_cell(roc_curve(evidence, truth).area, 3), std::to_string(rejected),
                 fmt::format("{} of {}", planted_named, correctly_rejected)});
    std::cout << summary.markdown();
}

/// Fits fragments of deformed copies of a synthetic template: errors of pose, observed and missing part, constraints.
void fragments(const ExperimentOptions& options) {
    const Canon canon = make_canon(options.vertices);
    ReconstructOptions how;
    set_option(how.fit, "space", options.space);
    const bool in_mesh = how.fit.space == NonRigidOptions::Space::mesh;
    const std::optional<ShapePrior> prior = in_mesh ? std::optional(learn_canon(canon)) : std::nullopt;
    const std::optional<TemplateCage> made = in_mesh ? std::nullopt : std::optional(generated_cage(canon.statuette.mesh));
    const TemplateCage* cage = made ? &*made : nullptr;
    TextTable table({"deformation", "at", "share", "noise", "erosion", "placed", "angle", "shift", "observed", "missing", "rigid",
                     "missing/rigid", "missing with class", "with class/rigid", "constraint before", "after", "crossings",
                     "seconds"});
    for (const std::string deformation : {"none", "stretch", "squash", "bend"})
        for (const std::string at : {"head", "base"})
            for (const double share : options.shares)
                for (const double noise : {0.001, 0.005}) {
                    const Case what{deformation, at, share, noise, noise == 0.005 ? 0.01 : 0.0};
                    Row sum, with_class;
                    int placed = 0;
                    for (int seed = 1; seed <= options.seeds; ++seed) {
                        const Row row = run(canon, nullptr, cage, how, what, static_cast<std::uint64_t>(seed));
                        if (!row.placed) continue;
                        ++placed;
                        const Row other =
                            prior ? run(canon, &*prior, nullptr, how, what, static_cast<std::uint64_t>(seed)) : Row();
                        with_class.missing += other.missing;
                        with_class.rigid += other.rigid;
                        sum.angle += row.angle, sum.shift += row.shift, sum.observed += row.observed, sum.missing += row.missing;
                        sum.rigid += row.rigid, sum.before += row.before, sum.after += row.after, sum.crossings += row.crossings;
                        sum.seconds += row.seconds;
                    }
                    const double n = std::max(1, placed);
                    table.add({deformation, at, percent_cell(share, 0), percent_cell(noise), percent_cell(what.erosion),
                               fmt::format("{} of {}", placed, options.seeds), fixed_cell(sum.angle / n, 2),
                               percent_cell(sum.shift / n, 2), percent_cell(sum.observed / n, 3),
                               percent_cell(sum.missing / n, 2), percent_cell(sum.rigid / n, 2),
                               fixed_cell(sum.missing / sum.rigid, 2), prior ? percent_cell(with_class.missing / n, 2) : "-",
                               prior ? fixed_cell(with_class.missing / sum.rigid, 2) : "-", fixed_cell(sum.before / n, 2),
                               fixed_cell(sum.after / n, 2), fixed_cell(static_cast<double>(sum.crossings) / n, 1),
                               fixed_cell(sum.seconds / n, 2)});
                }
    std::cout << table.markdown();
    write_file(Path(options.output) / "fragments.csv", table.csv());
}

const Registration registered_fragments("fragments", "fragments of deformed copies of a template, fitted", fragments);
const Registration registered_verdicts("verdicts", "pairs of fragments that belong together, or do not", verdicts);

}  // namespace

}  // namespace ostraka::experiments

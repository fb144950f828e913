#include "ostraka/transfer/transfer.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/stopwatch.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/polyline_distance.h"
#include "ostraka/measure/measure.h"
#include "ostraka/transfer/moved_annotations.h"
#include "ostraka/transfer/project_curves.h"
#include "transfer/attribute_carrier.h"
#include "transfer/curve_partition.h"
#include "transfer/edge_transfer.h"
#include "transfer/scores.h"

#include <algorithm>
#include <optional>
#include <set>

namespace ostraka {

namespace {

void check_indices(AnnotatedMeshView source) {
    for (const Annotation& annotation : source.annotations.annotations) {
        const auto check = [&](Index v, std::size_t count, const char* what) {
            if (v >= count)
                fail_input("annotation " + std::to_string(annotation.id),
                           std::string("names ") + what + " " + std::to_string(v) + " of " + std::to_string(count),
                           "is it of another mesh?");
        };
        for (const Index v : annotation.points) check(v, source.mesh.number_of_vertices(), "vertex");
        for (const auto& line : annotation.polylines)
            for (const Index v : line) check(v, source.mesh.number_of_vertices(), "vertex");
        for (const Index f : annotation.faces) check(f, source.mesh.number_of_faces(), "face");
        for (const Attribute& attribute : annotation.attributes)
            for (const Index v : pins_of(attribute)) check(v, source.mesh.number_of_vertices(), "vertex");
    }
}

/// Which annotations are projected by their curves: free ones, all if requested, and regions that partition the surface, whose
/// partition only curves preserve without zigzags.
std::vector<bool> find_projected(AnnotatedMeshView source, const TransferOptions& options) {
    using Outlines = TransferOptions::Outlines;
    const bool along_edges = options.refine || options.cover != TransferOptions::Cover::overlapping;
    std::vector<const Annotation*> all;
    for (const Annotation& annotation : source.annotations.annotations) all.push_back(&annotation);
    const bool parted = options.outlines == Outlines::partitions && !along_edges && part_surface(source.mesh, all);
    std::vector<bool> projected;
    for (const Annotation& annotation : source.annotations.annotations)
        projected.push_back(
            !annotation.all && options.outlines != Outlines::edges &&
            (is_free(annotation) || options.outlines == Outlines::free || (parted && annotation.type == AnnotationType::region)));
    return projected;
}

MovedAnnotation moved_by_curves(const Annotation& from, ProjectedAnnotation projected) {
    MovedAnnotation moved{&from, std::move(projected.annotation), {}, true};
    TransferScore& score = moved.score;
    score.id = from.id;
    score.tag = from.tag;
    score.source_type = from.type;
    score.vertices = projected.places;
    score.by_ray = projected.by_ray;
    score.by_closest_point = projected.by_closest_point;
    score.without_place = projected.without_place;
    score.detours = projected.detours;
    score.crossings_resolved = projected.untangled;
    score.note = projected.note;
    if (projected.lost) score.outcome = TransferOutcome::lost;
    return moved;
}

/// One transfer: some annotations are projected by their curves, the others follow edges; correspondences, attributes, scores
/// and search trees are common.
class Transfer {
public:
    /// `projected`: for each annotation, whether it is projected by its curves.
    Transfer(AnnotatedMeshView source, const std::vector<bool>& projected, const SurfaceSearch& target,
             const TransferOptions& options)
        : source_(source),
          projected_(projected),
          search_(target),
          options_(options),
          tracer_(source.mesh, target, options),
          edges_({source.mesh, along_edges_}, target, options, tracer_) {}

    TransferResult run(TransferTimes times);

private:
    void match();
    [[nodiscard]] std::vector<ProjectedAnnotation> project() const;
    [[nodiscard]] std::vector<MovedAnnotation> in_order(std::vector<ProjectedAnnotation> projected);
    void score_all(std::vector<MovedAnnotation>& moved);
    [[nodiscard]] std::optional<OverlapQuestion> measure(MovedAnnotation& moved);

    const AnnotatedMeshView source_;
    const std::vector<bool>& projected_;
    const SurfaceSearch& search_;
    const TransferOptions& options_;
    AnnotationSet along_edges_ = without_projected();
    PathTracer tracer_;
    EdgeTransfer edges_;

    [[nodiscard]] AnnotationSet without_projected() const {
        AnnotationSet others;
        for (std::size_t i = 0; i < source_.annotations.annotations.size(); ++i)
            if (!projected_[i]) others.annotations.push_back(source_.annotations.annotations[i]);
        return others;
    }
};

TransferResult Transfer::run(TransferTimes times) {
    {
        const ScopedSeconds seconds(times.correspondence);
        match();
    }
    std::vector<ProjectedAnnotation> projected;
    {
        const ScopedSeconds seconds(times.paths);
        edges_.trace();
        projected = project();
    }
    {
        const ScopedSeconds seconds(times.regions);
        edges_.fill();
    }
    const Stopwatch watch;
    TransferResult result;
    AttributeCarrier attributes(tracer_, edges_.refined().has_value());
    std::vector<MovedAnnotation> moved = in_order(std::move(projected));
    for (MovedAnnotation& annotation : moved) attributes.carry(*annotation.from, annotation.to);
    score_all(moved);
    result.annotations.object_class = source_.annotations.object_class;
    result.annotations.unit = source_.annotations.unit;
    result.annotations.up = source_.annotations.up;
    for (MovedAnnotation& annotation : moved) {
        if (annotation.score.outcome != TransferOutcome::lost) result.annotations.annotations.push_back(std::move(annotation.to));
        result.scores.push_back(std::move(annotation.score));
    }
    refresh_measures(edges_.mesh(), result.annotations);
    attributes.keep_old_values(result.annotations);
    result.refined = std::move(edges_.refined());
    times.scores = watch.seconds();
    result.times = times;
    return result;
}

/// Finds the correspondences of the vertices of paths and of pins.
void Transfer::match() {
    std::vector<Index> vertices = edges_.vertices();
    for (const Annotation& annotation : source_.annotations.annotations)
        for (const Attribute& attribute : annotation.attributes) {
            const std::vector<Index> pins = pins_of(attribute);
            vertices.insert(vertices.end(), pins.begin(), pins.end());
        }
    tracer_.match(std::move(vertices));
}

std::vector<ProjectedAnnotation> Transfer::project() const {
    std::vector<const Annotation*> annotations;
    for (std::size_t i = 0; i < source_.annotations.annotations.size(); ++i)
        if (projected_[i]) annotations.push_back(&source_.annotations.annotations[i]);
    if (annotations.empty()) return {};
    return project_curves(source_.mesh, annotations, search_, options_.correspondence);
}

/// The results of both kinds in the order of the set.
std::vector<MovedAnnotation> Transfer::in_order(std::vector<ProjectedAnnotation> projected) {
    std::vector<MovedAnnotation> moved;
    auto next_projected = projected.begin();
    auto next_along_edges = edges_.moved().begin();
    for (std::size_t i = 0; i < source_.annotations.annotations.size(); ++i)
        moved.push_back(projected_[i] ? moved_by_curves(source_.annotations.annotations[i], std::move(*next_projected++))
                                      : std::move(*next_along_edges++));
    return moved;
}

void Transfer::score_all(std::vector<MovedAnnotation>& moved) {
    Progress progress("scores", moved.size());
    std::vector<std::optional<OverlapQuestion>> questions(moved.size());
    parallel_for(moved.size(), 1, [&](std::size_t i) {
        questions[i] = measure(moved[i]);
        progress.advance();
    });
    std::vector<OverlapQuestion> given;
    for (auto& question : questions)
        if (question) given.push_back(std::move(*question));
    if (!given.empty())
        score_overlaps({source_.mesh, edges_.regions().source_search()}, {edges_.mesh(), search_}, given,
                       options_.correspondence);
}

/// Computes all scores except the overlap, for which a query is returned if it is to be measured.
std::optional<OverlapQuestion> Transfer::measure(MovedAnnotation& moved) {
    const Annotation &from = *moved.from, &to = moved.to;
    TransferScore& score = moved.score;
    score.target_type = to.type;
    if (score.outcome == TransferOutcome::kept && !moved.by_curves && to.points.empty() && to.polylines.empty() &&
        to.faces.empty())
        score.outcome = TransferOutcome::lost;
    const Mesh& mesh = edges_.mesh();
    const Segments a = segments_of(source_.mesh, from), b = segments_of(mesh, to);
    score.source_length = length_of(a);
    score.target_length = length_of(b);
    if (a.empty() == b.empty()) score.hausdorff = hausdorff_distance(a, b);
    else if (score.outcome == TransferOutcome::kept && !moved.by_curves)
        add_note(score.note, b.empty() ? "its outline vanished" : "it got an outline");
    if (from.type != AnnotationType::region) {
        const std::set<Index> vertices(to.points.begin(), to.points.end());
        if (from.type == AnnotationType::point && !moved.by_curves && to.points.size() > vertices.size())
            add_note(score.note, "several points fell on one vertex");
        return {};
    }
    score.source_area = area_of(source_.mesh, from);
    score.target_area = area_of(mesh, to);
    if (!options_.overlap || score.outcome != TransferOutcome::kept) return {};
    if (from.all) {
        // If the meshes show the same object, the whole of one corresponds to the whole of the other.
        if (distortions(score).area < 0.05) {
            score.overlap = 1;
            score.wrong_side = 0;
        }
        return {};
    }
    OverlapQuestion question{region_area(source_.mesh, from), region_area(mesh, to), {}, &score};
    if (const auto region = question.target.free)
        question.in_target = [region](const SurfaceHit& hit) { return region->contains(hit.face, hit.point); };
    else question.in_target = edges_.regions().membership(to.faces);
    return question;
}

}  // namespace

TransferResult transfer(AnnotatedMeshView source, const SurfaceSearch& target, const TransferOptions& options) {
    const Stopwatch watch;
    check_options(options, "transfer");
    check_indices(source);
    const Agreement alignment = compare_alignment(source.mesh, target.mesh());
    if (!options.force && !alignment.problem.empty())
        fail_input("transfer", alignment.problem, "or --force if they are meant to differ");
    if (alignment.opposite) {
        TransferResult result = transfer(turned_over(source), target, options);
        result.turned_over = true;
        return result;
    }
    const bool needs_edges = options.refine || options.cover != TransferOptions::Cover::overlapping;
    if (options.refine && options.cover != TransferOptions::Cover::overlapping)
        fail_usage("a refined target follows the outline exactly", "leave out --cover with --refine");
    const std::vector<bool> projected = find_projected(source, options);
    if (needs_edges && std::find(projected.begin(), projected.end(), true) != projected.end())
        fail_usage("--refine and --cover are for outlines along edges", "leave them out, or give --outlines edges");
    AnnotationSet set = source.annotations;
    if (options.outlines == TransferOptions::Outlines::edges)
        for (Annotation& annotation : set.annotations) annotation.curves.clear();
    TransferTimes times;
    times.checks = watch.seconds();
    return Transfer({source.mesh, set}, projected, target, options).run(times);
}

std::string to_string(TransferOutcome outcome) {
    static constexpr const char* words[]{"kept", "became a line", "became a point", "lost"};
    return words[static_cast<std::size_t>(outcome)];
}

void TransferOptions::declare_options(OptionList& list) {
    correspondence.declare_options(list);
    list("metric", metric, "length that paths between corresponding vertices minimise",
         Choices{"euclidean", "segment", "combined"});
    list("spikes", spikes, "spikes of outlines: prune (remove), avoid (visit no vertex twice) or keep",
         Choices{"prune", "avoid", "keep"});
    list("outlines", outlines,
         "representation of outlines and lines on the target: as on the source, but free for regions that partition the surface, "
         "such as labels (partitions); as on the source (kept); curves through the triangles (free); paths of edges (edges)",
         Choices{"partitions", "kept", "free", "edges"});
    list("rounding", rounding,
         "assignment of faces that an outline crosses: by edge paths (path), to the side with most of the face's area (area), or "
         "so that the area and perimeter of the region are preserved as well (balanced)",
         Choices{"path", "area", "balanced"});
    list("cover", cover, "required relation of a transferred region to its source region: overlapping, enclosing or enclosed",
         Choices{"overlapping", "enclosing", "enclosed"});
    list("refine", refine, "insert vertices on the target mesh where outlines cross its edges, so that the outlines are exact",
         Anything{});
    list("overlap", overlap, "measure the overlap of each transferred region with its source region", Anything{});
    list("force", force, "transfer even if the two meshes differ in size or position", Anything{});
}

}  // namespace ostraka

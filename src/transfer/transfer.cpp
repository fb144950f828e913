#include "ostraka/transfer/transfer.h"

#include "attribute_carrier.h"
#include "curve_partition.h"
#include "disjoint_regions.h"
#include "free_transfer.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/polyline_distance.h"
#include "ostraka/measure/measure.h"
#include "outline_rounding.h"
#include "path_tracer.h"
#include "region_transfer.h"
#include "scores.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>

namespace ostraka {

namespace {

void add_note(std::string& note, const std::string& text) { note += (note.empty() ? "" : "; ") + text; }

void check_annotations(const Mesh& source, const AnnotationSet& set) {
    for (const Annotation& annotation : set.annotations) {
        const auto check = [&](Index v, std::size_t count, const char* what) {
            if (v >= count)
                fail_input("annotation " + std::to_string(annotation.id),
                           std::string("names ") + what + " " + std::to_string(v) + " of " + std::to_string(count),
                           "is it of another mesh?");
        };
        for (const Index v : annotation.points) check(v, source.number_of_vertices(), "vertex");
        for (const auto& line : annotation.polylines)
            for (const Index v : line) check(v, source.number_of_vertices(), "vertex");
        for (const Index f : annotation.faces) check(f, source.number_of_faces(), "face");
        for (const Attribute& attribute : annotation.attributes)
            for (const Index v : pins_of(attribute.measure)) check(v, source.number_of_vertices(), "vertex");
    }
}

/// State of one transfer: correspondences, paths and search trees are shared by its steps.
class Transfer {
public:
    Transfer(const Mesh& source, const AnnotationSet& set, const SurfaceSearch& target, const TransferOptions& options)
        : source_(source),
          set_(set),
          search_(target),
          target_(target.mesh()),
          options_(options),
          tracer_(source, target, options),
          regions_(source, set, target, options) {}

    TransferResult run(Clock& clock) {
        result_.times.checks = clock.lap();
        match();
        result_.times.correspondence = clock.lap();
        std::vector<Annotation> transferred(set_.annotations.size());
        result_.scores.resize(set_.annotations.size());
        for (std::size_t i = 0; i < set_.annotations.size(); ++i) begin(set_.annotations[i], transferred[i], result_.scores[i]);
        if (options_.refine) insert(transferred);
        else
            for (std::size_t i = 0; i < transferred.size(); ++i) trace(i, transferred[i]);
        result_.times.paths = clock.lap();
        const Mesh& mesh = on();
        std::optional<OutlineRounding> rounding;
        if (!options_.refine && options_.cover == TransferOptions::Cover::overlapping &&
            options_.rounding != TransferOptions::Rounding::path)
            rounding.emplace(source_, set_, target_, vertex_paths_, tracer_);
        fill_all(transferred, rounding ? &*rounding : nullptr);
        result_.times.regions = clock.lap();
        AttributeCarrier attributes(tracer_, result_.refined.has_value());
        for (std::size_t i = 0; i < transferred.size(); ++i) attributes.carry(set_.annotations[i], transferred[i]);
        score_all(transferred);
        result_.times.scores = clock.lap();
        result_.annotations.object_class = set_.object_class;
        result_.annotations.unit = set_.unit;
        result_.annotations.up = set_.up;
        for (std::size_t i = 0; i < transferred.size(); ++i)
            if (result_.scores[i].outcome != TransferOutcome::lost)
                result_.annotations.annotations.push_back(std::move(transferred[i]));
        refresh_measures(mesh, result_.annotations);
        attributes.keep_old_values(result_.annotations);
        return std::move(result_);
    }

private:
    const Mesh& on() const { return result_.refined ? result_.refined->mesh : target_; }

    void match() {
        std::vector<Index> vertices;
        vertex_paths_.resize(set_.annotations.size());
        for (std::size_t i = 0; i < set_.annotations.size(); ++i) {
            const Annotation& annotation = set_.annotations[i];
            for (const auto& line : annotation.polylines) {
                SourcePath vertex_path;
                vertex_path.vertices = line;
                vertex_path.closed = line.size() > 2 && line.front() == line.back();
                if (vertex_path.closed) vertex_path.vertices.pop_back();
                vertex_paths_[i].push_back(std::move(vertex_path));
            }
            if (annotation.type == AnnotationType::region && !annotation.all)
                vertex_paths_[i] = region_paths(source_, annotation.faces);
            for (const SourcePath& vertex_path : vertex_paths_[i])
                vertices.insert(vertices.end(), vertex_path.vertices.begin(), vertex_path.vertices.end());
            vertices.insert(vertices.end(), annotation.points.begin(), annotation.points.end());
            for (const Attribute& attribute : annotation.attributes) {
                const std::vector<Index> pins = pins_of(attribute.measure);
                vertices.insert(vertices.end(), pins.begin(), pins.end());
            }
        }
        tracer_.match(std::move(vertices));
    }

    void begin(const Annotation& from, Annotation& to, TransferScore& score) {
        to.id = score.id = from.id;
        to.tag = score.tag = from.tag;
        to.colour = from.colour;
        to.type = score.source_type = from.type;
        to.all = from.all;
        to.note = from.note;
        to.information = from.information;
        std::set<Index> vertices(from.points.begin(), from.points.end());
        for (const SourcePath& vertex_path : vertex_paths_[index_of(score)])
            vertices.insert(vertex_path.vertices.begin(), vertex_path.vertices.end());
        score.vertices = vertices.size();
        for (const Index v : vertices) {
            const Correspondence& place = tracer_.place(v);
            if (place.kind == CorrespondenceKind::ray) ++score.by_ray;
            else if (place.kind == CorrespondenceKind::closest) ++score.by_closest_point;
            else ++score.without_place;
        }
    }

    std::size_t index_of(const TransferScore& score) const { return static_cast<std::size_t>(&score - result_.scores.data()); }

    void trace(std::size_t i, Annotation& to) {
        const Annotation& from = set_.annotations[i];
        if (from.type == AnnotationType::point) {
            for (const Index v : from.points)
                if (const Index w = tracer_.place(v).vertex; w != no_index) to.points.push_back(w);
            return;
        }
        traced_.resize(vertex_paths_.size());
        for (const SourcePath& vertex_path : vertex_paths_[i]) {
            traced_[i].push_back(tracer_.trace_edges(vertex_path, result_.scores[i]));
            if (from.type == AnnotationType::line) add_line(traced_[i].back(), to);
        }
    }

    static void add_line(const TracedPath& vertex_path, Annotation& to) {
        std::vector<Index> line = vertex_path.path;
        if (line.empty()) line = diameter_path(vertex_path.walk);
        else if (vertex_path.closed) line.push_back(line.front());
        if (line.size() >= 2) to.polylines.push_back(std::move(line));
    }

    /// Inserts the curves of all annotations as edges at once, then reads the paths from the refined mesh.
    void insert(std::vector<Annotation>& transferred) {
        std::vector<std::vector<std::vector<PathTracer::Step>>> steps(vertex_paths_.size());
        for (std::size_t i = 0; i < vertex_paths_.size(); ++i)
            for (const SourcePath& vertex_path : vertex_paths_[i])
                steps[i].push_back(tracer_.trace_curves(vertex_path, result_.scores[i]));
        std::vector<SurfaceCurve> curves = tracer_.curves();
        // Points become vertices as well: curves of a single node.
        std::map<Index, std::size_t> point_curve;
        for (const Annotation& annotation : set_.annotations)
            for (const Index v : annotation.points) {
                const Correspondence& place = tracer_.place(v);
                if (place.vertex == no_index || point_curve.count(v) > 0) continue;
                point_curve[v] = curves.size();
                SurfaceCurve curve;
                curve.points.push_back(surface_point(target_, place.place.face, place.place.barycentric));
                curves.push_back(std::move(curve));
            }
        result_.refined = insert_curves(target_, curves);
        const InsertedCurves& refined = *result_.refined;
        PathSearch paths(refined.mesh);
        traced_.resize(vertex_paths_.size());
        for (std::size_t i = 0; i < vertex_paths_.size(); ++i) {
            const Annotation& from = set_.annotations[i];
            for (const Index v : from.points)
                if (const auto found = point_curve.find(v); found != point_curve.end())
                    transferred[i].points.push_back(refined.node_vertex[found->second].front());
            for (std::size_t c = 0; c < vertex_paths_[i].size(); ++c) {
                TracedPath vertex_path;
                vertex_path.closed = vertex_paths_[i][c].closed;
                const auto to_vertex = [&](Index v) {
                    if (vertex_path.walk.empty()) {
                        vertex_path.walk.push_back(v);
                        return;
                    }
                    const Index last = vertex_path.walk.back();
                    if (last == v) return;
                    if (find_halfedge(refined.mesh, Vertex(last), Vertex(v)) != Mesh::null_halfedge()) {
                        vertex_path.walk.push_back(v);
                        return;
                    }
                    const std::vector<Index> way = paths.find(Vertex(last), Vertex(v), {});
                    if (!way.empty()) vertex_path.walk.insert(vertex_path.walk.end(), way.begin() + 1, way.end());
                };
                for (const PathTracer::Step& step : steps[i][c]) {
                    const auto& nodes = refined.node_vertex[step.curve];
                    if (step.backwards)
                        for (auto v = nodes.rbegin(); v != nodes.rend(); ++v) to_vertex(*v);
                    else
                        for (const Index v : nodes) to_vertex(v);
                }
                if (vertex_path.walk.empty() && !vertex_paths_[i][c].vertices.empty()) {
                    const Correspondence& place = tracer_.place(vertex_paths_[i][c].vertices.front());
                    if (place.vertex != no_index) vertex_path.walk.push_back(place.vertex);
                }
                if (vertex_path.closed && vertex_path.walk.size() > 1 && vertex_path.walk.front() == vertex_path.walk.back())
                    vertex_path.walk.pop_back();
                vertex_path.path = prune_spikes(vertex_path.walk, vertex_path.closed);
                traced_[i].push_back(vertex_path);
                if (from.type == AnnotationType::line) add_line(vertex_path, transferred[i]);
            }
        }
    }

    /// Calls body(i) for each annotation in parallel, largest first for a balanced load.
    template <class Body>
    void for_each_annotation(const Body& body) const {
        std::vector<std::size_t> order(set_.annotations.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
            return set_.annotations[i].faces.size() > set_.annotations[j].faces.size();
        });
        parallel_for(
            order.size(), [&](std::size_t k) { body(order[k]); }, 1);
    }

    void fill_all(std::vector<Annotation>& transferred, OutlineRounding* rounding) {
        regions_.set_outlines(traced_, on(), result_.refined ? &result_.refined->face_origin : nullptr);
        std::vector<FilledRegion> filled(transferred.size());
        for_each_annotation([&](std::size_t i) {
            if (set_.annotations[i].type == AnnotationType::region && !set_.annotations[i].all)
                filled[i] = regions_.fill(i, result_.scores[i]);
        });
        for (std::size_t i = 0; i < transferred.size(); ++i)
            if (result_.scores[i].voted) filled[i].selected = regions_.vote(i);
        for_each_annotation([&](std::size_t i) {
            if (filled[i].selected.empty()) return;
            if (options_.cover != TransferOptions::Cover::overlapping)
                regions_.cover(filled[i].selected, vertex_paths_[i], result_.scores[i]);
            else if (rounding != nullptr && !result_.scores[i].voted && filled[i].area > 0)
                rounding->round(i, filled[i], regions_.target_edge(), options_.rounding == TransferOptions::Rounding::balanced);
        });
        if (rounding != nullptr) rounding->round_shared_outlines(filled);
        std::vector<std::vector<bool>> selected;
        for (FilledRegion& region : filled) selected.push_back(std::move(region.selected));
        if (options_.cover == TransferOptions::Cover::overlapping)
            keep_disjoint(
                source_, set_, [&]() -> const SurfaceSearch& { return regions_.source_search(); }, on(), selected);
        for_each_annotation([&](std::size_t i) {
            if (set_.annotations[i].type == AnnotationType::region) finish(i, transferred[i], selected[i]);
            if (set_.annotations[i].type == AnnotationType::line) finish_line(i, transferred[i]);
        });
    }

    /// A line shorter than the target's edges becomes a point.
    void finish_line(std::size_t i, Annotation& to) {
        if (!to.polylines.empty()) return;
        for (const TracedPath& vertex_path : traced_[i])
            if (!vertex_path.walk.empty()) to.points.push_back(vertex_path.walk.front());
        if (to.points.empty()) return;
        to.type = AnnotationType::point;
        result_.scores[i].outcome = TransferOutcome::became_point;
        add_note(to.note, "was a line, too short for this mesh");
    }

    /// Stores the faces of a region or, if there are none, the line or point that it is reduced to.
    void finish(std::size_t i, Annotation& to, const std::vector<bool>& selected) {
        TransferScore& score = result_.scores[i];
        if (set_.annotations[i].all) {
            for (Index f = 0; f < on().number_of_faces(); ++f) to.faces.push_back(f);
            return;
        }
        to.faces = flagged(selected);
        if (!to.faces.empty()) return;
        // Only the traced outlines are left: the longest path represents the region.
        std::vector<Index> line;
        for (const TracedPath& vertex_path : traced_[i])
            if (std::vector<Index> path = diameter_path(vertex_path.walk); path.size() > line.size()) line = std::move(path);
        if (line.size() >= 2) {
            to.type = AnnotationType::line;
            to.polylines = {line};
            score.outcome = TransferOutcome::became_line;
        } else if (line.size() == 1) {
            to.type = AnnotationType::point;
            to.points = line;
            score.outcome = TransferOutcome::became_point;
        } else {
            score.outcome = TransferOutcome::lost;
        }
        if (score.outcome != TransferOutcome::lost) add_note(to.note, "was a region, too small for this mesh");
    }

    void score_all(const std::vector<Annotation>& transferred);
    std::optional<OverlapQuestion> score(const Annotation& from, const Annotation& to, TransferScore& score);

    const Mesh& source_;
    const AnnotationSet& set_;
    const SurfaceSearch& search_;
    const Mesh& target_;
    const TransferOptions& options_;
    PathTracer tracer_;
    RegionTransfer regions_;
    std::vector<std::vector<SourcePath>> vertex_paths_;
    std::vector<std::vector<TracedPath>> traced_;
    TransferResult result_;
};

void Transfer::score_all(const std::vector<Annotation>& transferred) {
    Progress progress("scores", transferred.size());
    std::vector<std::optional<OverlapQuestion>> asked(transferred.size());
    for_each_annotation([&](std::size_t i) {
        asked[i] = score(set_.annotations[i], transferred[i], result_.scores[i]);
        progress.advance();
    });
    std::vector<OverlapQuestion> questions;
    for (auto& question : asked)
        if (question) questions.push_back(std::move(*question));
    if (!questions.empty())
        score_overlaps({source_, regions_.source_search()}, {on(), search_}, questions, options_.correspondence);
}

/// Computes all scores except the overlap, for which a query is returned if it is to be measured.
std::optional<OverlapQuestion> Transfer::score(const Annotation& from, const Annotation& to, TransferScore& score) {
    score.target_type = to.type;
    if (score.outcome == TransferOutcome::kept && to.points.empty() && to.polylines.empty() && to.faces.empty())
        score.outcome = TransferOutcome::lost;
    const Segments a = segments_of(source_, from), b = segments_of(on(), to);
    score.source_length = length_of(a);
    score.target_length = length_of(b);
    if (a.empty() == b.empty()) score.hausdorff = hausdorff_distance(a, b);
    else if (score.outcome == TransferOutcome::kept)
        add_note(score.note, b.empty() ? "its outline vanished" : "it got an outline");
    if (from.type != AnnotationType::region) {
        if (from.type == AnnotationType::point && to.points.size() > std::set<Index>(to.points.begin(), to.points.end()).size())
            add_note(score.note, "several points fell on one vertex");
        return {};
    }
    score.source_area = area_of(source_, from.faces);
    score.target_area = area_of(on(), to.faces);
    if (!options_.overlap || to.faces.empty()) return {};
    if (from.all) {
        // If the meshes show the same object, the whole of one corresponds to the whole of the other.
        if (distortions(score).area < 0.05) {
            score.overlap = 1;
            score.wrong_side = 0;
        }
        return {};
    }
    OverlapQuestion question{region_area(source_, from), region_area(on(), to), {}, &score};
    question.in_target = regions_.membership(to.faces);
    return question;
}

}  // namespace

namespace {

/// Which annotations are projected by their curves: free ones, all if requested, and regions that partition the surface, whose
/// partition only curves preserve without zigzags.
std::vector<bool> laid_by_curves(const Mesh& source, const AnnotationSet& set, const TransferOptions& options) {
    using Outlines = TransferOptions::Outlines;
    const bool along_edges = options.refine || options.cover != TransferOptions::Cover::overlapping;
    std::vector<const Annotation*> all;
    for (const Annotation& annotation : set.annotations) all.push_back(&annotation);
    const bool parted = options.outlines == Outlines::partitions && !along_edges && part_surface(source, all);
    std::vector<bool> free;
    for (const Annotation& annotation : set.annotations)
        free.push_back(
            !annotation.all && options.outlines != Outlines::edges &&
            (is_free(annotation) || options.outlines == Outlines::free || (parted && annotation.type == AnnotationType::region)));
    return free;
}

}  // namespace

TransferResult transfer(const Mesh& source, const AnnotationSet& annotations, const SurfaceSearch& target,
                        const TransferOptions& options) {
    Clock clock;
    check_options(options, "transfer");
    check_annotations(source, annotations);
    if (!options.force) {
        const Agreement alignment = compare_alignment(source, target.mesh());
        if (!alignment.problem.empty()) fail_input("transfer", alignment.problem, "or --force if they are meant to differ");
    }
    if (options.refine && options.cover != TransferOptions::Cover::overlapping)
        fail_usage("a refined target follows the outline exactly", "leave out --cover with --refine");
    const std::vector<bool> free = laid_by_curves(source, annotations, options);
    AnnotationSet along_edges = annotations;
    for (Annotation& annotation : along_edges.annotations)
        if (options.outlines == TransferOptions::Outlines::edges) annotation.curves.clear();
    if (std::none_of(free.begin(), free.end(), [](bool b) { return b; }))
        return Transfer(source, along_edges, target, options).run(clock);
    if (options.refine || options.cover != TransferOptions::Cover::overlapping)
        fail_usage("--refine and --cover are for outlines along edges", "leave them out, or give --outlines edges");
    std::size_t i = 0;
    std::erase_if(along_edges.annotations, [&](const Annotation&) { return free[i++]; });
    TransferResult result = Transfer(source, along_edges, target, options).run(clock);
    transfer_free(source, annotations, free, target, options, clock, result);
    return result;
}

std::string to_string(TransferOutcome outcome) {
    static constexpr const char* words[]{"kept", "became a line", "became a point", "lost"};
    return words[static_cast<std::size_t>(outcome)];
}

void TransferOptions::describe(OptionList& visit) {
    correspondence.describe(visit);
    visit("metric", metric, "what paths between corresponding vertices minimise", Choices{"euclidean", "segment", "combined"});
    visit("spikes", spikes, "prune spikes of an outline, avoid used vertices while tracing it, or keep them",
          Choices{"prune", "avoid", "keep"});
    visit("outlines", outlines,
          "outlines and lines stay what they are, but regions that part the whole surface, such as labels, become free, through "
          "the "
          "triangles of the target (partitions); all stay what they are (kept); all become free; or all run along the target's "
          "edges",
          Choices{"partitions", "kept", "free", "edges"});
    visit("rounding", rounding,
          "faces that the true outline crosses: as the edge paths leave them (path), to the side that holds most of them "
          "(area), or so that area and perimeter are met as well (balanced)",
          Choices{"path", "area", "balanced"});
    visit("cover", cover, "the transferred region overlaps the source region, encloses it or is enclosed by it",
          Choices{"overlapping", "enclosing", "enclosed"});
    visit("refine", refine, "insert vertices on the target so that outlines are exact", Anything{});
    visit("overlap", overlap, "measure the overlap with the source region", Anything{});
    visit("force", force, "continue although the meshes differ in size or position", Anything{});
}

}  // namespace ostraka

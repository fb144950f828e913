#include "transfer/edge_transfer.h"

#include "ostraka/annotation/outline.h"
#include "ostraka/execution/parallel.h"
#include "transfer/disjoint_regions.h"
#include "transfer/outline_rounding.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace ostraka {

void add_note(std::string& note, const std::string& text) { note += (note.empty() ? "" : "; ") + text; }

namespace {

std::vector<SourcePath> paths_of(const Mesh& mesh, const Annotation& annotation) {
    std::vector<SourcePath> paths;
    if (annotation.type == AnnotationType::region && !annotation.all) {
        for (OutlinePath& path : outline_paths(mesh, annotation.faces))
            paths.push_back({std::move(path.vertices), path.closed, !path.closed});
        return paths;
    }
    for (const auto& line : annotation.polylines) {
        SourcePath& path = paths.emplace_back();
        path.vertices = line;
        path.closed = line.size() > 2 && line.front() == line.back();
        if (path.closed) path.vertices.pop_back();
    }
    return paths;
}

void add_line(const TracedPath& vertex_path, Annotation& to) {
    std::vector<Index> line = vertex_path.path;
    if (line.empty()) line = diameter_path(vertex_path.walk);
    else if (vertex_path.closed) line.push_back(line.front());
    if (line.size() >= 2) to.polylines.push_back(std::move(line));
}

}  // namespace

EdgeTransfer::EdgeTransfer(AnnotatedMeshView source, const SurfaceSearch& target, const TransferOptions& options,
                           PathTracer& tracer)
    : source_(source),
      search_(target),
      target_(target.mesh()),
      options_(options),
      tracer_(tracer),
      regions_(source, target, options),
      traced_(source.annotations.annotations.size()) {
    for (const Annotation& annotation : source.annotations.annotations) {
        vertex_paths_.push_back(paths_of(source.mesh, annotation));
        moved_.push_back({&annotation, {}, {}, false});
    }
}

std::vector<Index> EdgeTransfer::vertices() const {
    std::vector<Index> vertices;
    for (std::size_t i = 0; i < vertex_paths_.size(); ++i) {
        for (const SourcePath& vertex_path : vertex_paths_[i])
            vertices.insert(vertices.end(), vertex_path.vertices.begin(), vertex_path.vertices.end());
        const std::vector<Index>& points = source_.annotations.annotations[i].points;
        vertices.insert(vertices.end(), points.begin(), points.end());
    }
    return vertices;
}

void EdgeTransfer::trace() {
    for (std::size_t i = 0; i < moved_.size(); ++i) begin(i);
    if (options_.refine) return insert();
    for (std::size_t i = 0; i < moved_.size(); ++i) trace(i);
}

void EdgeTransfer::begin(std::size_t i) {
    const Annotation& from = source_.annotations.annotations[i];
    Annotation& to = moved_[i].to;
    TransferScore& score = moved_[i].score;
    to.id = score.id = from.id;
    to.tag = score.tag = from.tag;
    to.colour = from.colour;
    to.type = score.source_type = from.type;
    to.all = from.all;
    to.note = from.note;
    to.information = from.information;
    std::set<Index> vertices(from.points.begin(), from.points.end());
    for (const SourcePath& vertex_path : vertex_paths_[i])
        vertices.insert(vertex_path.vertices.begin(), vertex_path.vertices.end());
    score.vertices = vertices.size();
    for (const Index v : vertices) {
        const CorrespondenceKind kind = tracer_.place(v).kind;
        if (kind == CorrespondenceKind::ray) ++score.by_ray;
        else if (kind == CorrespondenceKind::closest) ++score.by_closest_point;
        else ++score.without_place;
    }
}

void EdgeTransfer::trace(std::size_t i) {
    const Annotation* from = moved_[i].from;
    Annotation& to = moved_[i].to;
    TransferScore& score = moved_[i].score;
    if (from->type == AnnotationType::point) {
        for (const Index v : from->points)
            if (const Index w = tracer_.place(v).vertex; w != no_index) to.points.push_back(w);
        return;
    }
    for (const SourcePath& vertex_path : vertex_paths_[i]) {
        traced_[i].push_back(tracer_.trace_edges(vertex_path, score));
        if (from->type == AnnotationType::line) add_line(traced_[i].back(), to);
    }
}

/// Inserts the curves of all annotations as edges at once, then reads the paths from the refined mesh.
void EdgeTransfer::insert() {
    std::vector<std::vector<std::vector<PathTracer::Step>>> steps(vertex_paths_.size());
    for (std::size_t i = 0; i < vertex_paths_.size(); ++i)
        for (const SourcePath& vertex_path : vertex_paths_[i])
            steps[i].push_back(tracer_.trace_curves(vertex_path, moved_[i].score));
    std::vector<SurfaceCurve> curves = tracer_.curves();
    // Points become vertices as well: curves of a single point.
    std::map<Index, std::size_t> point_curve;
    for (const Annotation& annotation : source_.annotations.annotations)
        for (const Index v : annotation.points) {
            const Correspondence& place = tracer_.place(v);
            if (place.vertex == no_index || point_curve.count(v) > 0) continue;
            point_curve[v] = curves.size();
            SurfaceCurve curve;
            curve.points.push_back(surface_point(target_, place.place.face, place.place.barycentric));
            curves.push_back(std::move(curve));
        }
    refined_ = insert_curves(target_, curves);
    PathSearch paths(refined_->mesh);
    for (std::size_t i = 0; i < vertex_paths_.size(); ++i) {
        const Annotation* from = moved_[i].from;
        Annotation& to = moved_[i].to;
        for (const Index v : from->points)
            if (const auto found = point_curve.find(v); found != point_curve.end())
                to.points.push_back(refined_->node_vertex[found->second].front());
        for (std::size_t c = 0; c < vertex_paths_[i].size(); ++c) {
            traced_[i].push_back(walked(vertex_paths_[i][c], steps[i][c], paths));
            if (from->type == AnnotationType::line) add_line(traced_[i].back(), to);
        }
    }
}

/// The walk along the inserted curves of a path.
TracedPath EdgeTransfer::walked(const SourcePath& vertex_path, const std::vector<PathTracer::Step>& steps,
                                PathSearch& paths) const {
    TracedPath traced;
    traced.closed = vertex_path.closed;
    std::vector<Index>& walk = traced.walk;
    const auto go_to = [&](Index v) {
        if (walk.empty()) return walk.push_back(v);
        if (walk.back() == v) return;
        if (find_halfedge(refined_->mesh, Vertex(walk.back()), Vertex(v)) != Mesh::null_halfedge()) return walk.push_back(v);
        const std::vector<Index> way = paths.find(Vertex(walk.back()), Vertex(v), {});
        if (!way.empty()) walk.insert(walk.end(), way.begin() + 1, way.end());
    };
    for (const PathTracer::Step& step : steps) {
        std::vector<Index> vertices = refined_->node_vertex[step.curve];
        if (step.backwards) std::reverse(vertices.begin(), vertices.end());
        for (const Index v : vertices) go_to(v);
    }
    if (walk.empty() && !vertex_path.vertices.empty())
        if (const Index v = tracer_.place(vertex_path.vertices.front()).vertex; v != no_index) walk.push_back(v);
    if (traced.closed && walk.size() > 1 && walk.front() == walk.back()) walk.pop_back();
    traced.path = prune_spikes(walk, traced.closed);
    return traced;
}

/// Calls body(i) for each annotation in parallel, largest first for a balanced load.
template <class Body>
void EdgeTransfer::for_each_annotation(const Body& body) const {
    std::vector<std::size_t> order(source_.annotations.annotations.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
        return source_.annotations.annotations[i].faces.size() > source_.annotations.annotations[j].faces.size();
    });
    parallel_for(order.size(), 1, [&](std::size_t k) { body(order[k]); });
}

void EdgeTransfer::fill() {
    const bool overlapping = options_.cover == TransferOptions::Cover::overlapping;
    std::optional<OutlineRounding> rounding;
    if (!options_.refine && overlapping && options_.rounding != TransferOptions::Rounding::path)
        rounding.emplace(source_, target_, vertex_paths_, tracer_);
    regions_.set_outlines(traced_, mesh(), refined_ ? &refined_->face_origin : nullptr);
    std::vector<FilledRegion> filled(moved_.size());
    for_each_annotation([&](std::size_t i) {
        if (source_.annotations.annotations[i].type == AnnotationType::region && !source_.annotations.annotations[i].all)
            filled[i] = regions_.fill(i, moved_[i].score);
    });
    for (std::size_t i = 0; i < moved_.size(); ++i)
        if (moved_[i].score.voted) filled[i].selected = regions_.vote(i);
    for_each_annotation([&](std::size_t i) {
        if (filled[i].selected.empty()) return;
        if (!overlapping) regions_.cover(filled[i].selected, vertex_paths_[i], moved_[i].score);
        else if (rounding && !moved_[i].score.voted && filled[i].area > 0)
            rounding->round(i, filled[i], regions_.target_edge(), options_.rounding == TransferOptions::Rounding::balanced);
    });
    if (rounding) rounding->round_shared_outlines(filled);
    std::vector<std::vector<bool>> selected;
    for (FilledRegion& region : filled) selected.push_back(std::move(region.selected));
    if (overlapping)
        keep_disjoint(
            source_, [&]() -> const SurfaceSearch& { return regions_.source_search(); }, mesh(), selected);
    for_each_annotation([&](std::size_t i) {
        if (source_.annotations.annotations[i].type == AnnotationType::region) finish_region(i, selected[i]);
        if (source_.annotations.annotations[i].type == AnnotationType::line) finish_line(i);
    });
}

/// A line shorter than the target's edges becomes a point.
void EdgeTransfer::finish_line(std::size_t i) {
    Annotation& to = moved_[i].to;
    TransferScore& score = moved_[i].score;
    if (!to.polylines.empty()) return;
    for (const TracedPath& vertex_path : traced_[i])
        if (!vertex_path.walk.empty()) to.points.push_back(vertex_path.walk.front());
    if (to.points.empty()) return;
    to.type = AnnotationType::point;
    score.outcome = TransferOutcome::became_point;
    add_note(to.note, "was a line, too short for this mesh");
}

/// Stores the faces of a region or, if there are none, the line or point that it is reduced to.
void EdgeTransfer::finish_region(std::size_t i, const std::vector<bool>& selected) {
    const Annotation* from = moved_[i].from;
    Annotation& to = moved_[i].to;
    TransferScore& score = moved_[i].score;
    if (from->all) {
        for (Index f = 0; f < mesh().number_of_faces(); ++f) to.faces.push_back(f);
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

}  // namespace ostraka

#include "ostraka/transfer/project_curves.h"

#include "ostraka/annotation/curve_strands.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/distance.h"
#include "ostraka/geom/geodesic.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/mesh/limits.h"
#include "transfer/curve_loops.h"
#include "transfer/curve_partition.h"
#include "transfer/curve_thinning.h"
#include "transfer/place_mapping.h"
#include "transfer/region_settling.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace ostraka {

namespace {

using Places = std::vector<SurfacePoint>;

/// A strand of the source and its projection. Curves that share a strand on the source share it on the target.
struct ProjectedStrand {
    CurveStrand from;
    bool bounds_region = false;
    bool first_at_border = false, last_at_border = false;  ///< ends of an outline that ends at the border of the mesh
    Places places;                                         ///< on the target
    std::size_t count = 0, by_ray = 0, by_closest_point = 0, without_place = 0, detours = 0;
};

class CurveProjector {
public:
    CurveProjector(const Mesh& source, const SurfaceSearch& target, const CorrespondenceOptions& options)
        : source_(source),
          search_(target),
          target_(target.mesh()),
          settling_(source, target, options),
          mapping_(source, target, options),
          edge_(mapping_.edge()) {}

    std::vector<ProjectedAnnotation> run(const std::vector<const Annotation*>& annotations) {
        std::vector<ProjectedAnnotation> projected(annotations.size());
        std::vector<std::vector<Places>> drawn(annotations.size());
        for (std::size_t i = 0; i < annotations.size(); ++i)
            if (!annotations[i]->all) drawn[i] = places_of(*annotations[i]);
        for (auto& curves : drawn)
            for (Places& curve : curves) curve = divided(curve);
        map_all(drawn);
        const auto uses = find_strands(annotations, drawn);
        for (ProjectedStrand& strand : strands_) project(strand);
        for (std::size_t i = 0; i < annotations.size(); ++i) {
            begin(*annotations[i], projected[i]);
            for (std::size_t c = 0; c < drawn[i].size(); ++c) {
                Places on_target = drawn[i][c].size() == 1 ? project_point(drawn[i][c].front(), projected[i])
                                                           : put_together(uses[i][c], projected[i]);
                const bool region = annotations[i]->type == AnnotationType::region;
                const bool closes = drawn[i][c].front() == drawn[i][c].back();
                if (region && closes && (on_target.size() < 4 || on_target.front() != on_target.back())) continue;
                if (on_target.size() >= (annotations[i]->type == AnnotationType::point ? 1U : 2U))
                    projected[i].annotation.curves.push_back(std::move(on_target));
            }
        }
        thin_out(target_, 1e-4 * edge_, projected);
        parallel_for(projected.size(), 1,
                     [&](std::size_t i) { settling_.settle(*annotations[i], drawn[i].size(), projected[i]); });
        keep_partition(source_, annotations, target_, projected);
        for (std::size_t i = 0; i < annotations.size(); ++i) note_change(*annotations[i], drawn[i].size(), projected[i]);
        return projected;
    }

private:
    // Curves of the source.

    std::vector<Places> places_of(const Annotation& annotation) const {
        if (is_free(annotation)) {
            curves_on(source_, annotation);  // throws if the curves do not fit
            return annotation.curves;
        }
        std::vector<Places> curves;
        for (const Index v : annotation.points) curves.push_back(vertex_curve({v}));
        for (const auto& line : annotation.polylines) curves.push_back(vertex_curve(line));
        if (annotation.type == AnnotationType::region)
            for (const OutlinePath& path : outline_paths(source_, annotation.faces))
                curves.push_back(vertex_curve(path.vertices, path.closed));
        return curves;
    }

    /// Subdivides segments longer than an edge of the target. Curves of both adjacent regions get the same places.
    Places divided(const Places& curve) const {
        Places places;
        for (std::size_t i = 0; i < curve.size(); ++i) {
            if (i > 0) {
                const double length = distance(position(source_, curve[i - 1]), position(source_, curve[i]));
                const int parts = std::clamp(static_cast<int>(std::ceil(length / edge_)), 1, 1000);
                for (int k = 1; k < parts; ++k) places.push_back(between(curve[i - 1], curve[i], k, parts));
            }
            places.push_back(curve[i]);
        }
        return places;
    }

    /// Point k of `parts` on the way from a to b, computed from the smaller place on.
    SurfacePoint between(const SurfacePoint& a, const SurfacePoint& b, int k, int parts) const {
        if (b < a) return between(b, a, parts - k, parts);
        const Index face = shared_face(source_, a, b);
        const auto u = in_face(source_, a, face), v = in_face(source_, b, face);
        const double t = static_cast<double>(k) / parts;
        std::array<double, 3> weights{};
        for (std::size_t c = 0; c < 3; ++c) weights[c] = (1 - t) * u[c] + t * v[c];
        return stored_point(source_, surface_point(source_, face, weights, 1e-9));
    }

    // Places.

    void map_all(const std::vector<std::vector<Places>>& drawn) {
        std::vector<SurfacePoint> all;
        for (const auto& curves : drawn)
            for (const Places& curve : curves) all.insert(all.end(), curve.begin(), curve.end());
        std::sort(all.begin(), all.end());
        all.erase(std::unique(all.begin(), all.end()), all.end());
        std::vector<MappedPlace> found(all.size());
        parallel_for(all.size(), 64, [&](std::size_t i) { found[i] = mapping_(all[i]); });
        for (std::size_t i = 0; i < all.size(); ++i) mapped_.emplace_hint(mapped_.end(), all[i], found[i]);
    }

    const MappedPlace& at(const SurfacePoint& place) {
        const auto [entry, fresh] = mapped_.try_emplace(place);
        if (fresh) entry->second = mapping_(place);
        return entry->second;
    }

    // Traces.

    /// Finds the strands of all curves; returns, for each annotation and curve, its sequence of strands.
    std::vector<std::vector<std::vector<StrandUse>>> find_strands(const std::vector<const Annotation*>& annotations,
                                                                  const std::vector<std::vector<Places>>& drawn) {
        std::vector<CurveStrand> found;
        auto uses = separate_nonmanifold(source_, drawn, std::vector<bool>(drawn.size(), true), found);
        for (CurveStrand& strand : found) strands_.emplace_back().from = std::move(strand);
        for (std::size_t i = 0; i < drawn.size(); ++i)
            for (std::size_t c = 0; c < drawn[i].size(); ++c) {
                const Places& curve = drawn[i][c];
                if (annotations[i]->type != AnnotationType::region || uses[i][c].empty()) continue;
                for (const StrandUse& use : uses[i][c]) strands_[use.strand].bounds_region = true;
                if (curve.front() == curve.back()) continue;
                const StrandUse first = uses[i][c].front(), last = uses[i][c].back();
                (first.backwards ? strands_[first.strand].last_at_border : strands_[first.strand].first_at_border) = true;
                (last.backwards ? strands_[last.strand].first_at_border : strands_[last.strand].last_at_border) = true;
            }
        return uses;
    }

    /// Computes the places of a strand on the target, including those where the traces between them cross edges.
    void project(ProjectedStrand& strand) {
        check_cancelled();
        const Places& from = strand.from.places;
        const std::vector<std::size_t> good = trusted(strand);
        if (good.empty()) return;
        Places places{stored_point(target_, at(from[good.front()]).to)};
        for (std::size_t k = 0; k + 1 < good.size(); ++k) append(from[good[k]], from[good[k + 1]], strand.detours, places);
        if (strand.from.closed && good.front() != 0) append(from[good.back()], from[good.front()], strand.detours, places);
        if (strand.last_at_border) lead_to_border(places);
        if (strand.first_at_border) {
            std::reverse(places.begin(), places.end());
            lead_to_border(places);
            std::reverse(places.begin(), places.end());
        }
        strand.places =
            strand.bounds_region ? without_small_loops(target_, std::move(places), edge_, strand.from.closed) : std::move(places);
    }

    Places project_point(const SurfacePoint& place, ProjectedAnnotation& projected) {
        const MappedPlace& one = at(place);
        ++projected.places;
        if (one.kind == CorrespondenceKind::none) {
            ++projected.without_place;
            return {};
        }
        ++(one.kind == CorrespondenceKind::ray ? projected.by_ray : projected.by_closest_point);
        return {stored_point(target_, one.to)};
    }

    /// Joins the strands of a curve. Gaps left by strands that vanished or lost their ends are bridged.
    Places put_together(const std::vector<StrandUse>& uses, ProjectedAnnotation& projected) {
        Places places;
        for (const StrandUse& use : uses) {
            const ProjectedStrand& strand = strands_[use.strand];
            projected.places += strand.count;
            projected.by_ray += strand.by_ray;
            projected.by_closest_point += strand.by_closest_point;
            projected.without_place += strand.without_place;
            projected.detours += strand.detours;
            Places part = strand.places;
            if (use.backwards) std::reverse(part.begin(), part.end());
            if (part.empty()) continue;
            if (!places.empty() && places.back() != part.front()) bridge(part.front(), projected, places);
            for (const SurfacePoint& place : part)
                if (places.empty() || places.back() != place) places.push_back(place);
        }
        if (uses.empty()) return places;
        const SurfacePoint &first = strand_end(uses.front(), true), &last = strand_end(uses.back(), false);
        if (first == last && places.size() > 2 && places.front() != places.back()) bridge(places.front(), projected, places);
        return places;
    }

    const SurfacePoint& strand_end(const StrandUse& use, bool first) const {
        const Places& places = strands_[use.strand].from.places;
        return first != use.backwards ? places.front() : places.back();
    }

    void bridge(SurfacePoint to, ProjectedAnnotation& projected, Places& places) {
        ++projected.detours;
        along_edges(SurfacePoint(places.back()), to, places);
    }

    /// Selects the places of a strand to use: both ends, and starting from the place nearest to its origin, those whose
    /// distance from the previous one is not much larger than on the source. Between two nearby places where the mapping is
    /// invertible, places where it is not are skipped: they lie in folds. A loop repeats its first place at the end if that
    /// place is used.
    std::vector<std::size_t> trusted(ProjectedStrand& strand) {
        const Places& curve = strand.from.places;
        const bool closed = strand.from.closed;
        const std::size_t n = closed ? curve.size() - 1 : curve.size();
        std::vector<const MappedPlace*> places;
        for (std::size_t i = 0; i < n; ++i) places.push_back(&at(curve[i]));
        strand.count = n;
        double nearest = std::numeric_limits<double>::infinity();
        std::size_t best = n;
        for (std::size_t i = 0; i < n; ++i) {
            const MappedPlace& one = *places[i];
            if (one.kind == CorrespondenceKind::ray) ++strand.by_ray;
            else if (one.kind == CorrespondenceKind::closest) ++strand.by_closest_point;
            if (one.kind == CorrespondenceKind::none) continue;
            const double off = distance(one.start, one.end) + (one.mutual ? 0 : mapping_.far());
            if (off < nearest - 1e-9 * edge_) nearest = off, best = i;
        }
        if (best == n) {
            strand.without_place = n;
            return {};
        }
        std::vector<bool> use(n, false);
        use[best] = true;
        if (closed) {
            spread(places, best, +1, n - 1, use);
        } else {
            spread(places, best, +1, n - 1 - best, use);
            spread(places, best, -1, best, use);
            for (const std::size_t end : {std::size_t{0}, n - 1})
                use[end] = use[end] || places[end]->kind != CorrespondenceKind::none;
        }
        std::vector<std::size_t> good;
        for (std::size_t i = 0; i < n; ++i)
            if (use[i]) good.push_back(i);
        strand.without_place = n - good.size();
        if (closed && use[0]) good.push_back(n);  // repeats the first place
        return good;
    }

    /// Marks the places to use among the next `steps` places from `start`, forwards or backwards along the strand.
    void spread(const std::vector<const MappedPlace*>& places, std::size_t start, int sense, std::size_t steps,
                std::vector<bool>& use) const {
        const std::size_t n = places.size();
        const auto at_step = [&](std::size_t k) { return sense > 0 ? (start + k) % n : (start + n - k % n) % n; };
        std::vector<double> along(steps + 1, 0);
        std::vector<std::size_t> next_mutual(steps + 2, steps + 1);  // from each step on
        for (std::size_t k = 1; k <= steps; ++k)
            along[k] = along[k - 1] + distance(places[at_step(k)]->start, places[at_step(k - 1)]->start);
        for (std::size_t k = steps; k >= 1; --k) next_mutual[k] = places[at_step(k)]->mutual ? k : next_mutual[k + 1];
        const auto follows = [&](std::size_t k, std::size_t last) {
            const MappedPlace &one = *places[at_step(k)], &before = *places[at_step(last)];
            return one.kind != CorrespondenceKind::none &&
                   distance(one.end, before.end) <= 3 * (along[k] - along[last]) + 0.5 * edge_;
        };
        std::size_t last = 0;
        for (std::size_t k = 1; k <= steps; ++k) {
            if (!places[at_step(k)]->mutual) {
                const std::size_t m = next_mutual[k];
                if (m <= steps && follows(m, last) && distance(places[at_step(m)]->end, places[at_step(last)]->end) <= 2 * edge_)
                    k = m;
            }
            if (!follows(k, last)) continue;
            use[at_step(k)] = true;
            last = k;
        }
    }

    /// Appends the trace from the place of a, which is the last of `places`, to the place of b.
    void append(const SurfacePoint& a, const SurfacePoint& b, std::size_t& detours, Places& places) {
        const auto [entry, fresh] = traces_.try_emplace(std::minmax(a, b));
        if (fresh) {
            const SurfacePoint &low = entry->first.first, &high = entry->first.second;
            entry->second.places.push_back(stored_point(target_, at(low).to));
            join(low, high, 0, entry->second);
        }
        detours += entry->second.detours;
        const Places& way = entry->second.places;
        const bool forward = a == entry->first.first;
        for (std::size_t k = 1; k < way.size(); ++k) {
            const SurfacePoint& place = forward ? way[k] : way[way.size() - 1 - k];
            if (places.back() != place) places.push_back(place);
        }
    }

    struct Trace {
        Places places;
        std::size_t detours = 0;
    };

    /// Appends the way from the place of a to that of b: a straight trace in the plane of the correspondence normals; if it
    /// does not arrive, the segment is halved, unless the mapping is not invertible at its midpoint; across folds, the
    /// geodesic.
    void join(const SurfacePoint& a, const SurfacePoint& b, int depth, Trace& trace) {
        const MappedPlace from = at(a), to = at(b);
        const double apart = distance(from.end, to.end), least = 1e-9 * search_.diagonal();
        const Vector across = mapping_.by_target_normals() ? from.up + to.up : from.normal + to.normal;
        const auto add = [&](const SurfaceCurve& line) {
            for (std::size_t k = 1; k < line.points.size(); ++k) trace.places.push_back(stored_point(target_, line.points[k]));
        };
        if (const auto line = trace_line(target_, from.to, to.to, unit_vector(across), 2 * apart + least)) return add(*line);
        if (const auto line = trace_line(target_, from.to, to.to, unit_vector(from.up + to.up), 2 * apart + least))
            return add(*line);
        if (depth < 6 && shared_face(source_, from.from, to.from) != no_index) {
            const SurfacePoint middle = between(a, b, 1, 2);
            const MappedPlace& half = at(middle);
            const double reach = 2 * apart + 0.1 * edge_;
            const bool there = mapping_.by_target_normals() ? half.mutual : half.kind != CorrespondenceKind::none;
            if (middle != a && middle != b && there && distance(half.end, from.end) < reach &&
                distance(half.end, to.end) < reach) {
                join(a, middle, depth + 1, trace);
                join(middle, b, depth + 1, trace);
                return;
            }
        }
        ++trace.detours;
        if (const auto line = geodesic_curve(target_, from.to, to.to)) return add(*line);
        along_edges(from.to, to.to, trace.places);
    }

    /// Connects the places through corners of their faces and an edge path; a gap between two components is left open.
    void along_edges(const SurfacePoint& a, const SurfacePoint& b, Places& places) {
        const auto nearest = [&](const SurfacePoint& p) {
            if (p.is_vertex()) return p.vertex();
            const Point at = position(target_, p);
            const auto corner = corners(target_, faces_of(target_, p).front());
            return *std::min_element(corner.begin(), corner.end(), [&](Vertex v, Vertex w) {
                return CGAL::squared_distance(target_.point(v), at) < CGAL::squared_distance(target_.point(w), at);
            });
        };
        if (!paths_) paths_.emplace(target_);
        for (const Index v : paths_->find(nearest(a), nearest(b), {})) {
            const SurfacePoint place = vertex_point(v);
            if (places.back() != place) places.push_back(place);
        }
        if (const SurfacePoint last = stored_point(target_, b); places.back() != last) places.push_back(last);
    }

    /// Extends the end of an outline that started at the border to the nearest border point of the target.
    void lead_to_border(Places& way) {
        if (border_.empty())
            for (const Halfedge h : target_.halfedges())
                if (target_.is_border(h)) border_.push_back(h);
        if (border_.empty()) return;
        const SurfacePoint from = way.back();
        if (is_on_border(target_, from)) return;
        const Point start = position(target_, from);
        double best = std::numeric_limits<double>::infinity();
        SurfacePoint goal;
        for (const Halfedge h : border_) {
            const Point &a = target_.point(target_.source(h)), &b = target_.point(target_.target(h));
            const Vector along = b - a;
            const double t = std::clamp(((start - a) * along) / along.squared_length(), 0.0, 1.0);
            const double off = CGAL::squared_distance(a + t * along, start);
            if (off >= best) continue;
            best = off;
            const Index v = target_.source(h), w = target_.target(h);
            goal = t < 1e-6 || t > 1 - 1e-6 ? vertex_point(t < 0.5 ? v : w) : ordered_edge_point(v, w, t);
        }
        const Vector up = unit_vector(smooth_normal(target_, from) + smooth_normal(target_, goal));
        if (const auto line = trace_line(target_, from, goal, up, 4 * std::sqrt(best) + 1e-9 * search_.diagonal()))
            for (std::size_t k = 1; k < line->points.size(); ++k) way.push_back(stored_point(target_, line->points[k]));
        else along_edges(from, goal, way);
    }

    static void begin(const Annotation& from, ProjectedAnnotation& projected) {
        projected.annotation.id = from.id;
        projected.annotation.tag = from.tag;
        projected.annotation.colour = from.colour;
        projected.annotation.type = from.type;
        projected.annotation.note = from.note;
        projected.annotation.information = from.information;
        projected.annotation.all = from.all;
    }

    /// Adds a note if a region or line has another number of outlines than on the source.
    static void note_change(const Annotation& from, std::size_t before, ProjectedAnnotation& projected) {
        const std::size_t after = projected.annotation.curves.size();
        if (from.all || projected.lost || after == before || after == 0 || !projected.note.empty()) return;
        projected.note = counted(before, from.type == AnnotationType::line    ? "line"
                                         : from.type == AnnotationType::point ? "point"
                                                                              : "outline") +
                         " became " + std::to_string(after);
    }

    const Mesh& source_;
    const SurfaceSearch& search_;
    const Mesh& target_;
    RegionSettling settling_;
    PlaceMapping mapping_;
    double edge_;  ///< typical edge length of the target
    std::vector<ProjectedStrand> strands_;
    std::map<SurfacePoint, MappedPlace> mapped_;
    std::map<std::pair<SurfacePoint, SurfacePoint>, Trace> traces_;
    std::optional<PathSearch> paths_;
    std::vector<Halfedge> border_;
};

}  // namespace

std::vector<ProjectedAnnotation> project_curves(const Mesh& source, const std::vector<const Annotation*>& annotations,
                                                const SurfaceSearch& target, const CorrespondenceOptions& options) {
    check_options(options, "correspondence");
    return CurveProjector(source, target, options).run(annotations);
}

std::vector<std::string> project_free_annotations(AnnotatedMeshView source, const Mesh& target, AnnotationSet& to,
                                                  const CorrespondenceOptions& options) {
    std::vector<std::string> notes;
    std::vector<const Annotation*> free;
    for (const Annotation& annotation : source.annotations.annotations)
        if (is_free(annotation)) free.push_back(&annotation);
    if (free.empty() || target.number_of_faces() == 0) return notes;
    const SurfaceSearch search(target);
    for (ProjectedAnnotation& projected : project_curves(source.mesh, free, search, options)) {
        Annotation* now = to.find(projected.annotation.id);
        if (projected.lost) {
            notes.push_back(name_of(projected.annotation) + ": its curves have no place on the new mesh");
            continue;
        }
        if (!projected.note.empty()) notes.push_back(name_of(projected.annotation) + ": " + projected.note);
        if (now == nullptr) continue;
        now->type = projected.annotation.type;
        now->points = std::move(projected.annotation.points);
        now->polylines = std::move(projected.annotation.polylines);
        now->faces = std::move(projected.annotation.faces);
        now->curves = std::move(projected.annotation.curves);
        now->note = std::move(projected.annotation.note);
    }
    return notes;
}

}  // namespace ostraka

#include "ostraka/annotation/curves.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/distance.h"
#include "ostraka/geom/insert_curves.h"
#include "ostraka/mesh/flood.h"

#include <algorithm>

namespace ostraka {

namespace {

bool is_closed(const std::vector<SurfacePoint>& curve) { return curve.size() > 3 && curve.front() == curve.back(); }

/// One face of each component that the region lists and no curve traverses.
std::vector<Index> seeds_of(const Mesh& mesh, const Annotation& annotation, const std::vector<SurfaceCurve>& curves,
                            const CurveFilling& filling) {
    std::vector<Index> seeds;
    std::vector<bool> seen, curved;
    for (const Index f : annotation.faces) {
        if (f >= filling.sides.size() || filling.sides[f] != FaceSide::out) continue;
        if (seen.empty()) {
            seen.assign(mesh.number_of_faces(), false);
            curved = seen;
            for (const SurfaceCurve& curve : curves)
                for (const Index g : curve.faces) curved[g] = true;
        }
        if (seen[f]) continue;
        const std::vector<Face> component = flood_faces(mesh, Face(f), seen);
        if (std::none_of(component.begin(), component.end(), [&](Face g) -> bool { return curved[g]; })) seeds.push_back(f);
    }
    return seeds;
}

CurveFilling filling_of(const Mesh& mesh, const Annotation& annotation, const std::vector<SurfaceCurve>& curves) {
    CurveFilling filling = fill_curves(mesh, curves);
    const std::vector<Index> seeds = seeds_of(mesh, annotation, curves, filling);
    return seeds.empty() ? filling : fill_curves(mesh, curves, seeds);
}

}  // namespace

bool any_free(const AnnotationSet& set) { return std::any_of(set.annotations.begin(), set.annotations.end(), is_free); }

std::vector<SurfacePoint> vertex_curve(const std::vector<Index>& path, bool closed) {
    std::vector<SurfacePoint> curve;
    curve.reserve(path.size() + 1);
    for (const Index v : path) curve.push_back(vertex_point(v));
    if (closed) curve.push_back(vertex_point(path.front()));
    return curve;
}

std::vector<SurfaceCurve> curves_on(const Mesh& mesh, const Annotation& annotation) {
    std::vector<SurfaceCurve> curves;
    for (const auto& places : annotation.curves) {
        const std::string where = name_of(annotation) + ", curve " + std::to_string(curves.size());
        const std::size_t least = annotation.type == AnnotationType::point ? 1 : 2;
        if (places.size() < least || (annotation.type == AnnotationType::point && places.size() > 1))
            fail_input(where, "has " + std::to_string(places.size()) + " places",
                       annotation.type == AnnotationType::point ? "give each point one" : "give two or more");
        try {
            curves.push_back(curve_through(mesh, places));
        } catch (const Error& error) {
            throw Error(error.kind(), where, error.problem(), error.remedy());
        }
        if (annotation.type != AnnotationType::region || is_closed(places)) continue;
        if (!is_on_border(mesh, places.front()) || !is_on_border(mesh, places.back()))
            fail_input(where, "is an outline that does not close",
                       "repeat its first place at the end; on an open mesh it may also end "
                       "at the border");
    }
    return curves;
}

CurveFilling filling_of(const Mesh& mesh, const Annotation& annotation) {
    return filling_of(mesh, annotation, curves_on(mesh, annotation));
}

void compute_elements(const Mesh& mesh, Annotation& annotation) {
    if (!is_free(annotation)) return;
    const std::vector<SurfaceCurve> curves = curves_on(mesh, annotation);
    if (annotation.type == AnnotationType::region) {
        const CurveFilling filling = filling_of(mesh, annotation, curves);
        if (filling.conflicts > 0)
            fail_input(name_of(annotation),
                       "its outlines contradict each other at " + std::to_string(filling.conflicts) + " places",
                       "the interior lies to the left of each curve: turn those that run the wrong way, and let them not cross");
        annotation.faces = filling.majority();
        return;
    }
    annotation.points.clear();
    annotation.polylines.clear();
    for (const auto& places : annotation.curves) {
        std::vector<Index> walk;
        for (const SurfacePoint& place : places) walk.push_back(nearest_vertex(mesh, place));
        if (annotation.type == AnnotationType::point) annotation.points.push_back(walk.front());
        else if (walk = prune_spikes(walk, false); walk.size() > 1) annotation.polylines.push_back(std::move(walk));
    }
}

RegionMeasures measure_region(const Mesh& mesh, const Annotation& annotation) {
    if (!is_free(annotation)) return measure_region(mesh, annotation.faces);
    const std::vector<SurfaceCurve> curves = curves_on(mesh, annotation);
    const CurveFilling filling = filling_of(mesh, annotation, curves);
    RegionMeasures measures{filling.area(mesh), filling.border};
    for (const SurfaceCurve& curve : curves) measures.perimeter += curve.length(mesh);
    return measures;
}

double area_of(const Mesh& mesh, const Annotation& annotation) {
    if (annotation.type != AnnotationType::region) return 0;
    return is_free(annotation) ? filling_of(mesh, annotation).area(mesh) : area_of(mesh, annotation.faces);
}

std::vector<std::pair<Index, double>> face_area_fractions(const Mesh& mesh, const Annotation& region) {
    std::vector<std::pair<Index, double>> shares;
    if (!is_free(region)) {
        for (const Index f : region.faces) shares.emplace_back(f, 1.0);
        return shares;
    }
    const CurveFilling filling = filling_of(mesh, region);
    auto cut = filling.cut.begin();
    for (Index f = 0; f < filling.sides.size(); ++f) {
        if (filling.sides[f] == FaceSide::in) shares.emplace_back(f, 1.0);
        if (filling.sides[f] != FaceSide::cut) continue;
        while (cut->first != f) ++cut;
        shares.emplace_back(f, cut->second);
    }
    return shares;
}

double length_of(const Mesh& mesh, const Annotation& annotation) {
    double sum = 0;
    if (is_free(annotation)) {
        for (const SurfaceCurve& curve : curves_on(mesh, annotation)) sum += curve.length(mesh);
        return sum;
    }
    for (const auto& polyline : annotation.polylines)
        for (std::size_t k = 0; k + 1 < polyline.size(); ++k)
            sum += distance(mesh.point(Vertex(polyline[k])), mesh.point(Vertex(polyline[k + 1])));
    return sum;
}

std::vector<std::vector<Point>> drawn_curves(const Mesh& mesh, const Annotation& annotation) {
    std::vector<std::vector<Point>> curves;
    if (is_free(annotation)) {
        for (const SurfaceCurve& curve : curves_on(mesh, annotation)) curves.push_back(positions(mesh, curve.points));
        return curves;
    }
    const auto add = [&](const std::vector<Index>& path, bool closed) {
        auto& points = curves.emplace_back();
        for (const Index v : path) points.push_back(mesh.point(Vertex(v)));
        if (closed && !path.empty()) points.push_back(points.front());
    };
    for (const Index v : annotation.points) add({v}, false);
    for (const auto& polyline : annotation.polylines) add(polyline, false);
    if (annotation.type == AnnotationType::region && !annotation.all)
        for (const Outline& outline : extract_outlines(mesh, annotation.faces)) add(outline, true);
    return curves;
}

std::vector<double> CutMesh::vertex_values(const Mesh& before, const std::vector<double>& values) const {
    std::vector<double> all = values;
    all.reserve(values.size() + points.size());
    for (const SurfacePoint& p : points) all.push_back(interpolate(before, p, [&](Vertex v) { return values[v]; }));
    return all;
}

namespace {

/// The faces of a free region on the cut mesh.
std::vector<Index> faces_on_cut(const Mesh& mesh, const Annotation& annotation, const std::vector<SurfaceCurve>& curves,
                                const std::vector<std::vector<Index>>& paths, const CutMesh& cut) {
    const CurveFilling filling = filling_of(mesh, annotation, curves);
    std::vector<Halfedge> edges;
    for (const auto& path : paths)
        for (std::size_t i = 0; i + 1 < path.size(); ++i)
            if (const Halfedge h = find_halfedge(cut.mesh, Vertex(path[i]), Vertex(path[i + 1])); h.is_valid())
                edges.push_back(h);
    const Filling filled = fill_edges(cut.mesh, edges);
    std::vector<Index> faces;
    std::optional<CutFaces> places;
    for (Index f = 0; f < cut.face_origin.size(); ++f) {
        const Index old = cut.face_origin[f];
        bool inside = filling.sides[old] == FaceSide::in;
        if (filling.sides[old] == FaceSide::cut) {
            if (filled.conflicts == 0) {
                inside = filled.selected[f];
            } else {
                if (!places) places.emplace(mesh, curves, filling);
                inside = places->inside(old, centroid(cut.mesh, Face(f)));
            }
        }
        if (inside) faces.push_back(f);
    }
    return faces;
}

}  // namespace

CutMesh cut_along_curves(AnnotatedMeshView object, const std::vector<SurfaceCurve>& more) {
    std::vector<SurfaceCurve> curves;
    std::vector<std::size_t> first;  // index of the first curve of each annotation
    for (const Annotation& annotation : object.annotations.annotations) {
        first.push_back(curves.size());
        for (SurfaceCurve& curve : curves_on(object.mesh, annotation)) curves.push_back(std::move(curve));
    }
    first.push_back(curves.size());
    curves.insert(curves.end(), more.begin(), more.end());
    InsertedCurves inserted = insert_curves(object.mesh, curves);
    CutMesh cut;
    cut.mesh = std::move(inserted.mesh);
    cut.face_origin = std::move(inserted.face_origin);
    cut.points = std::move(inserted.new_points);
    cut.old_vertices = object.mesh.number_of_vertices();
    cut.more_paths.assign(inserted.paths.begin() + static_cast<std::ptrdiff_t>(first.back()), inserted.paths.end());
    cut.annotations = object.annotations;
    const auto carry = [&](std::size_t i) {
        const Annotation& from = object.annotations.annotations[i];
        Annotation& to = cut.annotations.annotations[i];
        to.curves.clear();
        const std::vector<std::vector<Index>> paths(inserted.paths.begin() + static_cast<std::ptrdiff_t>(first[i]),
                                                    inserted.paths.begin() + static_cast<std::ptrdiff_t>(first[i + 1]));
        if (is_free(from)) {
            if (from.type == AnnotationType::point) {
                to.points.clear();
                for (const auto& path : paths) to.points.push_back(path.front());
            } else if (from.type == AnnotationType::line) {
                to.polylines.clear();
                for (const auto& path : paths)
                    if (path.size() > 1) to.polylines.push_back(path);
            } else {
                const std::vector<SurfaceCurve> own(curves.begin() + static_cast<std::ptrdiff_t>(first[i]),
                                                    curves.begin() + static_cast<std::ptrdiff_t>(first[i + 1]));
                to.faces = faces_on_cut(object.mesh, from, own, paths, cut);
            }
            return;
        }
        if (from.type == AnnotationType::region) {
            const std::vector<bool> selected = face_flags(object.mesh, from.faces);
            to.faces.clear();
            for (Index f = 0; f < cut.face_origin.size(); ++f)
                if (selected[cut.face_origin[f]]) to.faces.push_back(f);
        }
        for (std::size_t k = 0; k < from.polylines.size(); ++k) {
            const std::vector<Index>& line = from.polylines[k];
            std::vector<Index> path{line.front()};
            for (std::size_t v = 1; v < line.size(); ++v) {
                const Halfedge h = find_halfedge(object.mesh, Vertex(line[v - 1]), Vertex(line[v]));
                if (h.is_valid()) {
                    if (const auto on = inserted.on_edge.find(object.mesh.edge(h)); on != inserted.on_edge.end()) {
                        std::vector<Index> between = on->second;
                        if (object.mesh.halfedge(object.mesh.edge(h), 0) != h) std::reverse(between.begin(), between.end());
                        path.insert(path.end(), between.begin(), between.end());
                    }
                }
                path.push_back(line[v]);
            }
            to.polylines[k] = std::move(path);
        }
    };
    parallel_for(object.annotations.annotations.size(), 1, carry);
    return cut;
}

namespace {

/// Drops repeated places and places that lie between their neighbours on a straight piece in one face or along one edge.
std::vector<SurfacePoint> without_needless(const Mesh& mesh, std::vector<SurfacePoint> places) {
    const bool closed = is_closed(places);
    const auto needless = [&](const SurfacePoint& before, const SurfacePoint& place, const SurfacePoint& after) {
        if (place.is_vertex()) return false;
        if (place.is_on_edge()) {  // needed unless both neighbours lie on the same edge
            if (shared_edge(mesh, before, place) == no_index || shared_edge(mesh, place, after) == no_index) return false;
        } else if (shared_face(mesh, before, after) == no_index) {
            return false;
        }
        const Point start = position(mesh, before);
        const Vector whole = position(mesh, after) - start, part = position(mesh, place) - start;
        const double length = whole.squared_length();
        return length > 0 && CGAL::cross_product(whole, part).squared_length() <= 1e-20 * length * length && part * whole > 0 &&
               part * whole < length;
    };
    std::vector<SurfacePoint> kept;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (!kept.empty() && kept.back() == places[i]) continue;
        if (!kept.empty() && i + 1 < places.size() && needless(kept.back(), places[i], places[i + 1])) continue;
        kept.push_back(places[i]);
    }
    if (closed && kept.size() > 4 && needless(kept[kept.size() - 2], kept.front(), kept[1])) {
        kept.erase(kept.begin());
        kept.back() = kept.front();
    }
    return kept;
}

}  // namespace

void uncut_annotation(const Mesh& mesh, const CutMesh& cut, Annotation& annotation) {
    annotation.curves.clear();
    bool free = false;
    const auto place = [&](Index v) {
        if (v >= cut.old_vertices) {
            const SurfacePoint& p = cut.points[v - cut.old_vertices];
            // Snaps an intersection of curves close to the boundary of a face onto it: the face could not be cut again at the
            // original position.
            return stored_point(mesh, p.is_in_face() ? surface_point(mesh, p.element[0], p.weights) : p);
        }
        return vertex_point(v);
    };
    const auto joined = [&](const SurfacePoint& a, const SurfacePoint& b) {
        return a.is_vertex() && b.is_vertex() && find_halfedge(mesh, a.vertex(), b.vertex()).is_valid();
    };
    const auto add = [&](const std::vector<Index>& path) {
        std::vector<SurfacePoint> places;
        for (const Index v : path) places.push_back(place(v));
        places = without_needless(mesh, std::move(places));
        for (std::size_t i = 0; i < places.size(); ++i)
            if (!places[i].is_vertex() || (i > 0 && !joined(places[i - 1], places[i]))) free = true;
        annotation.curves.push_back(std::move(places));
    };
    if (annotation.type == AnnotationType::point) {
        for (const Index v : annotation.points) add({v});
    } else if (annotation.type == AnnotationType::line) {
        for (const auto& line : annotation.polylines) add(line);
    } else {
        for (OutlinePath& path : outline_paths(cut.mesh, annotation.faces)) {
            if (path.closed) path.vertices.push_back(path.vertices.front());
            add(path.vertices);
        }
        std::vector<Index> old;
        for (const Index f : annotation.faces) old.push_back(cut.face_origin[f]);
        old.erase(std::unique(old.begin(), old.end()), old.end());
        annotation.faces = std::move(old);
    }
    if (free || annotation.type != AnnotationType::region) compute_elements(mesh, annotation);
    if (!free) annotation.curves.clear();  // the curves follow edges of the mesh, so the elements represent them exactly
}

}  // namespace ostraka

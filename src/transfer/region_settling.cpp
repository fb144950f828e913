#include "transfer/region_settling.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/geom/insert_curves.h"
#include "ostraka/mesh/flood.h"
#include "ostraka/mesh/limits.h"
#include "transfer/curve_loops.h"
#include "transfer/region_transfer.h"
#include "transfer/scores.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

RegionSettling::RegionSettling(const Mesh& source, const SurfaceSearch& target, const CorrespondenceOptions& options)
    : source_(source),
      search_(target),
      target_(target.mesh()),
      options_(options),
      edge_(target.typical_edge()),
      far_(options.max_distance * target.diagonal()),
      min_cosine_(options.min_cosine()) {}

bool RegionSettling::is_plausible(double area, double expected) const {
    return std::abs(area - expected) <= 0.5 * expected + 0.1 * edge_ * edge_;
}

void RegionSettling::settle(const Annotation& from, std::size_t outlines, ProjectedAnnotation& projected) const {
    Annotation& to = projected.annotation;
    if (from.all) {
        to.faces.resize(target_.number_of_faces());
        for (Index f = 0; f < to.faces.size(); ++f) to.faces[f] = f;
        return;
    }
    if (from.type == AnnotationType::region) {
        to.faces = whole_components(from);
        if (to.curves.empty() && to.faces.empty()) projected.lost = true;
        if (to.curves.empty()) return;
        const CurveFilling filling = fill_curves(target_, curves_on(target_, to));
        const double expected = area_of(source_, from);
        if (filling.conflicts > 0 || !is_plausible(filling.area(target_), expected)) {
            untangle(from, expected, outlines, projected);
            return;
        }
    }
    if (to.curves.empty()) projected.lost = true;
    else compute_elements(target_, to);
}

/// Components of the source that the region covers completely have no outline: one face of each is mapped to find the component
/// of the target.
std::vector<Index> RegionSettling::whole_components(const Annotation& from) const {
    if (is_free(from) && from.faces.empty()) return {};
    std::vector<bool> selected = face_flags(source_, from.faces), seen(source_.number_of_faces(), false);
    if (is_free(from)) {
        std::vector<bool> curved(source_.number_of_faces(), false);
        for (const SurfaceCurve& curve : curves_on(source_, from))
            for (const Index f : curve.faces) curved[f] = true;
        for (std::size_t f = 0; f < curved.size(); ++f)
            if (curved[f]) selected[f] = false;
    }
    std::vector<Index> faces;
    for (const Index first : from.faces) {
        if (seen[first] || !selected[first]) continue;
        const std::vector<Face> component = flood_faces(source_, Face(first), seen);
        const bool whole = std::all_of(component.begin(), component.end(), [&](Face f) -> bool { return selected[f]; });
        if (!whole) continue;
        const Face middle = component.front();
        const auto hit =
            search_.closest_compatible(centroid(source_, middle), unit_vector(area_vector(source_, middle)), min_cosine_, far_);
        if (!hit) continue;
        std::vector<bool> flooded(target_.number_of_faces(), false);
        for (const Face f : flood_faces(target_, Face(hit->face), flooded)) faces.push_back(f);
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
}

/// For intersecting outlines: computes the region by winding numbers on the target cut along them, and extracts a new outline.
void RegionSettling::untangle(const Annotation& from, double expected, std::size_t outlines,
                              ProjectedAnnotation& projected) const {
    Annotation& to = projected.annotation;
    projected.untangled = true;
    const std::vector<Index> components = to.faces;
    InsertedCurves inserted = insert_curves(target_, curves_on(target_, to));
    std::vector<Halfedge> edges;
    for (const auto& path : inserted.paths)
        for (std::size_t i = 0; i + 1 < path.size(); ++i)
            if (const Halfedge h = find_halfedge(inserted.mesh, Vertex(path[i]), Vertex(path[i + 1])); h.is_valid())
                edges.push_back(h);
    CutMesh cut;
    cut.mesh = std::move(inserted.mesh);
    cut.face_origin = std::move(inserted.face_origin);
    cut.points = std::move(inserted.new_points);
    cut.old_vertices = target_.number_of_vertices();
    auto wound = fill_by_winding(cut.mesh, edges, expected);
    if (wound) dissolve_small_parts(cut.mesh, edge_ * edge_, outlines, *wound);
    const std::vector<Index> found = wound ? flagged(*wound) : std::vector<Index>();
    if (!found.empty() && is_plausible(area_of(cut.mesh, found), expected)) {
        to.faces = found;
        uncut_annotation(target_, cut, to);
        return;
    }
    // Classifies each face by its corresponding place on the source.
    to.curves.clear();
    const SurfaceSearch back(source_);
    to.faces = flagged(region_by_vote(source_, back, from.faces, target_, options_));
    projected.lost = to.faces.empty();
    to.note += std::string(to.note.empty() ? "" : "; ") + "its outline could not be followed: it runs along edges now";
}

}  // namespace ostraka

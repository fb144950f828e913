#include "transfer/curve_partition.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/flood.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace ostraka {

namespace {

/// Relative rounding error of the area of a surface.
constexpr double rounding_share = 1e-9;

/// Assignment of the faces of a mesh cut along all outlines such that each has one owner.
class Parting {
public:
    Parting(const Mesh& mesh, const std::vector<Annotation>& regions) : mesh_(mesh), holders_(mesh.number_of_faces()) {
        for (std::size_t r = 0; r < regions.size(); ++r)
            for (const Index f : regions[r].faces) holders_[f].push_back(r);
        owner_.assign(holders_.size(), none);
        for (std::size_t f = 0; f < holders_.size(); ++f)
            if (holders_[f].size() == 1) owner_[f] = holders_[f].front();
    }

    /// Assigns all contested pieces; returns the regions whose faces changed.
    std::vector<bool> settle(std::size_t regions) {
        std::vector<bool> changed(regions, false);
        std::vector<std::vector<Face>> pieces = contested();
        for (bool any = true; any && !pieces.empty();) {
            any = false;
            std::vector<std::vector<Face>> left;
            for (std::vector<Face>& piece : pieces) {
                const std::size_t best = heir(piece);
                if (best == none) {
                    left.push_back(std::move(piece));
                    continue;
                }
                any = true;
                for (const Face f : piece) owner_[f] = best;
                changed[best] = true;
                for (const std::size_t r : holders_[piece.front()]) changed[r] = true;
            }
            pieces = std::move(left);
        }
        return changed;
    }

    [[nodiscard]] std::vector<Index> faces_of(std::size_t region) const {
        std::vector<Index> faces;
        for (std::size_t f = 0; f < owner_.size(); ++f)
            if (owner_[f] == region) faces.push_back(static_cast<Index>(f));
        return faces;
    }

private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);

    /// Connected faces with the same set of holders, which is empty or has more than one element.
    std::vector<std::vector<Face>> contested() const {
        std::vector<std::vector<Face>> pieces;
        std::vector<bool> seen(holders_.size(), false);
        CancelCheck check;
        for (const Face start : mesh_.faces()) {
            check();
            if (seen[start] || holders_[start].size() == 1) continue;
            pieces.push_back(flood_faces(mesh_, start, seen, [&](Halfedge h) {
                const Face beyond = mesh_.face(mesh_.opposite(h));
                return beyond != Mesh::null_face() && holders_[beyond] == holders_[start];
            }));
        }
        return pieces;
    }

    /// The owner adjacent to most of a piece's border, restricted to its holders if it has any; without such a neighbour, its
    /// first holder, or none.
    [[nodiscard]] std::size_t heir(const std::vector<Face>& piece) const {
        const std::vector<std::size_t>& holders = holders_[piece.front()];
        std::map<std::size_t, double> shared;
        for (const Face f : piece)
            for (const Halfedge h : mesh_.halfedges_around_face(mesh_.halfedge(f))) {
                if (mesh_.is_border(mesh_.opposite(h))) continue;
                const std::size_t beyond = owner_[mesh_.face(mesh_.opposite(h))];
                if (beyond == none || (!holders.empty() && std::find(holders.begin(), holders.end(), beyond) == holders.end()))
                    continue;
                shared[beyond] += std::sqrt(CGAL::squared_distance(mesh_.point(mesh_.source(h)), mesh_.point(mesh_.target(h))));
            }
        if (shared.empty()) return holders.empty() ? none : holders.front();
        return std::max_element(shared.begin(), shared.end(), [](const auto& a, const auto& b) { return a.second < b.second; })
            ->first;
    }

    const Mesh& mesh_;
    std::vector<std::vector<std::size_t>> holders_;
    std::vector<std::size_t> owner_;
};

/// The sum of the areas of the regions, added in order.
template <class Regions>
double area_of_all(const Mesh& mesh, const Regions& regions) {
    std::vector<double> areas(regions.size());
    parallel_for(regions.size(), 1, [&](std::size_t k) { areas[k] = area_of(mesh, *regions[k]); });
    return std::accumulate(areas.begin(), areas.end(), 0.0);
}

/// Whether an area equals that of the whole mesh.
bool is_whole(double area, const Mesh& mesh) {
    const double whole = surface_area(mesh);
    return std::abs(area - whole) <= rounding_share * whole;
}

}  // namespace

bool part_surface(const Mesh& mesh, const std::vector<const Annotation*>& annotations) {
    std::vector<const Annotation*> regions;
    for (const Annotation* one : annotations)
        if (one->type == AnnotationType::region && !one->all) regions.push_back(one);
    return regions.size() > 1 && is_whole(area_of_all(mesh, regions), mesh);
}

void keep_partition(const Mesh& source, const std::vector<const Annotation*>& annotations, const Mesh& target,
                    std::vector<ProjectedAnnotation>& projected) {
    std::vector<std::size_t> which;  // regions that exist on the target
    std::vector<const Annotation*> there;
    bool untangled = false;
    for (std::size_t i = 0; i < annotations.size(); ++i) {
        if (annotations[i]->type != AnnotationType::region || annotations[i]->all || projected[i].lost) continue;
        which.push_back(i);
        there.push_back(&projected[i].annotation);
        untangled = untangled || projected[i].untangled;
    }
    if (which.empty() || !part_surface(source, annotations)) return;
    if (!untangled && is_whole(area_of_all(target, there), target)) return;
    AnnotationSet set;
    for (const std::size_t i : which) set.annotations.push_back(projected[i].annotation);
    try {
        const CutMesh cut = cut_along_curves({target, set});
        Parting parting(cut.mesh, cut.annotations.annotations);
        const std::vector<bool> changed = parting.settle(which.size());
        for (std::size_t r = 0; r < which.size(); ++r) {
            if (!changed[r]) continue;
            Annotation& annotation = set.annotations[r];
            annotation.faces = parting.faces_of(r);
            annotation.curves.clear();
            if (!annotation.faces.empty()) uncut_annotation(target, cut, annotation);
        }
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::cancelled) throw;
        for (const std::size_t i : which)
            if (projected[i].untangled && projected[i].note.empty())
                projected[i].note = "its neighbours may overlap it, or leave a gap: " + error.where() + ' ' + error.problem();
        return;
    }
    for (std::size_t r = 0; r < which.size(); ++r) {
        projected[which[r]].lost = set.annotations[r].faces.empty() && set.annotations[r].curves.empty();
        projected[which[r]].annotation = std::move(set.annotations[r]);
    }
}

}  // namespace ostraka

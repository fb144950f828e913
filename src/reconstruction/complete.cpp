#include "ostraka/reconstruction/complete.h"
#include "ostraka/core/angles.h"

#include "reconstruction/seam.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/submesh.h"
#include "ostraka/geom/surface_search.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

std::string to_string(Origin origin) { return enum_name(origin, {"observed", "interpolated", "hypothesis"}); }

namespace {

/// Per vertex, sum of the area vectors of its faces that are not fracture.
std::vector<Vector> outer_normals(const PlacedFragment& fragment) {
    std::vector<Vector> normals(fragment.mesh.number_of_vertices(), Vector(0, 0, 0));
    for (const Face face : fragment.mesh.faces()) {
        if (!fragment.facets.empty() && fragment.facets[face] == Facet::fracture) continue;
        const Vector area = area_vector(fragment.mesh, face);
        for (const Vertex v : corners(fragment.mesh, face)) normals[v] = normals[v] + area;
    }
    for (Vector& normal : normals)
        if (const double length = std::sqrt(normal.squared_length()); length > 0) normal = normal / length;
    return normals;
}

class Completer {
public:
    Completer(const Mesh& fitted, const std::vector<PlacedFragment>& fragments, const CompleteOptions& options)
        : fragments_(fragments), options_(options), diagonal_(box_diagonal(fitted)) {
        object_.mesh = fitted;
        const std::size_t n = fitted.number_of_faces();
        object_.fragment.assign(n, -1);
        object_.fragment_face.assign(n, no_index);
        object_.template_face.resize(n);
        for (Index f = 0; f < n; ++f) object_.template_face[f] = f;
        object_.origin.assign(n, Origin::hypothesis);
        object_.joined.assign(fragments.size(), 0);
    }

    CompletedObject run() {
        for (std::size_t k = 0; k < fragments_.size(); ++k) join(static_cast<int>(k));
        measure_distances();
        return std::move(object_);
    }

private:
    /// The projection of each vertex of the fragment onto the object, where that is still the template's surface.
    std::vector<std::optional<SurfaceHit>> project_vertices(int number, const std::vector<Vector>& normals) {
        const PlacedFragment& fragment = fragments_[static_cast<std::size_t>(number)];
        const SurfaceSearch search(object_.mesh);
        const double minimum = std::cos(options_.angle * pi / 180), search_radius = options_.tolerance * diagonal_;
        std::vector<std::optional<SurfaceHit>> hits(fragment.mesh.number_of_vertices());
        parallel_for(hits.size(), [&](std::size_t v) {
            if (!(normals[v].squared_length() > 0)) return;
            auto hit =
                search.closest_compatible(fragment.mesh.point(Vertex(static_cast<Index>(v))), normals[v], minimum, search_radius);
            if (hit) hits[v] = hit;
        });
        double outer_area = 0, lying_area = 0, shared_area = 0;
        for (const Face face : fragment.mesh.faces()) {
            if (!fragment.facets.empty() && fragment.facets[face] != Facet::outer) continue;
            const double area = face_area(fragment.mesh, face);
            outer_area += area;
            const auto c = corners(fragment.mesh, face);
            if (!std::all_of(c.begin(), c.end(), [&](Vertex v) { return hits[v].has_value(); })) continue;
            lying_area += area;
            if (std::all_of(c.begin(), c.end(), [&](Vertex v) { return object_.fragment[hits[v]->face] >= 0; }))
                shared_area += area;
        }
        object_.on_template.push_back(outer_area > 0 ? lying_area / outer_area : 0);
        object_.shared.push_back(outer_area > 0 ? shared_area / outer_area : 0);
        for (auto& hit : hits)
            if (hit && object_.template_face[hit->face] == no_index) hit.reset();
        return hits;
    }

    void join(int number) {
        const PlacedFragment& fragment = fragments_[static_cast<std::size_t>(number)];
        const std::vector<Vector> normals = outer_normals(fragment);
        const std::vector<std::optional<SurfaceHit>> hits = project_vertices(number, normals);
        if (!options_.join) {
            mark_observed(number, fragment, hits);
            return;
        }
        std::vector<bool> keep(fragment.mesh.number_of_faces(), false);
        for (const Face face : fragment.mesh.faces()) {
            if (!fragment.facets.empty() && fragment.facets[face] == Facet::fracture) continue;
            const auto c = corners(fragment.mesh, face);
            // A face across the surface would fold when projected.
            keep[face] = std::all_of(c.begin(), c.end(), [&](Vertex v) {
                return hits[v] && area_vector(fragment.mesh, face) * area_vector(object_.mesh, Face(hits[v]->face)) > 0;
            });
        }
        const Joint joint = join_patch(object_.mesh, Patch(fragment.mesh, std::move(keep), options_.min_piece), hits,
                                       options_.blend * diagonal_, frozen());
        if (!joint.problem.empty()) {
            object_.notes.push_back({number, joint.problem});
            mark_observed(number, fragment, hits);
            return;
        }
        CompletedObject next;
        next.mesh = joint.mesh;
        for (std::size_t f = 0; f < joint.old_face.size(); ++f) {
            const Index old = joint.old_face[f];
            const bool is_new = old == no_index;
            next.origin.push_back(is_new ? Origin::observed : object_.origin[old]);
            next.fragment.push_back(is_new ? number : object_.fragment[old]);
            next.fragment_face.push_back(is_new ? joint.patch_face[f] : object_.fragment_face[old]);
            next.template_face.push_back(is_new ? no_index : object_.template_face[old]);
        }
        next.notes = std::move(object_.notes);
        next.joined = std::move(object_.joined);
        next.on_template = std::move(object_.on_template);
        next.shared = std::move(object_.shared);
        next.joined[static_cast<std::size_t>(number)] = joint.patch_faces;
        object_ = std::move(next);
    }

    /// Vertices of faces that come from fragments.
    [[nodiscard]] std::vector<bool> frozen() const {
        std::vector<bool> marks(object_.mesh.number_of_vertices(), false);
        for (const Face face : object_.mesh.faces())
            if (object_.template_face[face] == no_index)
                for (const Vertex v : corners(object_.mesh, face)) marks[v] = true;
        return marks;
    }

    /// For a fragment that cannot be joined, marks the template's faces under it as observed.
    void mark_observed(int number, const PlacedFragment& fragment, const std::vector<std::optional<SurfaceHit>>& hits) {
        for (const Face face : fragment.mesh.faces()) {
            const auto c = corners(fragment.mesh, face);
            if (!std::all_of(c.begin(), c.end(), [&](Vertex v) { return hits[v].has_value(); })) continue;
            for (const Vertex v : c) {
                object_.origin[hits[v]->face] = Origin::observed;
                object_.fragment[hits[v]->face] = number;
            }
        }
    }

    void measure_distances() {
        const Mesh& mesh = object_.mesh;
        object_.distance.assign(mesh.number_of_faces(), 0);
        object_.confidence.assign(mesh.number_of_faces(), 1);
        std::vector<bool> is_observed(mesh.number_of_faces());
        for (std::size_t f = 0; f < is_observed.size(); ++f) is_observed[f] = object_.origin[f] == Origin::observed;
        if (std::find(is_observed.begin(), is_observed.end(), true) == is_observed.end()) {
            object_.distance.assign(mesh.number_of_faces(), -1);
            object_.confidence.assign(mesh.number_of_faces(), 0);
            return;
        }
        const SubMesh observed = keep_faces(mesh, is_observed);
        const SurfaceSearch search(observed.mesh);
        parallel_for(mesh.number_of_faces(), [&](std::size_t f) {
            if (is_observed[f]) return;
            object_.distance[f] = search.closest(centroid(mesh, Face(static_cast<Index>(f)))).distance;
            object_.confidence[f] = std::exp2(-object_.distance[f] / (options_.confidence_half_distance * diagonal_));
            if (object_.distance[f] <= options_.blend * diagonal_) object_.origin[f] = Origin::interpolated;
        });
    }

    const std::vector<PlacedFragment>& fragments_;
    const CompleteOptions& options_;
    double diagonal_;
    CompletedObject object_;
};

}  // namespace

CompletedObject complete(const Mesh& fitted, const std::vector<PlacedFragment>& fragments, const CompleteOptions& options) {
    check_options(options, "complete");
    if (fitted.number_of_faces() == 0) fail_input("template", "has no faces", "check that it is the right file");
    return Completer(fitted, fragments, options).run();
}

void CompleteOptions::declare_options(OptionList& list) {
    list("seam-angle", angle, "maximum angle between the normals of a used fragment face and of the fitted template",
         Range{0, 90}, "degrees");
    list("seam-width", blend, "width of the zone in which the template is blended into the edge of a fragment", Range{0, 1},
         "share of the diagonal");
    list("confidence-length", confidence_half_distance,
         "distance from observed surface over which the confidence of completed surface is halved", Range{1e-6, 1e6},
         "share of the diagonal");
    list("join", join, "insert the triangles of the fragments into the completed mesh", Anything{});
    list("min-piece", min_piece, "minimum area of an inserted piece of a fragment, as a share of the fragment's area",
         Range{0, 1});
}

}  // namespace ostraka

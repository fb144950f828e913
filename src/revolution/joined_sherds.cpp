#include "stages.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/dense.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

using Eigen::Vector3d;

JoinedSherds joined(const std::vector<const Fragment*>& sherds, const std::vector<Motion>& motions) {
    JoinedSherds all;
    for (std::size_t k = 0; k < sherds.size(); ++k) {
        const Fragment* sherd = sherds[k];
        const Mesh& mesh = sherd->mesh;
        std::vector<Vertex> vertices;
        for (const Vertex v : mesh.vertices())
            vertices.push_back(all.mesh.add_vertex(point_of(motions[k](eigen(mesh.point(v))))));
        auto& own = all.of_fragment.emplace_back();
        for (const Face face : mesh.faces()) {
            const auto c = corners(mesh, face);
            const Face made = all.mesh.add_face(vertices[c[0]], vertices[c[1]], vertices[c[2]]);
            if (!sherd->facets.empty() && sherd->facets[face] == Facet::fracture) continue;
            own.push_back(static_cast<Index>(made));
        }
        all.faces.insert(all.faces.end(), own.begin(), own.end());
    }
    return all;
}

std::vector<Motion> common_axis(const std::vector<const Fragment*>& sherds, const RevolutionOptions& options,
                                RevolutionTemplate& result) {
    std::vector<Motion> motions(sherds.size());
    const JoinedSherds all = joined(sherds, motions);
    result.axis = rotation_axis(all.mesh, all.faces, options.axis);
    std::vector<double> weights;
    Vector3d direction = Vector3d::Zero(), through = Vector3d::Zero(), first = Vector3d::Zero();
    double sum = 0;
    for (const auto& faces : all.of_fragment) {
        SherdOnProfile one;
        one.axis = rotation_axis(all.mesh, faces, options.axis);
        double area = 0;
        for (const Index f : faces) area += face_area(all.mesh, Face(f));
        weights.push_back(one.axis.found ? area : 0);
        if (one.axis.found) {
            Vector3d own = eigen(one.axis.direction);
            if (first.isZero()) first = own;
            if (own.dot(first) < 0) own = -own;
            direction += area * own;
            sum += area;
        }
        result.sherds.push_back(std::move(one));
    }
    if (!(sum > 0)) {
        if (!result.axis.found)
            fail_input("sherds", "have no common axis: " + result.axis.reason,
                       sherds.size() > 1 ? "do they lie as they did in the vessel?" : "");
        return motions;
    }
    direction.normalize();
    const auto middle_of = [&](std::size_t k) { return eigen(area_moments(all.mesh, all.of_fragment[k]).centroid); };
    // Where each axis is at the height of its sherd, across the common direction.
    std::vector<Vector3d> at(sherds.size(), Vector3d::Zero());
    for (std::size_t k = 0; k < sherds.size(); ++k) {
        if (weights[k] == 0) continue;
        const Vector3d p = eigen(result.sherds[k].axis.point), d = eigen(result.sherds[k].axis.direction);
        at[k] = p + d * ((middle_of(k) - p).dot(direction) / d.dot(direction));
        through += weights[k] / sum * at[k];
    }
    for (std::size_t k = 0; k < sherds.size(); ++k) {
        SherdOnProfile& one = result.sherds[k];
        one.name = sherds[k]->name;
        if (weights[k] == 0) {
            result.notes.push_back("sherd " + one.name + " has no axis of its own (" + one.axis.reason +
                                   "): it stays where it is");
            continue;
        }
        Vector3d own = eigen(one.axis.direction);
        if (own.dot(direction) < 0) own = -own;
        const Vector3d offset = through - at[k], aside = offset - offset.dot(direction) * direction;
        one.lean = 180 / pi * std::acos(std::min(1.0, own.dot(direction)));
        one.aside = aside.norm();
        if (one.lean > 15 || one.aside > 0.1 * box_diagonal(all.mesh))
            fail_input("sherd " + one.name,
                       "has an axis that leans by " + digits(one.lean, 3) + " degrees against that of all and lies " +
                           digits(one.aside, 3) + " off it",
                       "lay the sherds as they were in the vessel, or leave it out");
        motions[k].rotation = rotation_between(own, direction).toRotationMatrix();
        motions[k].translation = at[k] + aside - motions[k].rotation * at[k];
    }
    const auto heaviest = static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
    if (!result.axis.found) result.axis = result.sherds[heaviest].axis;
    result.axis.direction = vector_of(direction);
    result.axis.point = point_of(through);
    return motions;
}

}  // namespace ostraka

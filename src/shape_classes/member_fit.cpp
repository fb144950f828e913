#include "ostraka/shape_classes/member_fit.h"
#include "ostraka/algebra/dense.h"
#include "ostraka/core/angles.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/submesh.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/geom/with_points.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace ostraka {

using Eigen::Matrix2d;

std::string fit_off_message(const MemberFit& fit, double maximum) {
    if (!fit.residuals || !(fit.residuals->off() > maximum)) return {};
    const auto per_cent = [](double fraction) { return digits(100 * fraction, 3) + " %"; };
    return fmt::format(
        "the template does not lie on it: {} of the template and {} of the object are off the other surface; their mean may be "
        "at most {}",
        per_cent(fit.residuals->unmatched), per_cent(fit.residuals->unexplained), per_cent(maximum));
}

std::vector<std::string> fit_explanation(const MemberFit& fit) {
    std::vector<std::string> lines;
    if (!fit.residuals) return lines;
    const auto per_cent = [](double fraction) { return digits(100 * fraction, 3) + " %"; };
    const auto place = [](const Point& p) {
        return fmt::format("({}, {}, {})", digits(p.x(), 4), digits(p.y(), 4), digits(p.z(), 4));
    };
    lines.push_back(fmt::format("the template explains {} of its surface within {}; {} of the template lies on it",
                                per_cent(1 - fit.residuals->unexplained), digits(fit.contact_distance, 3),
                                per_cent(1 - fit.residuals->unmatched)));
    if (fit.cavity > 0)
        lines.push_back(fmt::format(
            "it is hollow: {} of its surface is the inside of walls whose outside lies on the template, and is ignored",
            per_cent(fit.cavity)));
    constexpr std::size_t maximum = 3;
    for (std::size_t i = 0; i < std::min(maximum, fit.foreign.size()); ++i) {
        const DeviatingRegion& region = fit.foreign[i];
        lines.push_back(fmt::format("foreign: {} of its surface about {}, farthest at {} by {}{}", per_cent(region.share),
                                    place(region.middle), place(region.at), digits(region.farthest, 3),
                                    region.part.empty() ? "" : "; the nearest part of the template is " + region.part));
    }
    for (std::size_t i = 0; i < std::min(maximum, fit.missing.size()); ++i) {
        const DeviatingRegion& region = fit.missing[i];
        lines.push_back(fmt::format("missing: {} of the template{}, located about {} after the fit, farthest by {}",
                                    per_cent(region.share), region.part.empty() ? "" : ", of its part " + region.part,
                                    place(region.middle), digits(region.farthest, 3)));
    }
    return lines;
}

bool in_correspondence(const Mesh& mesh, const Mesh& member) {
    if (mesh.number_of_vertices() != member.number_of_vertices() || mesh.number_of_faces() != member.number_of_faces())
        return false;
    return std::all_of(mesh.faces().begin(), mesh.faces().end(),
                       [&](Face face) { return corners(mesh, face) == corners(member, face); });
}

MemberFit member_in_correspondence(const Mesh& mesh, const WholeObject& member) {
    if (!in_correspondence(mesh, member.mesh))
        fail_input(
            member.name,
            fmt::format("is not in correspondence with the template: it has {} vertices and {} faces, the template {} and {}{}",
                        member.mesh.number_of_vertices(), member.mesh.number_of_faces(), mesh.number_of_vertices(),
                        mesh.number_of_faces(),
                        mesh.number_of_vertices() == member.mesh.number_of_vertices() ? ", or the faces differ" : ""),
            "omit --correspondence, so that the template is fitted to it");
    MemberFit fit;
    fit.placed_by = "correspondence";
    fit.points.assign(member.mesh.points().begin(), member.mesh.points().end());
    const double size = surface_area(mesh);
    fit.scale = size > 0 ? std::sqrt(surface_area(member.mesh) / size) : 1;
    return fit;
}

namespace {

/// The edge vectors of a triangle as two columns, in a frame of its plane.
Matrix2d edge_matrix(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const Vector3d u = b - a, v = c - a;
    const double length = u.norm(), along = length > 0 ? u.dot(v) / length : 0;
    Matrix2d m;
    m << length, along, 0, length > 0 ? u.cross(v).norm() / length : 0;
    return m;
}

double angle_at(const Mesh& mesh, Edge edge, const std::vector<Vector3d>& p) {
    const Halfedge h = mesh.halfedge(edge, 0), o = mesh.opposite(h);
    const Vector3d &a = p[mesh.source(h)], &b = p[mesh.target(h)];
    const Vector3d n = (b - a).cross(p[mesh.target(mesh.next(h))] - a), m = (a - b).cross(p[mesh.target(mesh.next(o))] - b);
    return std::atan2((b - a).norm() > 0 ? n.cross(m).dot((b - a).normalized()) : 0, n.dot(m));
}

/// Residuals and off-surface regions of one placement, as stored in the member fit.
struct Residuals {
    FitResiduals numbers;
    std::vector<DeviatingRegion> foreign, missing;
};

Residuals residuals_of(const Mesh& undeformed, const Mesh& fitted, const Mesh& object, double scale, double observed) {
    Residuals residuals;
    const double diagonal = scale * box_diagonal(undeformed);
    SurfaceDeviation template_to_object = surface_deviation(fitted, SurfaceSearch(object), observed * diagonal),
                     object_to_template = surface_deviation(object, SurfaceSearch(fitted), observed * diagonal);
    residuals.numbers.distance = template_to_object.distance / diagonal;
    residuals.numbers.unmatched = template_to_object.share;
    residuals.numbers.back = object_to_template.distance / diagonal;
    residuals.numbers.unexplained = object_to_template.share;
    residuals.missing = std::move(template_to_object.regions);
    residuals.foreign = std::move(object_to_template.regions);
    std::vector<Point> points(fitted.points().begin(), fitted.points().end());
    measure_distortion(undeformed, points, scale, residuals.numbers);
    return residuals;
}

/// The object without the insides of its walls, closed where these are cut off, and their share of its surface. None if there
/// are no such insides, or if nothing else is left.
std::optional<std::pair<Mesh, double>> without_inner_walls(const Mesh& fitted, const Mesh& object, double max_distance) {
    std::vector<bool> keep = inner_wall_faces(object, SurfaceSearch(fitted), max_distance);
    double inner_fraction = 0;
    const double area = surface_area(object);
    for (const Face f : object.faces())
        if (keep[f]) inner_fraction += face_area(object, f) / area;
    if (!(inner_fraction > 0) || !(inner_fraction < 0.9)) return {};
    keep.flip();
    Mesh outer = keep_faces(object, keep).mesh;
    if (holes_of(object).empty())
        for (const Halfedge border : holes_of(outer))
            if (outer.is_border(border)) close_hole(outer, border);
    return std::pair(std::move(outer), inner_fraction);
}

/// The regions transformed by a motion.
std::vector<DeviatingRegion> moved_regions(std::vector<DeviatingRegion> regions, const Motion& motion) {
    for (DeviatingRegion& region : regions) {
        region.middle = point_of(motion(eigen(region.middle)));
        region.at = point_of(motion(eigen(region.at)));
    }
    return regions;
}

/// Scale of the template, and the motion of the object to the template at this scale.
struct Place {
    double scale = 1;
    Motion pose;  ///< rigid motion of the object
};

std::vector<Place> places_by_surface(const Mesh& mesh, const WholeObject& member, const MemberFitOptions& options) {
    const AlignSurface object(member.mesh, options.alignment.samples), rest(mesh, options.alignment.samples);
    const double ratio = object.size() / rest.size();
    const Mesh scaled = scaled_by(mesh, ratio);
    const AlignSurface scaled_surface(scaled, options.alignment.samples);
    std::vector<Motion> initial_motions = principal_starts(scaled_surface, object);
    // The given pose, centroid on centroid.
    const auto middle = [](const Mesh& surface) {
        Vector3d sum = Vector3d::Zero();
        double area = 0;
        for (const Face face : surface.faces()) {
            const double a = face_area(surface, face);
            sum += a * eigen(centroid(surface, face));
            area += a;
        }
        return Vector3d(sum / area);
    };
    Motion given_pose;
    given_pose.translation = middle(member.mesh) - middle(scaled);
    initial_motions.push_back(given_pose);
    std::vector<Alignment> alignments;
    for (const Motion& start : initial_motions) alignments.push_back(align(scaled_surface, object, {start}, options.alignment));
    std::stable_sort(alignments.begin(), alignments.end(),
                     [](const Alignment& a, const Alignment& b) { return a.distance < b.distance; });
    std::vector<Place> places;
    for (const Alignment& alignment : alignments) {
        // x = s R (ratio p) + t for a point p of the template: the inverse of R and t is applied to the object, the scale to
        // the template.
        Place place;
        place.scale = ratio * alignment.motion.scale;
        place.pose.rotation = alignment.motion.rotation.transpose();
        place.pose.translation = -(place.pose.rotation * alignment.motion.translation);
        const bool is_known = std::any_of(places.begin(), places.end(), [&](const Place& other) {
            return (other.pose.rotation - place.pose.rotation).norm() < 0.2;
        });
        if (!is_known) places.push_back(place);
        if (places.size() == static_cast<std::size_t>(options.tries)) break;
    }
    return places;
}

}  // namespace

void measure_distortion(const Mesh& mesh, const std::vector<Point>& points, double scale, FitResiduals& residuals) {
    std::vector<Vector3d> rest_points, current_points;
    for (const Vertex v : mesh.vertices()) {
        rest_points.push_back(scale * eigen(mesh.point(v)));
        current_points.push_back(eigen(points[v]));
    }
    double area = 0, squares = 0;
    constexpr double maximum = 3;  // of a logarithm: limits the weight of triangles that collapse
    for (const Face face : mesh.faces()) {
        const auto c = corners(mesh, face);
        const double weight = face_area(mesh, face);
        const Matrix2d rest_edges = edge_matrix(rest_points[c[0]], rest_points[c[1]], rest_points[c[2]]),
                       current_edges = edge_matrix(current_points[c[0]], current_points[c[1]], current_points[c[2]]);
        if (!(weight > 0) || !(std::abs(rest_edges.determinant()) > 0)) continue;
        const Vector2d s = singular_values(current_edges * rest_edges.inverse());
        double sum = 0;
        for (int k = 0; k < 2; ++k) {
            const double log = s[k] > 0 ? std::clamp(std::log(s[k]), -maximum, maximum) : -maximum;
            sum += 0.5 * log * log;
        }
        area += weight;
        squares += weight * sum;
    }
    residuals.stretch = area > 0 ? std::sqrt(squares / area) : 0;
    double length = 0, turned = 0;
    for (const Edge edge : mesh.edges()) {
        if (mesh.is_border(edge)) continue;
        const double weight = (rest_points[mesh.vertex(edge, 0)] - rest_points[mesh.vertex(edge, 1)]).norm();
        const double angle_change =
            std::remainder(angle_at(mesh, edge, current_points) - angle_at(mesh, edge, rest_points), 2 * pi);
        length += weight;
        turned += weight * angle_change * angle_change;
    }
    residuals.bend = length > 0 ? std::sqrt(turned / length) : 0;
}

namespace {

/// A tag without the number at its end: "part 12" becomes "part", "finger" stays.
std::string without_number(const std::string& tag) {
    std::size_t end = tag.size();
    while (end > 0 && std::isdigit(static_cast<unsigned char>(tag[end - 1])) != 0) --end;
    if (end == tag.size() || end == 0) return tag;
    while (end > 0 && std::string(" _-.#").find(tag[end - 1]) != std::string::npos) --end;
    return tag.substr(0, end);
}

/// Gives regions with numbered tags ("part 0", "part 1") a common tag in both sets, so that they are matched by position and
/// shape: the two numberings need not agree. Landmarks keep their names. Returns the common tags.
std::set<std::string> forget_numbers(AnnotationSet& a, AnnotationSet& b) {
    std::set<std::string> numbered_stems;
    for (const AnnotationSet* set : {&a, &b}) {
        std::map<std::string, std::set<std::string>> tags;
        for (const Annotation& annotation : set->annotations)
            if (annotation.type == AnnotationType::region && without_number(annotation.tag) != annotation.tag)
                tags[without_number(annotation.tag)].insert(annotation.tag);
        for (const auto& [stem, numbered_tags] : tags)
            if (numbered_tags.size() > 1) numbered_stems.insert(stem);
    }
    for (AnnotationSet* set : {&a, &b})
        for (Annotation& annotation : set->annotations)
            if (annotation.type == AnnotationType::region && numbered_stems.count(without_number(annotation.tag)) > 0)
                annotation.tag = without_number(annotation.tag);
    return numbered_stems;
}

}  // namespace

MemberFit fit_member(AnnotatedMeshView object, const WholeObject& member, const MemberFitOptions& options) {
    check_options(options, "fit");
    if (!(surface_area(object.mesh) > 0)) fail_input("template", "has no area", "check that it is the right file");
    if (!(surface_area(member.mesh) > 0)) fail_input(member.name, "has no area", "check that it is the right file");
    MemberFit best;
    std::vector<Place> places;
    if (!options.ignore_landmarks) {
        const auto pairs = common_landmarks(object, member, &best.notes);
        if (pairs.size() >= 3) {
            const CommonPlacement placement = place_by_landmarks({pairs}, options.placement);
            const FragmentPlacement& fragment_placement = placement.fragments.front();
            if (fragment_placement.problem.empty()) {
                places.push_back({placement.scale, fragment_placement.pose});
                best.placed_by = "landmarks";
            } else if (fragment_placement.mirrored) {
                best.problem = fragment_placement.problem;
                return best;
            } else {
                best.notes.push_back(
                    fmt::format("it cannot be placed by landmarks: {}; it is placed by its surface", fragment_placement.problem));
            }
        }
    }
    if (places.empty()) {
        places = places_by_surface(object.mesh, member, options);
        best.placed_by = "surface";
    }
    AnnotationSet template_annotations, member_annotations;  // with common tags instead of numbered ones
    if (!object.annotations.annotations.empty() && !member.annotations.annotations.empty()) {
        template_annotations = object.annotations;
        member_annotations = member.annotations;
        for (const std::string& tag : forget_numbers(template_annotations, member_annotations))
            best.notes.push_back(
                fmt::format("the regions '{}' are numbered: they are matched by position and shape, not by their numbers", tag));
    }
    double minimum = std::numeric_limits<double>::infinity();
    for (const Place& place : places) {
        const Mesh scaled = scaled_by(object.mesh, place.scale);
        PlacedFragment placed{moved(member.mesh, place.pose), &member.annotations, {}, {}};
        placed.matches = match_annotations({scaled, template_annotations}, {member.mesh, member_annotations}, place.pose, {},
                                           options.annotations);
        std::vector<PlacedFragment> placed_fragments;
        placed_fragments.push_back(std::move(placed));
        const NonRigidFit fit = fit_template({scaled, object.annotations}, placed_fragments, options.fit);
        const Mesh fitted = with_points(object.mesh, fit.points);
        const auto outer = without_inner_walls(fitted, placed_fragments.front().mesh,
                                               options.observed * place.scale * box_diagonal(object.mesh));
        const Residuals residuals = residuals_of(object.mesh, fitted, outer ? outer->first : placed_fragments.front().mesh,
                                                 place.scale, options.observed);
        const double cost = std::hypot(residuals.numbers.distance, residuals.numbers.back);
        if (!(cost < minimum)) continue;
        minimum = cost;
        best.scale = place.scale;
        best.residuals = residuals.numbers;
        best.contact_distance = options.observed * place.scale * box_diagonal(object.mesh);
        best.points.clear();
        best.cavity = outer ? outer->second : 0;
        best.outer = outer ? std::make_shared<const Mesh>(outer->first) : nullptr;
        const Motion to_object = place.pose.inverse();
        best.foreign = moved_regions(residuals.foreign, to_object);
        best.missing = moved_regions(residuals.missing, to_object);
        for (const Point& p : fit.points) best.points.push_back(point_of(to_object(eigen(p))));
    }
    if (best.points.empty()) best.problem = "the fit has no usable result: check the mesh with 'mesh info'";
    return best;
}

void MemberFitOptions::declare_options(OptionList& list) {
    placement.declare_options(list);
    alignment.declare_options(list);
    annotations.declare_options(list);
    fit.declare_options(list);
    list("ignore-landmarks", ignore_landmarks, "ignore landmarks, and register the template onto objects by the surfaces alone",
         Anything{});
    list("tries", tries,
         "without landmarks: number of initial poses from which the template is fitted, nearest first; the best fit is kept "
         "(initial poses: principal axes, and the pose in the files)",
         Range{1, 5});
    list("observed", observed, "points within this distance of the other surface count as lying on it", Range{0, 1},
         "share of the diagonal");
    list("max-off", max_off,
         "the template fits an object only if, after the fit, at most this share of the two surfaces (mean of unmatched and "
         "unexplained) does not lie on the other surface",
         Range{0, 1});
}

}  // namespace ostraka

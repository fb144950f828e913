#include "ostraka/shape_classes/member_fit.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/dense.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/submesh.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/geom/with_points.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace ostraka {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

std::string fit_is_off(const MemberFit& fit, double maximum) {
    if (!fit.residuals || !(fit.residuals->off() > maximum)) return {};
    const auto per_cent = [](double share) { return digits(100 * share, 3) + " %"; };
    return "the template does not lie on it: " + per_cent(fit.residuals->unmatched) + " of the template and " +
           per_cent(fit.residuals->unexplained) + " of the object are off the other, " + per_cent(maximum) +
           " on average is the most";
}

std::vector<std::string> explained_text(const MemberFit& fit) {
    std::vector<std::string> lines;
    if (!fit.residuals) return lines;
    const auto per_cent = [](double share) { return digits(100 * share, 3) + " %"; };
    const auto place = [](const Point& p) {
        return "(" + digits(p.x(), 4) + ", " + digits(p.y(), 4) + ", " + digits(p.z(), 4) + ")";
    };
    lines.push_back("the template explains " + per_cent(1 - fit.residuals->unexplained) + " of its surface within " +
                    digits(fit.near, 3) + "; " + per_cent(1 - fit.residuals->unmatched) + " of the template lies on it");
    if (fit.cavity > 0)
        lines.push_back("it is hollow: " + per_cent(fit.cavity) +
                        " of its surface is the inside of walls whose outside lies on the template, and does not count");
    constexpr std::size_t maximum = 3;
    for (std::size_t i = 0; i < std::min(maximum, fit.foreign.size()); ++i) {
        const OffRegion& region = fit.foreign[i];
        lines.push_back("foreign: " + per_cent(region.share) + " of its surface about " + place(region.middle) +
                        ", farthest at " + place(region.at) + " by " + digits(region.farthest, 3) +
                        (region.part.empty() ? "" : "; the nearest part of the template is " + region.part));
    }
    for (std::size_t i = 0; i < std::min(maximum, fit.missing.size()); ++i) {
        const OffRegion& region = fit.missing[i];
        lines.push_back("missing: " + per_cent(region.share) + " of the template" +
                        (region.part.empty() ? "" : ", of its part " + region.part) + ", which came to lie about " +
                        place(region.middle) + ", farthest by " + digits(region.farthest, 3));
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
            "is not in correspondence with the template: it has " + std::to_string(member.mesh.number_of_vertices()) +
                " vertices and " + std::to_string(member.mesh.number_of_faces()) + " faces, the template " +
                std::to_string(mesh.number_of_vertices()) + " and " + std::to_string(mesh.number_of_faces()) +
                (mesh.number_of_vertices() == member.mesh.number_of_vertices() ? ", or the faces join other vertices" : ""),
            "leave out --correspondence: the template is then fitted to it");
    MemberFit fit;
    fit.placed_by = "correspondence";
    fit.points.assign(member.mesh.points().begin(), member.mesh.points().end());
    const double size = surface_area(mesh);
    fit.scale = size > 0 ? std::sqrt(surface_area(member.mesh) / size) : 1;
    return fit;
}

namespace {

/// The edge vectors of a triangle as two columns, in a frame of its plane.
Matrix2d flat(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
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
    std::vector<OffRegion> foreign, missing;
};

Residuals residuals_of(const Mesh& rest, const Mesh& fitted, const Mesh& object, double scale, double observed) {
    Residuals residuals;
    const double diagonal = scale * box_diagonal(rest);
    SurfaceOff there = surface_off(fitted, SurfaceSearch(object), observed * diagonal),
               back = surface_off(object, SurfaceSearch(fitted), observed * diagonal);
    residuals.numbers.distance = there.distance / diagonal;
    residuals.numbers.unmatched = there.share;
    residuals.numbers.back = back.distance / diagonal;
    residuals.numbers.unexplained = back.share;
    residuals.missing = std::move(there.regions);
    residuals.foreign = std::move(back.regions);
    std::vector<Point> points(fitted.points().begin(), fitted.points().end());
    measure_distortion(rest, points, scale, residuals.numbers);
    return residuals;
}

/// The object without the insides of its walls, closed where these are cut off, and their share of its surface. None if there
/// are no such insides, or if nothing else is left.
std::optional<std::pair<Mesh, double>> without_insides(const Mesh& fitted, const Mesh& object, double near) {
    std::vector<bool> keep = insides_of_walls(object, SurfaceSearch(fitted), near);
    double share = 0;
    const double area = surface_area(object);
    for (const Face f : object.faces())
        if (keep[f]) share += face_area(object, f) / area;
    if (!(share > 0) || !(share < 0.9)) return {};
    keep.flip();
    Mesh outer = keep_faces(object, keep).mesh;
    if (holes_of(object).empty())
        for (const Halfedge border : holes_of(outer))
            if (outer.is_border(border)) close_hole(outer, border);
    return std::pair(std::move(outer), share);
}

/// The regions transformed by a motion.
std::vector<OffRegion> moved_regions(std::vector<OffRegion> regions, const Motion& motion) {
    for (OffRegion& region : regions) {
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
    const AlignSurface whole(scaled, options.alignment.samples);
    std::vector<Motion> starts = principal_starts(whole, object);
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
    Motion same;
    same.translation = middle(member.mesh) - middle(scaled);
    starts.push_back(same);
    std::vector<Alignment> found;
    for (const Motion& start : starts) found.push_back(align(whole, object, {start}, options.alignment));
    std::stable_sort(found.begin(), found.end(), [](const Alignment& a, const Alignment& b) { return a.distance < b.distance; });
    std::vector<Place> places;
    for (const Alignment& alignment : found) {
        // x = s R (ratio p) + t for a point p of the template: the inverse of R and t is applied to the object, the scale to
        // the template.
        Place place;
        place.scale = ratio * alignment.motion.scale;
        place.pose.rotation = alignment.motion.rotation.transpose();
        place.pose.translation = -(place.pose.rotation * alignment.motion.translation);
        const bool known = std::any_of(places.begin(), places.end(), [&](const Place& other) {
            return (other.pose.rotation - place.pose.rotation).norm() < 0.2;
        });
        if (!known) places.push_back(place);
        if (places.size() == static_cast<std::size_t>(options.tries)) break;
    }
    return places;
}

}  // namespace

void measure_distortion(const Mesh& mesh, const std::vector<Point>& points, double scale, FitResiduals& residuals) {
    std::vector<Vector3d> rest, now;
    for (const Vertex v : mesh.vertices()) {
        rest.push_back(scale * eigen(mesh.point(v)));
        now.push_back(eigen(points[v]));
    }
    double area = 0, squares = 0;
    constexpr double maximum = 3;  // of a logarithm: limits the weight of triangles that collapse
    for (const Face face : mesh.faces()) {
        const auto c = corners(mesh, face);
        const double weight = face_area(mesh, face);
        const Matrix2d before = flat(rest[c[0]], rest[c[1]], rest[c[2]]), after = flat(now[c[0]], now[c[1]], now[c[2]]);
        if (!(weight > 0) || !(std::abs(before.determinant()) > 0)) continue;
        const Vector2d s = singular_values(after * before.inverse());
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
        const double weight = (rest[mesh.vertex(edge, 0)] - rest[mesh.vertex(edge, 1)]).norm();
        const double turn = std::remainder(angle_at(mesh, edge, now) - angle_at(mesh, edge, rest), 2 * pi);
        length += weight;
        turned += weight * turn * turn;
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
    std::set<std::string> counted;
    for (const AnnotationSet* set : {&a, &b}) {
        std::map<std::string, std::set<std::string>> tags;
        for (const Annotation& one : set->annotations)
            if (one.type == AnnotationType::region && without_number(one.tag) != one.tag)
                tags[without_number(one.tag)].insert(one.tag);
        for (const auto& [stem, list] : tags)
            if (list.size() > 1) counted.insert(stem);
    }
    for (AnnotationSet* set : {&a, &b})
        for (Annotation& one : set->annotations)
            if (one.type == AnnotationType::region && counted.count(without_number(one.tag)) > 0)
                one.tag = without_number(one.tag);
    return counted;
}

}  // namespace

MemberFit fit_member(const Mesh& mesh, const AnnotationSet& set, const WholeObject& member, const MemberFitOptions& options) {
    check_options(options, "fit");
    if (!(surface_area(mesh) > 0)) fail_input("template", "has no area", "is it the right file?");
    if (!(surface_area(member.mesh) > 0)) fail_input(member.name, "has no area", "is it the right file?");
    MemberFit best;
    std::vector<Place> places;
    if (!options.ignore_landmarks) {
        const auto pairs = common_landmarks(mesh, set, member.mesh, member.annotations, &best.notes);
        if (pairs.size() >= 3) {
            const CommonPlacement placement = place_by_landmarks({pairs}, options.placement);
            const FragmentPlacement& one = placement.fragments.front();
            if (one.problem.empty()) {
                places.push_back({placement.scale, one.pose});
                best.placed_by = "landmarks";
            } else if (one.mirrored) {
                best.problem = one.problem;
                return best;
            } else {
                best.notes.push_back("landmarks do not place it: " + one.problem + "; placed by its surface");
            }
        }
    }
    if (places.empty()) {
        places = places_by_surface(mesh, member, options);
        best.placed_by = "surface";
    }
    AnnotationSet ours, theirs;  // with common tags instead of numbered ones
    if (!set.annotations.empty() && !member.annotations.annotations.empty()) {
        ours = set;
        theirs = member.annotations;
        for (const std::string& tag : forget_numbers(ours, theirs))
            best.notes.push_back("the regions '" + tag +
                                 "' are counted up: they are matched by place and shape, not by their numbers");
    }
    double minimum = std::numeric_limits<double>::infinity();
    for (const Place& place : places) {
        const Mesh scaled = scaled_by(mesh, place.scale);
        PlacedFragment placed{moved(member.mesh, place.pose), &member.annotations, {}, {}};
        placed.matches = match_annotations(scaled, ours, member.mesh, theirs, place.pose, {}, options.annotations);
        std::vector<PlacedFragment> list;
        list.push_back(std::move(placed));
        const NonRigidFit fit = fit_template(scaled, set, list, options.fit);
        const Mesh fitted = with_points(mesh, fit.points);
        const auto outer = without_insides(fitted, list.front().mesh, options.observed * place.scale * box_diagonal(mesh));
        const Residuals residuals =
            residuals_of(mesh, fitted, outer ? outer->first : list.front().mesh, place.scale, options.observed);
        const double cost = std::hypot(residuals.numbers.distance, residuals.numbers.back);
        if (!(cost < minimum)) continue;
        minimum = cost;
        best.scale = place.scale;
        best.residuals = residuals.numbers;
        best.near = options.observed * place.scale * box_diagonal(mesh);
        best.points.clear();
        best.cavity = outer ? outer->second : 0;
        best.outer = outer ? std::make_shared<const Mesh>(outer->first) : nullptr;
        const Motion back = place.pose.inverse();
        best.foreign = moved_regions(residuals.foreign, back);
        best.missing = moved_regions(residuals.missing, back);
        for (const Point& p : fit.points) best.points.push_back(point_of(back(eigen(p))));
    }
    if (best.points.empty()) best.problem = "the fit has no usable result: look at the mesh with 'mesh info'";
    return best;
}

void MemberFitOptions::describe(OptionList& visit) {
    placement.describe(visit);
    alignment.describe(visit);
    annotations.describe(visit);
    fit.describe(visit);
    visit("ignore-landmarks", ignore_landmarks, "register the template onto objects by their surfaces alone", Anything{});
    visit("tries", tries,
          "without landmarks: placements that are fitted, the nearest ones of those by principal axes and as the files have "
          "it; the best fit is kept",
          Range{1, 5});
    visit("observed", observed, "maximum distance between surfaces that lie on each other", Range{0, 1}, "share of the diagonal");
    visit("max-off", max_off,
          "a template does not lie on an object if a larger share of both surfaces (mean of unmatched and unexplained) is off "
          "the other after the fit",
          Range{0, 1});
}

}  // namespace ostraka

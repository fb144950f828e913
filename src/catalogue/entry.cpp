#include "ostraka/catalogue/entry.h"

#include "catalogue/capacity.h"
#include "catalogue/drawing.h"
#include "catalogue/views.h"
#include "ostraka/catalogue/catalogue_axis.h"
#include "ostraka/core/message_text.h"
#include "ostraka/measure/measure.h"
#include "ostraka/measure/solid.h"
#include "ostraka/vocabulary/text_match.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

namespace ostraka {

namespace {

using detail::make_view;
using detail::Pose;

constexpr const char* kind_words[]{
    "whole vessel",          "rim sherd", "base sherd", "wall sherd", "body of revolution", "object",
    "object with landmarks", "unreadable"};

/// Names of descriptive fields (Dublin Core elements and usual fields of museums); other attributes describe the state.
const std::set<std::string>& provenance_names() {
    static const std::set<std::string> names{
        "title",      "creator",  "subject",  "description", "publisher", "contributor", "date",    "type",   "format",
        "identifier", "source",   "language", "relation",    "coverage",  "rights",      "licence", "place",  "provenance",
        "inventory",  "findspot", "site",     "context",     "museum",    "collection",  "owner",   "period", "dating"};
    return names;
}

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
    return text.starts_with("dc:") || text.starts_with("dcterms:") ? text.substr(text.find(':') + 1) : text;
}

std::string attribute_text(const Attribute& attribute) {
    if (const Note* note = attribute.note()) return note->text;
    const Figures figures = attribute_values(attribute);
    if (figures.values.size() != 1) return figures.values.empty() ? "" : counted(figures.values.size(), "value");
    std::string text = digits(figures.values[0], 5) + (figures.unit.empty() ? "" : " " + figures.unit);
    if (const Measure* measure = attribute.measure(); measure != nullptr && measure->uncertainty)
        text += " \u00B1 " + digits(*measure->uncertainty, 2);
    return text + (figures.stale ? " (out of date)" : "");
}

/// Faces of the annotations "fracture".
std::vector<Index> fractures_of(const CatalogueSubject& subject) {
    std::vector<Index> faces;
    if (subject.annotations == nullptr) return faces;
    for (const Annotation& annotation : subject.annotations->annotations)
        if (!annotation.all && lower(annotation.tag) == "fracture")
            faces.insert(faces.end(), annotation.faces.begin(), annotation.faces.end());
    return faces;
}

void add_annotations(CatalogueEntry& entry, const AnnotationSet& set) {
    if (!set.object_class.empty()) entry.state.emplace_back("class", set.object_class);
    for (const Annotation& annotation : set.annotations) {
        if (annotation.all) {
            for (const Attribute& attribute : annotation.attributes) {
                const std::string text = attribute_text(attribute);
                if (text.empty()) continue;
                auto& list = provenance_names().contains(lower(attribute.name)) ? entry.provenance : entry.state;
                list.emplace_back(lower(attribute.name), text);
            }
            for (const Information& information : annotation.information)
                entry.provenance.emplace_back(information.title.empty() ? to_string(information.kind) : information.title,
                                              information.value);
            continue;
        }
        std::vector<std::string> texts;
        for (const Attribute& attribute : annotation.attributes)
            if (const std::string text = attribute_text(attribute); !text.empty()) texts.push_back(attribute.name + " " + text);
        const std::string tag = annotation.tag.empty() ? fmt::format("annotation {}", annotation.id) : annotation.tag;
        entry.annotations.emplace_back(
            tag, fmt::format("{}{}{}", to_string(annotation.type), texts.empty() ? "" : ": ", joined(texts, "; ")));
        if (!annotation.note.empty()) entry.state.emplace_back("note on " + tag, annotation.note);
    }
}

/// Triangles in reversed order if they enclose a negative volume.
bool turn_outside_out(TriangleSoup& soup, const Mesh& mesh) {
    if (!CGAL::is_closed(mesh)) return false;
    const CGAL::Bbox_3 box = bounding_box(mesh);
    const Point middle((box.xmin() + box.xmax()) / 2, (box.ymin() + box.ymax()) / 2, (box.zmin() + box.zmax()) / 2);
    double volume = 0;
    for (const Face face : mesh.faces()) volume += (centroid(mesh, face) - middle) * area_vector(mesh, face);
    if (volume >= 0) return false;
    for (auto& triangle : soup.triangles) std::swap(triangle[1], triangle[2]);
    return true;
}

/// Millimetres of a unit.
double millimetres(CatalogueEntry& entry, const CatalogueSubject& subject, const CatalogueOptions& options) {
    entry.unit = subject.unit.empty() ? options.unit : subject.unit;
    entry.unit_assumed = entry.unit.empty();
    if (entry.unit.empty()) entry.unit = "mm";
    const auto factor = converted(1, entry.unit, "mm");
    if (!factor)
        fail_usage(fmt::format("'{}' is not a unit of length", printable(entry.unit, 40)), "use a unit such as mm, cm or m");
    if (entry.unit_assumed) entry.notes.emplace_back("the unit of the coordinates is not stated: millimetres are assumed");
    return *factor;
}

/// The views of a vessel or sherd beside its drawing.
void add_views_about_axis(CatalogueEntry& entry, const Pose& pose) {
    const double degrees = 180 / 3.141592653589793;
    const double front = entry.diameter.known && pose.all_around ? 0 : pose.range.middle() * degrees + 90;
    std::vector<View> views;
    if (pose.all_around) {
        views = {{"side", 0, 0}, {"from above", 0, 90}, {"from below", 0, -90}};
    } else {
        views = {{"outside", front, 0}, {"inside", front + 180, 0}, {"side", front + 90, 0}};
    }
    for (const View& view : views) entry.views.push_back(make_view(pose.soup, pose.mesh, view, {}));
}

/// The six views of an object without an axis, with its landmarks.
void add_six_views(CatalogueEntry& entry, const TriangleSoup& soup, const Mesh& mesh,
                   const std::vector<std::array<double, 3>>& landmarks, int pixels) {
    std::optional<SurfaceSearch> search;
    if (!landmarks.empty()) search.emplace(mesh);
    for (const View& view : standard_views()) {
        CatalogueView& added = entry.views.emplace_back(make_view(soup, mesh, view, {pixels * 2 / 3, true, true}));
        if (search) detail::mark_landmarks(added, view, *search, landmarks);
    }
    const CatalogueView &front = entry.views[0], &side = entry.views[1];
    entry.height = front.object_high - front.object_low;
    entry.width = front.object_right - front.object_left;
    entry.depth = side.object_right - side.object_left;
}

void set_volumes(CatalogueEntry& entry, const Mesh& mesh, const CatalogueOptions& options) {
    constexpr double cubic_mm_per_cm = 1000, cubic_mm_per_litre = 1e6;
    const double volume = closed_volume(mesh) / cubic_mm_per_cm;
    if (std::isfinite(volume)) entry.volume = volume;
    if (options.density > 0 && std::isfinite(volume)) entry.weight = volume * options.density;
    if (options.density > 0 && !std::isfinite(volume))
        entry.unknown.emplace_back("the weight cannot be told: the surface is not closed");
    if (entry.kind != CatalogueKind::vessel) return;
    const detail::VesselCapacity capacity = detail::capacity_of(mesh);
    if (!std::isfinite(capacity.volume)) {
        entry.unknown.push_back("the capacity is unknown: " + capacity.reason);
        return;
    }
    entry.capacity = capacity.volume / cubic_mm_per_litre;
    if (std::isfinite(capacity.deviation)) entry.capacity_error = 1.96 * capacity.deviation / cubic_mm_per_litre;
}

Vector up_of(const CatalogueSubject& subject) {
    if (subject.annotations == nullptr || !subject.annotations->up) return {0, 0, 1};
    const auto& up = *subject.annotations->up;
    return {up[0], up[1], up[2]};
}

/// An object as it stands: its upward direction along z, in millimetres, its lowest point at height 0 below its middle.
struct Standing {
    TriangleSoup soup;
    std::vector<std::array<double, 3>> landmarks;
};
Standing standing(const CatalogueSubject& subject, const TriangleSoup& soup, double factor) {
    // With y up, the front is the side towards +z, as in pictures.
    const ViewAxes axes = view_axes(
        {"", 0, 0}, parse_up(fmt::format("{:.17g},{:.17g},{:.17g}", up_of(subject).x(), up_of(subject).y(), up_of(subject).z())));
    const auto vector = [](const std::array<double, 3>& a, double sign) { return Vector(sign * a[0], sign * a[1], sign * a[2]); };
    const std::array<Vector, 3> directions{vector(axes.right, 1), vector(axes.toward, -1), vector(axes.up, 1)};
    std::array<double, 3> low{}, high{};
    low.fill(std::numeric_limits<double>::infinity()), high.fill(-std::numeric_limits<double>::infinity());
    for (const auto& triangle : soup.triangles)
        for (const Index i : triangle)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto& p = soup.points[i];
                const double value = directions[k] * Vector(p[0], p[1], p[2]);
                low[k] = std::min(low[k], value), high[k] = std::max(high[k], value);
            }
    const Point origin =
        Point(0, 0, 0) + (low[0] + high[0]) / 2 * directions[0] + (low[1] + high[1]) / 2 * directions[1] + low[2] * directions[2];
    TriangleSoup places;
    for (const auto& [name, place] : subject.landmarks) places.points.push_back(place);
    return {detail::placed(soup, origin, directions, factor), detail::placed(places, origin, directions, factor).points};
}

}  // namespace

std::string to_string(CatalogueKind kind) { return enum_name(kind, kind_words); }

bool CatalogueEntry::has_axis() const {
    return kind != CatalogueKind::object && kind != CatalogueKind::landmarks && kind != CatalogueKind::unreadable;
}

CatalogueEntry catalogue_entry(const CatalogueSubject& subject, const CatalogueOptions& options) {
    if (subject.soup.triangles.empty()) fail_input("mesh", "has no triangles", "give a surface, not points only");
    CatalogueEntry entry;
    entry.name = subject.name;
    entry.vertices = subject.soup.points.size(), entry.faces = subject.soup.triangles.size();
    entry.notes = subject.notes;
    const double factor = millimetres(entry, subject, options);
    if (subject.annotations != nullptr) add_annotations(entry, *subject.annotations);
    TriangleSoup soup = subject.soup;
    Mesh mesh;
    const bool manifold = !try_build_mesh(soup, mesh).any();
    if (manifold && turn_outside_out(soup, mesh)) {
        entry.notes.emplace_back("the mesh is inside out; it was turned");
        mesh = build_mesh(soup);
    }
    for (const auto& [name, place] : subject.landmarks) entry.landmarks.push_back(name);
    if (manifold && subject.landmarks.empty()) {
        const CatalogueAxis axis = catalogue_axis(mesh, fractures_of(subject));
        if (axis.found) {
            const bool hint_known = subject.annotations != nullptr && subject.annotations->up.has_value();
            const Pose pose = detail::pose_of(soup, axis, factor, up_of(subject), hint_known);
            detail::draw_about_axis(entry, pose, axis, factor, options);
            if (options.views) add_views_about_axis(entry, pose);
            set_volumes(entry, pose.mesh, options);
            return entry;
        }
        entry.unknown.push_back("an axis and a diameter cannot be told: " + axis.reason);
    }
    entry.kind = subject.landmarks.empty() ? CatalogueKind::object : CatalogueKind::landmarks;
    if (!manifold)
        entry.notes.emplace_back("the surface is no manifold (ostraka mesh repair): it is shown, but its volume is not known");
    const Standing object = standing(subject, soup, factor);
    const Mesh shown = manifold ? build_mesh(object.soup) : detail::loose_mesh(object.soup);
    add_six_views(entry, object.soup, shown, object.landmarks, options.pixels);
    if (manifold) set_volumes(entry, shown, options);
    return entry;
}

void CatalogueOptions::declare_options(OptionList& list) {
    list("unit", unit, "unit of the coordinates of objects that state none, such as mm; without it millimetres are assumed");
    list("max-error", max_error,
         "largest half width of the 95 % interval of a diameter that is drawn, as a share of the diameter; diameters that are "
         "less "
         "certain are reported as unknown",
         Range{0.001, 10});
    list("density", density, "density of the material, from which the weight is computed; 0: no weight", Range{0, 30}, "g/cm^3");
    list("outside", outside, "outside view of vessels and sherds: shaded with its outline, or lines only",
         Choices{"shaded", "lines"});
    list("pixels", pixels, "pixels along the longer side of the main picture of an object", Range{100, 4000});
}

}  // namespace ostraka

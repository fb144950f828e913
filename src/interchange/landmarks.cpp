#include "ostraka/interchange/landmarks.h"

#include "interchange/landmark_formats.h"
#include "interchange/placing.h"
#include "interchange/text.h"

#include "ostraka/annotation/colouring.h"
#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>

namespace ostraka {

namespace {

using interchange::Placed;
using interchange::Placer;
using std::to_string;

std::array<double, 3> position_of(const Mesh& mesh, Index vertex) {
    const Point& p = mesh.point(Vertex(vertex));
    return {p.x(), p.y(), p.z()};
}

constexpr const char* points_only = " left out: the format stores points only";

Point point_of(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

/// One item of the file with its position on the mesh.
struct Entry {
    std::string name;
    std::string kind;  ///< for messages
    const std::array<double, 3>* position = nullptr;
    Placed placed;
};

/// Whether the file would fit with x and y negated.
bool fits_negated(const Placer& placer, const std::vector<Entry>& entries) {
    double distance_sum = 0, negated_sum = 0;
    const std::size_t step = 1 + entries.size() / 200;
    for (std::size_t i = 0; i < entries.size(); i += step) {
        const auto& p = *entries[i].position;
        distance_sum += entries[i].placed.to_surface;
        negated_sum += placer.place(Point(-p[0], -p[1], p[2])).to_surface;
    }
    return negated_sum < distance_sum / 4;
}

[[noreturn]] void refuse(const Placer& placer, const std::vector<Entry>& entries, const std::vector<Entry>& far, double limit,
                         const std::string& where) {
    const auto worst = std::max_element(far.begin(), far.end(),
                                        [](const Entry& a, const Entry& b) { return a.placed.to_surface < b.placed.to_surface; });
    const std::string remedy =
        fits_negated(placer, entries)
            ? "they would fit with x and y negated: one is in LPS, the other in RAS coordinates; try the other "
              "--mesh-space"
            : "check that mesh and file have the same unit and position, raise --tolerance, or skip them with --skip-far";
    fail_input(where,
               fmt::format("{} of {} farther than {} from the surface; the farthest is {} '{}' at {}",
                           counted(far.size(), "point"), entries.size(), digits(limit), worst->kind,
                           interchange::one_line(worst->name).substr(0, 40), digits(worst->placed.to_surface)),
               remedy);
}

class Assembler {
public:
    Assembler(const Mesh& mesh, const std::string& where) : placer_(mesh), where_(where) {}

    PlacedAnnotations assemble(const LandmarkSet& input, const PlaceOptions& options) {
        std::vector<Entry> entries;
        const auto add = [&](const std::string& name, const char* kind, const std::array<double, 3>& position) {
            interchange::check_position(position, where_);
            entries.push_back({name, kind, &position, placer_.place(point_of(position))});
        };
        for (const Landmark& landmark : input.landmarks) add(landmark.name, "landmark", landmark.position);
        for (const LandmarkCurve& curve : input.curves)
            for (const auto& position : curve.points) add(curve.name, "point of curve", position);
        const double limit = options.tolerance * placer_.diagonal();
        std::vector<Entry> far;
        std::copy_if(entries.begin(), entries.end(), std::back_inserter(far),
                     [&](const Entry& entry) { return entry.placed.to_surface > limit; });
        if (!far.empty() && !options.skip_far) refuse(placer_, entries, far, limit, where_);

        result_.set.unit = input.unit;
        result_.set.notes = input.notes;
        for (const Landmark& landmark : input.landmarks)
            if (landmark.group) used_.insert(*landmark.group);
        for (const LandmarkCurve& curve : input.curves)
            if (curve.group) used_.insert(*curve.group);
        for (std::size_t i = 0; i < input.landmarks.size(); ++i)
            if (entries[i].placed.to_surface <= limit) add_point(input.landmarks[i], entries[i].placed);
        std::size_t index = input.landmarks.size();
        for (const LandmarkCurve& curve : input.curves) {
            std::vector<Placed> places;
            for (std::size_t k = 0; k < curve.points.size(); ++k, ++index)
                if (entries[index].placed.to_surface <= limit) places.push_back(entries[index].placed);
            add_curve(curve, places);
        }
        if (!far.empty())
            result_.set.notes.push_back(fmt::format("{} farther than {} from the surface were skipped as requested: {}",
                                                    counted(far.size(), "point"), digits(limit), names_of(far)));
        return std::move(result_);
    }

private:
    static std::string names_of(const std::vector<Entry>& entries) {
        std::string text;
        for (std::size_t i = 0; i < std::min<std::size_t>(entries.size(), 5); ++i)
            text += fmt::format("{}{}'", i > 0 ? ", '" : "'", interchange::one_line(entries[i].name).substr(0, 40));
        return text + (entries.size() > 5 ? " ..." : "");
    }

    int fresh_id() {
        while (used_.contains(next_)) ++next_;
        used_.insert(next_);
        return next_;
    }

    void begin(std::optional<int> group, const std::string& name, AnnotationType type) {
        Annotation annotation;
        annotation.id = group && !index_of_id_.contains(*group) ? *group : fresh_id();
        annotation.tag = name;
        annotation.type = type;
        annotation.colour = distinct_colour(result_.set.annotations.size());
        index_of_id_.emplace(annotation.id, result_.set.annotations.size());
        result_.placements.push_back({annotation.id, name, 0, 0, 0, "places"});
        result_.set.annotations.push_back(std::move(annotation));
    }

    void count(std::size_t index, const Placed& placed) {
        PlacedAnnotation& placement = result_.placements[index];
        ++placement.points;
        placement.to_surface = std::max(placement.to_surface, placed.to_surface);
        placement.to_vertex = std::max(placement.to_vertex, placed.to_vertex);
    }

    void add_point(const Landmark& landmark, const Placed& placed) {
        const auto existing = landmark.group ? index_of_id_.find(*landmark.group) : index_of_id_.end();
        std::size_t index = result_.set.annotations.size();
        if (existing != index_of_id_.end()) index = existing->second;
        else begin(landmark.group, landmark.name, AnnotationType::point);
        result_.set.annotations[index].points.push_back(placed.vertex);
        count(index, placed);
    }

    void add_curve(const LandmarkCurve& curve, const std::vector<Placed>& places) {
        std::vector<Index> picks;
        for (const Placed& placed : places) picks.push_back(placed.vertex);
        std::vector<Index> vertex_path =
            placer_.vertex_path(picks, curve.closed && picks.size() > 2, fmt::format("{}, curve '{}'", where_, curve.name));
        if (vertex_path.size() < 2) {
            result_.set.notes.push_back(fmt::format("curve '{}' collapsed to a point on this mesh and was left out",
                                                    interchange::one_line(curve.name).substr(0, 40)));
            return;
        }
        const auto existing = curve.group ? index_of_id_.find(*curve.group) : index_of_id_.end();
        const bool joined =
            existing != index_of_id_.end() && result_.set.annotations[existing->second].type == AnnotationType::line;
        const std::size_t index = joined ? existing->second : result_.set.annotations.size();
        if (!joined) begin(curve.group, curve.name, AnnotationType::line);
        result_.set.annotations[index].polylines.push_back(std::move(vertex_path));
        for (const Placed& placed : places) count(index, placed);
    }

    Placer placer_;
    const std::string& where_;
    PlacedAnnotations result_;
    std::map<int, std::size_t> index_of_id_;  ///< ids -> positions in the set
    std::set<int> used_;                      ///< ids in use
    int next_ = 0;
};

}  // namespace

LandmarkSet landmarks_from_text(const std::string& bytes, LandmarkFormat format, const std::string& where,
                                const LandmarkFileOptions& options) {
    check_options(options, "landmarks");
    if (format == LandmarkFormat::tps) return interchange::read_tps(bytes, where, options);
    if (format == LandmarkFormat::pp) return interchange::read_picked_points(bytes, where);
    if (format == LandmarkFormat::mrk) return interchange::read_markups(bytes, where, options);
    if (format == LandmarkFormat::fcsv) return interchange::read_fcsv(bytes, where, options);
    return interchange::read_landmark_table(bytes, where, options);
}

LandmarkSet read_landmarks(const Path& file, LandmarkFormat format, const LandmarkFileOptions& options) {
    return landmarks_from_text(read_file(file), format, file.string(), options);
}

std::string landmarks_to_text(const LandmarkSet& set, LandmarkFormat format, const std::string& mesh_file,
                              const Provenance& provenance, std::vector<std::string>& notes, const LandmarkFileOptions& options) {
    check_options(options, "landmarks");
    if (format != LandmarkFormat::mrk && !set.curves.empty())
        notes.push_back(counted(set.curves.size(), "poly-line") + points_only);
    if (format == LandmarkFormat::tps) return interchange::write_tps(set, mesh_file);
    if (format == LandmarkFormat::pp) return interchange::write_picked_points(set, mesh_file, notes);
    if (format == LandmarkFormat::mrk) return interchange::write_markups(set, options, provenance);
    if (format == LandmarkFormat::fcsv) return interchange::write_fcsv(set, options, notes);
    return interchange::write_landmark_table(set);
}

LandmarkSet landmarks_of(AnnotatedMeshView object, LandmarkFormat format) {
    LandmarkSet result;
    result.unit = object.annotations.unit;
    std::size_t regions = 0, polylines = 0, attributes = 0;
    for (const Annotation& annotation : object.annotations.annotations) {
        if (annotation.type == AnnotationType::region) {
            ++regions;
            continue;
        }
        if (annotation.type == AnnotationType::line && format != LandmarkFormat::mrk) {
            polylines += annotation.polylines.size();
            continue;
        }
        attributes += annotation.attributes.size();
        for (std::size_t i = 0; i < annotation.points.size(); ++i)
            result.landmarks.push_back(
                {annotation.points.size() == 1 ? annotation.tag : fmt::format("{} {}", annotation.tag, i + 1),
                 position_of(object.mesh, annotation.points[i]), annotation.id});
        for (const auto& polyline : annotation.polylines) {
            LandmarkCurve curve{annotation.tag, polyline.size() > 3 && polyline.front() == polyline.back(), {}, annotation.id};
            for (std::size_t k = 0; k < polyline.size() - (curve.closed ? 1 : 0); ++k)
                curve.points.push_back(position_of(object.mesh, polyline[k]));
            result.curves.push_back(std::move(curve));
        }
    }
    if (regions > 0) result.notes.push_back(counted(regions, "region") + " left out: landmark files store no regions");
    if (polylines > 0) result.notes.push_back(counted(polylines, "poly-line") + points_only);
    if (attributes > 0)
        result.notes.push_back(counted(attributes, "attribute") + " left out: landmark files cannot store attributes");
    return result;
}

PlacedAnnotations place_landmarks(const Mesh& mesh, const LandmarkSet& landmarks, const std::string& where,
                                  const PlaceOptions& options) {
    check_options(options, "place landmarks");
    return Assembler(mesh, where).assemble(landmarks, options);
}

void LandmarkFileOptions::declare_options(OptionList& list) {
    list("mesh-space", mesh_space,
         "anatomical coordinate system of the mesh, for file formats that state their coordinate system: LPS (x to the left, y "
         "to the back; 3D Slicer since 4.11) or RAS (x to the right, y to the front; older versions)",
         Choices{"LPS", "RAS"});
    list("specimen", specimen, "specimen of a TPS file that has several: the ID, or the number from 1", Anything{});
}

void PlaceOptions::declare_options(OptionList& list) {
    list("tolerance", tolerance, "maximum distance of a point of the file from the mesh surface", Range{0, 1},
         "share of the box diagonal");
    list("skip-far", skip_far, "skip points farther away than --tolerance, with a note, instead of refusing the file",
         Anything{});
}

}  // namespace ostraka

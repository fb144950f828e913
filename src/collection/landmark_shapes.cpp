#include "ostraka/collection/landmark_shapes.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/files/csv.h"
#include "ostraka/files/json_build.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/interchange/interchange.h"
#include "ostraka/io/mesh_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <memory>
#include <set>

namespace ostraka {

namespace {

/// Points at equal distances along a curve.
std::vector<std::array<double, 3>> resampled(const std::vector<std::array<double, 3>>& points, bool closed, std::size_t count) {
    std::vector<Eigen::Vector3d> places;
    for (const auto& p : points) places.emplace_back(p[0], p[1], p[2]);
    if (closed) places.push_back(places.front());
    std::vector<double> lengths{0};
    for (std::size_t i = 1; i < places.size(); ++i) lengths.push_back(lengths.back() + (places[i] - places[i - 1]).norm());
    std::vector<std::array<double, 3>> result;
    std::size_t segment = 1;
    for (std::size_t i = 0; i < count; ++i) {
        const double at =
            lengths.back() * static_cast<double>(i) / static_cast<double>(closed ? count : std::max<std::size_t>(1, count - 1));
        while (segment + 1 < places.size() && lengths[segment] < at) ++segment;
        const double length = lengths[segment] - lengths[segment - 1];
        const double share = length > 0 ? std::clamp((at - lengths[segment - 1]) / length, 0.0, 1.0) : 0;
        const Eigen::Vector3d p = places[segment - 1] + share * (places[segment] - places[segment - 1]);
        result.push_back({p.x(), p.y(), p.z()});
    }
    return result;
}

/// Replaces the points of each complete curve by `count` points at equal distances.
void resample_curves(LandmarkSpecimen& specimen, std::size_t count) {
    LandmarkSpecimen result;
    result.name = specimen.name;
    result.properties = specimen.properties;
    std::set<std::size_t> on_curves;
    for (const SpecimenCurve& curve : specimen.curves) on_curves.insert(curve.points.begin(), curve.points.end());
    for (std::size_t k = 0; k < specimen.positions.size(); ++k)
        if (!on_curves.contains(k)) {
            result.landmarks.push_back(specimen.landmarks[k]);
            result.positions.push_back(specimen.positions[k]);
        }
    for (const SpecimenCurve& curve : specimen.curves) {
        std::vector<std::array<double, 3>> points;
        for (const std::size_t k : curve.points)
            if (specimen.positions[k]) points.push_back(*specimen.positions[k]);
        if (points.size() < 2 || points.size() < curve.points.size()) continue;
        SpecimenCurve replaced{curve.name, curve.closed, {}};
        for (const auto& position : resampled(points, curve.closed, count)) {
            replaced.points.push_back(result.positions.size());
            result.landmarks.push_back(fmt::format("{} point {}", curve.name, replaced.points.size()));
            result.positions.emplace_back(position);
        }
        result.curves.push_back(std::move(replaced));
    }
    specimen = std::move(result);
}

/// Points of annotations as landmarks of one specimen.
LandmarkSpecimens from_annotations(AnnotatedMeshView object) {
    LandmarkSpecimens result = one_specimen(landmarks_of(object, LandmarkFormat::csv));
    result.notes.clear();  // on annotations that are not points
    return result;
}

LandmarkSpecimens specimens_of(const CollectionObject& object, const LandmarkReading& reading) {
    if (!object.landmarks.empty() && is_specimen_file(object.landmarks))
        return read_specimens(object.landmarks, reading.specimens);
    if (!object.landmarks.empty() && !object.mesh.empty()) {
        const Mesh mesh = read_mesh(object.mesh).mesh;
        const std::string bytes = read_file(object.landmarks);
        const PlacedAnnotations placed =
            import_annotations(mesh, bytes, guess_interchange_format(object.landmarks, bytes), object.landmarks.string());
        return from_annotations({mesh, placed.set});
    }
    if (object.landmarks.empty() && !object.mesh.empty() && !object.annotations.empty()) {
        const Mesh mesh = read_mesh(object.mesh).mesh;
        const AnnotationSet set = read_annotations(object.annotations, mesh);
        LandmarkSpecimens result = from_annotations({mesh, set});
        if (!result.specimens.front().positions.empty()) return result;
    }
    fail_input(object.name, "the object has no landmarks",
               "put NAME.mrk.json (or another landmark file) next to the mesh, or point annotations into NAME.ant.json");
}

Json landmarks_json(const CollectionObject& object, const LandmarkReading& reading) {
    LandmarkSpecimens set = specimens_of(object, reading);
    const std::string where = object.landmarks.empty() ? object.name : object.landmarks.string();
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    JsonValue specimens(rapidjson::kArrayType);
    for (LandmarkSpecimen& specimen : set.specimens) {
        if (reading.curve_points > 0) resample_curves(specimen, static_cast<std::size_t>(reading.curve_points));
        JsonValue names(rapidjson::kArrayType), places(rapidjson::kArrayType), curves(rapidjson::kArrayType),
            properties(rapidjson::kObjectType);
        std::set<std::string> names_found;
        for (std::size_t k = 0; k < specimen.landmarks.size(); ++k) {
            if (!names_found.insert(specimen.landmarks[k]).second)
                fail_input(where, fmt::format("two landmarks are called '{}'", specimen.landmarks[k]),
                           "give each landmark its own name");
            names.PushBack(json_string(specimen.landmarks[k], allocator), allocator);
            for (std::size_t c = 0; c < 3; ++c) {
                if (specimen.positions[k]) places.PushBack((*specimen.positions[k])[c], allocator);
                else places.PushBack(JsonValue(rapidjson::kNullType), allocator);
            }
        }
        for (const SpecimenCurve& curve : specimen.curves)
            curves.PushBack(
                json_object(allocator, "name", curve.name, "closed", curve.closed, "points",
                            json_list(curve.points, allocator, [](std::size_t k) { return static_cast<std::uint64_t>(k); })),
                allocator);
        for (const auto& [key, value] : specimen.properties) add_member(properties, key, value, allocator);
        specimens.PushBack(
            json_object(allocator, "name", set.specimens.size() == 1 ? object.name : specimen.name, "names", std::move(names),
                        "places", std::move(places), "curves", std::move(curves), "properties", std::move(properties)),
            allocator);
    }
    add_members(document, allocator, "unit", set.unit, "dimension", set.dimension, "notes",
                json_list(set.notes, allocator, [](const std::string& note) { return note; }), "specimens", std::move(specimens));
    return document;
}

/// The data that can be read of one specimen.
struct ReadObject {
    const CollectionObject* object = nullptr;
    std::size_t source = 0;  ///< index of the object
    std::string name;
    std::map<std::string, std::array<double, 3>> places;  ///< without missing landmarks
    std::vector<std::string> order;                       ///< with missing landmarks
    std::vector<SpecimenCurve> curves;
    std::map<std::string, std::string> properties;
    std::string unit;
    int dimension = 3;
};

std::vector<ReadObject> readable(const Collection& collection, const std::vector<ObjectResult>& read,
                                 std::vector<std::string>& notes) {
    std::vector<ReadObject> read_objects;
    std::set<std::string> used;
    for (std::size_t i = 0; i < read.size(); ++i) {
        if (!read[i].problem.empty() || read[i].elsewhere) continue;
        const Json& landmark_data = read[i].result;
        const CollectionObject& source = collection.objects[i];
        for (const auto& note : landmark_data["notes"].GetArray()) notes.push_back(source.name + ": " + note.GetString());
        for (const auto& specimen : landmark_data["specimens"].GetArray()) {
            ReadObject& object = read_objects.emplace_back();
            object.object = &source;
            object.source = i;
            object.name = specimen["name"].GetString();
            if (used.contains(object.name)) object.name = source.name + " " + object.name;
            used.insert(object.name);
            object.unit = source.unit.empty() ? landmark_data["unit"].GetString() : source.unit;
            object.dimension = landmark_data["dimension"].GetInt();
            for (rapidjson::SizeType k = 0; k < specimen["names"].Size(); ++k) {
                object.order.emplace_back(specimen["names"][k].GetString());
                const auto& places = specimen["places"];
                if (places[3 * k].IsNull()) continue;
                for (rapidjson::SizeType c = 0; c < 3; ++c)
                    object.places[object.order.back()].at(c) = places[3 * k + c].GetDouble();
            }
            for (const auto& curve : specimen["curves"].GetArray()) {
                SpecimenCurve& copy = object.curves.emplace_back();
                copy.name = curve["name"].GetString();
                copy.closed = curve["closed"].GetBool();
                for (const auto& k : curve["points"].GetArray()) copy.points.push_back(k.GetUint64());
            }
            for (const auto& property : specimen["properties"].GetObject())
                object.properties[property.name.GetString()] = property.value.GetString();
        }
    }
    return read_objects;
}

/// Moves objects for which `reason_of` returns a reason to the outliers.
template <class ReasonOf>
void move_outliers(std::vector<ReadObject>& objects, std::vector<ShapeOutlier>& outliers, const char* cause,
                   ReasonOf&& reason_of) {
    std::vector<ReadObject> kept;
    for (ReadObject& object : objects) {
        if (std::string reason = reason_of(object); !reason.empty())
            outliers.push_back({object.name, std::move(reason), true, cause, {}, {}, {}});
        else kept.push_back(std::move(object));
    }
    objects = std::move(kept);
}

void move_incomplete(std::vector<ReadObject>& objects, std::vector<ShapeOutlier>& outliers) {
    std::map<std::string, std::size_t> counts;
    for (const ReadObject& object : objects)
        for (const auto& [name, place] : object.places) ++counts[name];
    std::set<std::string> usual_names;
    for (const auto& [name, count] : counts)
        if (2 * count >= objects.size()) usual_names.insert(name);
    move_outliers(objects, outliers, "incomplete", [&](const ReadObject& object) -> std::string {
        const auto present =
            static_cast<std::size_t>(std::count_if(object.places.begin(), object.places.end(), [&](const auto& name_and_place) {
                return usual_names.count(name_and_place.first) > 0;
            }));
        if (2 * present >= usual_names.size()) return {};
        return fmt::format(
            "it has {} of the {} landmarks that at least half of the objects have; add the missing landmarks, or use the common "
            "names",
            present, usual_names.size());
    });
}

void move_other_units(std::vector<ReadObject>& objects, std::vector<ShapeOutlier>& outliers) {
    std::map<std::string, std::size_t> counts;
    for (const ReadObject& object : objects) ++counts[object.unit];
    const auto usual_unit =
        std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    if (usual_unit == counts.end() || 2 * usual_unit->second <= objects.size()) return;
    const auto unit_words = [](const std::string& unit) { return unit.empty() ? std::string("an unstated unit") : unit; };
    move_outliers(objects, outliers, "unit", [&](const ReadObject& object) -> std::string {
        if (object.unit == usual_unit->first) return {};
        return fmt::format("its landmarks are in {}, those of most objects in {}; convert them to that unit, or use --scaling",
                           unit_words(object.unit), unit_words(usual_unit->first));
    });
}

/// Landmarks in the order in which specimens have them first; `missing`: without those that fewer than half of the specimens
/// have.
std::vector<std::string> usual_landmarks(const std::vector<ReadObject>& objects, bool estimated,
                                         std::vector<std::string>& notes) {
    std::map<std::string, std::size_t> counts;
    std::vector<std::string> order, kept, rare;
    for (const ReadObject& object : objects)
        for (const std::string& name : object.order) {
            const auto [entry, is_new] = counts.try_emplace(name, 0);
            if (is_new) order.push_back(name);
            entry->second += object.places.contains(name) ? 1 : 0;
        }
    if (!estimated) return order;
    for (const std::string& name : order) (2 * counts.at(name) >= objects.size() ? kept : rare).push_back(name);
    if (!rare.empty())
        notes.push_back(
            fmt::format("landmarks that fewer than half of the specimens have are left out: '{}'", joined(rare, "', '")));
    return kept;
}

/// Curves of the first specimen that all other specimens have with the same landmarks, all of which were kept.
std::vector<SpecimenCurve> common_curves(const std::vector<ReadObject>& objects, const std::vector<std::string>& names) {
    std::map<std::string, std::size_t> index;
    for (std::size_t k = 0; k < names.size(); ++k) index.emplace(names[k], k);
    const auto names_on = [](const ReadObject& object, const SpecimenCurve& curve) {
        std::vector<std::string> result;
        for (const std::size_t k : curve.points) result.push_back(object.order[k]);
        return result;
    };
    std::vector<SpecimenCurve> result;
    for (const SpecimenCurve& curve : objects.front().curves) {
        const std::vector<std::string> landmarks = names_on(objects.front(), curve);
        const bool common = std::all_of(objects.begin(), objects.end(), [&](const ReadObject& object) {
            return std::any_of(object.curves.begin(), object.curves.end(), [&](const SpecimenCurve& other) {
                return other.name == curve.name && names_on(object, other) == landmarks;
            });
        });
        SpecimenCurve kept{curve.name, curve.closed, {}};
        for (const std::string& landmark : landmarks)
            if (const auto entry = index.find(landmark); entry != index.end()) kept.points.push_back(entry->second);
        if (common && kept.points.size() == landmarks.size()) result.push_back(std::move(kept));
    }
    return result;
}

}  // namespace

std::vector<ObjectResult> read_object_landmarks(const Collection& collection, const ResultStore& store,
                                                const LandmarkReading& reading) {
    check_options(reading, "landmarks");
    return for_each_object(collection, store, {"landmarks of specimens", options_text(reading)},
                           [&](const CollectionObject& object) { return landmarks_json(object, reading); });
}

std::size_t landmark_index(const std::vector<std::string>& landmarks, const std::string& name_or_number) {
    if (const auto place = std::find(landmarks.begin(), landmarks.end(), name_or_number); place != landmarks.end())
        return static_cast<std::size_t>(place - landmarks.begin());
    if (const auto number = parse_int(name_or_number);
        number && *number >= 1 && static_cast<std::size_t>(*number) <= landmarks.size())
        return static_cast<std::size_t>(*number) - 1;
    fail_usage(fmt::format("there is no landmark '{}'", printable(name_or_number, 60)),
               fmt::format("give a name, or a number from 1 to {}; the first is '{}'", landmarks.size(),
                           landmarks.empty() ? std::string() : printable(landmarks.front(), 60)));
}

LandmarkPairs landmark_pairs(const std::vector<std::string>& landmarks, const std::vector<std::array<std::string, 2>>& pairs) {
    if (pairs.empty()) return pairs_by_name(landmarks);
    LandmarkPairs result;
    for (const auto& [a, b] : pairs) result.pairs.push_back({landmark_index(landmarks, a), landmark_index(landmarks, b)});
    return result;
}

LandmarkShapes common_landmarks(const Collection& collection, const std::vector<ObjectResult>& read, bool scaling,
                                const std::string& where) {
    CommonLandmarks options;
    options.scaling = scaling;
    return common_landmarks(collection, read, options, where);
}

LandmarkShapes common_landmarks(const Collection& collection, const std::vector<ObjectResult>& read,
                                const CommonLandmarks& options, const std::string& where) {
    LandmarkShapes shapes;
    std::vector<ReadObject> objects = readable(collection, read, shapes.notes);
    if (objects.empty())
        fail_input(where, "the landmarks of no object could be read", "the first error: " + read.front().problem);
    move_incomplete(objects, shapes.odd);
    if (!options.scaling) move_other_units(objects, shapes.odd);
    std::set<std::string> units;
    shapes.dimension = objects.front().dimension;
    for (const ReadObject& object : objects) {
        if (object.dimension != shapes.dimension)
            fail_input(where,
                       fmt::format("'{}' has landmarks in {} dimensions, '{}' in {}", objects.front().name, shapes.dimension,
                                   object.name, object.dimension),
                       "put them into separate collections");
        units.insert(object.unit);
    }
    if (!options.scaling && units.size() > 1)
        fail_input(where, "the landmarks have different units", "use --scaling, or convert them to one unit");
    if (units.size() == 1) shapes.unit = *units.begin();
    ShapeSample sample;
    sample.dimension = shapes.dimension;
    sample.landmarks = usual_landmarks(objects, options.missing != MissingMethod::leave_out, shapes.notes);
    for (const ReadObject& object : objects) {
        sample.specimens.push_back(object.name);
        Landmarks x(static_cast<Eigen::Index>(sample.landmarks.size()), 3);
        for (std::size_t k = 0; k < sample.landmarks.size(); ++k) {
            const auto place = object.places.find(sample.landmarks[k]);
            for (std::size_t c = 0; c < 3; ++c)
                x(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c)) =
                    place == object.places.end() ? std::numeric_limits<double>::quiet_NaN() : place->second.at(c);
        }
        sample.configurations.push_back(std::move(x));
        shapes.labels.push_back(object.object->label);
        shapes.sources.push_back(object.source);
        shapes.properties.push_back(object.properties);
    }
    const CompletedSample completed =
        complete_landmarks(sample, options.missing, landmark_pairs(sample.landmarks, options.pairs));
    std::vector<std::string> left_out;
    for (const MissingLandmark& missing : completed.missing) {
        shapes.missing.push_back({sample.specimens[missing.specimen], sample.landmarks[missing.landmark], missing.how});
        const std::string& name = sample.landmarks[missing.landmark];
        if (missing.how == "left out" && std::find(left_out.begin(), left_out.end(), name) == left_out.end())
            left_out.push_back(name);
    }
    std::sort(left_out.begin(), left_out.end(), [&](const std::string& a, const std::string& b) {
        return std::find(sample.landmarks.begin(), sample.landmarks.end(), a) <
               std::find(sample.landmarks.begin(), sample.landmarks.end(), b);
    });
    if (!left_out.empty())
        shapes.notes.push_back(fmt::format("landmarks that some objects lack are left out: '{}'", joined(left_out, "', '")));
    shapes.objects = completed.sample.specimens;
    shapes.names = completed.sample.landmarks;
    shapes.configurations = completed.sample.configurations;
    shapes.curves = common_curves(objects, shapes.names);
    return shapes;
}

namespace {

/// The message about a doubtful specimen; `names`: names of all landmarks.
ShapeOutlier outlier_of(const Doubt& doubt, const LandmarkShapes& shapes, const std::vector<std::string>& names) {
    ShapeOutlier outlier;
    outlier.name = shapes.objects[doubt.specimen];
    outlier.distance = doubt.distance;
    for (const std::size_t k : doubt.landmarks) outlier.landmarks.push_back(names[k]);
    const std::string distances = fmt::format("at distance {} from the mean of the others (outliers begin at {})",
                                              digits(doubt.distance, 3), digits(doubt.limit, 3));
    if (doubt.cause != DoubtCause::unexplained) outlier.corrected = doubt.corrected;
    const std::string afterwards = fmt::format(", and at {} ", digits(doubt.corrected, 3));
    if (doubt.cause == DoubtCause::exchanged) {
        outlier.cause = "exchanged";
        outlier.why = fmt::format("landmarks '{}' and '{}' seem to be exchanged: it is {}{}after they are exchanged back",
                                  outlier.landmarks[0], outlier.landmarks[1], distances, afterwards);
    } else if (doubt.cause == DoubtCause::displaced) {
        outlier.cause = "displaced";
        outlier.why = fmt::format("landmark '{}' seems to be in the wrong place: it is {}{}without this landmark",
                                  outlier.landmarks[0], distances, afterwards);
    } else if (doubt.cause == DoubtCause::mirrored) {
        outlier.cause = "mirrored";
        outlier.why =
            "its mirror image is closer to the mean of the others than the object itself: are its landmarks mirrored, or "
            "left and right exchanged?";
    } else {
        outlier.cause = "outlier";
        outlier.why =
            fmt::format("it is an outlier, {}; neither one exchange of landmarks nor one wrong landmark explains it", distances);
    }
    return outlier;
}

/// Specimens mirrored, or of another size.
std::vector<ShapeOutlier> mirrored_or_sized(const LandmarkShapes& shapes) {
    constexpr double times = 3, nearer = 0.5;
    std::vector<ShapeOutlier> outliers;
    const std::size_t n = shapes.configurations.size();
    std::vector<double> sizes;
    for (const Landmarks& configuration : shapes.configurations) sizes.push_back(centroid_size(configuration));
    std::vector<double> sorted = sizes;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(n / 2), sorted.end());
    const double median = sorted[n / 2];
    const ProcrustesOptions options = shapes.sample().procrustes_options();
    const GeneralisedProcrustes aligned = generalised_procrustes(shapes.configurations, options);
    for (std::size_t i = 0; i < n; ++i) {
        ShapeOutlier outlier{shapes.objects[i], {}, false, {}, {}, {}, {}};
        if (const double ratio = sizes[i] / median; ratio > times || ratio * times < 1) {
            outlier.why = fmt::format("it is {} times as large as the median: is it in another unit?", digits(ratio, 3));
            outlier.cause = "size";
        }
        // The mean without the tested object, so that it does not affect its own test.
        const Landmarks others_mean = static_cast<double>(n) * aligned.mean - aligned.aligned[i];
        Landmarks mirror = shapes.configurations[i];
        mirror.col(0) *= -1;
        const double own_residual = procrustes(shapes.configurations[i], others_mean, options).sum_of_squares,
                     mirrored = procrustes(mirror, others_mean, options).sum_of_squares;
        if (mirrored < nearer * nearer * own_residual && own_residual > 1e-6 * others_mean.squaredNorm()) {
            outlier.why += std::string(outlier.why.empty() ? "" : "; ") +
                           "its mirror image is closer to the mean of the others than the object itself: are its landmarks "
                           "mirrored, or left and right exchanged?";
            outlier.cause = "mirrored";
        }
        if (!outlier.why.empty()) outliers.push_back(std::move(outlier));
    }
    return outliers;
}

}  // namespace

std::vector<ShapeOutlier> shape_outliers(const LandmarkShapes& shapes, const std::vector<std::size_t>& sliding) {
    if (shapes.configurations.size() < 3) return {};
    std::vector<ShapeOutlier> outliers = mirrored_or_sized(shapes);
    std::vector<std::size_t> fixed;
    const std::set<std::size_t> slides(sliding.begin(), sliding.end());
    for (std::size_t k = 0; k < shapes.names.size(); ++k)
        if (!slides.contains(k)) fixed.push_back(k);
    if (fixed.size() < 3) return outliers;
    ShapeSample sample{shapes.dimension, {}, shapes.objects, {}};
    for (const std::size_t k : fixed) sample.landmarks.push_back(shapes.names[k]);
    for (const Landmarks& configuration : shapes.configurations) sample.configurations.push_back(rows_of(configuration, fixed));
    for (const Doubt& doubt : doubtful_specimens(sample)) {
        ShapeOutlier found = outlier_of(doubt, shapes, sample.landmarks);
        const auto known =
            std::find_if(outliers.begin(), outliers.end(), [&](const ShapeOutlier& o) { return o.name == found.name; });
        if (known == outliers.end()) {
            outliers.push_back(std::move(found));
            continue;
        }
        known->distance = found.distance;
        if (found.cause == "mirrored" || found.cause == known->cause) known->corrected = found.corrected;
        if (found.cause == "outlier" || found.cause == "mirrored" || known->cause == "mirrored") continue;
        known->why += "; " + found.why;
        known->landmarks = found.landmarks;
        known->corrected = found.corrected;
    }
    std::stable_sort(outliers.begin(), outliers.end(), [&](const ShapeOutlier& a, const ShapeOutlier& b) {
        const auto place = [&](const ShapeOutlier& o) { return std::find(shapes.objects.begin(), shapes.objects.end(), o.name); };
        return place(a) < place(b);
    });
    return outliers;
}

LandmarkShapes without(const LandmarkShapes& shapes, const std::vector<ShapeOutlier>& outliers) {
    LandmarkShapes kept = shapes;
    kept.objects.clear();
    kept.labels.clear();
    kept.configurations.clear();
    kept.sources.clear();
    kept.properties.clear();
    for (std::size_t i = 0; i < shapes.objects.size(); ++i) {
        if (std::any_of(outliers.begin(), outliers.end(), [&](const auto& outlier) { return outlier.name == shapes.objects[i]; }))
            continue;
        kept.objects.push_back(shapes.objects[i]);
        kept.labels.push_back(shapes.labels[i]);
        kept.configurations.push_back(shapes.configurations[i]);
        if (i < shapes.sources.size()) kept.sources.push_back(shapes.sources[i]);
        if (i < shapes.properties.size()) kept.properties.push_back(shapes.properties[i]);
    }
    return kept;
}

SemiLandmarks semi_landmarks(const LandmarkShapes& shapes, const std::string& sliders_table, const std::string& where,
                             bool slide_curves, const std::vector<std::string>& surface) {
    SemiLandmarks semi;
    if (!sliders_table.empty()) {
        const auto rows = csv_rows(sliders_table, csv_separator(sliders_table), where);
        for (std::size_t r = 0; r < rows.size(); ++r) {
            std::vector<std::string> cells;
            for (const std::string& cell : rows[r].cells) cells.push_back(unescape_formula(std::string(trimmed(cell))));
            if (cells.size() == 1) {  // columns separated by blanks
                const auto words = split_words(rows[r].cells.front());
                cells.assign(words.begin(), words.end());
            }
            if (cells.size() == 4) cells.erase(cells.begin());  // row names, as R writes them
            if (r == 0 && !cells.empty() && lower_case(cells.front()) == "before") continue;
            if (cells.size() != 3)
                fail_input(fmt::format("{}, line {}", where, rows[r].line), fmt::format("has {} cells", cells.size()),
                           "give three landmarks in each row: before, slide, after");
            semi.curves.push_back({landmark_index(shapes.names, cells[0]), landmark_index(shapes.names, cells[1]),
                                   landmark_index(shapes.names, cells[2])});
        }
    }
    if (slide_curves)
        for (const SpecimenCurve& curve : shapes.curves) {
            const std::size_t n = curve.points.size();
            for (std::size_t i = 1; i < n; ++i)
                if (i + 1 < n || curve.closed)
                    semi.curves.push_back({curve.points[i - 1], curve.points[i], curve.points[(i + 1) % n]});
        }
    for (const std::string& text : surface)
        for (const std::string_view word : split_words(text, ",; ")) {
            const std::size_t dash = word.find('-', 1);
            const auto first = dash == std::string_view::npos ? std::nullopt : parse_int(word.substr(0, dash)),
                       last = dash == std::string_view::npos ? std::nullopt : parse_int(word.substr(dash + 1));
            if (!first || !last) {
                semi.surface.push_back(landmark_index(shapes.names, std::string(word)));
                continue;
            }
            for (int k = *first; k <= *last; ++k) semi.surface.push_back(landmark_index(shapes.names, std::to_string(k)));
        }
    return semi;
}

SurfaceOfSpecimen specimen_surfaces(const Collection& collection, const LandmarkShapes& shapes, std::vector<std::string>& notes) {
    std::vector<std::string> bare;
    for (std::size_t i = 0; i < shapes.objects.size(); ++i) {
        const bool shared = std::count(shapes.sources.begin(), shapes.sources.end(), shapes.sources[i]) > 1;
        if (shared || collection.objects[shapes.sources[i]].mesh.empty()) bare.push_back(shapes.objects[i]);
    }
    if (!bare.empty()) {
        notes.push_back(fmt::format("{} of {} specimens have no mesh: tangent planes are fitted to neighbouring landmarks",
                                    bare.size(), shapes.objects.size()));
        return {};
    }
    struct Surface {
        explicit Surface(Mesh read) : mesh(std::move(read)), search(mesh) {}
        Mesh mesh;
        SurfaceSearch search;
    };
    auto surfaces = std::make_shared<std::vector<std::unique_ptr<Surface>>>();
    for (const std::size_t source : shapes.sources)
        surfaces->push_back(std::make_unique<Surface>(read_mesh(collection.objects[source].mesh).mesh));
    return [surfaces](std::size_t specimen, const Eigen::RowVector3d& point) {
        const SurfaceSearch& search = (*surfaces)[specimen]->search;
        const SurfaceHit hit = search.closest({point.x(), point.y(), point.z()});
        const Vector normal = search.normal(hit.face);
        return OrientedPoint{{hit.point.x(), hit.point.y(), hit.point.z()}, {normal.x(), normal.y(), normal.z()}};
    };
}

void LandmarkReading::declare_options(OptionList& list) {
    specimens.declare_options(list);
    list("curve-points", curve_points,
         "resample each curve of the landmark files to this number of points at equal distances; 0: "
         "as in the file",
         Range{0, 10000});
}

}  // namespace ostraka

#include "ostraka/collection/landmark_shapes.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/files/json_build.h"
#include "ostraka/interchange/landmarks.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace ostraka {

namespace {

Json landmarks_json(const CollectionObject& object) {
    if (object.landmarks.empty()) fail_input(object.name, "the object has no landmarks", "put NAME.mrk.json next to the mesh");
    const LandmarkSet set = read_landmarks(object.landmarks, LandmarkFormat::mrk);
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    JsonValue names(rapidjson::kArrayType), places(rapidjson::kArrayType);
    std::set<std::string> names_found;
    for (const Landmark& landmark : set.landmarks) {
        if (!names_found.insert(landmark.name).second)
            fail_input(object.landmarks.string(), fmt::format("two landmarks are called '{}'", landmark.name),
                       "give each landmark its own name");
        names.PushBack(json_string(landmark.name, allocator), allocator);
        for (const double c : landmark.position) places.PushBack(c, allocator);
    }
    add_members(document, allocator, "unit", set.unit, "names", std::move(names), "places", std::move(places));
    return document;
}

/// The data that can be read of one object.
struct ReadObject {
    const CollectionObject* object = nullptr;
    std::map<std::string, std::array<double, 3>> places;
    std::vector<std::string> order;
    std::string unit;
};

std::vector<ReadObject> readable(const Collection& collection, const std::vector<ObjectResult>& read) {
    std::vector<ReadObject> read_objects;
    for (std::size_t i = 0; i < read.size(); ++i) {
        if (!read[i].problem.empty()) continue;
        const Json& landmark_data = read[i].result;
        ReadObject& object = read_objects.emplace_back();
        object.object = &collection.objects[i];
        object.unit = object.object->unit.empty() ? landmark_data["unit"].GetString() : object.object->unit;
        for (rapidjson::SizeType k = 0; k < landmark_data["names"].Size(); ++k) {
            object.order.emplace_back(landmark_data["names"][k].GetString());
            for (rapidjson::SizeType c = 0; c < 3; ++c)
                object.places[object.order.back()].at(c) = landmark_data["places"][3 * k + c].GetDouble();
        }
    }
    return read_objects;
}

/// Moves objects for which `reason_of` returns a reason to the outliers.
template <class ReasonOf>
void move_outliers(std::vector<ReadObject>& objects, std::vector<ShapeOutlier>& outliers, ReasonOf&& reason_of) {
    std::vector<ReadObject> kept;
    for (ReadObject& object : objects) {
        if (std::string reason = reason_of(object); !reason.empty())
            outliers.push_back({object.object->name, std::move(reason), true});
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
    move_outliers(objects, outliers, [&](const ReadObject& object) -> std::string {
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
    move_outliers(objects, outliers, [&](const ReadObject& object) -> std::string {
        if (object.unit == usual_unit->first) return {};
        return fmt::format("its landmarks are in {}, those of most objects in {}; convert them to that unit, or use --scaling",
                           unit_words(object.unit), unit_words(usual_unit->first));
    });
}

}  // namespace

std::vector<ObjectResult> read_object_landmarks(const Collection& collection, const ResultStore& store) {
    return for_each_object(collection, store, {"landmarks"}, landmarks_json);
}

LandmarkShapes common_landmarks(const Collection& collection, const std::vector<ObjectResult>& read, bool scaling,
                                const std::string& where) {
    LandmarkShapes shapes;
    std::vector<ReadObject> objects = readable(collection, read);
    if (objects.empty())
        fail_input(where, "the landmarks of no object could be read", "the first error: " + read.front().problem);
    move_incomplete(objects, shapes.odd);
    if (!scaling) move_other_units(objects, shapes.odd);
    std::map<std::string, std::size_t> counts;
    std::vector<std::string> order;
    std::set<std::string> units;
    for (const ReadObject& object : objects) {
        for (const std::string& name : object.order)
            if (++counts[name] == 1) order.push_back(name);
        shapes.objects.push_back(object.object->name);
        shapes.labels.push_back(object.object->label);
        units.insert(object.unit);
    }
    std::string missing_names;
    for (const std::string& name : order) {
        if (counts.at(name) == objects.size()) shapes.names.push_back(name);
        else missing_names += fmt::format("{}{}'", missing_names.empty() ? "'" : ", '", name);
    }
    if (!missing_names.empty()) shapes.notes.push_back("landmarks that some objects lack are left out: " + missing_names);
    if (shapes.names.size() < 3)
        fail_input(where, fmt::format("the objects have {} landmarks in common", shapes.names.size()),
                   "at least three are needed");
    if (!scaling && units.size() > 1)
        fail_input(where, "the landmarks have different units", "use --scaling, or convert them to one unit");
    if (units.size() == 1) shapes.unit = *units.begin();
    for (const ReadObject& object : objects) {
        Landmarks x(static_cast<Eigen::Index>(shapes.names.size()), 3);
        for (std::size_t k = 0; k < shapes.names.size(); ++k)
            for (std::size_t c = 0; c < 3; ++c)
                x(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c)) = object.places.at(shapes.names[k])[c];
        shapes.configurations.push_back(std::move(x));
    }
    return shapes;
}

std::vector<ShapeOutlier> shape_outliers(const LandmarkShapes& shapes) {
    constexpr double times = 3, nearer = 0.5;
    std::vector<ShapeOutlier> outliers;
    const std::size_t n = shapes.configurations.size();
    if (n < 3) return outliers;
    std::vector<double> sizes;
    for (const Landmarks& configuration : shapes.configurations) sizes.push_back(centroid_size(configuration));
    std::vector<double> sorted = sizes;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(n / 2), sorted.end());
    const double median = sorted[n / 2];
    ProcrustesOptions options;
    options.scaling = true;
    const GeneralisedProcrustes aligned = generalised_procrustes(shapes.configurations, options);
    for (std::size_t i = 0; i < n; ++i) {
        std::string reason;
        if (const double ratio = sizes[i] / median; ratio > times || ratio * times < 1)
            reason = fmt::format("it is {} times as large as the median: is it in another unit?", digits(ratio, 3));
        // The mean without the tested object, so that it does not affect its own test.
        const Landmarks others_mean = static_cast<double>(n) * aligned.mean - aligned.aligned[i];
        Landmarks mirror = shapes.configurations[i];
        mirror.col(0) *= -1;
        const double own_residual = procrustes(shapes.configurations[i], others_mean, options).sum_of_squares,
                     mirrored = procrustes(mirror, others_mean, options).sum_of_squares;
        if (mirrored < nearer * nearer * own_residual && own_residual > 1e-6 * others_mean.squaredNorm())
            reason += std::string(reason.empty() ? "" : "; ") +
                      "its mirror image is closer to the mean of the others than the object itself: are its landmarks mirrored, "
                      "or left and right exchanged?";
        if (!reason.empty()) outliers.push_back({shapes.objects[i], reason, false});
    }
    return outliers;
}

LandmarkShapes without(const LandmarkShapes& shapes, const std::vector<ShapeOutlier>& outliers) {
    LandmarkShapes kept = shapes;
    kept.objects.clear();
    kept.labels.clear();
    kept.configurations.clear();
    for (std::size_t i = 0; i < shapes.objects.size(); ++i) {
        if (std::any_of(outliers.begin(), outliers.end(), [&](const auto& outlier) { return outlier.name == shapes.objects[i]; }))
            continue;
        kept.objects.push_back(shapes.objects[i]);
        kept.labels.push_back(shapes.labels[i]);
        kept.configurations.push_back(shapes.configurations[i]);
    }
    return kept;
}

}  // namespace ostraka

#include "ostraka/collection/landmark_shapes.h"

#include "ostraka/core/error.h"
#include "ostraka/core/json_build.h"
#include "ostraka/core/text.h"
#include "ostraka/interchange/landmarks.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace ostraka {

namespace {

Json landmarks_json(const CollectionObject& object) {
    if (object.landmarks.empty()) fail_input(object.name, "there are no landmarks", "put NAME.mrk.json beside the mesh");
    const LandmarkSet set = read_landmarks(object.landmarks, LandmarkFormat::mrk);
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    JsonValue names(rapidjson::kArrayType), places(rapidjson::kArrayType);
    std::set<std::string> seen;
    for (const Landmark& landmark : set.landmarks) {
        if (!seen.insert(landmark.name).second)
            fail_input(object.landmarks.string(), "two landmarks are called '" + landmark.name + "'",
                       "give each a name of its own");
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
    std::vector<ReadObject> list;
    for (std::size_t i = 0; i < read.size(); ++i) {
        if (!read[i].problem.empty()) continue;
        const Json& one = read[i].result;
        ReadObject& object = list.emplace_back();
        object.object = &collection.objects[i];
        object.unit = object.object->unit.empty() ? one["unit"].GetString() : object.object->unit;
        for (rapidjson::SizeType k = 0; k < one["names"].Size(); ++k) {
            object.order.emplace_back(one["names"][k].GetString());
            for (rapidjson::SizeType c = 0; c < 3; ++c)
                object.places[object.order.back()].at(c) = one["places"][3 * k + c].GetDouble();
        }
    }
    return list;
}

/// Moves objects for which `why` returns a reason to the odd ones.
template <class Why>
void leave_out(std::vector<ReadObject>& objects, std::vector<OddSpecimen>& odd, Why&& why) {
    std::vector<ReadObject> kept;
    for (ReadObject& object : objects) {
        if (std::string reason = why(object); !reason.empty()) odd.push_back({object.object->name, std::move(reason), true});
        else kept.push_back(std::move(object));
    }
    objects = std::move(kept);
}

void leave_out_poor(std::vector<ReadObject>& objects, std::vector<OddSpecimen>& odd) {
    std::map<std::string, std::size_t> counts;
    for (const ReadObject& object : objects)
        for (const auto& [name, place] : object.places) ++counts[name];
    std::set<std::string> usual;
    for (const auto& [name, count] : counts)
        if (2 * count >= objects.size()) usual.insert(name);
    leave_out(objects, odd, [&](const ReadObject& object) -> std::string {
        const auto has = static_cast<std::size_t>(std::count_if(object.places.begin(), object.places.end(),
                                                                [&](const auto& one) { return usual.count(one.first) > 0; }));
        if (2 * has >= usual.size()) return {};
        return "it has " + std::to_string(has) + " of the " + std::to_string(usual.size()) +
               " landmarks that half of the objects have; pick the others, or name them as the others are named";
    });
}

void leave_out_other_units(std::vector<ReadObject>& objects, std::vector<OddSpecimen>& odd) {
    std::map<std::string, std::size_t> counts;
    for (const ReadObject& object : objects) ++counts[object.unit];
    const auto most =
        std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == counts.end() || 2 * most->second <= objects.size()) return;
    const auto named = [](const std::string& unit) { return unit.empty() ? std::string("no unit that it states") : unit; };
    leave_out(objects, odd, [&](const ReadObject& object) -> std::string {
        if (object.unit == most->first) return {};
        return "its landmarks are in " + named(object.unit) + ", most objects' in " + named(most->first) +
               "; bring it to their unit, or give --scaling";
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
    if (objects.empty()) fail_input(where, "no object has landmarks that can be read", "the first: " + read.front().problem);
    leave_out_poor(objects, shapes.odd);
    if (!scaling) leave_out_other_units(objects, shapes.odd);
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
    std::string lacking;
    for (const std::string& name : order) {
        if (counts.at(name) == objects.size()) shapes.names.push_back(name);
        else lacking += (lacking.empty() ? "'" : ", '") + name + "'";
    }
    if (!lacking.empty()) shapes.notes.push_back("landmarks that not all objects have are left out: " + lacking);
    if (shapes.names.size() < 3)
        fail_input(where, "the objects have " + std::to_string(shapes.names.size()) + " landmarks in common",
                   "at least three are needed");
    if (!scaling && units.size() > 1)
        fail_input(where, "the landmarks have different units", "give --scaling, or bring them to one unit");
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

std::vector<OddSpecimen> odd_specimens(const LandmarkShapes& shapes) {
    constexpr double times = 3, nearer = 0.5;
    std::vector<OddSpecimen> odd;
    const std::size_t n = shapes.configurations.size();
    if (n < 3) return odd;
    std::vector<double> sizes;
    for (const Landmarks& one : shapes.configurations) sizes.push_back(centroid_size(one));
    std::vector<double> sorted = sizes;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(n / 2), sorted.end());
    const double median = sorted[n / 2];
    ProcrustesOptions how;
    how.scaling = true;
    const GeneralisedProcrustes aligned = generalised_procrustes(shapes.configurations, how);
    for (std::size_t i = 0; i < n; ++i) {
        std::string why;
        if (const double ratio = sizes[i] / median; ratio > times || ratio * times < 1)
            why = "it is " + digits(ratio, 3) + " times as large as the median: is it in another unit?";
        // The mean without the tested object, so that it does not affect its own test.
        const Landmarks others = static_cast<double>(n) * aligned.mean - aligned.aligned[i];
        Landmarks mirror = shapes.configurations[i];
        mirror.col(0) *= -1;
        const double own = procrustes(shapes.configurations[i], others, how).sum_of_squares,
                     mirrored = procrustes(mirror, others, how).sum_of_squares;
        if (mirrored < nearer * nearer * own && own > 1e-6 * others.squaredNorm())
            why += std::string(why.empty() ? "" : "; ") +
                   "its mirror image is nearer the mean of the others than itself: are its landmarks mirrored, or left and right "
                   "exchanged?";
        if (!why.empty()) odd.push_back({shapes.objects[i], why, false});
    }
    return odd;
}

LandmarkShapes without(const LandmarkShapes& shapes, const std::vector<OddSpecimen>& odd) {
    LandmarkShapes kept = shapes;
    kept.objects.clear();
    kept.labels.clear();
    kept.configurations.clear();
    for (std::size_t i = 0; i < shapes.objects.size(); ++i) {
        if (std::any_of(odd.begin(), odd.end(), [&](const auto& one) { return one.name == shapes.objects[i]; })) continue;
        kept.objects.push_back(shapes.objects[i]);
        kept.labels.push_back(shapes.labels[i]);
        kept.configurations.push_back(shapes.configurations[i]);
    }
    return kept;
}

}  // namespace ostraka

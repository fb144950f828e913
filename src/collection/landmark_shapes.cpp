#include "ostraka/collection/landmark_shapes.h"

#include "ostraka/core/error.h"
#include "ostraka/core/json_build.h"
#include "ostraka/interchange/landmarks.h"

#include <array>
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

}  // namespace

std::vector<ObjectResult> read_object_landmarks(const Collection& collection, const ResultStore& store) {
    return for_each_object(collection, store, {"landmarks"}, landmarks_json);
}

LandmarkShapes common_landmarks(const Collection& collection, const std::vector<ObjectResult>& read, bool scaling,
                                const std::string& where) {
    LandmarkShapes shapes;
    std::map<std::string, std::size_t> counts;
    std::vector<std::map<std::string, std::array<double, 3>>> places;
    std::vector<std::string> order;
    std::set<std::string> units;
    for (std::size_t i = 0; i < read.size(); ++i) {
        if (!read[i].problem.empty()) continue;
        const Json& one = read[i].result;
        auto& of = places.emplace_back();
        for (rapidjson::SizeType k = 0; k < one["names"].Size(); ++k) {
            const std::string name = one["names"][k].GetString();
            for (rapidjson::SizeType c = 0; c < 3; ++c) of[name].at(c) = one["places"][3 * k + c].GetDouble();
            if (++counts[name] == 1) order.push_back(name);
        }
        const CollectionObject& object = collection.objects[i];
        shapes.objects.push_back(object.name);
        shapes.labels.push_back(object.label);
        units.insert(object.unit.empty() ? one["unit"].GetString() : object.unit);
    }
    if (places.empty()) fail_input(where, "no object has landmarks that can be read", "the first: " + read.front().problem);
    std::string lacking;
    for (const std::string& name : order) {
        if (counts.at(name) == places.size()) shapes.names.push_back(name);
        else lacking += (lacking.empty() ? "'" : ", '") + name + "'";
    }
    if (!lacking.empty()) shapes.notes.push_back("landmarks that not all objects have are left out: " + lacking);
    if (shapes.names.size() < 3)
        fail_input(where, "the objects have " + std::to_string(shapes.names.size()) + " landmarks in common",
                   "at least three are needed");
    if (!scaling && units.size() > 1)
        fail_input(where, "the landmarks have different units", "give --scaling, or bring them to one unit");
    if (units.size() == 1) shapes.unit = *units.begin();
    for (const auto& of : places) {
        Landmarks x(static_cast<Eigen::Index>(shapes.names.size()), 3);
        for (std::size_t k = 0; k < shapes.names.size(); ++k)
            for (std::size_t c = 0; c < 3; ++c)
                x(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c)) = of.at(shapes.names[k])[c];
        shapes.configurations.push_back(std::move(x));
    }
    return shapes;
}

}  // namespace ostraka

#include "builder.h"

#include "ostraka/core/error.h"
#include "ostraka/core/nearest_name.h"

#include <algorithm>
#include <map>

namespace ostraka {

namespace {
using Maker = shapes::ObjectPointer (*)();
const std::map<std::string, Maker>& makers() {
    static const std::map<std::string, Maker> list{
        {"box", shapes::make_box_object},      {"capsule", shapes::make_capsule},
        {"chair", shapes::make_chair},         {"cylinder", shapes::make_cylinder_object},
        {"hand", shapes::make_hand},           {"sphere", shapes::make_sphere},
        {"statuette", shapes::make_statuette}, {"teapot", shapes::make_teapot},
        {"torus", shapes::make_torus_object},  {"vase", shapes::make_vase}};
    return list;
}

}  // namespace

std::vector<std::string> synthetic_object_names() {
    std::vector<std::string> names;
    for (const auto& [name, maker] : makers()) names.push_back(name);
    return names;
}

const SyntheticObject& synthetic_object(const std::string& name) {
    static std::map<std::string, shapes::ObjectPointer> made = [] {
        std::map<std::string, shapes::ObjectPointer> list;
        for (const auto& [known, maker] : makers()) list[known] = maker();
        return list;
    }();
    const auto found = made.find(name);
    if (found != made.end()) return *found->second;
    std::string nearest, all;
    std::size_t minimum = std::max<std::size_t>(3, name.size() / 2 + 1);
    for (const auto& [known, maker] : makers()) {
        all += (all.empty() ? "" : ", ") + known;
        const std::size_t distance = name.size() > 64 ? 64 : edit_distance(name, known, minimum - 1);
        if (distance < minimum) minimum = distance, nearest = known;
    }
    fail_usage("there is no made object '" + name + "'",
               nearest.empty() ? "use one of: " + all : "did you mean '" + nearest + "'? All: " + all);
}

}  // namespace ostraka

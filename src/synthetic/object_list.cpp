#include "synthetic/builder.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/nearest_name.h"

#include <fmt/core.h>

#include <map>

namespace ostraka {

namespace {
using Maker = shapes::ObjectPointer (*)();
const std::map<std::string, Maker>& makers() {
    static const std::map<std::string, Maker> map{{"bird", shapes::make_bird},
                                                  {"box", shapes::make_box_object},
                                                  {"capsule", shapes::make_capsule},
                                                  {"chair", shapes::make_chair},
                                                  {"cylinder", shapes::make_cylinder_object},
                                                  {"elephant", shapes::make_elephant},
                                                  {"hand", shapes::make_hand},
                                                  {"sphere", shapes::make_sphere},
                                                  {"statuette", shapes::make_statuette},
                                                  {"teapot", shapes::make_teapot},
                                                  {"torus", shapes::make_torus_object},
                                                  {"vase", shapes::make_vase}};
    return map;
}

}  // namespace

std::vector<std::string> synthetic_object_names() {
    std::vector<std::string> names;
    for (const auto& [name, maker] : makers()) names.push_back(name);
    return names;
}

const SyntheticObject& synthetic_object(const std::string& name) {
    static std::map<std::string, shapes::ObjectPointer> objects = [] {
        std::map<std::string, shapes::ObjectPointer> map;
        for (const auto& [object_name, maker] : makers()) map[object_name] = maker();
        return map;
    }();
    const auto object = objects.find(name);
    if (object != objects.end()) return *object->second;
    const std::vector<std::string> names = synthetic_object_names();
    const std::string nearest = name.size() > 64 ? "" : nearest_name(name, names), all_names = joined(names);
    fail_usage(fmt::format("there is no synthetic object '{}'", name),
               nearest.empty() ? "use one of: " + all_names : fmt::format("did you mean '{}'? All: {}", nearest, all_names));
}

}  // namespace ostraka

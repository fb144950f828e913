#include "builder.h"

#include "ostraka/core/error.h"
#include "ostraka/core/nearest_name.h"
#include "ostraka/core/words.h"

#include <map>

namespace ostraka {

namespace {
using Maker = shapes::ObjectPointer (*)();
const std::map<std::string, Maker>& makers() {
    static const std::map<std::string, Maker> list{{"bird", shapes::make_bird},
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
    const std::vector<std::string> names = synthetic_object_names();
    const std::string nearest = name.size() > 64 ? "" : nearest_name(name, names), all = joined(names);
    fail_usage("there is no made object '" + name + "'",
               nearest.empty() ? "use one of: " + all : "did you mean '" + nearest + "'? All: " + all);
}

}  // namespace ostraka

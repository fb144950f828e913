#include "builder.h"

#include "ostraka/core/error.h"

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

/// Levenshtein distance.
std::size_t edits(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
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
        const std::size_t distance = name.size() > 64 ? 64 : edits(name, known);
        if (distance < minimum) minimum = distance, nearest = known;
    }
    fail_usage("there is no made object '" + name + "'",
               nearest.empty() ? "use one of: " + all : "did you mean '" + nearest + "'? All: " + all);
}

}  // namespace ostraka

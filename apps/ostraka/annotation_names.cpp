#include "annotation_names.h"

#include "command.h"

#include "ostraka/measure/measure.h"

#include <charconv>

namespace ostraka::app {

const Annotation& find_annotation(const AnnotationSet& set, const std::string& name, const std::string& file) {
    int id = 0;
    const auto [end, code] = std::from_chars(name.data(), name.data() + name.size(), id);
    if (code == std::errc() && end == name.data() + name.size())
        if (const Annotation* found = set.find(id)) return *found;
    std::vector<const Annotation*> tagged;
    for (const Annotation& annotation : set.annotations)
        if (annotation.tag == name) tagged.push_back(&annotation);
    if (tagged.empty())
        fail_input(file, "has no annotation '" + printable(name, 60) + "'",
                   "give the id or the tag of one; 'ostraka annotation list' shows them");
    if (tagged.size() > 1)
        fail_input(file, "has " + std::to_string(tagged.size()) + " annotations tagged '" + printable(name, 60) + "'",
                   "give the id of one");
    return *tagged.front();
}

std::string in_unit(const std::string& quantity, const AnnotationSet& set) {
    const std::string unit = descriptor_unit(quantity, set.unit);
    return quantity + (unit.empty() ? "" : " " + printable(unit, 20));
}

}  // namespace ostraka::app

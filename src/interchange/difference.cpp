#include "ostraka/interchange/difference.h"

#include "interchange/fields.h"

#include <algorithm>
#include <map>

namespace ostraka {

namespace {

using namespace interchange;
using Kind = Difference::Kind;

/// The elements of a selection as sortable integers: vertices, edges (both ends, lower first) or faces.
std::vector<std::uint64_t> elements(const Annotation& annotation) {
    std::vector<std::uint64_t> result(annotation.points.begin(), annotation.points.end());
    result.insert(result.end(), annotation.faces.begin(), annotation.faces.end());
    for (const auto& polyline : annotation.polylines)
        for (std::size_t i = 0; i + 1 < polyline.size(); ++i) {
            const auto [low, high] = std::minmax(polyline[i], polyline[i + 1]);
            result.push_back(static_cast<std::uint64_t>(low) << 32 | high);
        }
    std::sort(result.begin(), result.end());
    return result;
}

std::size_t count_only_in(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b) {
    std::vector<std::uint64_t> only_in_a;
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(only_in_a));
    return only_in_a.size();
}

/// The ids of `ids` that are also in `other_ids`, in the order of `ids`.
std::vector<int> common(const std::vector<int>& ids, std::vector<int> other_ids) {
    std::sort(other_ids.begin(), other_ids.end());
    std::vector<int> result;
    for (const int id : ids)
        if (std::binary_search(other_ids.begin(), other_ids.end(), id)) result.push_back(id);
    return result;
}

class Comparison {
public:
    std::vector<Difference> differences;

    void compare(const AnnotationSet& a, const AnnotationSet& b) {
        if (a.object_class != b.object_class) change("class", as_text(a.object_class), as_text(b.object_class));
        if (a.unit != b.unit) change("unit", as_text(a.unit), as_text(b.unit));
        if (a.up != b.up) change("up", as_text(a.up), as_text(b.up));
        order(ids_of(a.annotations), ids_of(b.annotations));
        std::map<int, std::pair<const Annotation*, const Annotation*>> pairs;
        for (const Annotation& annotation : a.annotations) pairs[annotation.id].first = &annotation;
        for (const Annotation& annotation : b.annotations) pairs[annotation.id].second = &annotation;
        for (const auto& [id, pair] : pairs) {
            const auto& [before, after] = pair;
            id_ = id;
            tag_ = after != nullptr ? after->tag : before->tag;
            if (before == nullptr) add(Kind::added, "", "", as_text(*after));
            else if (after == nullptr) add(Kind::removed, "", as_text(*before), "");
            else compare(*before, *after);
        }
    }

private:
    void add(Kind kind, const std::string& field, const std::string& before, const std::string& after) {
        differences.push_back({kind, id_, tag_, field, before, after, 0, 0});
    }
    void change(const std::string& field, const std::string& before, const std::string& after) {
        add(Kind::changed, field, before, after);
    }

    void order(const std::vector<int>& a, const std::vector<int>& b) {
        const std::vector<int> before = common(a, b), after = common(b, a);
        if (before != after) change("order", as_text(before), as_text(after));
    }

    void compare(const Annotation& a, const Annotation& b) {
        if (a.tag != b.tag) change("tag", as_text(a.tag), as_text(b.tag));
        if (a.colour != b.colour) change("colour", as_text(a.colour), as_text(b.colour));
        if (a.type != b.type) change("type", to_string(a.type), to_string(b.type));
        if (!same_geometry(a, b)) {
            change("geometry", geometry_as_text(a), geometry_as_text(b));
            const auto before = elements(a), after = elements(b);
            differences.back().only_before = a.type == b.type ? count_only_in(before, after) : before.size();
            differences.back().only_after = a.type == b.type ? count_only_in(after, before) : after.size();
        }
        if (a.note != b.note) change("note", as_text(a.note), as_text(b.note));
        if (a.information != b.information) change("information", as_text(a.information), as_text(b.information));
        order(ids_of(a.attributes), ids_of(b.attributes));
        std::map<int, std::pair<const Attribute*, const Attribute*>> pairs;
        for (const Attribute& attribute : a.attributes) pairs[attribute.id].first = &attribute;
        for (const Attribute& attribute : b.attributes) pairs[attribute.id].second = &attribute;
        for (const auto& [id, pair] : pairs) {
            const auto& [before, after] = pair;
            if (before != nullptr && after != nullptr && same(*before, *after)) continue;
            change("attribute " + std::to_string(id), before == nullptr ? "" : as_text(*before),
                   after == nullptr ? "" : as_text(*after));
        }
    }

    std::optional<int> id_;
    std::string tag_;
};

}  // namespace

std::vector<Difference> differences(const AnnotationSet& a, const AnnotationSet& b) {
    Comparison comparison;
    comparison.compare(a, b);
    return std::move(comparison.differences);
}

void MergeOptions::declare_options(OptionList& list) {
    list("prefer", prefer, "set whose value is kept where both sets changed a field; none: a conflict is reported",
         Choices{"none", "ours", "theirs"});
    list("merge-faces", merge_faces, "where both sets changed a region, merge face by face instead of reporting a conflict",
         Anything{});
    list("renumber", renumber, "give a new id to the second of two annotations added with the same id, instead of a conflict",
         Anything{});
}

}  // namespace ostraka

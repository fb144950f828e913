#include "ostraka/semantic/edit_words.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/nearest_name.h"
#include "ostraka/core/text.h"
#include "ostraka/files/json_build.h"
#include "ostraka/measure/measure.h"
#include "ostraka/mesh/ids.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

constexpr double weight = 1000;

/// True if the last word of the tag, ignoring a number, is the word: "front left leg" and "leg 2" end in "leg".
bool ends_in_word(std::string tag, const std::string& word) {
    if (const std::size_t space = tag.rfind(' '); space != std::string::npos && number_of(tag.substr(space + 1)))
        tag.resize(space);
    return tag == word || tag.ends_with(" " + word);
}

std::vector<const Annotation*> parts_of_word(const AnnotationSet& set, const std::string& word) {
    std::vector<const Annotation*> parts;
    const auto take = [&](auto&& is_meant) {
        if (!parts.empty() || word.empty()) return;
        for (const Annotation& annotation : set.annotations)
            if (is_meant(annotation)) parts.push_back(&annotation);
    };
    take([&](const Annotation& one) { return std::to_string(one.id) == word; });
    take([&](const Annotation& one) { return one.tag == word; });
    const std::string single = word.ends_with("s") ? word.substr(0, word.size() - 1) : word;
    // Regions take precedence over lines and points: "arms" does not mean "ends of the arms".
    for (const AnnotationType type : {AnnotationType::region, AnnotationType::line, AnnotationType::point})
        take([&](const Annotation& one) {
            return one.type == type && !single.empty() && (ends_in_word(one.tag, word) || ends_in_word(one.tag, single));
        });
    return parts;
}

struct Amount {
    std::string parts;
    double number = 0;
    Eigen::Vector3d axis{0, 0, 1};  ///< of any length
};

/// Parses PARTS=NUMBER or PARTS=NUMBER,AXIS.
Amount amount_of(const std::string& text, const char* option, const AnnotationSet& set) {
    const auto fail = [&](const std::string& what, const std::string& remedy) {
        fail_usage(std::string(option) + " " + printable(text, 60) + ": " + what, remedy);
    };
    const std::size_t equals = text.rfind('='), comma = text.find(',', equals == std::string::npos ? 0 : equals);
    if (equals == std::string::npos || equals == 0) fail("contains no amount", "give PART=NUMBER, like back=1.2");
    Amount amount;
    amount.parts = text.substr(0, equals);
    const auto number = number_of(text.substr(equals + 1, comma == std::string::npos ? comma : comma - equals - 1));
    if (!number || !std::isfinite(*number))
        fail("the amount is not a number", "give PART=NUMBER without a unit (a length is in the mesh's own), like back=1.2");
    amount.number = *number;
    const std::string axis = comma == std::string::npos ? "up" : text.substr(comma + 1);
    if (axis == "up") {
        if (!set.up)
            fail("no upward direction is given", "add the axis, like " + text.substr(0, comma) + ",z, or up to the annotations");
        amount.axis = {(*set.up)[0], (*set.up)[1], (*set.up)[2]};
        return amount;
    }
    const std::size_t k = axis.empty() ? std::string::npos : std::string("xyz").find(axis.back());
    if (k == std::string::npos || (axis.size() == 2 ? axis[0] != '-' : axis.size() != 1))
        fail("'" + printable(axis, 20) + "' is not an axis", "use up, x, y, z, -x, -y or -z");
    amount.axis.setZero();
    amount.axis[static_cast<Eigen::Index>(k)] = axis.size() == 2 ? -1 : 1;
    return amount;
}

}  // namespace

void EditWords::declare_options(OptionList& list) {
    list("stretch", stretch, "PART=FACTOR or PART=FACTOR,AXIS: stretch parts from the base along an axis (up); repeatable");
    list("raise", raise, "PART=LENGTH or PART=LENGTH,AXIS: move parts by a length along an axis (default: up); repeatable");
    list("rotate", rotate, "PART=DEGREES or PART=DEGREES,AXIS: rotate parts about an axis (up) through their middle");
    list("keep", keep, "PART MEASURE or PART: keep a measure of parts, or the shape of parts, as before the edit; repeatable");
    list("level", level, "PARTS: keep parts (tags separated by commas, or a word like legs) at the same height; repeatable");
}

std::vector<const Annotation*> parts_named(const AnnotationSet& set, const std::string& words) {
    std::vector<const Annotation*> all;
    for (std::size_t begin = 0; begin <= words.size();) {
        const std::size_t end = std::min(words.find(',', begin), words.size());
        const std::string word(trimmed(std::string_view(words).substr(begin, end - begin)));
        const auto parts = parts_of_word(set, word);
        if (parts.empty()) {
            std::vector<std::string> tags;
            for (const Annotation& annotation : set.annotations) tags.push_back(annotation.tag);
            const std::string near = nearest_name(word, tags);
            fail_input("annotations", "no part is called '" + printable(word, 60) + "'",
                       near.empty() ? "see 'annotation list'" : "did you mean '" + near + "'?");
        }
        for (const Annotation* part : parts)
            if (std::find(all.begin(), all.end(), part) == all.end()) all.push_back(part);
        begin = end + 1;
    }
    return all;
}

Edit parse_edit(const EditWords& words, const AnnotationSet& set) {
    Edit edit;
    const auto add = [&](const std::vector<std::string>& texts, const char* option, auto&& operation_of) {
        for (const std::string& text : texts) {
            const Amount amount = amount_of(text, option, set);
            EditStep::Annotations parts;
            for (const Annotation* part : parts_named(set, amount.parts)) parts.names.emplace_back(part->id);
            EditStep step;
            step.select = std::move(parts);
            step.operation = operation_of(amount);
            edit.steps.push_back(std::move(step));
        }
    };
    add(words.stretch, "--stretch", [](const Amount& amount) {
        if (!(amount.number > 0 && amount.number < 1e6))
            fail_usage(fmt::format("--stretch {} has the factor {}", printable(amount.parts, 60), digits(amount.number, 6)),
                       "give a positive factor; 1 changes nothing");
        return EditStep::Stretch{unit_direction(amount.axis), amount.number};
    });
    add(words.raise, "--raise", [](const Amount& amount) {
        double size = 0;
        for (const double x : amount.axis) size = std::hypot(size, x);
        return EditStep::Translate{amount.axis * (amount.number / size)};
    });
    add(words.rotate, "--rotate", [](const Amount& amount) {
        return EditStep::Rotate{unit_direction(amount.axis), amount.number};
    });
    return edit;
}

namespace {

/// The parts and the measure (empty: the shape) named by a text of "keep".
struct Kept {
    std::vector<const Annotation*> parts;
    std::string measure;
};
Kept kept_by(const std::string& text, const AnnotationSet& set) {
    // The text starts with the parts. The longest prefix that is a tag takes precedence ("part 0 thickness" is not "0
    // thickness" of "part"); otherwise the shortest prefix that means a part, so that the measure's name is the longest
    // possible.
    if (!parts_of_word(set, text).empty()) return {parts_named(set, text), ""};
    for (std::size_t end = text.rfind(' '); end != std::string::npos && end > 0; end = text.rfind(' ', end - 1))
        if (std::any_of(set.annotations.begin(), set.annotations.end(),
                        [&](const Annotation& one) { return one.tag == text.substr(0, end); }))
            return {parts_named(set, text.substr(0, end)), text.substr(end + 1)};
    std::size_t space = text.find(' ');
    while (space != std::string::npos && parts_of_word(set, text.substr(0, space)).empty()) space = text.find(' ', space + 1);
    if (space == std::string::npos) return {parts_named(set, text), ""};
    return {parts_named(set, text.substr(0, space)), text.substr(space + 1)};
}

bool has_measure(const Annotation& part, const std::string& name) {
    return std::any_of(part.attributes.begin(), part.attributes.end(),
                       [&](const Attribute& attribute) { return attribute.measure() != nullptr && attribute.name == name; });
}

}  // namespace

void add_missing_measures(const EditWords& words, const Mesh& mesh, AnnotationSet& set) {
    for (const std::string& text : words.keep) {
        const Kept kept = kept_by(text, set);
        if (!set.up || (kept.measure != "height" && kept.measure != "thickness")) continue;
        for (const Annotation* part : kept.parts) {
            if (has_measure(*part, kept.measure)) continue;
            Measure extent;
            extent.tool = "bounding";
            extent.direction = set.up;
            extent.unit = set.unit;
            const auto pins = extremes(mesh, *part, *set.up);
            extent.points.assign(pins.begin(), pins.end());
            const auto own =
                std::find_if(set.annotations.begin(), set.annotations.end(), [&](auto& one) { return &one == part; });
            extent.value = evaluate(mesh, *own, extent);
            add_measure(*own, kept.measure, std::move(extent));
        }
    }
}

void add_constraints(const EditWords& words, const AnnotationSet& set, RelationGraph& graph) {
    const auto add = [&](const char* type, std::vector<int> members, const std::string& parameters) {
        Relationship relationship;
        relationship.id = next_free_id(graph.relationships);
        relationship.type = type;
        relationship.annotations = std::move(members);
        relationship.is_constraint = true;
        relationship.weight = weight;
        relationship.constraint = parameters;
        relationship.origin = "stated";
        graph.relationships.push_back(std::move(relationship));
    };
    for (const std::string& text : words.keep) {
        const Kept kept = kept_by(text, set);
        for (const Annotation* part : kept.parts) {
            if (kept.measure.empty()) {
                add("keep shape", {part->id}, "");
                continue;
            }
            if (!has_measure(*part, kept.measure)) {
                std::vector<std::string> names;
                for (const Attribute& attribute : part->attributes)
                    if (attribute.measure() != nullptr) names.push_back(attribute.name);
                fail_input("annotations", "'" + part->tag + "' has no measure '" + printable(kept.measure, 60) + "'",
                           "take it with 'measure take'" + (names.empty() ? "" : ", or name one of: " + joined(names)));
            }
            Json parameters;
            parameters.SetObject();
            add_members(parameters, parameters.GetAllocator(), "measure", kept.measure);
            add("keep measure", {part->id}, to_text(parameters));
        }
    }
    for (const std::string& text : words.level) {
        std::vector<int> ids;
        for (const Annotation* part : parts_named(set, text)) ids.push_back(part->id);
        if (ids.size() < 2)
            fail_usage("--level " + printable(text, 60) + " names one part, '" + printable(set.find(ids[0])->tag, 60) + "'",
                       "name two or more");
        add("same level", std::move(ids), R"({"shapes": "free", "heights": "rest", "reference": "base"})");
    }
}

}  // namespace ostraka

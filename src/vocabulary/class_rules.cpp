#include "ostraka/vocabulary/class_rules.h"

#include "ostraka/core/error.h"
#include "ostraka/vocabulary/tag_matcher.h"
#include "ostraka/vocabulary/text_match.h"

#include "vocabulary/words.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>

namespace ostraka {

using namespace detail;

namespace {

using std::to_string;

Subject subject_of(const JsonValue& value) {
    if (value.IsString()) return {text_of(value), std::nullopt};
    Subject subject{text_of(value["tag"]), std::nullopt};
    if (const JsonValue* type = find_member(value, "type")) {
        const std::string name = text_of(*type);
        subject.type = name == "point" ? AnnotationType::point : name == "line" ? AnnotationType::line : AnnotationType::region;
    }
    return subject;
}

std::optional<int> integer_in(const JsonValue& object, const char* name) {
    const JsonValue* value = find_member(object, name);
    return value == nullptr ? std::nullopt : std::optional(value->GetInt());
}

ClassRule class_rule_of(const JsonValue& object, const std::string& where, const std::string& pointer) {
    ClassRule rule;
    rule.id = text_of(object["id"]);
    rule.note = text_in(object, "note");
    if (const JsonValue* count = find_member(object, "count")) {
        rule.count = CountRule{subject_of((*count)["of"]), integer_in(*count, "min"), integer_in(*count, "max")};
        const auto& [subject, min, max] = *rule.count;
        if (!min && !max) fail_input(where, fmt::format("at {}/count: a count without bounds", pointer), "give min, max or both");
        if (min && max && *min > *max) fail_input(where, fmt::format("at {}/count: min is above max", pointer), "swap them");
    }
    if (const JsonValue* attribute = find_member(object, "attribute")) {
        AttributeRule attribute_rule;
        attribute_rule.subject = subject_of((*attribute)["of"]);
        attribute_rule.name = text_of((*attribute)["name"]);
        attribute_rule.values = names_in(*attribute, "is");
        attribute_rule.min = number_in(*attribute, "min");
        attribute_rule.max = number_in(*attribute, "max");
        attribute_rule.unit = text_in(*attribute, "unit");
        if (!attribute_rule.values.empty() && (attribute_rule.min || attribute_rule.max || !attribute_rule.unit.empty()))
            fail_input(where, fmt::format("at {}/attribute: both words and bounds", pointer),
                       "give 'is' for a word, min, max and unit for a number");
        if (attribute_rule.min && attribute_rule.max && *attribute_rule.min > *attribute_rule.max)
            fail_input(where, fmt::format("at {}/attribute: min is above max", pointer), "swap them");
        rule.attribute = std::move(attribute_rule);
    }
    if (const JsonValue* relation = find_member(object, "relation")) {
        RelationRule relation_rule{subject_of((*relation)["of"]), names_in(*relation, "is"), subject_of((*relation)["to"]), {}};
        const std::string place = text_in(*relation, "place");
        relation_rule.place = place == "first"    ? RelationRule::Place::first
                              : place == "second" ? RelationRule::Place::second
                                                  : RelationRule::Place::any;
        rule.relation = std::move(relation_rule);
    }
    if (rule.count.has_value() + rule.attribute.has_value() + rule.relation.has_value() != 1)
        fail_input(where, fmt::format("at {}: a rule must state a count, an attribute or a relation", pointer),
                   "give exactly one of the three per rule");
    return rule;
}

class RuleChecker {
public:
    RuleChecker(const AnnotationSet& set, const Vocabulary* vocabulary, const std::vector<RelationFact>& relations,
                std::string where)
        : set_(set), relations_(relations), where_(std::move(where)) {
        if (vocabulary != nullptr) search_.emplace(*vocabulary);
        for (const Annotation& annotation : set.annotations)
            concepts_.push_back(search_ ? search_->concept_of(annotation.tag) : std::nullopt);
        close_containment();
    }
    std::vector<RuleViolation> violations;

    void check(const ClassRule& rule, const std::string& pointer) {
        rule_ = &rule;
        rule_pointer_ = pointer;
        if (rule.count) count(*rule.count);
        if (rule.attribute) attribute(*rule.attribute);
        if (rule.relation) relation(*rule.relation);
    }

private:
    void report(std::optional<int> annotation, const std::string& text) {
        violations.push_back({rule_->id, annotation, text + (rule_->note.empty() ? "" : fmt::format(" ({})", rule_->note))});
    }
    static std::string name_of(const Subject& subject) {
        const std::string kind = subject.type ? ostraka::to_string(*subject.type) : "annotation";
        return subject.tag == "*" ? kind : in_quotes(subject.tag) + (subject.type ? " " + kind : "");
    }

    /// Adds the transitive pairs: containment is stored as its transitive reduction.
    void close_containment() {
        std::map<int, std::vector<int>> contained;
        for (const RelationFact& fact : relations_)
            if (folded(fact.type) == "containment" && fact.annotations.size() == 2)
                contained[fact.annotations[0]].push_back(fact.annotations[1]);
        for (const auto& [container, direct] : contained) {
            std::vector<int> front = direct;
            std::set<int>& closure = contained_[container];
            while (!front.empty()) {
                const int next = front.back();
                front.pop_back();
                if (!closure.insert(next).second) continue;
                if (const auto entry = contained.find(next); entry != contained.end())
                    front.insert(front.end(), entry->second.begin(), entry->second.end());
            }
        }
    }

    [[nodiscard]] std::vector<const Annotation*> matching_annotations(const Subject& subject, const std::string& pointer) const {
        std::optional<std::size_t> required_concept;
        if (search_ && subject.tag != "*") {
            const auto candidates = search_->concepts_of(subject.tag);
            if (candidates.size() != 1)
                fail_input(where_,
                           fmt::format("at {}{}: the vocabulary has {} concept {}", rule_pointer_, pointer,
                                       candidates.empty() ? "no" : "more than one", in_quotes(subject.tag)),
                           "name a concept by id or label" + did_you_mean(search_->suggestions(subject.tag)));
            required_concept = candidates.front();
        }
        std::vector<const Annotation*> matches;
        for (std::size_t i = 0; i < set_.annotations.size(); ++i) {
            const Annotation& annotation = set_.annotations[i];
            if (subject.type && annotation.type != *subject.type) continue;
            const bool is_match = subject.tag == "*" ? true
                                  : required_concept ? concepts_[i] && search_->is_a(*concepts_[i], *required_concept)
                                                     : tag_words_.means(annotation.tag, subject.tag);
            if (is_match) matches.push_back(&annotation);
        }
        return matches;
    }

    void count(const CountRule& rule) {
        const auto matches = matching_annotations(rule.subject, "/count/of");
        const auto number = static_cast<long long>(matches.size());
        if ((!rule.min || number >= *rule.min) && (!rule.max || number <= *rule.max)) return;
        std::string required_count = rule.min && rule.max && *rule.min == *rule.max ? "exactly " + to_string(*rule.min)
                                     : rule.min && rule.max ? fmt::format("{} to {}", *rule.min, *rule.max)
                                     : rule.min             ? "at least " + to_string(*rule.min)
                                                            : "at most " + to_string(*rule.max);
        std::string ids;
        for (std::size_t i = 0; i < std::min<std::size_t>(matches.size(), 8); ++i)
            ids += (i == 0 ? ": " : ", ") + annotation_name(*matches[i]);
        if (matches.size() > 8) ids += " ...";
        report(std::nullopt,
               fmt::format("there must be {} of {}, but there are {}{}", required_count, name_of(rule.subject), number, ids));
    }

    void attribute(const AttributeRule& rule) {
        for (const Annotation* annotation : matching_annotations(rule.subject, "/attribute/of")) {
            const auto i = static_cast<std::size_t>(annotation - set_.annotations.data());
            const AllowedAttribute* allowed = concepts_[i] ? search_->attribute_of(*concepts_[i], rule.name) : nullptr;
            bool present = false, valid = false;
            std::string given_values;
            for (const Attribute& attribute : annotation->attributes) {
                const bool is_match = folded(attribute.name) == folded(rule.name) ||
                                      (allowed != nullptr && search_->attribute_of(*concepts_[i], attribute.name) == allowed);
                if (!is_match) continue;
                present = true;
                std::string text;
                valid = valid || satisfies(rule, allowed, attribute, text);
                given_values += (given_values.empty() ? "" : ", ") + text;
            }
            if (!present)
                report(annotation->id, fmt::format("{} has no attribute {}", annotation_name(*annotation), in_quotes(rule.name)));
            else if (!valid)
                report(annotation->id,
                       fmt::format("the {} of {} is {}, but must be {}", in_quotes(rule.name), annotation_name(*annotation),
                                   given_values, rule.values.empty() ? range(rule) : alternatives(rule.values)));
        }
    }

    static std::string range(const AttributeRule& rule) {
        const std::string unit = rule.unit.empty() ? "" : " " + rule.unit;
        if (rule.min && rule.max) return fmt::format("{} to {}{}", text_of(*rule.min), text_of(*rule.max), unit);
        if (!rule.min && !rule.max) return rule.unit.empty() ? "given" : "a number in " + rule.unit;
        return rule.min ? fmt::format("{}{} or more", text_of(*rule.min), unit)
                        : fmt::format("{}{} or less", text_of(*rule.max), unit);
    }

    static bool satisfies(const AttributeRule& rule, const AllowedAttribute* allowed, const Attribute& attribute,
                          std::string& text) {
        if (const Note* note = attribute.note()) {
            text = in_quotes(note->text);
            if (rule.min || rule.max || !rule.unit.empty()) return false;
            return rule.values.empty() || is_one_of(note->text, rule.values, allowed);
        }
        const auto [values, unit, stale] = attribute_values(attribute);
        text = values.empty() ? "without a value" : text_of(values.front()) + (unit.empty() ? "" : " " + unit);
        if (stale) text += " (stale)";
        if (!rule.values.empty()) return false;
        if (!rule.min && !rule.max && rule.unit.empty()) return true;
        if (values.empty() || stale) return false;
        for (const double value : values) {
            const auto number = rule.unit.empty() ? std::optional<double>(value) : converted(value, unit, rule.unit);
            if (!number || (rule.min && *number < *rule.min) || (rule.max && *number > *rule.max)) return false;
        }
        return true;
    }

    void relation(const RelationRule& rule) {
        std::set<int> related_ids;
        for (const Annotation* annotation : matching_annotations(rule.to, "/relation/to")) related_ids.insert(annotation->id);
        std::set<std::string> types;
        for (const std::string& type : rule.types) types.insert(folded(type));
        for (const Annotation* annotation : matching_annotations(rule.subject, "/relation/of"))
            if (!related(annotation->id, related_ids, types, rule.place))
                report(
                    annotation->id,
                    fmt::format("{} has no relationship of type {} to {}", annotation_name(*annotation), alternatives(rule.types),
                                related_ids.empty() ? "any " + name_of(rule.to) + ", as there is none" : name_of(rule.to)));
    }

    [[nodiscard]] bool related(int id, const std::set<int>& related_ids, const std::set<std::string>& types,
                               RelationRule::Place place) const {
        using Place = RelationRule::Place;
        const auto is_related = [&](int other) { return other != id && related_ids.contains(other); };
        if (types.contains("containment"))
            for (const auto& [container, contained] : contained_) {
                if (container == id && place != Place::second && std::any_of(contained.begin(), contained.end(), is_related))
                    return true;
                if (place != Place::first && is_related(container) && contained.contains(id)) return true;
            }
        for (const RelationFact& fact : relations_) {
            if (!types.contains(folded(fact.type)) || folded(fact.type) == "containment") continue;
            const auto position = std::find(fact.annotations.begin(), fact.annotations.end(), id);
            if (position == fact.annotations.end()) continue;
            const bool first = position == fact.annotations.begin();
            if (fact.directed && place == Place::first && !first) continue;
            if (fact.directed && place == Place::second && first) continue;
            if (std::any_of(fact.annotations.begin(), fact.annotations.end(), is_related)) return true;
        }
        return false;
    }

    const AnnotationSet& set_;
    const std::vector<RelationFact>& relations_;
    std::string where_, rule_pointer_;
    std::optional<VocabularySearch> search_;
    std::vector<std::optional<std::size_t>> concepts_;
    TagMatcher tag_words_;  ///< used if there is no vocabulary
    std::map<int, std::set<int>> contained_;
    const ClassRule* rule_ = nullptr;
};

}  // namespace

bool ClassRules::uses_relations() const {
    return std::any_of(rules.begin(), rules.end(), [](const ClassRule& rule) { return rule.relation.has_value(); });
}

ClassRules class_rules_from_json(const JsonValue& document, const std::string& where) {
    check_format(document, "ostraka-rules", where, "give rules of a class ('ostraka-rules')");
    validate(document, "rules", where);
    ClassRules result;
    result.object_class = text_in(document, "class");
    const JsonValue& rules = document["rules"];
    std::set<std::string> ids;
    for (rapidjson::SizeType i = 0; i < rules.Size(); ++i) {
        const std::string pointer = "/rules/" + to_string(i);
        result.rules.push_back(class_rule_of(rules[i], where, pointer));
        if (!ids.insert(result.rules.back().id).second)
            fail_input(where, fmt::format("at {}/id: another rule has the id '{}'", pointer, result.rules.back().id),
                       "give each rule its own id");
    }
    return result;
}

ClassRules read_class_rules(const Path& file) { return class_rules_from_json(read_json(file), file.string()); }

std::vector<RuleViolation> check_class_rules(const AnnotationSet& set, const ClassRules& rules, const Vocabulary* vocabulary,
                                             const std::vector<RelationFact>& relations, const std::string& where) {
    RuleChecker checker(set, vocabulary, relations, where);
    for (std::size_t i = 0; i < rules.rules.size(); ++i) checker.check(rules.rules[i], "/rules/" + to_string(i));
    return std::move(checker.violations);
}

}  // namespace ostraka

#include "ostraka/vocabulary/class_rules.h"

#include "ostraka/core/error.h"
#include "ostraka/vocabulary/tag_words.h"
#include "ostraka/vocabulary/text_match.h"

#include "words.h"

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

std::optional<int> whole_in(const JsonValue& object, const char* name) {
    const JsonValue* value = find_member(object, name);
    return value == nullptr ? std::nullopt : std::optional(value->GetInt());
}

ClassRule class_rule_of(const JsonValue& object, const std::string& where, const std::string& at) {
    ClassRule rule;
    rule.id = text_of(object["id"]);
    rule.note = text_in(object, "note");
    if (const JsonValue* count = find_member(object, "count")) {
        rule.count = CountRule{subject_of((*count)["of"]), whole_in(*count, "min"), whole_in(*count, "max")};
        const auto& [subject, min, max] = *rule.count;
        if (!min && !max) fail_input(where, "at " + at + "/count: a count without bounds", "give min, max or both");
        if (min && max && *min > *max) fail_input(where, "at " + at + "/count: min is above max", "swap them");
    }
    if (const JsonValue* attribute = find_member(object, "attribute")) {
        AttributeRule wanted;
        wanted.subject = subject_of((*attribute)["of"]);
        wanted.name = text_of((*attribute)["name"]);
        wanted.values = names_in(*attribute, "is");
        wanted.min = number_in(*attribute, "min");
        wanted.max = number_in(*attribute, "max");
        wanted.unit = text_in(*attribute, "unit");
        if (!wanted.values.empty() && (wanted.min || wanted.max || !wanted.unit.empty()))
            fail_input(where, "at " + at + "/attribute: words and bounds",
                       "give 'is' for a word, min, max and unit for a number");
        if (wanted.min && wanted.max && *wanted.min > *wanted.max)
            fail_input(where, "at " + at + "/attribute: min is above max", "swap them");
        rule.attribute = std::move(wanted);
    }
    if (const JsonValue* relation = find_member(object, "relation")) {
        RelationRule wanted{subject_of((*relation)["of"]), names_in(*relation, "is"), subject_of((*relation)["to"]), {}};
        const std::string place = text_in(*relation, "place");
        wanted.place = place == "first"    ? RelationRule::Place::first
                       : place == "second" ? RelationRule::Place::second
                                           : RelationRule::Place::any;
        rule.relation = std::move(wanted);
    }
    if (rule.count.has_value() + rule.attribute.has_value() + rule.relation.has_value() != 1)
        fail_input(where, "at " + at + ": a rule is about a count, an attribute or a relation",
                   "give one of the three, in a rule each");
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
    std::vector<BrokenRule> broken;

    void look_at(const ClassRule& rule, const std::string& at) {
        rule_ = &rule;
        at_ = at;
        if (rule.count) count(*rule.count);
        if (rule.attribute) attribute(*rule.attribute);
        if (rule.relation) relation(*rule.relation);
    }

private:
    void report(std::optional<int> annotation, const std::string& text) {
        broken.push_back({rule_->id, annotation, text + (rule_->note.empty() ? "" : " (" + rule_->note + ")")});
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
            std::set<int>& all = contained_[container];
            while (!front.empty()) {
                const int next = front.back();
                front.pop_back();
                if (!all.insert(next).second) continue;
                if (const auto more = contained.find(next); more != contained.end())
                    front.insert(front.end(), more->second.begin(), more->second.end());
            }
        }
    }

    [[nodiscard]] std::vector<const Annotation*> meant(const Subject& subject, const std::string& at) const {
        std::optional<std::size_t> wanted;
        if (search_ && subject.tag != "*") {
            const auto found = search_->concepts_of(subject.tag);
            if (found.size() != 1)
                fail_input(where_,
                           "at " + at_ + at + ": the vocabulary has " + (found.empty() ? "no" : "more than one") + " concept " +
                               in_quotes(subject.tag),
                           "name a concept by id or label" + did_you_mean(search_->suggestions(subject.tag)));
            wanted = found.front();
        }
        std::vector<const Annotation*> list;
        for (std::size_t i = 0; i < set_.annotations.size(); ++i) {
            const Annotation& annotation = set_.annotations[i];
            if (subject.type && annotation.type != *subject.type) continue;
            const bool same = subject.tag == "*" ? true
                              : wanted           ? concepts_[i] && search_->is_a(*concepts_[i], *wanted)
                                                 : letters_.means(annotation.tag, subject.tag);
            if (same) list.push_back(&annotation);
        }
        return list;
    }

    void count(const CountRule& rule) {
        const auto found = meant(rule.subject, "/count/of");
        const auto number = static_cast<long long>(found.size());
        if ((!rule.min || number >= *rule.min) && (!rule.max || number <= *rule.max)) return;
        std::string wanted = rule.min && rule.max && *rule.min == *rule.max ? "exactly " + to_string(*rule.min)
                             : rule.min && rule.max                         ? to_string(*rule.min) + " to " + to_string(*rule.max)
                             : rule.min                                     ? "at least " + to_string(*rule.min)
                                                                            : "at most " + to_string(*rule.max);
        std::string ids;
        for (std::size_t i = 0; i < std::min<std::size_t>(found.size(), 8); ++i) ids += (i == 0 ? ": " : ", ") + whose(*found[i]);
        if (found.size() > 8) ids += " ...";
        report(std::nullopt,
               "there must be " + wanted + " of " + name_of(rule.subject) + ", there are " + to_string(number) + ids);
    }

    void attribute(const AttributeRule& rule) {
        for (const Annotation* annotation : meant(rule.subject, "/attribute/of")) {
            const auto i = static_cast<std::size_t>(annotation - set_.annotations.data());
            const AllowedAttribute* allowed = concepts_[i] ? search_->attribute_of(*concepts_[i], rule.name) : nullptr;
            bool present = false, good = false;
            std::string seen;
            for (const Attribute& attribute : annotation->attributes) {
                const bool same = folded(attribute.name) == folded(rule.name) ||
                                  (allowed != nullptr && search_->attribute_of(*concepts_[i], attribute.name) == allowed);
                if (!same) continue;
                present = true;
                std::string text;
                good = good || satisfies(rule, allowed, attribute, text);
                seen += (seen.empty() ? "" : ", ") + text;
            }
            if (!present) report(annotation->id, whose(*annotation) + " has no attribute " + in_quotes(rule.name));
            else if (!good)
                report(annotation->id, "the " + in_quotes(rule.name) + " of " + whose(*annotation) + " is " + seen +
                                           ", it must be " + (rule.values.empty() ? range(rule) : alternatives(rule.values)));
        }
    }

    static std::string range(const AttributeRule& rule) {
        const std::string unit = rule.unit.empty() ? "" : " " + rule.unit;
        if (rule.min && rule.max) return text_of(*rule.min) + " to " + text_of(*rule.max) + unit;
        if (!rule.min && !rule.max) return rule.unit.empty() ? "given" : "a number in " + rule.unit;
        return rule.min ? text_of(*rule.min) + unit + " or more" : text_of(*rule.max) + unit + " or less";
    }

    static bool satisfies(const AttributeRule& rule, const AllowedAttribute* allowed, const Attribute& attribute,
                          std::string& text) {
        if (attribute.type == AttributeType::semantic) {
            text = in_quotes(attribute.note);
            if (rule.min || rule.max || !rule.unit.empty()) return false;
            return rule.values.empty() || is_one_of(attribute.note, rule.values, allowed);
        }
        const auto [values, unit, stale] = figures_of(attribute);
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
        std::set<int> others;
        for (const Annotation* annotation : meant(rule.to, "/relation/to")) others.insert(annotation->id);
        std::set<std::string> types;
        for (const std::string& type : rule.types) types.insert(folded(type));
        for (const Annotation* annotation : meant(rule.subject, "/relation/of"))
            if (!related(annotation->id, others, types, rule.place))
                report(annotation->id, whose(*annotation) + " stands in no relation of " + alternatives(rule.types) + " to " +
                                           (others.empty() ? "any " + name_of(rule.to) + ", there is none" : name_of(rule.to)));
    }

    [[nodiscard]] bool related(int id, const std::set<int>& others, const std::set<std::string>& types,
                               RelationRule::Place place) const {
        using Place = RelationRule::Place;
        const auto among = [&](int other) { return other != id && others.contains(other); };
        if (types.contains("containment"))
            for (const auto& [container, contained] : contained_) {
                if (container == id && place != Place::second && std::any_of(contained.begin(), contained.end(), among))
                    return true;
                if (place != Place::first && among(container) && contained.contains(id)) return true;
            }
        for (const RelationFact& fact : relations_) {
            if (!types.contains(folded(fact.type)) || folded(fact.type) == "containment") continue;
            const auto self = std::find(fact.annotations.begin(), fact.annotations.end(), id);
            if (self == fact.annotations.end()) continue;
            const bool first = self == fact.annotations.begin();
            if (fact.directed && place == Place::first && !first) continue;
            if (fact.directed && place == Place::second && first) continue;
            if (std::any_of(fact.annotations.begin(), fact.annotations.end(), among)) return true;
        }
        return false;
    }

    const AnnotationSet& set_;
    const std::vector<RelationFact>& relations_;
    std::string where_, at_;
    std::optional<VocabularySearch> search_;
    std::vector<std::optional<std::size_t>> concepts_;
    TagWords letters_;  ///< used if there is no vocabulary
    std::map<int, std::set<int>> contained_;
    const ClassRule* rule_ = nullptr;
};

}  // namespace

bool ClassRules::about_relations() const {
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
        const std::string at = "/rules/" + to_string(i);
        result.rules.push_back(class_rule_of(rules[i], where, at));
        if (!ids.insert(result.rules.back().id).second)
            fail_input(where, "at " + at + "/id: another rule is called '" + result.rules.back().id + "' as well",
                       "give each rule an id of its own");
    }
    return result;
}

ClassRules read_class_rules(const Path& file) { return class_rules_from_json(read_json(file), file.string()); }

std::vector<BrokenRule> check_class_rules(const AnnotationSet& set, const ClassRules& rules, const Vocabulary* vocabulary,
                                          const std::vector<RelationFact>& relations, const std::string& where) {
    RuleChecker checker(set, vocabulary, relations, where);
    for (std::size_t i = 0; i < rules.rules.size(); ++i) checker.look_at(rules.rules[i], "/rules/" + to_string(i));
    return std::move(checker.broken);
}

}  // namespace ostraka

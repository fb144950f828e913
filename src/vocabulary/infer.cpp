#include "ostraka/vocabulary/infer.h"

#include "ostraka/vocabulary/text_match.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace ostraka {

namespace {

std::string text_of(double value) {
    std::ostringstream text;
    text.precision(6);
    text << value;
    return text.str();
}

std::string in_quotes(const std::string& text) { return "'" + text + "'"; }

/// What an operand came to, or why it came to nothing.
struct Value {
    std::optional<double> number;
    std::string word, unit;
    std::string missing;
};

enum class Verdict { holds, fails, unknown };

struct Judgement {
    Verdict verdict = Verdict::holds;
    std::string why;      ///< the conditions that hold, with their inputs
    std::string missing;  ///< what keeps the rule from being judged
};

class Reasoner {
public:
    Reasoner(const AnnotationSet& set, const Vocabulary& vocabulary) : search_(vocabulary) {
        result_.annotations.object_class = set.object_class;
        result_.annotations.unit = set.unit;
        result_.annotations.up = set.up;
        result_.annotations.notes = set.notes;
        if (!set.provenance.IsNull())
            result_.annotations.provenance.CopyFrom(set.provenance, result_.annotations.provenance.GetAllocator());
        result_.annotations.annotations = set.annotations;
        for (Annotation& annotation : result_.annotations.annotations) {
            std::erase_if(annotation.attributes, [](const Attribute& attribute) { return inferred(attribute); });
            concepts_.push_back(search_.concept_of(annotation.tag));
        }
        given_ = result_.annotations.annotations;
    }

    InferenceResult run() {
        // Where rules disagree, their attribute is blocked and all is done again without it.
        for (std::size_t blocked = 0;; blocked = blocked_.size()) {
            result_.annotations.annotations = given_;
            result_.inferred.clear();
            while (pass()) {
            }
            if (blocked_.size() == blocked) break;
        }
        say_missing();
        return std::move(result_);
    }

private:
    using Key = std::pair<std::size_t, std::string>;  // annotation, attribute

    static bool inferred(const Attribute& attribute) {
        return attribute.type == AttributeType::semantic && attribute.origin.starts_with("rule ");
    }

    [[nodiscard]] std::vector<Annotation>& annotations() { return result_.annotations.annotations; }

    [[nodiscard]] bool speaks_of(const InferenceRule& rule, std::size_t i) const {
        if (!concepts_[i]) return false;
        if (!rule.concept_id.empty() && !search_.is_a(*concepts_[i], *search_.find(rule.concept_id))) return false;
        return search_.attribute_of(*concepts_[i], rule.attribute) != nullptr;
    }

    /// The attributes of an annotation that a name means.
    [[nodiscard]] std::vector<const Attribute*> attributes_named(std::size_t i, const std::string& name) {
        const auto meaning = [&](const std::string& text) {
            const AllowedAttribute* allowed = concepts_[i] ? search_.attribute_of(*concepts_[i], text) : nullptr;
            return folded(allowed == nullptr ? text : allowed->name);
        };
        std::vector<const Attribute*> found;
        const std::string wanted = meaning(name);
        for (const Attribute& attribute : annotations()[i].attributes)
            if (meaning(attribute.name) == wanted) found.push_back(&attribute);
        return found;
    }

    Value value_of(const Operand& operand, std::size_t i) {
        Value value;
        if (!operand.concept_id.empty()) {
            std::vector<std::size_t> owners;
            for (std::size_t k = 0; k < annotations().size(); ++k)
                if (concepts_[k] && search_.is_a(*concepts_[k], *search_.find(operand.concept_id))) owners.push_back(k);
            if (owners.size() != 1) {
                value.missing = (owners.empty() ? "there is no " : "there are several of ") + in_quotes(operand.concept_id);
                return value;
            }
            i = owners.front();
        }
        const std::string name =
            in_quotes(operand.attribute) + (operand.concept_id.empty() ? "" : " of " + in_quotes(operand.concept_id));
        const auto found = attributes_named(i, operand.attribute);
        if (found.size() != 1) {
            value.missing = (found.empty() ? "it has no " : "it has more than one ") + name;
            return value;
        }
        const Attribute& attribute = *found.front();
        const bool measured = attribute.type == AttributeType::measure;
        if (attribute.type == AttributeType::semantic) {
            value.word = attribute.note;
            return value;
        }
        value.unit = measured ? attribute.measure.unit : attribute.descriptor.unit;
        if (measured ? attribute.measure.stale : attribute.descriptor.stale) value.missing = name + " is stale";
        else if (measured && attribute.measure.value) value.number = attribute.measure.value;
        else if (!measured && attribute.descriptor.values.size() == 1) value.number = attribute.descriptor.values.front();
        else value.missing = name + (measured || attribute.descriptor.values.empty() ? " has no value" : " is a list of numbers");
        return value;
    }

    static std::string name_of(const Operand& operand) {
        return operand.attribute + (operand.concept_id.empty() ? "" : " of " + operand.concept_id);
    }

    Judgement judge(const InferenceRule& rule, const Condition& c, std::size_t i) {
        const Value value = value_of(c.operand, i);
        if (!value.missing.empty()) return {Verdict::unknown, {}, value.missing};
        if (!c.is.empty()) {
            if (value.number) return {Verdict::unknown, {}, in_quotes(c.operand.attribute) + " is a number"};
            const AllowedAttribute* allowed =
                concepts_[i] && c.operand.concept_id.empty() ? search_.attribute_of(*concepts_[i], c.operand.attribute) : nullptr;
            const bool holds = std::any_of(c.is.begin(), c.is.end(), [&](const std::string& word) {
                if (folded(word) == folded(value.word)) return true;
                const Term* term = allowed == nullptr ? nullptr : term_of(*allowed, word);
                return term != nullptr && term == term_of(*allowed, value.word);
            });
            return {holds ? Verdict::holds : Verdict::fails, name_of(c.operand) + " is " + value.word, {}};
        }
        if (!value.number) return {Verdict::unknown, {}, in_quotes(c.operand.attribute) + " is a word"};
        double number = *value.number;
        std::string text = name_of(c.operand);
        std::string inputs = text + " " + text_of(number) + (value.unit.empty() ? "" : " " + value.unit);
        std::string unit;
        if (c.divisor) {
            const Value divisor = value_of(*c.divisor, i);
            if (!divisor.missing.empty()) return {Verdict::unknown, {}, divisor.missing};
            if (!divisor.number) return {Verdict::unknown, {}, in_quotes(c.divisor->attribute) + " is a word"};
            const auto same = converted(*divisor.number, divisor.unit, value.unit);
            if (!same) return {Verdict::unknown, {}, "'" + value.unit + "' and '" + divisor.unit + "' cannot be compared"};
            if (*same == 0) return {Verdict::unknown, {}, in_quotes(c.divisor->attribute) + " is zero"};
            number /= *same;
            inputs +=
                ", " + name_of(*c.divisor) + " " + text_of(*divisor.number) + (divisor.unit.empty() ? "" : " " + divisor.unit);
            text += " / " + name_of(*c.divisor) + " = " + text_of(number);
        } else {
            unit = condition_unit(search_, rule, c);
            if (!unit.empty()) {
                const auto same = converted(number, value.unit, unit);
                if (!same)
                    return {Verdict::unknown,
                            {},
                            in_quotes(c.operand.attribute) +
                                (value.unit.empty() ? " has no unit" : " is in '" + value.unit + "', not in '" + unit + "'")};
                number = *same;
            }
        }
        const bool holds = (!c.min || number >= *c.min) && (!c.max || number <= *c.max) && (!c.above || number > *c.above) &&
                           (!c.below || number < *c.below);
        std::string bounds;
        const auto bound = [&](const std::optional<double>& limit, const char* sign) {
            if (limit) bounds += (bounds.empty() ? " " : " and ") + std::string(sign) + " " + text_of(*limit);
        };
        bound(c.min, ">="), bound(c.above, ">"), bound(c.max, "<="), bound(c.below, "<");
        if (!unit.empty()) bounds += " " + unit;
        return {holds ? Verdict::holds : Verdict::fails, c.divisor ? text + bounds + " (" + inputs + ")" : inputs + bounds, {}};
    }

    Judgement judge(const InferenceRule& rule, std::size_t i) {
        Judgement all;
        for (const Condition& condition : rule.conditions) {
            const Judgement one = judge(rule, condition, i);
            if (one.verdict == Verdict::fails) return one;
            if (one.verdict == Verdict::unknown) {
                all.verdict = Verdict::unknown;
                all.missing += (all.missing.empty() ? "" : "; ") + one.missing;
            }
            all.why += (all.why.empty() ? "" : "; ") + one.why;
        }
        return all;
    }

    /// All rules over all annotations, once. True if a word was added, so that other rules may hold now.
    bool pass() {
        bool added = false;
        for (std::size_t i = 0; i < annotations().size(); ++i)
            for (const InferenceRule& rule : search_.vocabulary().rules) {
                if (!speaks_of(rule, i)) continue;
                const AllowedAttribute& allowed = *search_.attribute_of(*concepts_[i], rule.attribute);
                const Key key{i, allowed.name};
                if (blocked_.contains(key)) continue;
                const Judgement judgement = judge(rule, i);
                if (judgement.verdict == Verdict::holds) added = conclude(rule, allowed, key, judgement.why) || added;
            }
        return added;
    }

    bool conclude(const InferenceRule& rule, const AllowedAttribute& allowed, const Key& key, const std::string& why) {
        Annotation& annotation = annotations()[key.first];
        const Term* term = term_of(allowed, rule.value);
        const std::string value = term == nullptr ? rule.value : term->name;
        const auto stands = attributes_named(key.first, allowed.name);
        const std::string whose = in_quotes(annotation.tag) + " (id " + std::to_string(annotation.id) + "): ";
        const std::string says = "the rule " + in_quotes(rule.id) + " says " + in_quotes(value) + ", since " + why;
        for (const Attribute* other : stands) {
            if (other->type == AttributeType::semantic) {
                const Term* stated = term_of(allowed, other->note);
                if (folded(stated == nullptr ? other->note : stated->name) == folded(value)) return false;  // said already
            }
            blocked_.insert(key);
            result_.contradictions.push_back(
                whose + in_quotes(allowed.name) +
                (inferred(*other)
                     ? " is left out: the " + other->origin + " says " + in_quotes(other->note)
                     : " is stated to be " + in_quotes(other->type == AttributeType::semantic ? other->note : "a number")) +
                ", but " + says);
            return false;
        }
        Attribute attribute;
        for (const Attribute& other : annotation.attributes) attribute.id = std::max(attribute.id, other.id + 1);
        attribute.name = allowed.name;
        attribute.note = value;
        attribute.origin = "rule " + in_quotes(rule.id) + ": " + why;
        annotation.attributes.push_back(attribute);
        result_.inferred.push_back({annotation.id, allowed.name, value, rule.id, attribute.origin});
        return true;
    }

    void say_missing() {
        for (std::size_t i = 0; i < annotations().size(); ++i)
            for (const InferenceRule& rule : search_.vocabulary().rules) {
                if (!speaks_of(rule, i)) continue;
                const Judgement judgement = judge(rule, i);
                if (judgement.verdict == Verdict::unknown)
                    result_.missing.push_back(in_quotes(annotations()[i].tag) + " (id " + std::to_string(annotations()[i].id) +
                                              "): the rule " + in_quotes(rule.id) + " cannot be judged: " + judgement.missing);
            }
    }

    VocabularySearch search_;
    InferenceResult result_;
    std::vector<std::optional<std::size_t>> concepts_;
    std::vector<Annotation> given_;
    std::set<Key> blocked_;
};

}  // namespace

std::string condition_unit(const VocabularySearch& search, const InferenceRule& rule, const Condition& condition) {
    if (condition.divisor || !condition.unit.empty() || !condition.is.empty()) return condition.unit;
    const std::string& owner = condition.operand.concept_id.empty() ? rule.concept_id : condition.operand.concept_id;
    if (!owner.empty()) {
        const AllowedAttribute* allowed = search.attribute_of(*search.find(owner), condition.operand.attribute);
        return allowed == nullptr ? std::string() : allowed->unit;
    }
    for (const AllowedAttribute& allowed : search.vocabulary().attributes)
        if (folded(allowed.name) == folded(condition.operand.attribute)) return allowed.unit;
    return {};
}

InferenceResult infer(const AnnotationSet& set, const Vocabulary& vocabulary) { return Reasoner(set, vocabulary).run(); }

}  // namespace ostraka

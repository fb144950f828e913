// Annotations against a vocabulary, and a vocabulary against itself.
#include "ostraka/core/error.h"
#include "ostraka/vocabulary/infer.h"
#include "ostraka/vocabulary/text_match.h"
#include "ostraka/vocabulary/vocabulary.h"

#include <algorithm>
#include <limits>
#include <set>
#include <sstream>

namespace ostraka {

namespace {

using std::to_string;

std::string text_of(double value) {
    std::ostringstream text;
    text.precision(9);
    text << value;
    return text.str();
}

std::string quoted(const std::vector<std::string>& names) {
    std::string text;
    for (const auto& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
    return text;
}

std::string range_text(const AllowedAttribute& attribute) {
    const std::string unit = attribute.unit.empty() ? "" : " " + attribute.unit;
    if (attribute.min && attribute.max) return text_of(*attribute.min) + " to " + text_of(*attribute.max) + unit;
    return attribute.min ? text_of(*attribute.min) + unit + " or more" : text_of(*attribute.max) + unit + " or less";
}

class Inspector {
public:
    Inspector(const Vocabulary& vocabulary, const CheckVocabularyOptions& options) : search_(vocabulary), options_(options) {}
    std::vector<Finding> findings;

    void look_at(const Annotation& annotation, const std::string& at) {
        const auto concepts = search_.concepts_of(annotation.tag);
        if (concepts.empty()) {
            defect(at + "/tag", "the tag '" + annotation.tag + "' is not in the vocabulary" +
                                    did_you_mean(search_.suggestions(annotation.tag)));
            return;
        }
        if (concepts.size() > 1) {
            std::vector<std::string> ids;
            for (const std::size_t i : concepts) ids.push_back(search_.vocabulary().concepts[i].id);
            defect(at + "/tag", "the tag '" + annotation.tag + "' may mean " + quoted(ids) + ": use one of these ids");
            return;
        }
        for (std::size_t i = 0; i < annotation.attributes.size(); ++i)
            attribute(concepts.front(), annotation.attributes[i], at + "/attributes/" + to_string(i));
    }

private:
    void defect(const std::string& at, const std::string& text) { findings.push_back({true, at, text}); }
    void remark(const std::string& at, const std::string& text) { findings.push_back({false, at, text}); }

    void attribute(std::size_t concept_index, const Attribute& attribute, const std::string& at) {
        const AllowedAttribute* allowed = search_.attribute_of(concept_index, attribute.name);
        const bool word = attribute.type == AttributeType::semantic;
        if (allowed == nullptr) {
            std::vector<std::string> names;
            for (const AllowedAttribute* other : search_.attributes_of(concept_index)) {
                names.push_back(other->name);
                for (const auto& [language, label] : other->labels) names.push_back(label);
            }
            const std::string text = "the attribute '" + attribute.name + "' is not among those of '" +
                                     search_.vocabulary().concepts[concept_index].id + "'" +
                                     did_you_mean(near_misses(attribute.name, names));
            if (word || options_.strict) defect(at + "/name", text);
            else remark(at + "/name", text);
            return;
        }
        if (word && allowed->quantitative())
            defect(at, "'" + attribute.name + "' is a quantity in the vocabulary, and a word here: '" + attribute.note + "'");
        else if (!word && !allowed->values.empty())
            defect(at, "'" + attribute.name + "' is one of a list of words in the vocabulary, and a quantity here");
        else if (word) value(*allowed, attribute, at);
        else quantity(*allowed, attribute, at);
    }

    void value(const AllowedAttribute& allowed, const Attribute& attribute, const std::string& at) {
        if (allowed.values.empty() || term_of(allowed, attribute.note) != nullptr) return;
        std::vector<std::string> names, all;
        for (const Term& term : allowed.values) {
            names.push_back(term.name);
            all.push_back(term.name);
            for (const auto& [language, label] : term.labels) all.push_back(label);
        }
        std::string hint = did_you_mean(near_misses(attribute.note, all));
        if (hint.empty() && names.size() <= 12) hint = ": it is one of " + quoted(names);
        defect(at + "/note", "'" + attribute.note + "' is no value of '" + attribute.name + "'" + hint);
    }

    void quantity(const AllowedAttribute& allowed, const Attribute& attribute, const std::string& at) {
        if (!allowed.quantitative()) return;
        const bool measured = attribute.type == AttributeType::measure;
        const std::string& unit = measured ? attribute.measure.unit : attribute.descriptor.unit;
        std::vector<double> values = attribute.descriptor.values;
        if (measured) values = attribute.measure.value ? std::vector<double>{*attribute.measure.value} : std::vector<double>{};
        if (measured ? attribute.measure.stale : attribute.descriptor.stale) {
            remark(at, "the value of '" + attribute.name + "' is stale: its range was not looked at");
            return;
        }
        if (unit.empty() && !allowed.unit.empty()) {
            remark(at, "'" + attribute.name + "' has no unit: its range was not looked at");
            return;
        }
        for (const double value : values) {
            const std::optional<double> number = allowed.unit.empty() ? value : converted(value, unit, allowed.unit);
            if (!number) {
                defect(at, "'" + attribute.name + "' is in '" + unit + "', which cannot be brought to the vocabulary's '" +
                               allowed.unit + "'");
                return;
            }
            if ((allowed.min && *number < *allowed.min) || (allowed.max && *number > *allowed.max)) {
                defect(at, "'" + attribute.name + "' is " + text_of(value) + (unit.empty() ? "" : " " + unit) +
                               ", outside its range of " + range_text(allowed));
                return;
            }
        }
    }

    VocabularySearch search_;
    CheckVocabularyOptions options_;
};

/// Bounds of a condition as an interval, closed or open at each end.
struct Interval {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    bool low_open = false, high_open = false;

    explicit Interval(const Condition& c) {
        if (c.min || c.above) low = c.min ? *c.min : *c.above, low_open = c.above.has_value();
        if (c.max || c.below) high = c.max ? *c.max : *c.below, high_open = c.below.has_value();
    }
    [[nodiscard]] bool meets(const Interval& other) const {
        const auto before = [](const Interval& a, const Interval& b) {
            return a.high < b.low || (a.high == b.low && (a.high_open || b.low_open));
        };
        return !before(*this, other) && !before(other, *this);
    }
};

/// Can both conditions hold of one annotation? Yes unless they speak of the same thing and exclude one another.
bool compatible(const Condition& a, const std::string& a_unit, const Condition& b, const std::string& b_unit) {
    const auto same = [](const Operand& x, const Operand& y) {
        return folded(x.attribute) == folded(y.attribute) && x.concept_id == y.concept_id;
    };
    if (!same(a.operand, b.operand) || a.divisor.has_value() != b.divisor.has_value()) return true;
    if (a.divisor && !same(*a.divisor, *b.divisor)) return true;
    if (!a.is.empty() && !b.is.empty()) {
        std::set<std::string> words;
        for (const auto& word : a.is) words.insert(folded(word));
        return std::any_of(b.is.begin(), b.is.end(), [&](const auto& word) { return words.contains(folded(word)); });
    }
    if (!a.is.empty() || !b.is.empty()) return false;
    const auto other_unit = converted(1, b_unit, a_unit);
    if (!other_unit) return true;
    Condition scaled = b;
    for (auto* bound : {&scaled.min, &scaled.max, &scaled.above, &scaled.below})
        if (*bound) **bound *= *other_unit;
    return Interval(a).meets(Interval(scaled));
}

/// Rules that speak of one attribute of one concept (or of a narrower one) and can both hold with different results.
void compare_rules(const VocabularySearch& search, std::vector<Finding>& findings) {
    const auto& rules = search.vocabulary().rules;
    for (std::size_t i = 0; i < rules.size(); ++i)
        for (std::size_t k = i + 1; k < rules.size(); ++k) {
            const InferenceRule &a = rules[i], &b = rules[k];
            if (folded(a.attribute) != folded(b.attribute) || folded(a.value) == folded(b.value)) continue;
            if (!a.concept_id.empty() && !b.concept_id.empty()) {
                const std::size_t x = *search.find(a.concept_id), y = *search.find(b.concept_id);
                if (!search.is_a(x, y) && !search.is_a(y, x)) continue;
            }
            bool both = true;
            for (const Condition& x : a.conditions)
                for (const Condition& y : b.conditions)
                    both = both && compatible(x, condition_unit(search, a, x), y, condition_unit(search, b, y));
            if (both)
                findings.push_back({false, "/rules/" + to_string(k),
                                    "the rules '" + a.id + "' and '" + b.id + "' can both hold, and infer '" + a.value +
                                        "' and '" + b.value + "' for '" + a.attribute + "'"});
        }
}

}  // namespace

std::vector<Finding> check_against_vocabulary(const AnnotationSet& set, const Vocabulary& vocabulary,
                                              const CheckVocabularyOptions& options) {
    Inspector inspector(vocabulary, options);
    for (std::size_t i = 0; i < set.annotations.size(); ++i)
        inspector.look_at(set.annotations[i], "/annotations/" + to_string(i));
    return std::move(inspector.findings);
}

void require_vocabulary(const AnnotationSet& set, const Vocabulary& vocabulary, const std::string& where,
                        const CheckVocabularyOptions& options) {
    Inspector inspector(vocabulary, options);
    std::size_t defects = 0;
    std::string first;
    for (const Annotation& annotation : set.annotations) {
        inspector.findings.clear();
        inspector.look_at(annotation, "");
        for (const auto& finding : inspector.findings) {
            if (finding.defect && ++defects == 1) first = "annotation " + to_string(annotation.id) + ": " + finding.text;
        }
    }
    if (defects > 0)
        fail_input(where, first + (defects > 1 ? " (and " + to_string(defects - 1) + " more)" : ""),
                   "use words of the vocabulary, or add to it");
}

std::vector<Finding> examine(const Vocabulary& vocabulary) {
    std::vector<Finding> findings;
    const VocabularySearch search(vocabulary);
    std::map<std::string, std::size_t> languages;
    for (const Concept& entry : vocabulary.concepts)
        for (const auto& [language, label] : entry.labels)
            if (!language.empty()) ++languages[language];
    for (std::size_t i = 0; i < vocabulary.concepts.size(); ++i) {
        const Concept& entry = vocabulary.concepts[i];
        const std::string at = "/concepts/" + to_string(i);
        if (entry.labels.empty()) findings.push_back({false, at, "the concept '" + entry.id + "' has no label"});
        std::string missing;
        for (const auto& [language, count] : languages)
            if (!entry.labels.empty() && !entry.labels.contains(language)) missing += (missing.empty() ? "" : ", ") + language;
        if (!missing.empty()) findings.push_back({false, at, "the concept '" + entry.id + "' has no label in " + missing});
        // Of concepts that share a label, the last one names the others.
        std::set<std::string> told;
        const auto look = [&](const std::string& label) {
            const auto concepts = label == entry.id ? std::vector<std::size_t>{i} : search.concepts_of(label);
            if (concepts.size() < 2 || concepts.back() != i || !told.insert(folded(label)).second) return;
            std::vector<std::string> ids;
            for (const std::size_t k : concepts) ids.push_back(vocabulary.concepts[k].id);
            findings.push_back({false, at, "the label '" + label + "' means " + quoted(ids) + ": as a tag it is ambiguous"});
        };
        for (const auto& [language, label] : entry.labels) look(label);
        for (const auto& [language, labels] : entry.alternatives)
            for (const auto& label : labels) look(label);
    }
    compare_rules(search, findings);
    return findings;
}

}  // namespace ostraka

// Checks annotations against a vocabulary, and a vocabulary for consistency.
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/text.h"
#include "ostraka/vocabulary/infer.h"
#include "ostraka/vocabulary/text_match.h"
#include "ostraka/vocabulary/vocabulary.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <set>

namespace ostraka {

namespace {

using std::to_string;

std::string quoted(const std::vector<std::string>& names) { return fmt::format("'{}'", joined(names, "', '")); }

std::string range_text(const AllowedAttribute& attribute) {
    const std::string unit = attribute.unit.empty() ? "" : " " + attribute.unit;
    if (attribute.min && attribute.max)
        return fmt::format("{} to {}{}", digits(*attribute.min, 9), digits(*attribute.max, 9), unit);
    return attribute.min ? fmt::format("{}{} or more", digits(*attribute.min, 9), unit)
                         : fmt::format("{}{} or less", digits(*attribute.max, 9), unit);
}

class Inspector {
public:
    Inspector(const Vocabulary& vocabulary, const CheckVocabularyOptions& options) : search_(vocabulary), options_(options) {}
    std::vector<Finding> findings;

    void check(const Annotation& annotation, const std::string& pointer) {
        const auto concepts = search_.concepts_of(annotation.tag);
        if (concepts.empty()) {
            defect(pointer + "/tag", fmt::format("the tag '{}' is not in the vocabulary{}", annotation.tag,
                                                 did_you_mean(search_.suggestions(annotation.tag))));
            return;
        }
        if (concepts.size() > 1) {
            std::vector<std::string> ids;
            for (const std::size_t i : concepts) ids.push_back(search_.vocabulary().concepts[i].id);
            defect(pointer + "/tag",
                   fmt::format("the tag '{}' is ambiguous between {}: use one of these ids", annotation.tag, quoted(ids)));
            return;
        }
        for (std::size_t i = 0; i < annotation.attributes.size(); ++i)
            attribute(concepts.front(), annotation.attributes[i], fmt::format("{}/attributes/{}", pointer, i));
    }

private:
    void defect(const std::string& pointer, const std::string& text) { findings.push_back({true, pointer, text}); }
    void remark(const std::string& pointer, const std::string& text) { findings.push_back({false, pointer, text}); }

    void attribute(std::size_t concept_index, const Attribute& attribute, const std::string& pointer) {
        const AllowedAttribute* allowed = search_.attribute_of(concept_index, attribute.name);
        const Note* note = attribute.note();
        if (allowed == nullptr) {
            std::vector<std::string> names;
            for (const AllowedAttribute* candidate : search_.attributes_of(concept_index)) {
                names.push_back(candidate->name);
                for (const auto& [language, label] : candidate->labels) names.push_back(label);
            }
            const std::string text =
                fmt::format("the attribute '{}' is not among those of '{}'{}", attribute.name,
                            search_.vocabulary().concepts[concept_index].id, did_you_mean(near_misses(attribute.name, names)));
            if (note != nullptr || options_.strict) defect(pointer + "/name", text);
            else remark(pointer + "/name", text);
            return;
        }
        if (note != nullptr && allowed->quantitative())
            defect(pointer,
                   fmt::format("'{}' is a quantity in the vocabulary, but has the text value '{}'", attribute.name, note->text));
        else if (note == nullptr && !allowed->values.empty())
            defect(pointer, fmt::format("'{}' has a list of values in the vocabulary, but is a quantity here", attribute.name));
        else if (note != nullptr) value(*allowed, attribute.name, note->text, pointer);
        else quantity(*allowed, attribute, pointer);
    }

    void value(const AllowedAttribute& allowed, const std::string& name, const std::string& text, const std::string& pointer) {
        if (allowed.values.empty() || term_of(allowed, text) != nullptr) return;
        std::vector<std::string> names, all_names;
        for (const Term& term : allowed.values) {
            names.push_back(term.name);
            all_names.push_back(term.name);
            for (const auto& [language, label] : term.labels) all_names.push_back(label);
        }
        std::string hint = did_you_mean(near_misses(text, all_names));
        if (hint.empty() && names.size() <= 12) hint = ": its values are " + quoted(names);
        defect(pointer + "/note", fmt::format("'{}' is not a value of '{}'{}", text, name, hint));
    }

    void quantity(const AllowedAttribute& allowed, const Attribute& attribute, const std::string& pointer) {
        if (!allowed.quantitative()) return;
        const auto [values, unit, stale] = attribute_values(attribute);
        if (stale) {
            remark(pointer, fmt::format("the value of '{}' is stale: its range was not checked", attribute.name));
            return;
        }
        if (unit.empty() && !allowed.unit.empty()) {
            remark(pointer, fmt::format("'{}' has no unit: its range was not checked", attribute.name));
            return;
        }
        for (const double value : values) {
            const std::optional<double> number = allowed.unit.empty() ? value : converted(value, unit, allowed.unit);
            if (!number) {
                defect(pointer, fmt::format("'{}' is in '{}', which cannot be converted to the vocabulary's '{}'", attribute.name,
                                            unit, allowed.unit));
                return;
            }
            if ((allowed.min && *number < *allowed.min) || (allowed.max && *number > *allowed.max)) {
                defect(pointer, fmt::format("'{}' is {}{}, outside its range of {}", attribute.name, digits(value, 9),
                                            unit.empty() ? "" : " " + unit, range_text(allowed)));
                return;
            }
        }
    }

    VocabularySearch search_;
    CheckVocabularyOptions options_;
};

/// The bounds of a condition as an interval, closed or open at each end.
struct Interval {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    bool low_open = false, high_open = false;

    explicit Interval(const Condition& c) {
        if (c.min || c.above) low = c.min ? *c.min : *c.above, low_open = c.above.has_value();
        if (c.max || c.below) high = c.max ? *c.max : *c.below, high_open = c.below.has_value();
    }
    [[nodiscard]] bool overlaps(const Interval& other) const {
        const auto before = [](const Interval& a, const Interval& b) {
            return a.high < b.low || (a.high == b.low && (a.high_open || b.low_open));
        };
        return !before(*this, other) && !before(other, *this);
    }
};

/// A condition with its names resolved.
struct Side {
    std::string subject;  ///< the attribute or ratio that the condition is about
    std::set<std::string> words;
    Condition bounds;
    std::string unit;
};

struct ResolvedRule {
    std::string value;
    std::optional<std::size_t> concept_index;
    std::set<std::size_t> lineage;
    std::vector<Side> sides;
};

ResolvedRule resolved(const VocabularySearch& search, const InferenceRule& rule) {
    ResolvedRule result{folded(rule.value), {}, {}, {}};
    if (!rule.concept_id.empty()) {
        result.concept_index = search.find(rule.concept_id);
        const auto ancestors = search.lineage(*result.concept_index);
        result.lineage.insert(ancestors.begin(), ancestors.end());
    }
    for (const Condition& c : rule.conditions) {
        const auto name = [](const Operand& x) { return folded(x.attribute) + '\0' + x.concept_id; };
        Side side{name(c.operand) + (c.divisor ? '\0' + name(*c.divisor) : ""), {}, c, condition_unit(search, rule, c)};
        for (const auto& word : c.is) side.words.insert(folded(word));
        result.sides.push_back(std::move(side));
    }
    return result;
}

/// True if both conditions can hold for one annotation: they are about different things, or do not exclude each other.
bool compatible(const Side& a, const Side& b) {
    if (a.subject != b.subject) return true;
    if (!a.words.empty() && !b.words.empty())
        return std::any_of(b.words.begin(), b.words.end(), [&](const auto& word) { return a.words.contains(word); });
    if (!a.words.empty() || !b.words.empty()) return false;
    const auto other_unit = converted(1, b.unit, a.unit);
    if (!other_unit) return true;
    Condition scaled;
    const auto scale = [&](const std::optional<double>& x) { return x ? std::optional<double>(*x * *other_unit) : x; };
    scaled.min = scale(b.bounds.min), scaled.max = scale(b.bounds.max);
    scaled.above = scale(b.bounds.above), scaled.below = scale(b.bounds.below);
    return Interval(a.bounds).overlaps(Interval(scaled));
}

/// Reports pairs of rules about one attribute of one concept (or of a narrower one) that can both hold with different results.
/// Their number may be quadratic; the first hundred are named, the others counted.
void compare_rules(const VocabularySearch& search, std::vector<Finding>& findings) {
    constexpr std::size_t maximum = 100;
    const auto& rules = search.vocabulary().rules;
    std::vector<ResolvedRule> sides;
    std::map<std::string, std::vector<std::size_t>> by_attribute;
    for (std::size_t i = 0; i < rules.size(); ++i) {
        sides.push_back(resolved(search, rules[i]));
        by_attribute[folded(rules[i].attribute)].push_back(i);
    }
    const auto both_hold = [](const ResolvedRule& a, const ResolvedRule& b) {
        if (a.value == b.value) return false;
        if (a.concept_index && b.concept_index && !a.lineage.contains(*b.concept_index) && !b.lineage.contains(*a.concept_index))
            return false;
        for (const Side& x : a.sides)
            for (const Side& y : b.sides)
                if (!compatible(x, y)) return false;
        return true;
    };
    std::vector<std::pair<std::size_t, std::size_t>> conflicts;  // the first hundred, in the order of the rules
    std::size_t count = 0;
    for (const auto& [attribute, indices] : by_attribute) {
        std::size_t conflict_count = 0;
        for (std::size_t x = 0; x < indices.size(); ++x)
            for (std::size_t y = x + 1; y < indices.size(); ++y)
                if (both_hold(sides[indices[x]], sides[indices[y]])) {
                    ++count;
                    if (conflict_count++ < maximum) conflicts.emplace_back(indices[x], indices[y]);
                }
    }
    std::sort(conflicts.begin(), conflicts.end());
    if (conflicts.size() > maximum) conflicts.resize(maximum);
    for (const auto& [i, k] : conflicts)
        findings.push_back({false, "/rules/" + to_string(k),
                            fmt::format("the rules '{}' and '{}' can both hold, and infer '{}' and '{}' for '{}'", rules[i].id,
                                        rules[k].id, rules[i].value, rules[k].value, rules[i].attribute)});
    if (count > conflicts.size())
        findings.push_back(
            {false, "/rules",
             to_string(count - conflicts.size()) + " more pairs of rules can both hold and infer different words"});
}

}  // namespace

std::vector<Finding> check_against_vocabulary(const AnnotationSet& set, const Vocabulary& vocabulary,
                                              const CheckVocabularyOptions& options) {
    Inspector inspector(vocabulary, options);
    for (std::size_t i = 0; i < set.annotations.size(); ++i) inspector.check(set.annotations[i], "/annotations/" + to_string(i));
    return std::move(inspector.findings);
}

void require_vocabulary(const AnnotationSet& set, const Vocabulary& vocabulary, const std::string& where,
                        const CheckVocabularyOptions& options) {
    Inspector inspector(vocabulary, options);
    std::size_t defects = 0;
    std::string first;
    for (const Annotation& annotation : set.annotations) {
        inspector.findings.clear();
        inspector.check(annotation, "");
        for (const auto& finding : inspector.findings) {
            if (finding.defect && ++defects == 1) first = fmt::format("annotation {}: {}", annotation.id, finding.text);
        }
    }
    if (defects > 0)
        fail_input(where, first + (defects > 1 ? fmt::format(" (and {} more)", defects - 1) : ""),
                   "use terms of the vocabulary, or extend it");
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
        const std::string pointer = "/concepts/" + to_string(i);
        if (entry.labels.empty()) findings.push_back({false, pointer, fmt::format("the concept '{}' has no label", entry.id)});
        std::vector<std::string> missing;
        for (const auto& [language, count] : languages)
            if (!entry.labels.empty() && !entry.labels.contains(language)) missing.push_back(language);
        if (!missing.empty())
            findings.push_back({false, pointer, fmt::format("the concept '{}' has no label in {}", entry.id, joined(missing))});
        // If concepts share a label, the finding is reported at the last of them.
        std::set<std::string> reported;
        const auto check_label = [&](const std::string& label) {
            const auto concepts = label == entry.id ? std::vector<std::size_t>{i} : search.concepts_of(label);
            if (concepts.size() < 2 || concepts.back() != i || !reported.insert(folded(label)).second) return;
            std::vector<std::string> ids;
            for (const std::size_t k : concepts) ids.push_back(vocabulary.concepts[k].id);
            findings.push_back(
                {false, pointer, fmt::format("the label '{}' belongs to {}: as a tag it is ambiguous", label, quoted(ids))});
        };
        for (const auto& [language, label] : entry.labels) check_label(label);
        for (const auto& [language, labels] : entry.alternatives)
            for (const auto& label : labels) check_label(label);
    }
    compare_rules(search, findings);
    return findings;
}

}  // namespace ostraka

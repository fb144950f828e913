#include "ostraka/relation/query.h"

#include "relation/query_parser.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/text.h"
#include "ostraka/measure/descriptors.h"
#include "ostraka/vocabulary/text_match.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

namespace ostraka {

namespace {

using QueryKind = AnnotationQuery::Node::Kind;

/// A number; with a unit it is a power of a length (0: an angle or a ratio), in metres or radians.
struct QueryAmount {
    double value = 0;
    bool bare = true;  ///< without a unit
    int power = 0;
};

QueryAmount query_amount(double value, const std::string& unit) {
    const auto known = detail::query_unit(unit);
    return known ? QueryAmount{value * known->factor, false, known->power} : QueryAmount{value};
}

/// The value of an attribute as text that is equal for equal values.
std::string value_text(const Attribute& attribute, const AllowedAttribute* allowed) {
    if (const Note* note = attribute.note()) {
        const Term* term = allowed != nullptr ? term_of(*allowed, note->text) : nullptr;
        return folded(term != nullptr ? term->name : note->text);
    }
    const Figures figures = attribute_values(attribute);
    std::string text;
    for (const double value : figures.values) {
        const QueryAmount amount = query_amount(value, figures.unit);
        text += digits(amount.value, 9) + (amount.bare ? figures.unit : "m" + std::to_string(amount.power)) + " ";
    }
    return text;
}

/// Resolves attribute names in any language.
class AttributeNames {
public:
    explicit AttributeNames(const Vocabulary* vocabulary) {
        if (vocabulary != nullptr) search_.emplace(*vocabulary);
    }
    [[nodiscard]] const AllowedAttribute* allowed(const Annotation& annotation, const std::string& name) const {
        if (!search_) return nullptr;
        const auto meant = search_->concept_of(annotation.tag);
        return meant ? search_->attribute_of(*meant, name) : search_->common_attribute(name);
    }
    [[nodiscard]] const Attribute* find(const Annotation& annotation, const std::string& name) const {
        const std::string text = folded(name);
        for (const Attribute& one : annotation.attributes)
            if (folded(one.name) == text) return &one;
        if (const AllowedAttribute* wanted = allowed(annotation, name))
            for (const Attribute& one : annotation.attributes)
                if (allowed(annotation, one.name) == wanted) return &one;
        return nullptr;
    }

private:
    std::optional<VocabularySearch> search_;
};

/// Collects the words, variables, names and references of a query.
void gather(const AnnotationQuery::Node& node, std::vector<std::string>& words, std::vector<std::string>& variables,
            std::vector<std::string>& names, std::vector<QueryReference>& references) {
    const auto add = [](auto& list, const auto& one) {
        if (std::find(list.begin(), list.end(), one) == list.end()) list.push_back(one);
    };
    if (node.kind == QueryKind::same) {
        add(references, QueryReference{node.text, node.words.front()});
        add(names, node.text);
    } else {
        for (const std::string& word : node.words) add(words, word);
    }
    if (node.kind == QueryKind::quantity || node.kind == QueryKind::related)
        for (const std::string& word : node.words) add(variables, word);
    if (node.kind == QueryKind::quantity) add(names, node.text);
    for (const auto& child : node.of) gather(*child, words, variables, names, references);
}

class QueryEvaluator {
public:
    QueryEvaluator(const QueriedObject& object, const std::vector<std::string>& words, const std::vector<std::string>& variables)
        : object_(object), names_(object.vocabulary), descriptors_(object.mesh) {
        const TagMatcher tags(object.vocabulary);
        for (const std::string& word : words) means_[word] = tags.find(object.annotations, word);
        for (const std::string& word : variables) {
            const auto& list = means_.at(word);
            choices_ *= static_cast<double>(std::max<std::size_t>(1, list.size()));
            variables_.push_back(&word);
        }
        constexpr double most = 1e6;
        if (choices_ > most)
            fail_input("query", "there are " + digits(choices_, 3) + " ways to choose annotations for its words",
                       "ask for fewer words at once, or by words that fewer annotations have");
    }

    QueryAnswer ask(const AnnotationQuery::Node& root) {
        choose(root, 0);
        QueryAnswer answer;
        answer.holds = holds_;
        for (const std::size_t i : supporting_) answer.annotations.push_back(object_.annotations.annotations[i].id);
        std::sort(answer.annotations.begin(), answer.annotations.end());
        answer.problems.assign(problems_.begin(), problems_.end());
        return answer;
    }

private:
    using Support = std::set<std::size_t>;

    void choose(const AnnotationQuery::Node& root, std::size_t variable) {
        if (variable == variables_.size()) {
            check_cancelled();
            Support support;
            if (!holds(root, support)) return;
            holds_ = true;
            supporting_.merge(support);
            return;
        }
        const std::string& word = *variables_[variable];
        for (const std::size_t i : means_.at(word)) {
            chosen_[word] = i;
            choose(root, variable + 1);
        }
        if (means_.at(word).empty()) choose(root, variable + 1);
        chosen_.erase(word);
    }

    bool holds(const AnnotationQuery::Node& node, Support& support) {
        switch (node.kind) {
            case QueryKind::either: {
                Support other;
                const bool a = holds(*node.of[0], support), b = holds(*node.of[1], other);
                if (b) support.merge(other);
                return a || b;
            }
            case QueryKind::both: {
                Support together;
                if (!holds(*node.of[0], together) || !holds(*node.of[1], together)) return false;
                support.merge(together);
                return true;
            }
            case QueryKind::none: {
                Support unused;
                return !holds(*node.of[0], unused);
            }
            case QueryKind::count: {
                const auto& list = means_.at(node.words.front());
                if (static_cast<double>(list.size()) < node.value) return false;
                support.insert(list.begin(), list.end());
                return true;
            }
            case QueryKind::related:
                return related(node, support);
            case QueryKind::same:
                return same(node, support);
            default:
                return compare(node, support);
        }
    }

    bool compare(const AnnotationQuery::Node& node, Support& support) {
        Support used;
        bool answer = false;
        if (node.of[1]->kind == QueryKind::word) {
            const auto at = chosen(node.of[0]->words.front());
            if (!at) return false;
            const Annotation& annotation = object_.annotations.annotations[*at];
            const Attribute* attribute = names_.find(annotation, node.of[0]->text);
            if (attribute == nullptr) return false;
            const AllowedAttribute* allowed = names_.allowed(annotation, attribute->name);
            const Term* term = allowed != nullptr ? term_of(*allowed, node.of[1]->text) : nullptr;
            const std::string wanted = folded(term != nullptr ? term->name : node.of[1]->text);
            answer = (value_text(*attribute, allowed) == wanted) == (node.text == "=");
            used.insert(*at);
        } else {
            const auto a = amount(*node.of[0], used), b = amount(*node.of[1], used);
            if (!a || !b || !alike(*a, *b, node.at)) return false;
            const double slack = 1e-12 * std::max(std::abs(a->value), std::abs(b->value));
            const double d = a->value - b->value;
            answer = node.text == "<"    ? d < -slack
                     : node.text == "<=" ? d <= slack
                     : node.text == ">"  ? d > slack
                     : node.text == ">=" ? d >= -slack
                                         : (std::abs(d) <= slack) == (node.text == "=");
        }
        if (answer) support.merge(used);
        return answer;
    }

    /// True if the amounts can be compared or added; otherwise notes a problem.
    bool alike(const QueryAmount& a, const QueryAmount& b, std::size_t at) {
        if (a.bare == b.bare ? a.bare || a.power == b.power : (a.bare ? b : a).power == 0) return true;
        if ((a.bare && a.value == 0) || (b.bare && b.value == 0)) return true;
        const auto named = [](const QueryAmount& x) {
            return x.bare         ? std::string("a number without a unit")
                   : x.power == 0 ? std::string("a ratio or an angle")
                   : x.power == 1 ? std::string("a length")
                   : x.power == 2 ? std::string("an area")
                   : x.power == 3 ? std::string("a volume")
                                  : "a power " + std::to_string(x.power) + " of a length";
        };
        problems_.insert("column " + std::to_string(at) + ": " + named(a) + " and " + named(b) +
                         " cannot be compared: give a unit to the number or to the annotations (annotation edit --set-unit)");
        return false;
    }

    std::optional<QueryAmount> amount(const AnnotationQuery::Node& node, Support& used) {
        if (node.kind == QueryKind::number)
            return node.unit.empty() ? QueryAmount{node.value} : query_amount(node.value, node.unit);
        if (node.kind == QueryKind::number_of) {
            const auto& list = means_.at(node.words.front());
            used.insert(list.begin(), list.end());
            return QueryAmount{static_cast<double>(list.size())};
        }
        if (node.kind == QueryKind::quantity) {
            const auto at = chosen(node.words.front());
            if (!at) return std::nullopt;
            used.insert(*at);
            return quantity(*at, node.text);
        }
        const auto a = amount(*node.of[0], used), b = amount(*node.of[1], used);
        if (!a || !b) return std::nullopt;
        if (node.kind == QueryKind::multiply || node.kind == QueryKind::divide) {
            const bool times = node.kind == QueryKind::multiply;
            if (!times && b->value == 0) return std::nullopt;
            return QueryAmount{times ? a->value * b->value : a->value / b->value, a->bare && b->bare,
                               a->power + (times ? b->power : -b->power)};
        }
        if (!alike(*a, *b, node.at)) return std::nullopt;
        const bool plus = node.kind == QueryKind::add;
        return QueryAmount{plus ? a->value + b->value : a->value - b->value, a->bare && b->bare, a->bare ? b->power : a->power};
    }

    std::optional<QueryAmount> quantity(std::size_t at, const std::string& name) {
        const auto [known, fresh] = quantities_.try_emplace({at, name});
        if (!fresh) return known->second;
        const Annotation& annotation = object_.annotations.annotations[at];
        if (const Attribute* attribute = names_.find(annotation, name);
            attribute != nullptr && !attribute_values(*attribute).stale) {
            const Figures figures = attribute_values(*attribute);
            if (figures.values.size() == 1) known->second = query_amount(figures.values.front(), figures.unit);
            if (const Note* note = attribute->note()) {
                double value = 0;
                const char* const end = note->text.data() + note->text.size();
                if (const auto [to, code] = std::from_chars(note->text.data(), end, value); code == std::errc() && to == end)
                    known->second = QueryAmount{value};
            }
        } else if (const auto computed = descriptors_.find(annotation, name); computed && computed->values.size() == 1) {
            known->second = query_amount(computed->values.front(), unit_of(*computed, object_.annotations.unit));
        }
        return known->second;
    }

    bool related(const AnnotationQuery::Node& node, Support& support) {
        if (object_.graph == nullptr) return false;
        const auto a = chosen(node.words[0]), b = node.words.size() > 1 ? chosen(node.words[1]) : std::nullopt;
        if (!a || (node.words.size() > 1 && (!b || a == b))) return false;
        const int first = object_.annotations.annotations[*a].id;
        for (const Relationship& one : object_.graph->relationships) {
            if (folded(one.type) != folded(node.text)) continue;
            const auto place = [&](int id) { return std::find(one.annotations.begin(), one.annotations.end(), id); };
            if (place(first) == one.annotations.end()) continue;
            if (b) {
                const int second = object_.annotations.annotations[*b].id;
                if (place(second) == one.annotations.end() || (one.directed && place(first) != one.annotations.begin())) continue;
                support.insert({*a, *b});
                return true;
            }
            for (std::size_t i = 0; i < object_.annotations.annotations.size(); ++i)
                if (place(object_.annotations.annotations[i].id) != one.annotations.end()) support.insert(i);
            return true;
        }
        return false;
    }

    bool same(const AnnotationQuery::Node& node, Support& support) {
        if (!object_.values_elsewhere) return false;
        const std::vector<std::string> wanted = object_.values_elsewhere({node.text, node.words.front()});
        bool found = false;
        for (std::size_t i = 0; i < object_.annotations.annotations.size(); ++i) {
            const Annotation& annotation = object_.annotations.annotations[i];
            const Attribute* attribute = names_.find(annotation, node.text);
            if (attribute == nullptr) continue;
            const std::string value = value_text(*attribute, names_.allowed(annotation, attribute->name));
            if (!std::binary_search(wanted.begin(), wanted.end(), value)) continue;
            support.insert(i);
            found = true;
        }
        return found;
    }

    [[nodiscard]] std::optional<std::size_t> chosen(const std::string& word) const {
        const auto found = chosen_.find(word);
        return found == chosen_.end() ? std::nullopt : std::optional(found->second);
    }

    const QueriedObject& object_;
    AttributeNames names_;
    DescriptorSearch descriptors_;
    std::map<std::string, std::vector<std::size_t>> means_;
    std::vector<const std::string*> variables_;
    std::map<std::string, std::size_t> chosen_;
    std::map<std::pair<std::size_t, std::string>, std::optional<QueryAmount>> quantities_;
    double choices_ = 1;
    bool holds_ = false;
    Support supporting_;
    std::set<std::string> problems_;
};

}  // namespace

AnnotationQuery::AnnotationQuery(const std::string& text) : root_(detail::parse_query(text)) {
    gather(*root_, words_, variables_, names_, references_);
}

AnnotationQuery::~AnnotationQuery() = default;
AnnotationQuery::AnnotationQuery(AnnotationQuery&&) noexcept = default;

const std::vector<std::string>& AnnotationQuery::words() const { return words_; }
const std::vector<std::string>& AnnotationQuery::names() const { return names_; }
const std::vector<QueryReference>& AnnotationQuery::references() const { return references_; }

QueryAnswer AnnotationQuery::ask(const QueriedObject& object) const {
    return QueryEvaluator(object, words_, variables_).ask(*root_);
}

std::vector<std::string> values_of(const QueriedObject& object, const std::string& attribute) {
    const AttributeNames names(object.vocabulary);
    std::set<std::string> values;
    for (const Annotation& annotation : object.annotations.annotations)
        if (const Attribute* one = names.find(annotation, attribute))
            values.insert(value_text(*one, names.allowed(annotation, one->name)));
    return {values.begin(), values.end()};
}

}  // namespace ostraka

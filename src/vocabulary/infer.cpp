#include "ostraka/vocabulary/infer.h"

#include "ostraka/core/text.h"
#include "ostraka/mesh/ids.h"
#include "ostraka/vocabulary/text_match.h"

#include "vocabulary/words.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>

namespace ostraka {

using namespace detail;

namespace {

/// The value of an operand, or the reason why it has none.
struct Value {
    std::optional<double> number;
    std::string word, unit;
    std::string missing;
};

enum class Verdict { holds, fails, unknown };

struct Judgement {
    Verdict verdict = Verdict::holds;
    std::string why;      ///< the conditions that hold, with their inputs
    std::string missing;  ///< the input that is missing for an evaluation
};

class Reasoner {
public:
    Reasoner(const AnnotationSet& set, const Vocabulary& vocabulary) : search_(vocabulary) {
        result_.annotations = set;
        for (Annotation& annotation : result_.annotations.annotations) {
            std::erase_if(annotation.attributes, [](const Attribute& attribute) { return inferred(attribute); });
            concepts_.push_back(search_.concept_of(annotation.tag));
        }
        stated_ = result_.annotations.annotations;
        resolve();
    }

    InferenceResult run() {
        // If rules contradict each other, their attribute is blocked and the inference repeated without it.
        for (std::size_t blocked = 0;; blocked = blocked_.size()) {
            restart();
            std::set<Task> tasks;
            for (std::size_t i = 0; i < annotations().size(); ++i)
                for (std::size_t r = 0; r < rules_of(i).size(); ++r) judge_task({i, r}, nullptr);
            for (tasks.swap(deferred_); !tasks.empty(); tasks.swap(deferred_))
                while (!tasks.empty()) {
                    const Task task = *tasks.begin();
                    tasks.erase(tasks.begin());
                    judge_task(task, &tasks);
                }
            if (blocked_.size() == blocked) break;
        }
        report_missing();
        return std::move(result_);
    }

private:
    using Key = std::pair<std::size_t, std::string>;   // annotation, attribute
    using Task = std::pair<std::size_t, std::size_t>;  // annotation, index in the list of rules that apply to it
    struct Applicable {
        const InferenceRule* rule;
        const AllowedAttribute* allowed;  ///< the attribute that the rule infers
    };

    static bool inferred(const Attribute& attribute) {
        return attribute.note() != nullptr && attribute.note()->origin.starts_with("rule ");
    }

    [[nodiscard]] std::vector<Annotation>& annotations() { return result_.annotations.annotations; }

    [[nodiscard]] const std::vector<Applicable>& rules_of(std::size_t i) const {
        static const std::vector<Applicable> none;
        return concepts_[i] ? rules_.at(*concepts_[i]) : none;
    }

    /// Resolves names once: the rules that apply to each concept, the annotations that operands refer to, and the rules that
    /// depend on an attribute.
    void resolve() {
        for (const auto& entry : concepts_) {
            if (!entry || rules_.contains(*entry)) continue;
            const auto lineage = search_.lineage(*entry);
            const std::set<std::size_t> ancestors(lineage.begin(), lineage.end());
            auto& applicable = rules_[*entry];
            for (const InferenceRule& rule : search_.vocabulary().rules) {
                if (!rule.concept_id.empty() && !ancestors.contains(*search_.find(rule.concept_id))) continue;
                if (const AllowedAttribute* allowed = search_.attribute_of(*entry, rule.attribute))
                    applicable.push_back({&rule, allowed});
            }
        }
        for (std::size_t i = 0; i < concepts_.size(); ++i)
            if (concepts_[i])
                for (const std::size_t k : search_.lineage(*concepts_[i])) owners_[k].push_back(i);
        readers_.resize(concepts_.size());
        for (std::size_t i = 0; i < concepts_.size(); ++i)
            for (std::size_t r = 0; r < rules_of(i).size(); ++r)
                for (const Condition& condition : rules_of(i)[r].rule->conditions)
                    for (const Operand* operand : {&condition.operand, condition.divisor ? &*condition.divisor : nullptr}) {
                        if (operand == nullptr) continue;
                        const auto owner = owner_of(*operand, i);
                        if (owner.size() == 1) readers_[owner[0]][meaning(owner[0], operand->attribute)].emplace_back(i, r);
                    }
    }

    /// The annotations that an operand may refer to, for a rule on annotation `i`.
    [[nodiscard]] std::vector<std::size_t> owner_of(const Operand& operand, std::size_t i) const {
        if (operand.concept_id.empty()) return {i};
        const auto owners = owners_.find(*search_.find(operand.concept_id));
        if (owners == owners_.end()) return {};
        // Two suffice: more than one means ambiguous.
        return {owners->second.begin(), owners->second.begin() + std::min<std::ptrdiff_t>(2, std::ssize(owners->second))};
    }

    /// Resets the annotations to the input, without inferred attributes.
    void restart() {
        annotations() = stated_;
        result_.inferred.clear();
        attribute_indices_.assign(stated_.size(), {});
        for (std::size_t i = 0; i < stated_.size(); ++i)
            for (std::size_t k = 0; k < stated_[i].attributes.size(); ++k)
                attribute_indices_[i][meaning(i, stated_[i].attributes[k].name)].push_back(k);
    }

    /// A text that is equal for all names of an attribute.
    [[nodiscard]] std::string meaning(std::size_t i, const std::string& text) const {
        const AllowedAttribute* allowed = concepts_[i] ? search_.attribute_of(*concepts_[i], text) : nullptr;
        return folded(allowed == nullptr ? text : allowed->name);
    }

    /// The attributes of an annotation with this name or a label of it.
    [[nodiscard]] std::vector<const Attribute*> attributes_named(std::size_t i, const std::string& name) {
        std::vector<const Attribute*> attributes;
        if (const auto entry = attribute_indices_[i].find(meaning(i, name)); entry != attribute_indices_[i].end())
            for (const std::size_t k : entry->second) attributes.push_back(&annotations()[i].attributes[k]);
        return attributes;
    }

    Value value_of(const Operand& operand, std::size_t i) {
        Value value;
        if (!operand.concept_id.empty()) {
            const auto owners = owner_of(operand, i);
            if (owners.size() != 1) {
                value.missing = (owners.empty() ? "there is no " : "there is more than one ") + in_quotes(operand.concept_id);
                return value;
            }
            i = owners.front();
        }
        const std::string name =
            in_quotes(operand.attribute) + (operand.concept_id.empty() ? "" : " of " + in_quotes(operand.concept_id));
        const auto matches = attributes_named(i, operand.attribute);
        if (matches.size() != 1) {
            value.missing = (matches.empty() ? "it has no " : "it has more than one ") + name;
            return value;
        }
        const Attribute& attribute = *matches.front();
        if (const Note* note = attribute.note()) {
            value.word = note->text;
            return value;
        }
        const Figures figures = attribute_values(attribute);
        value.unit = figures.unit;
        if (figures.stale) value.missing = name + " is stale";
        else if (figures.values.size() == 1) value.number = figures.values.front();
        else value.missing = name + (figures.values.empty() ? " has no value" : " is a list of numbers");
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
            const bool holds = is_one_of(value.word, c.is, allowed);
            return {holds ? Verdict::holds : Verdict::fails, fmt::format("{} is {}", name_of(c.operand), value.word), {}};
        }
        if (!value.number) return {Verdict::unknown, {}, in_quotes(c.operand.attribute) + " is a word"};
        double number = *value.number;
        std::string text = name_of(c.operand);
        std::string inputs = fmt::format("{} {}{}", text, digits(number, 6), value.unit.empty() ? "" : " " + value.unit);
        std::string unit;
        if (c.divisor) {
            const Value divisor = value_of(*c.divisor, i);
            if (!divisor.missing.empty()) return {Verdict::unknown, {}, divisor.missing};
            if (!divisor.number) return {Verdict::unknown, {}, in_quotes(c.divisor->attribute) + " is a word"};
            const auto converted_divisor = converted(*divisor.number, divisor.unit, value.unit);
            if (!converted_divisor)
                return {Verdict::unknown, {}, fmt::format("'{}' and '{}' cannot be compared", value.unit, divisor.unit)};
            if (*converted_divisor == 0) return {Verdict::unknown, {}, in_quotes(c.divisor->attribute) + " is zero"};
            number /= *converted_divisor;
            inputs += fmt::format(", {} {}{}", name_of(*c.divisor), digits(*divisor.number, 6),
                                  divisor.unit.empty() ? "" : " " + divisor.unit);
            text += fmt::format(" / {} = {}", name_of(*c.divisor), digits(number, 6));
        } else {
            unit = condition_unit(search_, rule, c);
            if (!unit.empty()) {
                const auto converted_number = converted(number, value.unit, unit);
                if (!converted_number)
                    return {
                        Verdict::unknown,
                        {},
                        in_quotes(c.operand.attribute) +
                            (value.unit.empty() ? " has no unit" : fmt::format(" is in '{}', not in '{}'", value.unit, unit))};
                number = *converted_number;
            }
        }
        const bool holds = (!c.min || number >= *c.min) && (!c.max || number <= *c.max) && (!c.above || number > *c.above) &&
                           (!c.below || number < *c.below);
        std::string bounds;
        const auto bound = [&](const std::optional<double>& limit, const char* sign) {
            if (limit) bounds += fmt::format("{}{} {}", bounds.empty() ? " " : " and ", sign, digits(*limit, 6));
        };
        bound(c.min, ">="), bound(c.above, ">"), bound(c.max, "<="), bound(c.below, "<");
        if (!unit.empty()) bounds += " " + unit;
        return {holds ? Verdict::holds : Verdict::fails,
                c.divisor ? fmt::format("{}{} ({})", text, bounds, inputs) : inputs + bounds,
                {}};
    }

    Judgement judge(const InferenceRule& rule, std::size_t i) {
        Judgement combined;
        for (const Condition& condition : rule.conditions) {
            const Judgement judgement = judge(rule, condition, i);
            if (judgement.verdict == Verdict::fails) return judgement;
            if (judgement.verdict == Verdict::unknown) {
                combined.verdict = Verdict::unknown;
                combined.missing += (combined.missing.empty() ? "" : "; ") + judgement.missing;
            }
            combined.why += (combined.why.empty() ? "" : "; ") + judgement.why;
        }
        return combined;
    }

    /// Evaluates a rule on an annotation. Tasks that depend on the attribute added are scheduled: in `now` if they come later
    /// in the order of annotations and rules, otherwise in the next pass. Without `now` the later tasks are not scheduled,
    /// since the caller evaluates all tasks in order.
    void judge_task(const Task& task, std::set<Task>* current_tasks) {
        const auto& [rule, allowed] = rules_of(task.first)[task.second];
        const Key key{task.first, allowed->name};
        if (blocked_.contains(key)) return;
        const Judgement judgement = judge(*rule, task.first);
        if (judgement.verdict != Verdict::holds || !conclude(*rule, *allowed, key, judgement.why)) return;
        const std::string name = meaning(task.first, allowed->name);
        attribute_indices_[task.first][name].push_back(annotations()[task.first].attributes.size() - 1);
        const auto readers = readers_[task.first].find(name);
        if (readers == readers_[task.first].end()) return;
        for (const Task& reader : readers->second)
            if (reader <= task) deferred_.insert(reader);
            else if (current_tasks != nullptr) current_tasks->insert(reader);
    }

    bool conclude(const InferenceRule& rule, const AllowedAttribute& allowed, const Key& key, const std::string& why) {
        Annotation& annotation = annotations()[key.first];
        const Term* term = term_of(allowed, rule.value);
        const std::string value = term == nullptr ? rule.value : term->name;
        const auto existing = attributes_named(key.first, allowed.name);
        const std::string prefix = detail::annotation_name(annotation) + ": ";
        const std::string claim = fmt::format("the rule {} infers {}, because {}", in_quotes(rule.id), in_quotes(value), why);
        for (const Attribute* other : existing) {
            const Note* note = other->note();
            if (note != nullptr) {
                const Term* stated = term_of(allowed, note->text);
                if (folded(stated == nullptr ? note->text : stated->name) == folded(value)) return false;  // already stated
            }
            blocked_.insert(key);
            result_.contradictions.push_back(fmt::format(
                "{}{}{}, but {}", prefix, in_quotes(allowed.name),
                inferred(*other) ? fmt::format(" is not inferred: the {} infers {}", note->origin, in_quotes(note->text))
                                 : " is stated to be " + in_quotes(note != nullptr ? note->text : "a number"),
                claim));
            return false;
        }
        Attribute attribute;
        attribute.id = next_free_id(annotation.attributes);
        attribute.name = allowed.name;
        const Note note{value, fmt::format("rule {}: {}", in_quotes(rule.id), why)};
        attribute.value = note;
        annotation.attributes.push_back(attribute);
        result_.inferred.push_back({annotation.id, allowed.name, value, rule.id, note.origin});
        return true;
    }

    void report_missing() {
        for (std::size_t i = 0; i < annotations().size(); ++i)
            for (const auto& [rule, allowed] : rules_of(i)) {
                const Judgement judgement = judge(*rule, i);
                if (judgement.verdict == Verdict::unknown)
                    result_.missing.push_back(fmt::format("{}: the rule {} cannot be evaluated: {}",
                                                          detail::annotation_name(annotations()[i]), in_quotes(rule->id),
                                                          judgement.missing));
            }
    }

    VocabularySearch search_;
    InferenceResult result_;
    std::vector<std::optional<std::size_t>> concepts_;
    std::vector<Annotation> stated_;
    std::set<Key> blocked_;
    std::map<std::size_t, std::vector<Applicable>> rules_;           ///< by concept
    std::map<std::size_t, std::vector<std::size_t>> owners_;         ///< concept -> annotations of that concept
    std::vector<std::map<std::string, std::vector<Task>>> readers_;  ///< for each annotation and attribute, the tasks that
                                                                     ///< depend on it
    std::vector<std::map<std::string, std::vector<std::size_t>>> attribute_indices_;  ///< for each annotation and folded name,
                                                                                      ///< indices of attributes
    std::set<Task> deferred_;
};

}  // namespace

std::string condition_unit(const VocabularySearch& search, const InferenceRule& rule, const Condition& condition) {
    if (condition.divisor || !condition.unit.empty() || !condition.is.empty()) return condition.unit;
    const std::string& owner = condition.operand.concept_id.empty() ? rule.concept_id : condition.operand.concept_id;
    if (!owner.empty()) {
        const AllowedAttribute* allowed = search.attribute_of(*search.find(owner), condition.operand.attribute);
        return allowed == nullptr ? std::string() : allowed->unit;
    }
    const AllowedAttribute* allowed = search.common_attribute(condition.operand.attribute);
    return allowed == nullptr ? std::string() : allowed->unit;
}

InferenceResult infer(const AnnotationSet& set, const Vocabulary& vocabulary) { return Reasoner(set, vocabulary).run(); }

}  // namespace ostraka

// Validation of vocabularies, and VocabularySearch.
#include "ostraka/vocabulary/vocabulary.h"

#include "vocabulary/skos_terms.h"

#include "ostraka/core/error.h"
#include "ostraka/vocabulary/text_match.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

namespace ostraka {

namespace {

using std::to_string;

/// Checks the structure only, as VocabularySearch requires it.
class Checker {
public:
    Checker(const Vocabulary& vocabulary, const std::string& where) : vocabulary_(vocabulary), where_(where) {}

    void structure() {
        languages(vocabulary_.title, "/title");
        attributes(vocabulary_.attributes, "");
        for (const ForeignStatement& statement : vocabulary_.others) language(statement.language, "/other");
        std::set<std::string> uris;
        for (std::size_t i = 0; i < vocabulary_.concepts.size(); ++i) {
            const Concept& entry = vocabulary_.concepts[i];
            const std::string pointer = "/concepts/" + to_string(i);
            if (entry.id.empty()) fail(pointer + "/id", "the id is empty", "give the concept an id");
            const auto [existing, added] = ids_.emplace(entry.id, i);
            if (!added)
                fail(pointer + "/id", fmt::format("the id '{}' is already used by /concepts/{}", entry.id, existing->second),
                     "give each concept its own id");
            const std::string uri =
                entry.uri.empty() ? skos::namespace_of(vocabulary_.uri) + percent_encoded(entry.id) : entry.uri;
            if (!uris.insert(uri).second)
                fail(pointer + "/uri", fmt::format("another concept has the same URI <{}>", uri),
                     "give each concept its own URI");
            attributes(entry.attributes, pointer);
            languages(entry.labels, pointer + "/label");
            languages(entry.definition, pointer + "/definition");
            for (const auto& [language_tag, labels] : entry.alternatives) language(language_tag, pointer + "/alternatives");
            for (const ForeignStatement& statement : entry.others) language(statement.language, pointer + "/other");
        }
        for (std::size_t i = 0; i < vocabulary_.concepts.size(); ++i) broader(i);
        cycles();
    }

    void rules(const VocabularySearch& search) {
        std::set<std::string> ids;
        for (std::size_t i = 0; i < vocabulary_.rules.size(); ++i) {
            const InferenceRule& rule = vocabulary_.rules[i];
            const std::string pointer = "/rules/" + to_string(i);
            if (!ids.insert(rule.id).second)
                fail(pointer + "/id", fmt::format("another rule has the id '{}'", rule.id), "give each rule its own id");
            require_concept(search, rule.concept_id, pointer + "/concept");
            for (std::size_t k = 0; k < rule.conditions.size(); ++k)
                condition(search, rule, rule.conditions[k], fmt::format("{}/if/{}", pointer, k));
            conclusion(search, rule, pointer + "/then");
        }
    }

private:
    [[noreturn]] void fail(const std::string& pointer, const std::string& problem, const std::string& remedy) const {
        fail_input(where_, fmt::format("at {}: {}", pointer, problem), remedy);
    }

    /// Checks a language tag as in BCP 47: letters, then groups of letters and digits, each of at most eight characters, joined
    /// by hyphens.
    void language(const std::string& tag, const std::string& pointer) const {
        std::size_t length = 0;
        bool valid = true, first = true;
        for (const char c : tag) {
            const bool digit = c >= '0' && c <= '9', letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
            valid = valid && (c == '-' ? length > 0 : (letter || (digit && !first)) && length < 8);
            first = first && c != '-';
            length = c == '-' ? 0 : length + 1;
        }
        if (!valid || (!tag.empty() && length == 0))
            fail(pointer, fmt::format("'{}' is not a language tag", tag), "use a tag such as en, de-AT, or \"\" for none");
    }
    void languages(const Labels& labels, const std::string& pointer) const {
        for (const auto& [tag, text] : labels) language(tag, pointer);
    }

    void attributes(const std::vector<AllowedAttribute>& entries, const std::string& owner) {
        std::set<std::string> names;
        for (std::size_t i = 0; i < entries.size(); ++i) {
            const AllowedAttribute& attribute = entries[i];
            const std::string pointer = fmt::format("{}/attributes/{}", owner, i);
            if (folded(attribute.name).empty()) fail(pointer + "/name", "the name is blank", "give the attribute a name");
            if (!names.insert(folded(attribute.name)).second)
                fail(pointer + "/name", fmt::format("the attribute '{}' appears twice in one list", attribute.name),
                     "keep one of the two");
            if (!attribute.values.empty() && attribute.quantitative())
                fail(pointer, fmt::format("the attribute '{}' has a list of values and a range or a unit", attribute.name),
                     "a list makes it qualitative, a range or unit quantitative: keep one");
            if (attribute.min && attribute.max && *attribute.min > *attribute.max)
                fail(pointer, fmt::format("the range of '{}' is reversed: its minimum is above its maximum", attribute.name),
                     "swap min and max");
            named_.emplace(folded(attribute.name), &attribute);
            languages(attribute.labels, pointer + "/label");
            languages(attribute.definition, pointer + "/definition");
            for (const Term& term : attribute.values) languages(term.labels, pointer + "/values");
            std::set<std::string> terms;
            for (std::size_t k = 0; k < attribute.values.size(); ++k)
                if (!terms.insert(folded(attribute.values[k].name)).second)
                    fail(fmt::format("{}/values/{}", pointer, k),
                         fmt::format("the value '{}' appears twice", attribute.values[k].name), "keep one of the two");
        }
    }

    void broader(std::size_t i) const {
        const Concept& entry = vocabulary_.concepts[i];
        check_references(i, entry.broader, "broader", "narrower than");
        check_references(i, entry.part_of, "partOf", "a part of");
        if (std::find(entry.part_of.begin(), entry.part_of.end(), entry.id) != entry.part_of.end())
            fail(fmt::format("/concepts/{}/partOf", i), fmt::format("'{}' is declared to be a part of itself", entry.id),
                 "remove it");
    }

    /// Checks ids of other concepts in a member of a concept.
    void check_references(std::size_t i, const std::vector<std::string>& ids, const std::string& member,
                          const std::string& relation) const {
        const Concept& entry = vocabulary_.concepts[i];
        std::set<std::string> visited;
        for (const std::string& id : ids) {
            const std::string pointer = fmt::format("/concepts/{}/{}", i, member);
            if (!visited.insert(id).second) fail(pointer, fmt::format("'{}' appears twice", id), "keep one of the two");
            if (ids_.contains(id)) continue;
            std::vector<std::string> all_ids;
            for (const Concept& candidate : vocabulary_.concepts) all_ids.push_back(candidate.id);
            fail(pointer, fmt::format("'{}' is declared to be {} '{}', which is not the id of a concept", entry.id, relation, id),
                 "add that concept or correct the id" + did_you_mean(near_misses(id, all_ids)));
        }
    }

    /// Iterative depth-first search, since a chain of concepts may be as long as the file.
    void cycles() const {
        enum class State : char { unvisited, active, done };
        const std::size_t count = vocabulary_.concepts.size();
        std::vector<State> state(count, State::unvisited);
        for (std::size_t start = 0; start < count; ++start) {
            std::vector<std::pair<std::size_t, std::size_t>> path;  // concept, number of its broader concepts visited
            if (state[start] == State::unvisited) path.emplace_back(start, 0), state[start] = State::active;
            while (!path.empty()) {
                auto& [current, next] = path.back();
                const auto& broader = vocabulary_.concepts[current].broader;
                if (next == broader.size()) {
                    state[current] = State::done;
                    path.pop_back();
                    continue;
                }
                const std::size_t broader_concept = ids_.at(broader[next++]);
                if (state[broader_concept] == State::active) cycle(path, broader_concept);
                if (state[broader_concept] == State::unvisited)
                    path.emplace_back(broader_concept, 0), state[broader_concept] = State::active;
            }
        }
    }

    [[noreturn]] void cycle(const std::vector<std::pair<std::size_t, std::size_t>>& path, std::size_t first) const {
        auto from = path.begin();
        while (from->first != first) ++from;
        std::string text;
        const auto length = static_cast<std::size_t>(path.end() - from);
        for (std::size_t k = 0; k < length; ++k)
            if (k < 4 || k + 1 == length)
                text += fmt::format("'{}' -> ", vocabulary_.concepts[from[static_cast<std::ptrdiff_t>(k)].first].id);
            else if (k == 4) text += "... -> ";
        fail(fmt::format("/concepts/{}/broader", first),
             fmt::format("the concept is broader than itself: {}'{}'", text, vocabulary_.concepts[first].id),
             "remove one of these statements");
    }

    void require_concept(const VocabularySearch& search, const std::string& id, const std::string& pointer) const {
        if (!id.empty() && !search.find(id))
            fail(pointer, fmt::format("'{}' is not the id of a concept", id),
                 "name a concept of the vocabulary" + did_you_mean(search.suggestions(id)));
    }

    /// The attributes of that name that the concept may have; for a rule about any concept, those of all concepts.
    [[nodiscard]] std::vector<const AllowedAttribute*> matching_attributes(const VocabularySearch& search,
                                                                           const std::string& concept_id,
                                                                           const std::string& name) const {
        std::vector<const AllowedAttribute*> attributes;
        if (!concept_id.empty()) {
            if (const AllowedAttribute* attribute = search.attribute_of(*search.find(concept_id), name))
                attributes.push_back(attribute);
            return attributes;
        }
        const auto [first, last] = named_.equal_range(folded(name));
        for (auto entry = first; entry != last; ++entry) attributes.push_back(entry->second);
        return attributes;
    }

    void condition(const VocabularySearch& search, const InferenceRule& rule, const Condition& c,
                   const std::string& pointer) const {
        require_concept(search, c.operand.concept_id, pointer + (c.divisor ? "/ratio/0/concept" : "/concept"));
        if (c.divisor) require_concept(search, c.divisor->concept_id, pointer + "/ratio/1/concept");
        const bool bounded = c.min || c.max || c.above || c.below;
        if (bounded == !c.is.empty())
            fail(pointer, bounded ? "a condition with bounds and words" : "a condition without bounds or words",
                 "give bounds (min, max, above, below) for a number, or 'is' for a word");
        if (c.divisor && !c.is.empty()) fail(pointer + "/is", "a ratio is not a word", "give bounds");
        if (c.divisor && !c.unit.empty()) fail(pointer + "/unit", "a ratio has no unit", "remove the unit");
        if ((c.min && c.above) || (c.max && c.below))
            fail(pointer, "two bounds on one side", "give 'min' or 'above', and 'max' or 'below'");
        const std::optional<double> low = c.min ? c.min : c.above, high = c.max ? c.max : c.below;
        if (low && high && (*low > *high || (*low == *high && (c.above || c.below))))
            fail(pointer, "no number lies within the bounds", "the lower bound must be below the upper one");
        for (const std::string& word : c.is)
            for (const AllowedAttribute* attribute : matching_attributes(
                     search, c.operand.concept_id.empty() ? rule.concept_id : c.operand.concept_id, c.operand.attribute))
                require_term(*attribute, word, pointer + "/is");
    }

    void require_term(const AllowedAttribute& attribute, const std::string& word, const std::string& pointer) const {
        if (attribute.values.empty() || term_of(attribute, word) != nullptr) return;
        std::vector<std::string> names;
        for (const Term& term : attribute.values) names.push_back(term.name);
        fail(pointer, fmt::format("'{}' is not a value of '{}'", word, attribute.name),
             "use one of its values" + did_you_mean(near_misses(word, names)));
    }

    void conclusion(const VocabularySearch& search, const InferenceRule& rule, const std::string& pointer) const {
        const auto attributes = matching_attributes(search, rule.concept_id, rule.attribute);
        if (attributes.empty())
            fail(pointer + "/attribute",
                 fmt::format("the rule infers '{}', which is not an attribute of {}", rule.attribute,
                             rule.concept_id.empty() ? std::string("any concept") : "'" + rule.concept_id + "'"),
                 "add the attribute to the vocabulary");
        for (const AllowedAttribute* attribute : attributes) {
            if (attribute->quantitative())
                fail(pointer + "/attribute", fmt::format("the rule infers '{}', which is a quantity", rule.attribute),
                     "rules infer words");
            require_term(*attribute, rule.value, pointer + "/value");
        }
    }

    const Vocabulary& vocabulary_;
    std::string where_;
    std::unordered_map<std::string, std::size_t> ids_;
    std::multimap<std::string, const AllowedAttribute*> named_;  ///< all attributes by folded name, in the order of the file
};

}  // namespace

void check_vocabulary(const Vocabulary& vocabulary, const std::string& where) {
    Checker checker(vocabulary, where);
    checker.structure();
    checker.rules(VocabularySearch(vocabulary));
}

VocabularySearch::VocabularySearch(const Vocabulary& vocabulary) : vocabulary_(vocabulary) {
    const std::size_t count = vocabulary.concepts.size();
    for (std::size_t i = 0; i < count; ++i) ids_.emplace(vocabulary.concepts[i].id, i);
    const auto add = [this](const std::string& text, std::size_t i) {
        auto& indices = labels_[folded(text)];
        if (indices.empty() || indices.back() != i) indices.push_back(i);
    };
    for (const AllowedAttribute& attribute : vocabulary.attributes) common_.try_emplace(folded(attribute.name), &attribute);
    broader_.resize(count);
    part_of_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Concept& entry = vocabulary.concepts[i];
        add(entry.id, i);
        for (const auto& [language, label] : entry.labels) add(label, i);
        for (const auto& [language, labels] : entry.alternatives)
            for (const auto& label : labels) add(label, i);
        for (const auto& id : entry.broader) broader_[i].push_back(ids_.at(id));
        for (const auto& id : entry.part_of) part_of_[i].push_back(ids_.at(id));
    }
}

std::optional<std::size_t> VocabularySearch::find(const std::string& id) const {
    const auto match = ids_.find(id);
    return match == ids_.end() ? std::nullopt : std::optional<std::size_t>(match->second);
}

std::vector<std::size_t> VocabularySearch::concepts_of(const std::string& tag) const {
    if (const auto exact = find(tag)) return {*exact};
    const std::string text = folded(tag);
    for (const std::string& key : {text, without_number(text)})
        if (const auto match = labels_.find(key); match != labels_.end() && !text.empty()) return match->second;
    return {};
}

std::optional<std::size_t> VocabularySearch::concept_of(const std::string& tag) const {
    const auto concepts = concepts_of(tag);
    return concepts.size() == 1 ? std::optional<std::size_t>(concepts.front()) : std::nullopt;
}

std::vector<std::size_t> VocabularySearch::lineage(std::size_t concept_index) const {
    std::vector<std::size_t> ancestors{concept_index};
    std::set<std::size_t> visited{concept_index};
    for (std::size_t k = 0; k < ancestors.size(); ++k)
        for (const std::size_t next : broader_[ancestors[k]])
            if (visited.insert(next).second) ancestors.push_back(next);
    return ancestors;
}

std::vector<std::vector<std::size_t>> VocabularySearch::containing_concepts(std::size_t concept_index) const {
    std::vector<std::vector<std::size_t>> levels;
    std::set<std::size_t> visited{concept_index};
    std::vector<std::size_t> front{concept_index};
    while (!front.empty()) {
        std::vector<std::size_t> next;
        for (const std::size_t current : front)
            for (const std::size_t ancestor : lineage(current))
                for (const std::size_t container : part_of_[ancestor])
                    if (visited.insert(container).second) next.push_back(container);
        if (!next.empty()) levels.push_back(next);
        front = std::move(next);
    }
    return levels;
}

bool VocabularySearch::is_a(std::size_t concept_index, std::size_t other) const {
    const auto ancestors = lineage(concept_index);
    return std::find(ancestors.begin(), ancestors.end(), other) != ancestors.end();
}

std::vector<const AllowedAttribute*> VocabularySearch::attributes_of(std::size_t concept_index) const {
    std::vector<const AllowedAttribute*> result;
    std::set<std::string> names;
    const auto add = [&](const std::vector<AllowedAttribute>& attributes) {
        for (const AllowedAttribute& attribute : attributes)
            if (names.insert(folded(attribute.name)).second) result.push_back(&attribute);
    };
    for (const std::size_t i : lineage(concept_index)) add(vocabulary_.concepts[i].attributes);
    add(vocabulary_.attributes);
    return result;
}

const AllowedAttribute* VocabularySearch::attribute_of(std::size_t concept_index, const std::string& name) const {
    const auto [entry, inserted] = attributes_.try_emplace(concept_index);
    auto& meanings = entry->second;
    if (inserted) {
        const auto concept_attributes = attributes_of(concept_index);
        for (const AllowedAttribute* attribute : concept_attributes) meanings.try_emplace(folded(attribute->name), attribute);
        for (const AllowedAttribute* attribute : concept_attributes)
            for (const auto& [language, label] : attribute->labels) meanings.try_emplace(folded(label), attribute);
    }
    const auto match = meanings.find(folded(name));
    return match == meanings.end() ? nullptr : match->second;
}

const AllowedAttribute* VocabularySearch::common_attribute(const std::string& name) const {
    const auto match = common_.find(folded(name));
    return match == common_.end() ? nullptr : match->second;
}

std::vector<std::string> VocabularySearch::suggestions(const std::string& tag) const {
    std::vector<std::string> candidates;
    for (const Concept& entry : vocabulary_.concepts) {
        for (const auto& [language, label] : entry.labels) candidates.push_back(label);
        for (const auto& [language, labels] : entry.alternatives)
            candidates.insert(candidates.end(), labels.begin(), labels.end());
        candidates.push_back(entry.id);
    }
    return near_misses(tag, candidates);
}

std::string VocabularySearch::label(std::size_t concept_index, const std::string& language) const {
    const Concept& entry = vocabulary_.concepts[concept_index];
    for (const std::string& key : {language, std::string(), std::string("en")})
        if (const auto match = entry.labels.find(key); match != entry.labels.end()) return match->second;
    return entry.labels.empty() ? entry.id : entry.labels.begin()->second;
}

const Term* term_of(const AllowedAttribute& attribute, const std::string& text) {
    const std::string folded_text = folded(text);
    for (const Term& term : attribute.values)
        if (folded(term.name) == folded_text) return &term;
    for (const Term& term : attribute.values)
        for (const auto& [language, label] : term.labels)
            if (folded(label) == folded_text) return &term;
    return nullptr;
}

void CheckVocabularyOptions::declare_options(OptionList& list) {
    list("strict", strict, "report measures and descriptors that the vocabulary does not define as defects", Anything{});
}

}  // namespace ostraka

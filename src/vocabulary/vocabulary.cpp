// Validation of vocabularies, and VocabularySearch.
#include "ostraka/vocabulary/vocabulary.h"

#include "skos_terms.h"

#include "ostraka/core/error.h"
#include "ostraka/vocabulary/text_match.h"

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
        for (const ForeignStatement& other : vocabulary_.others) language(other.language, "/other");
        std::set<std::string> uris;
        for (std::size_t i = 0; i < vocabulary_.concepts.size(); ++i) {
            const Concept& entry = vocabulary_.concepts[i];
            const std::string at = "/concepts/" + to_string(i);
            if (entry.id.empty()) fail(at + "/id", "the id is empty", "name the concept");
            const auto [first, added] = ids_.emplace(entry.id, i);
            if (!added)
                fail(at + "/id", "the id '" + entry.id + "' is that of /concepts/" + to_string(first->second) + " as well",
                     "give each concept an id of its own");
            const std::string uri =
                entry.uri.empty() ? skos::namespace_of(vocabulary_.uri) + percent_encoded(entry.id) : entry.uri;
            if (!uris.insert(uri).second)
                fail(at + "/uri", "another concept has the URI <" + uri + "> as well", "give each concept its own");
            attributes(entry.attributes, at);
            languages(entry.labels, at + "/label");
            languages(entry.definition, at + "/definition");
            for (const auto& [tongue, labels] : entry.alternatives) language(tongue, at + "/alternatives");
            for (const ForeignStatement& other : entry.others) language(other.language, at + "/other");
        }
        for (std::size_t i = 0; i < vocabulary_.concepts.size(); ++i) broader(i);
        cycles();
    }

    void rules(const VocabularySearch& search) {
        std::set<std::string> ids;
        for (std::size_t i = 0; i < vocabulary_.rules.size(); ++i) {
            const InferenceRule& rule = vocabulary_.rules[i];
            const std::string at = "/rules/" + to_string(i);
            if (!ids.insert(rule.id).second)
                fail(at + "/id", "another rule is called '" + rule.id + "' as well", "give each rule an id of its own");
            require_concept(search, rule.concept_id, at + "/concept");
            for (std::size_t k = 0; k < rule.conditions.size(); ++k)
                condition(search, rule, rule.conditions[k], at + "/if/" + to_string(k));
            conclusion(search, rule, at + "/then");
        }
    }

private:
    [[noreturn]] void fail(const std::string& at, const std::string& what, const std::string& remedy) const {
        fail_input(where_, "at " + at + ": " + what, remedy);
    }

    /// Checks a language tag as in BCP 47: letters, then groups of letters and digits, each of at most eight characters, joined
    /// by hyphens.
    void language(const std::string& tag, const std::string& at) const {
        std::size_t length = 0;
        bool good = true, first = true;
        for (const char c : tag) {
            const bool digit = c >= '0' && c <= '9', letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
            good = good && (c == '-' ? length > 0 : (letter || (digit && !first)) && length < 8);
            first = first && c != '-';
            length = c == '-' ? 0 : length + 1;
        }
        if (!good || (!tag.empty() && length == 0))
            fail(at, "'" + tag + "' is no language", "use a tag such as en, de-AT, or \"\" for none");
    }
    void languages(const Labels& labels, const std::string& at) const {
        for (const auto& [tag, text] : labels) language(tag, at);
    }

    void attributes(const std::vector<AllowedAttribute>& list, const std::string& owner) {
        std::set<std::string> names;
        for (std::size_t i = 0; i < list.size(); ++i) {
            const AllowedAttribute& attribute = list[i];
            const std::string at = owner + "/attributes/" + to_string(i);
            if (folded(attribute.name).empty()) fail(at + "/name", "the name is blank", "name the attribute");
            if (!names.insert(folded(attribute.name)).second)
                fail(at + "/name", "the attribute '" + attribute.name + "' stands twice in one list", "keep one of the two");
            if (!attribute.values.empty() && attribute.quantitative())
                fail(at, "the attribute '" + attribute.name + "' has a list of values and a range or a unit",
                     "a list makes it qualitative, a range or unit quantitative: keep one");
            if (attribute.min && attribute.max && *attribute.min > *attribute.max)
                fail(at, "the range of '" + attribute.name + "' is upside down: its least value is above its greatest",
                     "swap min and max");
            named_.emplace(folded(attribute.name), &attribute);
            languages(attribute.labels, at + "/label");
            languages(attribute.definition, at + "/definition");
            for (const Term& term : attribute.values) languages(term.labels, at + "/values");
            std::set<std::string> terms;
            for (std::size_t k = 0; k < attribute.values.size(); ++k)
                if (!terms.insert(folded(attribute.values[k].name)).second)
                    fail(at + "/values/" + to_string(k), "the value '" + attribute.values[k].name + "' stands twice",
                         "keep one of the two");
        }
    }

    void broader(std::size_t i) const {
        const Concept& entry = vocabulary_.concepts[i];
        named(i, entry.broader, "broader", "narrower than");
        named(i, entry.part_of, "partOf", "a part of");
        if (std::find(entry.part_of.begin(), entry.part_of.end(), entry.id) != entry.part_of.end())
            fail("/concepts/" + to_string(i) + "/partOf", "'" + entry.id + "' is said to be a part of itself", "remove it");
    }

    /// Checks ids of other concepts in a member of a concept.
    void named(std::size_t i, const std::vector<std::string>& ids, const std::string& member, const std::string& said) const {
        const Concept& entry = vocabulary_.concepts[i];
        std::set<std::string> seen;
        for (const std::string& id : ids) {
            const std::string at = "/concepts/" + to_string(i) + "/" + member;
            if (!seen.insert(id).second) fail(at, "'" + id + "' stands twice", "keep one of the two");
            if (ids_.contains(id)) continue;
            std::vector<std::string> known;
            for (const Concept& other : vocabulary_.concepts) known.push_back(other.id);
            fail(at, "'" + entry.id + "' is said to be " + said + " '" + id + "', which is no concept's id",
                 "add that concept or mend the id" + did_you_mean(near_misses(id, known)));
        }
    }

    /// Iterative depth-first search, since a chain of concepts may be as long as the file.
    void cycles() const {
        enum class State : char { fresh, open, done };
        const std::size_t count = vocabulary_.concepts.size();
        std::vector<State> state(count, State::fresh);
        for (std::size_t start = 0; start < count; ++start) {
            std::vector<std::pair<std::size_t, std::size_t>> path;  // concept, number of its broader concepts visited
            if (state[start] == State::fresh) path.emplace_back(start, 0), state[start] = State::open;
            while (!path.empty()) {
                auto& [at, next] = path.back();
                const auto& broader = vocabulary_.concepts[at].broader;
                if (next == broader.size()) {
                    state[at] = State::done;
                    path.pop_back();
                    continue;
                }
                const std::size_t other = ids_.at(broader[next++]);
                if (state[other] == State::open) cycle(path, other);
                if (state[other] == State::fresh) path.emplace_back(other, 0), state[other] = State::open;
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
                text += "'" + vocabulary_.concepts[from[static_cast<std::ptrdiff_t>(k)].first].id + "' -> ";
            else if (k == 4) text += "... -> ";
        fail("/concepts/" + to_string(first) + "/broader",
             "the concept is broader than itself: " + text + "'" + vocabulary_.concepts[first].id + "'",
             "take one of these statements away");
    }

    void require_concept(const VocabularySearch& search, const std::string& id, const std::string& at) const {
        if (!id.empty() && !search.find(id))
            fail(at, "'" + id + "' is no concept's id",
                 "name a concept of the vocabulary" + did_you_mean(search.suggestions(id)));
    }

    /// The attributes of that name that the concept may have; for a rule about any concept, those of all concepts.
    [[nodiscard]] std::vector<const AllowedAttribute*> meant(const VocabularySearch& search, const std::string& concept_id,
                                                             const std::string& name) const {
        std::vector<const AllowedAttribute*> found;
        if (!concept_id.empty()) {
            if (const AllowedAttribute* one = search.attribute_of(*search.find(concept_id), name)) found.push_back(one);
            return found;
        }
        const auto [first, last] = named_.equal_range(folded(name));
        for (auto one = first; one != last; ++one) found.push_back(one->second);
        return found;
    }

    void condition(const VocabularySearch& search, const InferenceRule& rule, const Condition& c, const std::string& at) const {
        require_concept(search, c.operand.concept_id, at + (c.divisor ? "/ratio/0/concept" : "/concept"));
        if (c.divisor) require_concept(search, c.divisor->concept_id, at + "/ratio/1/concept");
        const bool bounded = c.min || c.max || c.above || c.below;
        if (bounded == !c.is.empty())
            fail(at, bounded ? "a condition with bounds and words" : "a condition without bounds or words",
                 "give bounds (min, max, above, below) for a number, or 'is' for a word");
        if (c.divisor && !c.is.empty()) fail(at + "/is", "a ratio is no word", "give bounds");
        if (c.divisor && !c.unit.empty()) fail(at + "/unit", "a ratio has no unit", "take the unit away");
        if ((c.min && c.above) || (c.max && c.below))
            fail(at, "two bounds on one side", "give 'min' or 'above', and 'max' or 'below'");
        const std::optional<double> low = c.min ? c.min : c.above, high = c.max ? c.max : c.below;
        if (low && high && (*low > *high || (*low == *high && (c.above || c.below))))
            fail(at, "no number lies within the bounds", "the lower bound must be below the upper one");
        for (const std::string& word : c.is)
            for (const AllowedAttribute* attribute :
                 meant(search, c.operand.concept_id.empty() ? rule.concept_id : c.operand.concept_id, c.operand.attribute))
                require_term(*attribute, word, at + "/is");
    }

    void require_term(const AllowedAttribute& attribute, const std::string& word, const std::string& at) const {
        if (attribute.values.empty() || term_of(attribute, word) != nullptr) return;
        std::vector<std::string> names;
        for (const Term& term : attribute.values) names.push_back(term.name);
        fail(at, "'" + word + "' is no value of '" + attribute.name + "'",
             "use one of its values" + did_you_mean(near_misses(word, names)));
    }

    void conclusion(const VocabularySearch& search, const InferenceRule& rule, const std::string& at) const {
        const auto attributes = meant(search, rule.concept_id, rule.attribute);
        if (attributes.empty())
            fail(at + "/attribute",
                 "the rule infers '" + rule.attribute + "', which " +
                     (rule.concept_id.empty() ? std::string("no concept") : "'" + rule.concept_id + "'") + " may not carry",
                 "add the attribute to the vocabulary");
        for (const AllowedAttribute* attribute : attributes) {
            if (attribute->quantitative())
                fail(at + "/attribute", "the rule infers '" + rule.attribute + "', which is a quantity", "rules infer words");
            require_term(*attribute, rule.value, at + "/value");
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
        auto& list = labels_[folded(text)];
        if (list.empty() || list.back() != i) list.push_back(i);
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
    const auto found = ids_.find(id);
    return found == ids_.end() ? std::nullopt : std::optional<std::size_t>(found->second);
}

std::vector<std::size_t> VocabularySearch::concepts_of(const std::string& tag) const {
    if (const auto exact = find(tag)) return {*exact};
    const std::string text = folded(tag);
    for (const std::string& wanted : {text, without_number(text)})
        if (const auto found = labels_.find(wanted); found != labels_.end() && !text.empty()) return found->second;
    return {};
}

std::optional<std::size_t> VocabularySearch::concept_of(const std::string& tag) const {
    const auto found = concepts_of(tag);
    return found.size() == 1 ? std::optional<std::size_t>(found.front()) : std::nullopt;
}

std::vector<std::size_t> VocabularySearch::lineage(std::size_t concept_index) const {
    std::vector<std::size_t> line{concept_index};
    std::set<std::size_t> seen{concept_index};
    for (std::size_t k = 0; k < line.size(); ++k)
        for (const std::size_t next : broader_[line[k]])
            if (seen.insert(next).second) line.push_back(next);
    return line;
}

std::vector<std::vector<std::size_t>> VocabularySearch::wholes_of(std::size_t concept_index) const {
    std::vector<std::vector<std::size_t>> levels;
    std::set<std::size_t> seen{concept_index};
    std::vector<std::size_t> front{concept_index};
    while (!front.empty()) {
        std::vector<std::size_t> next;
        for (const std::size_t part : front)
            for (const std::size_t kind : lineage(part))
                for (const std::size_t whole : part_of_[kind])
                    if (seen.insert(whole).second) next.push_back(whole);
        if (!next.empty()) levels.push_back(next);
        front = std::move(next);
    }
    return levels;
}

bool VocabularySearch::is_a(std::size_t concept_index, std::size_t other) const {
    const auto line = lineage(concept_index);
    return std::find(line.begin(), line.end(), other) != line.end();
}

std::vector<const AllowedAttribute*> VocabularySearch::attributes_of(std::size_t concept_index) const {
    std::vector<const AllowedAttribute*> list;
    std::set<std::string> names;
    const auto add = [&](const std::vector<AllowedAttribute>& attributes) {
        for (const AllowedAttribute& attribute : attributes)
            if (names.insert(folded(attribute.name)).second) list.push_back(&attribute);
    };
    for (const std::size_t i : lineage(concept_index)) add(vocabulary_.concepts[i].attributes);
    add(vocabulary_.attributes);
    return list;
}

const AllowedAttribute* VocabularySearch::attribute_of(std::size_t concept_index, const std::string& name) const {
    const auto [known, fresh] = attributes_.try_emplace(concept_index);
    auto& meanings = known->second;
    if (fresh) {
        const auto list = attributes_of(concept_index);
        for (const AllowedAttribute* attribute : list) meanings.try_emplace(folded(attribute->name), attribute);
        for (const AllowedAttribute* attribute : list)
            for (const auto& [language, label] : attribute->labels) meanings.try_emplace(folded(label), attribute);
    }
    const auto found = meanings.find(folded(name));
    return found == meanings.end() ? nullptr : found->second;
}

const AllowedAttribute* VocabularySearch::common_attribute(const std::string& name) const {
    const auto found = common_.find(folded(name));
    return found == common_.end() ? nullptr : found->second;
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
    for (const std::string& wanted : {language, std::string(), std::string("en")})
        if (const auto found = entry.labels.find(wanted); found != entry.labels.end()) return found->second;
    return entry.labels.empty() ? entry.id : entry.labels.begin()->second;
}

const Term* term_of(const AllowedAttribute& attribute, const std::string& text) {
    const std::string wanted = folded(text);
    for (const Term& term : attribute.values)
        if (folded(term.name) == wanted) return &term;
    for (const Term& term : attribute.values)
        for (const auto& [language, label] : term.labels)
            if (folded(label) == wanted) return &term;
    return nullptr;
}

void CheckVocabularyOptions::describe(OptionList& visit) {
    visit("strict", strict, "measures and descriptors that are not in the vocabulary are defects too", Anything{});
}

}  // namespace ostraka

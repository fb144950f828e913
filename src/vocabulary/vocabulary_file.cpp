// Converts vocabularies to and from JSON.
#include "vocabulary/rules_json.h"
#include "vocabulary/skos_terms.h"

#include "ostraka/core/error.h"
#include "ostraka/files/json_build.h"
#include "ostraka/vocabulary/skos.h"

#include "vocabulary/words.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

using namespace detail;

namespace {

using std::to_string;

Labels labels_of(const JsonValue& object, const char* name) {
    Labels labels;
    const JsonValue* value = find_member(object, name);
    if (value == nullptr) return labels;
    if (value->IsString()) return {{"", text_of(*value)}};
    for (const auto& member : value->GetObject()) labels[text_of(member.name)] = text_of(member.value);
    return labels;
}

AllowedAttribute attribute_of(const JsonValue& object) {
    AllowedAttribute attribute;
    attribute.name = text_in(object, "name");
    attribute.labels = labels_of(object, "label");
    attribute.definition = labels_of(object, "definition");
    for (const auto& value : list_in(object, "values"))
        attribute.values.push_back(value.IsString() ? Term{text_of(value), {}}
                                                    : Term{text_in(value, "name"), labels_of(value, "label")});
    attribute.min = number_in(object, "min");
    attribute.max = number_in(object, "max");
    attribute.unit = text_in(object, "unit");
    return attribute;
}

std::vector<AllowedAttribute> attributes_of(const JsonValue& object) {
    std::vector<AllowedAttribute> result;
    for (const auto& attribute : list_in(object, "attributes")) result.push_back(attribute_of(attribute));
    return result;
}

/// Sorted without duplicates, so that equal vocabularies are written identically.
template <class T>
std::vector<T> canonical(std::vector<T> values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
}

std::vector<ForeignStatement> statements_of(const JsonValue& object, const std::string& where, const std::string& pointer) {
    std::vector<ForeignStatement> result;
    for (const auto& entry : list_in(object, "other")) {
        ForeignStatement statement;
        const std::string location = fmt::format("at {}/other/{}", pointer, result.size());
        statement.property = text_in(entry, "property");
        statement.is_uri = find_member(entry, "uri") != nullptr;
        if (statement.is_uri == (find_member(entry, "value") != nullptr))
            fail_input(where, location + ": a statement must have either a value or a uri", "give one of the two");
        statement.value = text_in(entry, statement.is_uri ? "uri" : "value");
        statement.language = text_in(entry, "language");
        statement.datatype = text_in(entry, "datatype");
        if (statement.datatype == skos::xsd + "string") statement.datatype.clear();  // equivalent to a text without a datatype
        if ((!statement.language.empty() && !statement.datatype.empty()) ||
            (statement.is_uri && (!statement.language.empty() || !statement.datatype.empty())))
            fail_input(where, location + ": a URI may have neither language nor datatype, a text only one of the two",
                       "remove one");
        result.push_back(std::move(statement));
    }
    return canonical(std::move(result));
}

Concept concept_of(const JsonValue& object, const std::string& where, const std::string& pointer) {
    Concept result;
    result.id = text_in(object, "id");
    result.uri = text_in(object, "uri");
    result.labels = labels_of(object, "label");
    if (const JsonValue* alternatives = find_member(object, "alternatives"))
        for (const auto& member : alternatives->GetObject())
            for (const auto& label : member.value.GetArray()) result.alternatives[text_of(member.name)].push_back(text_of(label));
    for (auto& [language, labels] : result.alternatives) labels = canonical(std::move(labels));
    result.broader = names_in(object, "broader");
    std::sort(result.broader.begin(), result.broader.end());
    result.part_of = names_in(object, "partOf");
    std::sort(result.part_of.begin(), result.part_of.end());
    result.definition = labels_of(object, "definition");
    result.attributes = attributes_of(object);
    result.others = statements_of(object, where, pointer);
    return result;
}

Operand operand_of(const JsonValue& value) {
    if (value.IsString()) return {text_of(value), {}};
    return {text_in(value, "attribute"), text_in(value, "concept")};
}

Condition condition_of(const JsonValue& object, const std::string& where, const std::string& pointer) {
    Condition condition;
    const JsonValue *ratio = find_member(object, "ratio"), *attribute = find_member(object, "attribute");
    if ((ratio == nullptr) == (attribute == nullptr))
        fail_input(where, fmt::format("at {}: a condition must have either an attribute or a ratio", pointer),
                   "give one of the two");
    if (ratio != nullptr) {
        if (find_member(object, "concept") != nullptr)
            fail_input(where, fmt::format("at {}/concept: cannot be combined with a ratio", pointer),
                       "give it for each side: {\"attribute\": ..., \"concept\": ...}");
        condition.operand = operand_of((*ratio)[0]);
        condition.divisor = operand_of((*ratio)[1]);
    } else {
        condition.operand = {text_in(object, "attribute"), text_in(object, "concept")};
    }
    condition.min = number_in(object, "min");
    condition.max = number_in(object, "max");
    condition.above = number_in(object, "above");
    condition.below = number_in(object, "below");
    condition.unit = text_in(object, "unit");
    condition.is = names_in(object, "is");
    return condition;
}

InferenceRule inference_rule_of(const JsonValue& object, const std::string& where, const std::string& pointer) {
    InferenceRule rule;
    rule.id = text_in(object, "id");
    rule.note = text_in(object, "note");
    rule.concept_id = text_in(object, "concept");
    const JsonValue& conditions = object["if"];
    for (rapidjson::SizeType i = 0; i < conditions.Size(); ++i)
        rule.conditions.push_back(condition_of(conditions[i], where, fmt::format("{}/if/{}", pointer, i)));
    rule.attribute = text_in(object["then"], "attribute");
    rule.value = text_in(object["then"], "value");
    return rule;
}

/// Writes a vocabulary; empty members are omitted.
class Writer {
public:
    Json document = json_document("vocabulary");

    explicit Writer(const Vocabulary& vocabulary) {
        add_nonempty_members(document, allocator_, "uri", vocabulary.uri);
        labels(document, "title", vocabulary.title);
        attributes(document, vocabulary.attributes);
        add_members(document, allocator_, "concepts", list_of(vocabulary.concepts));
        add_nonempty_members(document, allocator_, "rules", list_of(vocabulary.rules));
        statements(document, vocabulary.others);
    }

private:
    JsonAllocator& allocator_ = document.GetAllocator();

    template <class Entry>
    JsonValue list_of(const std::vector<Entry>& entries) {
        return json_list(entries, allocator_, [&](const Entry& entry) { return json_of(entry); });
    }
    void number(JsonValue& object, const char* name, const std::optional<double>& value) {
        if (value) add_member(object, name, json_number(*value), allocator_);
    }
    void labels(JsonValue& object, const char* name, const Labels& value) {
        if (value.empty()) return;
        if (value.size() == 1 && value.begin()->first.empty()) {
            add_member(object, name, value.begin()->second, allocator_);
            return;
        }
        JsonValue by_language(rapidjson::kObjectType);
        for (const auto& [language, label] : value) add_member(by_language, language, label, allocator_);
        add_member(object, name, std::move(by_language), allocator_);
    }
    void names(JsonValue& object, const char* name, const std::vector<std::string>& value) {
        if (value.size() == 1) add_member(object, name, value.front(), allocator_);
        else add_nonempty_members(object, allocator_, name, value);
    }
    JsonValue json_of(const Term& term) {
        if (term.labels.empty()) return json_string(term.name, allocator_);
        JsonValue object = json_object(allocator_, "name", term.name);
        labels(object, "label", term.labels);
        return object;
    }
    JsonValue json_of(const AllowedAttribute& attribute) {
        JsonValue entry = json_object(allocator_, "name", attribute.name);
        labels(entry, "label", attribute.labels);
        labels(entry, "definition", attribute.definition);
        add_nonempty_members(entry, allocator_, "values", list_of(attribute.values));
        number(entry, "min", attribute.min);
        number(entry, "max", attribute.max);
        add_nonempty_members(entry, allocator_, "unit", attribute.unit);
        return entry;
    }
    void attributes(JsonValue& object, const std::vector<AllowedAttribute>& value) {
        add_nonempty_members(object, allocator_, "attributes", list_of(value));
    }
    JsonValue json_of(const ForeignStatement& statement) {
        JsonValue entry =
            json_object(allocator_, "property", statement.property, statement.is_uri ? "uri" : "value", statement.value);
        add_nonempty_members(entry, allocator_, "language", statement.language, "datatype", statement.datatype);
        return entry;
    }
    void statements(JsonValue& object, const std::vector<ForeignStatement>& value) {
        add_nonempty_members(object, allocator_, "other", list_of(value));
    }
    JsonValue json_of(const Concept& entry) {
        JsonValue object = json_object(allocator_, "id", entry.id);
        add_nonempty_members(object, allocator_, "uri", entry.uri);
        labels(object, "label", entry.labels);
        JsonValue alternatives(rapidjson::kObjectType);
        for (const auto& [language, alternative_labels] : entry.alternatives)
            add_members(alternatives, allocator_, language, alternative_labels);
        add_nonempty_members(object, allocator_, "alternatives", std::move(alternatives));
        names(object, "broader", entry.broader);
        names(object, "partOf", entry.part_of);
        labels(object, "definition", entry.definition);
        attributes(object, entry.attributes);
        statements(object, entry.others);
        return object;
    }
    JsonValue json_of(const Operand& operand) {
        if (operand.concept_id.empty()) return json_string(operand.attribute, allocator_);
        return json_object(allocator_, "attribute", operand.attribute, "concept", operand.concept_id);
    }
    JsonValue json_of(const Condition& condition) {
        JsonValue entry(rapidjson::kObjectType);
        if (condition.divisor) {
            add_members(entry, allocator_, "ratio", list_of(std::vector{condition.operand, *condition.divisor}));
        } else {
            add_members(entry, allocator_, "attribute", condition.operand.attribute);
            add_nonempty_members(entry, allocator_, "concept", condition.operand.concept_id);
        }
        number(entry, "min", condition.min);
        number(entry, "max", condition.max);
        number(entry, "above", condition.above);
        number(entry, "below", condition.below);
        add_nonempty_members(entry, allocator_, "unit", condition.unit);
        names(entry, "is", condition.is);
        return entry;
    }
    JsonValue json_of(const InferenceRule& rule) {
        JsonValue object = json_object(allocator_, "id", rule.id);
        add_nonempty_members(object, allocator_, "note", rule.note, "concept", rule.concept_id);
        add_members(object, allocator_, "if", list_of(rule.conditions), "then",
                    json_object(allocator_, "attribute", rule.attribute, "value", rule.value));
        return object;
    }
};

}  // namespace

std::vector<InferenceRule> rules_from_json(const JsonValue& rule_list, const std::string& where) {
    Json document = json_document("vocabulary");
    add_members(document, document.GetAllocator(), "concepts", JsonValue(rapidjson::kArrayType), "rules", rule_list);
    validate(document, "vocabulary", where);
    std::vector<InferenceRule> rules;
    for (const auto& rule : rule_list.GetArray())
        rules.push_back(inference_rule_of(rule, where, "/rules/" + to_string(rules.size())));
    return rules;
}

Vocabulary vocabulary_from_json(const JsonValue& document, const std::string& where) {
    check_format(document, "ostraka-vocabulary", where, "give a vocabulary ('ostraka-vocabulary')");
    validate(document, "vocabulary", where);
    Vocabulary vocabulary;
    vocabulary.uri = text_in(document, "uri");
    vocabulary.title = labels_of(document, "title");
    vocabulary.attributes = attributes_of(document);
    for (const auto& entry : list_in(document, "concepts"))
        vocabulary.concepts.push_back(concept_of(entry, where, "/concepts/" + to_string(vocabulary.concepts.size())));
    for (const auto& rule : list_in(document, "rules"))
        vocabulary.rules.push_back(inference_rule_of(rule, where, "/rules/" + to_string(vocabulary.rules.size())));
    vocabulary.others = statements_of(document, where, "");
    if (vocabulary.uri == skos::default_scheme) vocabulary.uri.clear();
    for (Concept& entry : vocabulary.concepts)
        if (entry.uri == skos::namespace_of(vocabulary.uri) + percent_encoded(entry.id)) entry.uri.clear();
    check_vocabulary(vocabulary, where);
    return vocabulary;
}

Vocabulary read_vocabulary(const Path& file) {
    return is_skos(file) ? read_skos(file) : vocabulary_from_json(read_json(file), file.string());
}

Json vocabulary_to_json(const Vocabulary& vocabulary) { return std::move(Writer(vocabulary).document); }

void write_vocabulary(const Path& file, const Vocabulary& vocabulary) {
    if (is_skos(file)) return write_skos(file, vocabulary);
    check_vocabulary(vocabulary, file.string());
    write_json(file, vocabulary_to_json(vocabulary));
}

}  // namespace ostraka

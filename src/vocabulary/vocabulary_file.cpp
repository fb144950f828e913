// Vocabulary <-> JSON.
#include "rules_json.h"
#include "skos_terms.h"

#include "ostraka/core/error.h"
#include "ostraka/core/json_build.h"
#include "ostraka/vocabulary/skos.h"

#include "words.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

using namespace detail;

namespace {

using std::to_string;

std::string text_in(const JsonValue& object, const char* name) {
    const JsonValue* value = find_member(object, name);
    return value == nullptr ? std::string() : text_of(*value);
}

std::optional<double> number_of(const JsonValue& object, const char* name) {
    const JsonValue* value = find_member(object, name);
    return value == nullptr ? std::nullopt : std::optional<double>(value->GetDouble());
}

Labels labels_of(const JsonValue& object, const char* name) {
    Labels labels;
    const JsonValue* value = find_member(object, name);
    if (value == nullptr) return labels;
    if (value->IsString()) return {{"", text_of(*value)}};
    for (const auto& member : value->GetObject()) labels[text_of(member.name)] = text_of(member.value);
    return labels;
}

std::vector<std::string> names_of(const JsonValue& object, const char* name) {
    std::vector<std::string> names;
    const JsonValue* value = find_member(object, name);
    if (value == nullptr) return names;
    if (value->IsString()) return {text_of(*value)};
    for (const auto& element : value->GetArray()) names.push_back(text_of(element));
    return names;
}

AllowedAttribute attribute_of(const JsonValue& object) {
    AllowedAttribute attribute;
    attribute.name = text_in(object, "name");
    attribute.labels = labels_of(object, "label");
    attribute.definition = labels_of(object, "definition");
    if (const JsonValue* values = find_member(object, "values"))
        for (const auto& value : values->GetArray())
            attribute.values.push_back(value.IsString() ? Term{text_of(value), {}}
                                                        : Term{text_in(value, "name"), labels_of(value, "label")});
    attribute.min = number_of(object, "min");
    attribute.max = number_of(object, "max");
    attribute.unit = text_in(object, "unit");
    return attribute;
}

std::vector<AllowedAttribute> attributes_of(const JsonValue& object) {
    std::vector<AllowedAttribute> list;
    if (const JsonValue* attributes = find_member(object, "attributes"))
        for (const auto& attribute : attributes->GetArray()) list.push_back(attribute_of(attribute));
    return list;
}

/// Sets are kept in one order, so that equal vocabularies are written alike.
template <class T>
std::vector<T> canonical(std::vector<T> list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
}

std::vector<ForeignStatement> statements_of(const JsonValue& object, const std::string& where, const std::string& at) {
    std::vector<ForeignStatement> list;
    const JsonValue* statements = find_member(object, "other");
    if (statements == nullptr) return list;
    for (const auto& entry : statements->GetArray()) {
        ForeignStatement statement;
        statement.property = text_in(entry, "property");
        statement.is_uri = find_member(entry, "uri") != nullptr;
        if (statement.is_uri == (find_member(entry, "value") != nullptr))
            fail_input(where, "at " + at + "/other/" + to_string(list.size()) + ": a statement has a value or a uri",
                       "give one of the two");
        statement.value = text_in(entry, statement.is_uri ? "uri" : "value");
        statement.language = text_in(entry, "language");
        statement.datatype = text_in(entry, "datatype");
        if (statement.datatype == skos::xsd + "string") statement.datatype.clear();  // as texts are without one
        if ((!statement.language.empty() && !statement.datatype.empty()) ||
            (statement.is_uri && (!statement.language.empty() || !statement.datatype.empty())))
            fail_input(where,
                       "at " + at + "/other/" + to_string(list.size()) + ": a URI has neither language nor datatype, a text one",
                       "take one away");
        list.push_back(std::move(statement));
    }
    return canonical(std::move(list));
}

Concept concept_of(const JsonValue& object, const std::string& where, const std::string& at) {
    Concept result;
    result.id = text_in(object, "id");
    result.uri = text_in(object, "uri");
    result.labels = labels_of(object, "label");
    if (const JsonValue* alternatives = find_member(object, "alternatives"))
        for (const auto& member : alternatives->GetObject())
            for (const auto& label : member.value.GetArray()) result.alternatives[text_of(member.name)].push_back(text_of(label));
    for (auto& [language, labels] : result.alternatives) labels = canonical(std::move(labels));
    result.broader = names_of(object, "broader");
    std::sort(result.broader.begin(), result.broader.end());
    result.definition = labels_of(object, "definition");
    result.attributes = attributes_of(object);
    result.others = statements_of(object, where, at);
    return result;
}

Operand operand_of(const JsonValue& value) {
    if (value.IsString()) return {text_of(value), {}};
    return {text_in(value, "attribute"), text_in(value, "concept")};
}

Condition condition_of(const JsonValue& object, const std::string& where, const std::string& at) {
    Condition condition;
    const JsonValue *ratio = find_member(object, "ratio"), *attribute = find_member(object, "attribute");
    if ((ratio == nullptr) == (attribute == nullptr))
        fail_input(where, "at " + at + ": a condition is about an attribute or a ratio", "give one of the two");
    if (ratio != nullptr) {
        if (find_member(object, "concept") != nullptr)
            fail_input(where, "at " + at + "/concept: stands beside a ratio",
                       "say it of each side: {\"attribute\": ..., \"concept\": ...}");
        condition.operand = operand_of((*ratio)[0]);
        condition.divisor = operand_of((*ratio)[1]);
    } else {
        condition.operand = {text_in(object, "attribute"), text_in(object, "concept")};
    }
    condition.min = number_of(object, "min");
    condition.max = number_of(object, "max");
    condition.above = number_of(object, "above");
    condition.below = number_of(object, "below");
    condition.unit = text_in(object, "unit");
    condition.is = names_of(object, "is");
    return condition;
}

InferenceRule inference_rule_of(const JsonValue& object, const std::string& where, const std::string& at) {
    InferenceRule rule;
    rule.id = text_in(object, "id");
    rule.note = text_in(object, "note");
    rule.concept_id = text_in(object, "concept");
    const JsonValue& conditions = object["if"];
    for (rapidjson::SizeType i = 0; i < conditions.Size(); ++i)
        rule.conditions.push_back(condition_of(conditions[i], where, at + "/if/" + to_string(i)));
    rule.attribute = text_in(object["then"], "attribute");
    rule.value = text_in(object["then"], "value");
    return rule;
}

/// Members that are empty are left out.
class Writer {
public:
    Json document{rapidjson::kObjectType};

    explicit Writer(const Vocabulary& vocabulary) {
        add_members(document, allocator_, "format", "ostraka-vocabulary", "version", 1);
        text(document, "uri", vocabulary.uri);
        labels(document, "title", vocabulary.title);
        attributes(document, vocabulary.attributes);
        JsonValue concepts(rapidjson::kArrayType);
        for (const Concept& entry : vocabulary.concepts) concepts.PushBack(json_of(entry), allocator_);
        add_member(document, "concepts", std::move(concepts), allocator_);
        if (!vocabulary.rules.empty()) {
            JsonValue rules(rapidjson::kArrayType);
            for (const InferenceRule& rule : vocabulary.rules) rules.PushBack(json_of(rule), allocator_);
            add_member(document, "rules", std::move(rules), allocator_);
        }
        statements(document, vocabulary.others);
    }

private:
    JsonAllocator& allocator_ = document.GetAllocator();

    void text(JsonValue& object, const char* name, const std::string& value) {
        if (!value.empty()) add_member(object, name, value, allocator_);
    }
    void number(JsonValue& object, const char* name, const std::optional<double>& value) {
        if (!value) return;
        const bool whole = std::abs(*value) < 1e9 && *value == std::floor(*value);
        add_member(object, name, whole ? JsonValue(static_cast<int>(*value)) : JsonValue(*value), allocator_);
    }
    void labels(JsonValue& object, const char* name, const Labels& value) {
        if (value.empty()) return;
        if (value.size() == 1 && value.begin()->first.empty()) {
            add_member(object, name, value.begin()->second, allocator_);
            return;
        }
        JsonValue list(rapidjson::kObjectType);
        for (const auto& [language, label] : value) add_member(list, language, label, allocator_);
        add_member(object, name, std::move(list), allocator_);
    }
    JsonValue list_of(const std::vector<std::string>& value) {
        JsonValue list(rapidjson::kArrayType);
        for (const auto& element : value) list.PushBack(json_string(element, allocator_), allocator_);
        return list;
    }
    void names(JsonValue& object, const char* name, const std::vector<std::string>& value) {
        if (value.size() == 1) add_member(object, name, value.front(), allocator_);
        else if (!value.empty()) add_member(object, name, list_of(value), allocator_);
    }
    void attributes(JsonValue& object, const std::vector<AllowedAttribute>& value) {
        if (value.empty()) return;
        JsonValue list(rapidjson::kArrayType);
        for (const AllowedAttribute& attribute : value) {
            JsonValue entry(rapidjson::kObjectType);
            add_member(entry, "name", attribute.name, allocator_);
            labels(entry, "label", attribute.labels);
            labels(entry, "definition", attribute.definition);
            if (!attribute.values.empty()) {
                JsonValue terms(rapidjson::kArrayType);
                for (const Term& term : attribute.values) {
                    if (term.labels.empty()) {
                        terms.PushBack(json_string(term.name, allocator_), allocator_);
                        continue;
                    }
                    JsonValue object_of_term(rapidjson::kObjectType);
                    add_member(object_of_term, "name", term.name, allocator_);
                    labels(object_of_term, "label", term.labels);
                    terms.PushBack(object_of_term, allocator_);
                }
                add_member(entry, "values", std::move(terms), allocator_);
            }
            number(entry, "min", attribute.min);
            number(entry, "max", attribute.max);
            text(entry, "unit", attribute.unit);
            list.PushBack(entry, allocator_);
        }
        add_member(object, "attributes", std::move(list), allocator_);
    }
    void statements(JsonValue& object, const std::vector<ForeignStatement>& value) {
        if (value.empty()) return;
        JsonValue list(rapidjson::kArrayType);
        for (const ForeignStatement& statement : value) {
            JsonValue entry =
                json_object(allocator_, "property", statement.property, statement.is_uri ? "uri" : "value", statement.value);
            text(entry, "language", statement.language);
            text(entry, "datatype", statement.datatype);
            list.PushBack(entry, allocator_);
        }
        add_member(object, "other", std::move(list), allocator_);
    }
    JsonValue json_of(const Concept& entry) {
        JsonValue object(rapidjson::kObjectType);
        add_member(object, "id", entry.id, allocator_);
        text(object, "uri", entry.uri);
        labels(object, "label", entry.labels);
        if (!entry.alternatives.empty()) {
            JsonValue list(rapidjson::kObjectType);
            for (const auto& [language, alternatives] : entry.alternatives)
                add_member(list, language, list_of(alternatives), allocator_);
            add_member(object, "alternatives", std::move(list), allocator_);
        }
        names(object, "broader", entry.broader);
        labels(object, "definition", entry.definition);
        attributes(object, entry.attributes);
        statements(object, entry.others);
        return object;
    }
    JsonValue json_of(const Operand& operand) {
        if (operand.concept_id.empty()) return json_string(operand.attribute, allocator_);
        JsonValue object = json_object(allocator_, "attribute", operand.attribute, "concept", operand.concept_id);
        return object;
    }
    JsonValue json_of(const InferenceRule& rule) {
        JsonValue object(rapidjson::kObjectType), conditions(rapidjson::kArrayType), then(rapidjson::kObjectType);
        add_member(object, "id", rule.id, allocator_);
        text(object, "note", rule.note);
        text(object, "concept", rule.concept_id);
        for (const Condition& condition : rule.conditions) {
            JsonValue entry(rapidjson::kObjectType);
            if (condition.divisor) {
                JsonValue ratio(rapidjson::kArrayType);
                ratio.PushBack(json_of(condition.operand), allocator_).PushBack(json_of(*condition.divisor), allocator_);
                add_member(entry, "ratio", std::move(ratio), allocator_);
            } else {
                add_member(entry, "attribute", condition.operand.attribute, allocator_);
                text(entry, "concept", condition.operand.concept_id);
            }
            number(entry, "min", condition.min);
            number(entry, "max", condition.max);
            number(entry, "above", condition.above);
            number(entry, "below", condition.below);
            text(entry, "unit", condition.unit);
            names(entry, "is", condition.is);
            conditions.PushBack(entry, allocator_);
        }
        add_member(object, "if", std::move(conditions), allocator_);
        add_members(then, allocator_, "attribute", rule.attribute, "value", rule.value);
        add_member(object, "then", std::move(then), allocator_);
        return object;
    }
};

}  // namespace

std::vector<InferenceRule> rules_from_json(const JsonValue& list, const std::string& where) {
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    add_members(document, allocator, "format", "ostraka-vocabulary", "version", 1, "concepts", JsonValue(rapidjson::kArrayType),
                "rules", JsonValue(list, allocator));
    validate(document, "vocabulary", where);
    std::vector<InferenceRule> rules;
    for (rapidjson::SizeType i = 0; i < list.Size(); ++i)
        rules.push_back(inference_rule_of(list[i], where, "/rules/" + to_string(i)));
    return rules;
}

Vocabulary vocabulary_from_json(const JsonValue& document, const std::string& where) {
    if (const JsonValue* format = find_member(document, "format");
        format != nullptr && format->IsString() && text_of(*format) != "ostraka-vocabulary")
        fail_input(where, "at /format: the format is '" + text_of(*format) + "'", "give a vocabulary ('ostraka-vocabulary')");
    validate(document, "vocabulary", where);
    Vocabulary vocabulary;
    vocabulary.uri = text_in(document, "uri");
    vocabulary.title = labels_of(document, "title");
    vocabulary.attributes = attributes_of(document);
    const JsonValue& concepts = document["concepts"];
    for (rapidjson::SizeType i = 0; i < concepts.Size(); ++i)
        vocabulary.concepts.push_back(concept_of(concepts[i], where, "/concepts/" + to_string(i)));
    if (const JsonValue* rules = find_member(document, "rules"))
        for (rapidjson::SizeType i = 0; i < rules->Size(); ++i)
            vocabulary.rules.push_back(inference_rule_of((*rules)[i], where, "/rules/" + to_string(i)));
    vocabulary.others = statements_of(document, where, "");
    if (vocabulary.uri == skos::default_scheme) vocabulary.uri.clear();
    for (Concept& entry : vocabulary.concepts)
        if (entry.uri == skos::namespace_of(vocabulary.uri) + skos::percent_encoded(entry.id)) entry.uri.clear();
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

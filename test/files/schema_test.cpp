// Schemas of doc/schema: all references resolve, and any document is accepted or refused with a message.
#include "ostraka/core/error.h"
#include "ostraka/files/json.h"

#include <gtest/gtest.h>
#include <rapidjson/pointer.h>

using namespace ostraka;

namespace {

using Pointer = rapidjson::GenericPointer<JsonValue>;

constexpr const char* ending = ".schema.json";
Path schema_folder() { return Path(OSTRAKA_SOURCE_DIR) / "doc" / "schema"; }

std::vector<std::string> schema_names() {
    std::vector<std::string> names;
    for (const std::string& file : files_in(schema_folder()))
        if (file.ends_with(ending)) names.push_back(file.substr(0, file.size() - std::string_view(ending).size()));
    return names;
}

/// All values of "$ref", with their locations.
void list_references(const JsonValue& value, const std::string& pointer,
                     std::vector<std::pair<std::string, std::string>>& references) {
    if (value.IsArray())
        for (rapidjson::SizeType i = 0; i < value.Size(); ++i)
            list_references(value[i], pointer + "/" + std::to_string(i), references);
    if (!value.IsObject()) return;
    for (const auto& member : value.GetObject()) {
        if (text_of(member.name) == "$ref" && member.value.IsString()) references.emplace_back(pointer, text_of(member.value));
        else list_references(member.value, pointer + "/" + text_of(member.name), references);
    }
}

/// A document that has every member that the schema knows, approximately valid.
class Sample {
public:
    explicit Sample(const JsonValue& schema) : schema_(schema) {}

    Json make() {
        Json document;
        allocator_ = &document.GetAllocator();
        static_cast<JsonValue&>(document) = value_for(schema_, 0);
        return document;
    }

private:
    JsonValue value_for(const JsonValue& rules, int depth) {
        if (depth > 7 || !rules.IsObject()) return {};
        if (const JsonValue* reference = find_member(rules, "$ref")) {
            const JsonValue* target = Pointer(text_of(*reference).substr(1).c_str()).Get(schema_);
            return target == nullptr ? JsonValue() : value_for(*target, depth + 1);
        }
        for (const char* choice : {"anyOf", "oneOf", "allOf"})
            if (const JsonValue* list = find_member(rules, choice); list != nullptr && !list->Empty())
                return value_for((*list)[0], depth + 1);
        if (const JsonValue* values = find_member(rules, "enum")) return JsonValue((*values)[0], *allocator_);
        const std::string type = text_in(rules, "type");
        if (type == "object" || find_member(rules, "properties") != nullptr) return object(rules, depth);
        if (type == "array") return array(rules, depth);
        if (type == "string") return json_string(find_member(rules, "pattern") == nullptr ? "text" : "s001", *allocator_);
        if (type == "boolean") return JsonValue(true);
        return JsonValue(1);
    }

    JsonValue object(const JsonValue& rules, int depth) {
        JsonValue value(rapidjson::kObjectType);
        if (const JsonValue* members = find_member(rules, "properties"))
            for (const auto& member : members->GetObject())
                add_member(value, text_of(member.name), value_for(member.value, depth + 1), *allocator_);
        if (const JsonValue* others = find_member(rules, "additionalProperties"); others != nullptr && others->IsObject())
            add_member(value, "other", value_for(*others, depth + 1), *allocator_);
        return value;
    }

    JsonValue array(const JsonValue& rules, int depth) {
        JsonValue value(rapidjson::kArrayType);
        const auto count = static_cast<int>(std::min(4.0, number_or(rules, "minItems", 1)));
        if (const JsonValue* items = find_member(rules, "items"); items != nullptr && items->IsArray()) {
            for (const auto& item : items->GetArray()) value.PushBack(value_for(item, depth + 1), *allocator_);
        } else if (items != nullptr) {
            for (int i = 0; i < std::max(1, count); ++i) value.PushBack(value_for(*items, depth + 1), *allocator_);
        }
        return value;
    }

    const JsonValue& schema_;
    JsonAllocator* allocator_ = nullptr;
};

/// Any document is valid, or an Error gives the location of the problem.
void expect_words(const JsonValue& document, const std::string& schema) {
    try {
        validate(document, schema, "document");
    } catch (const Error& error) {
        EXPECT_FALSE(error.problem().empty());
        EXPECT_FALSE(error.remedy().empty());
    }
}

/// Replaces each value by values of all types in turn. Returns the number of documents.
std::size_t with_wrong_types(Json& document, JsonValue& value, const std::string& schema) {
    static const Json others = parse_json(R"([null, true, 5, -1, 1e300, "", "x", [], {}, [5], [["a"], 5], {"a": 5}])", "others");
    auto& a = document.GetAllocator();
    std::size_t count = 0;
    JsonValue original;
    original.Swap(value);
    for (const auto& other : others.GetArray()) {
        value.CopyFrom(other, a);
        expect_words(document, schema);
        ++count;
    }
    value.Swap(original);
    if (value.IsObject())
        for (auto& member : value.GetObject()) count += with_wrong_types(document, member.value, schema);
    else if (value.IsArray())
        for (auto& element : value.GetArray()) count += with_wrong_types(document, element, schema);
    return count;
}

}  // namespace

TEST(Schemas, EveryReferenceResolves) {
    std::size_t count = 0;
    for (const std::string& name : schema_names()) {
        const Json schema = read_json(schema_folder() / (name + ending));
        std::vector<std::pair<std::string, std::string>> references;
        list_references(schema, "", references);
        for (const auto& [place, reference] : references) {
            ASSERT_TRUE(reference.starts_with("#/")) << name << " at " << place << ": " << reference;
            EXPECT_NE(Pointer(reference.substr(1).c_str()).Get(schema), nullptr) << name << " at " << place << ": " << reference;
            ++count;
        }
    }
    EXPECT_GT(count, 40U);
}

TEST(Schemas, WrongTypesInEveryMemberAreRefusedWithAMessage) {
    const std::vector<std::string> names = schema_names();
    ASSERT_GT(names.size(), 20U);
    for (const std::string& name : names) {
        const Json schema = read_json(schema_folder() / (name + ending));
        Json document = Sample(schema).make();
        EXPECT_GT(with_wrong_types(document, document, name), 12U) << name;
    }
}

TEST(Schemas, RecordListsArePairsOfTexts) {
    const auto record = [](const std::string& depends) {
        return parse_json(
            R"({"format": "ostraka-study-record", "version": 1, "step": "a", "parameters": {}, "read": [], "outputs": {},
                              "holds": true, "run": {"seconds": 1, "began": "", "ended": ""}, "depends": )" +
                depends + "}",
            "record");
    };
    EXPECT_NO_THROW(validate(record(R"([["toolkit", "1"], ["input", "x"]])"), "study-record", "record"));
    for (const char* wrong : {"5", "{}", "[5]", R"(["a", "b"])", R"([["a"]])", R"([["a", "b", "c"]])", R"([["a", 5]])", "null"})
        EXPECT_THROW(validate(record(wrong), "study-record", "record"), Error) << wrong;
}

// The prototype's own .ant files: types Area, Line and Point, the key color, flat attributes. Read as well as may be.
#include "annotation_places.h"

#include "ostraka/core/error.h"

#include <algorithm>
#include <cctype>

namespace ostraka {

namespace {

using places::fail;
using std::to_string;

std::string lower(const JsonValue* value) {
    if (value == nullptr || !value->IsString()) return {};
    std::string text(value->GetString(), value->GetStringLength());
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

const std::vector<std::string>& capital_types() {
    static const std::vector<std::string> types{"Area", "Surface", "Region", "Line", "Point"};
    return types;
}

class Converter {
public:
    Converter(std::string where, std::vector<std::string>& notes) : where_(std::move(where)), notes_(notes) {
        document_.SetObject();
    }

    Json convert(const JsonValue& source) {
        JsonValue list(rapidjson::kArrayType);
        const JsonValue& annotations = *find_member(source, "annotations");
        notes_.emplace_back("an annotation file of the thesis's prototype, converted");
        for (rapidjson::SizeType i = 0; i < annotations.Size(); ++i)
            list.PushBack(annotation(annotations[i], "/annotations/" + to_string(i)), allocator());
        add_member(document_, "annotations", std::move(list), allocator());
        return std::move(document_);
    }

private:
    JsonAllocator& allocator() { return document_.GetAllocator(); }
    JsonValue copy(const JsonValue& value) { return JsonValue(value, allocator()); }
    void note(const std::string& at, const std::string& text) { notes_.push_back("at " + at + ": " + text); }

    /// An integer, which some versions of the prototype wrote as text.
    JsonValue whole(const JsonValue& value, const std::string& at) {
        if (value.IsInt()) return JsonValue(value.GetInt());
        if (value.IsString()) {
            const std::string text(value.GetString(), value.GetStringLength());
            if (!text.empty() && text.size() < 10 &&
                std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; }))
                return JsonValue(std::stoi(text));
        }
        fail(where_, at, "is not a whole number", "mend it");
    }

    JsonValue annotation(const JsonValue& source, const std::string& at) {
        if (!source.IsObject()) fail(where_, at, "is not an object", "mend or regenerate the file");
        JsonValue result(rapidjson::kObjectType);
        std::string type = lower(find_member(source, "type"));
        if (type == "area" || type == "surface") type = "region";
        const bool known = type == "region" || type == "line" || type == "point";
        if (!known) fail(where_, at + "/type", "'" + type + "' is no type of annotation", "use Area, Line or Point");
        for (const auto& member : source.GetObject()) {
            const std::string name(member.name.GetString(), member.name.GetStringLength());
            if (name == "id") add_member(result, "id", whole(member.value, at + "/id"), allocator());
            else if (name == "color") add_member(result, "colour", copy(member.value), allocator());
            else if (name == "type") add_member(result, "type", type, allocator());
            else if (name == "attributes")
                add_member(result, "attributes", attributes(member.value, at + "/attributes"), allocator());
            else if (name == "level") note(at, "the level in the hierarchy is not kept: it follows from the containment");
            else add_member(result, name, copy(member.value), allocator());
        }
        return result;
    }

    JsonValue attributes(const JsonValue& source, const std::string& at) {
        if (!source.IsArray()) fail(where_, at, "is not a list", "mend or regenerate the file");
        JsonValue list(rapidjson::kArrayType);
        for (rapidjson::SizeType i = 0; i < source.Size(); ++i) {
            const std::string here = at + '/' + to_string(i);
            const JsonValue& entry = source[i];
            if (!entry.IsObject()) fail(where_, here, "is not an object", "mend or regenerate the file");
            const std::string type = lower(find_member(entry, "type"));
            if (type == "semantic" && find_member(entry, "note") == nullptr) list.PushBack(semantic(entry), allocator());
            else if (type == "geometric") list.PushBack(geometric(entry, here), allocator());
            else list.PushBack(copy(entry), allocator());
        }
        return list;
    }

    JsonValue head(const JsonValue& entry, const char* type) {
        JsonValue result(rapidjson::kObjectType);
        for (const char* name : {"id", "name"})
            if (const JsonValue* value = find_member(entry, name)) add_member(result, name, copy(*value), allocator());
        add_member(result, "type", type, allocator());
        return result;
    }

    JsonValue semantic(const JsonValue& entry) {
        JsonValue result = head(entry, "semantic");
        const JsonValue* value = find_member(entry, "value");
        add_member(result, "note", value != nullptr && value->IsString() ? copy(*value) : json_string("", allocator()),
                   allocator());
        return result;
    }

    JsonValue geometric(const JsonValue& entry, const std::string& at) {
        std::string tool = lower(find_member(entry, "tool"));
        const JsonValue* value = find_member(entry, "value");
        const JsonValue* points = find_member(entry, "points");
        const JsonValue* direction = find_member(entry, "direction");
        if (tool == "height" && direction != nullptr) {
            note(at, "the tool height is read as bounding");
            tool = "bounding";
        }
        const bool usable = (tool == "ruler" || tool == "tape" || (tool == "bounding" && direction != nullptr)) &&
                            points != nullptr && points->IsArray() && points->Size() >= 2;
        if (!usable) {
            note(at, "a measure without a known tool or without its pins becomes a descriptor");
            JsonValue result = head(entry, "descriptor");
            if (value != nullptr && value->IsNumber()) add_member(result, "value", copy(*value), allocator());
            return result;
        }
        JsonValue measure(rapidjson::kObjectType);
        add_member(measure, "tool", tool, allocator());
        JsonValue pins(rapidjson::kArrayType);
        for (rapidjson::SizeType i = 0; i < points->Size(); ++i)
            pins.PushBack(whole((*points)[i], at + "/points/" + to_string(i)), allocator());
        add_member(measure, "points", std::move(pins), allocator());
        if (direction != nullptr) add_member(measure, "direction", copy(*direction), allocator());
        if (value != nullptr && value->IsNumber()) add_member(measure, "value", copy(*value), allocator());
        JsonValue result = head(entry, "measure");
        add_member(result, "measure", std::move(measure), allocator());
        return result;
    }

    std::string where_;
    std::vector<std::string>& notes_;
    Json document_;
};

}  // namespace

bool is_prototype(const JsonValue& document) {
    const JsonValue* list = find_member(document, "annotations");
    if (find_member(document, "format") != nullptr || list == nullptr || !list->IsArray()) return false;
    for (const auto& annotation : list->GetArray()) {
        if (find_member(annotation, "color") != nullptr) return true;
        const JsonValue* type = find_member(annotation, "type");
        for (const std::string& capital : capital_types())
            if (type != nullptr && type->IsString() && capital == type->GetString()) return true;
    }
    return false;
}

Json convert_prototype(const JsonValue& document, const std::string& where, std::vector<std::string>& notes) {
    return Converter(where, notes).convert(document);
}

}  // namespace ostraka

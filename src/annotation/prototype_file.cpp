// The prototype's .ant files: types Area, Line and Point, the key color, flat attributes. Read as far as possible.
#include "annotation/annotation_places.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/files/json_build.h"

#include <algorithm>
#include <cctype>
#include <set>

namespace ostraka {

namespace {

using places::fail;
using std::to_string;

std::string lower_in(const JsonValue& object, const char* name) { return lower_case(text_in(object, name)); }

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
            const std::string text = text_of(value);
            if (!text.empty() && text.size() < 10 &&
                std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; }))
                return JsonValue(std::stoi(text));
        }
        fail(where_, at, "is not a whole number", "give an integer");
    }

    JsonValue annotation(const JsonValue& source, const std::string& at) {
        if (!source.IsObject()) fail(where_, at, "is not an object", "correct or regenerate the file");
        JsonValue result(rapidjson::kObjectType);
        std::string type = lower_in(source, "type");
        if (type == "area" || type == "surface") type = "region";
        const bool known = type == "region" || type == "line" || type == "point";
        if (!known) fail(where_, at + "/type", "'" + type + "' is no type of annotation", "use Area, Line or Point");
        for (const auto& member : source.GetObject()) {
            const std::string name = text_of(member.name);
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
        if (!source.IsArray()) fail(where_, at, "is not a list", "correct or regenerate the file");
        JsonValue list(rapidjson::kArrayType);
        for (rapidjson::SizeType i = 0; i < source.Size(); ++i) {
            const std::string here = at + '/' + to_string(i);
            const JsonValue& entry = source[i];
            if (!entry.IsObject()) fail(where_, here, "is not an object", "correct or regenerate the file");
            const std::string type = lower_in(entry, "type");
            if (type == "semantic" && find_member(entry, "note") == nullptr) list.PushBack(semantic(entry), allocator());
            else if (type == "geometric") list.PushBack(geometric(entry, here), allocator());
            else list.PushBack(copy(entry), allocator());
        }
        return list;
    }

    JsonValue head(const JsonValue& entry, const char* type) {
        JsonValue result(rapidjson::kObjectType);
        copy_members(result, allocator(), entry, {"id", "name"});
        add_member(result, "type", type, allocator());
        return result;
    }

    JsonValue semantic(const JsonValue& entry) {
        JsonValue result = head(entry, "semantic");
        add_member(result, "note", text_in(entry, "value"), allocator());
        return result;
    }

    JsonValue geometric(const JsonValue& entry, const std::string& at) {
        std::string tool = lower_in(entry, "tool");
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
        JsonValue pins(rapidjson::kArrayType);
        for (rapidjson::SizeType i = 0; i < points->Size(); ++i)
            pins.PushBack(whole((*points)[i], at + "/points/" + to_string(i)), allocator());
        JsonValue measure = json_object(allocator(), "tool", tool, "points", std::move(pins));
        copy_members(measure, allocator(), entry, {"direction"});
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
    if (find_member(document, "format") != nullptr) return false;
    const auto list = list_in(document, "annotations");
    return std::any_of(list.begin(), list.end(), [](const JsonValue& annotation) {
        static const std::set<std::string> capital_types{"Area", "Surface", "Region", "Line", "Point"};
        return find_member(annotation, "color") != nullptr || capital_types.contains(text_in(annotation, "type"));
    });
}

Json convert_prototype(const JsonValue& document, const std::string& where, std::vector<std::string>& notes) {
    return Converter(where, notes).convert(document);
}

}  // namespace ostraka

#include "mutations.h"

#include "ostraka/core/error.h"

#include <rapidjson/pointer.h>

#include <algorithm>
#include <limits>

namespace ostraka::fuzz {

namespace {

const std::vector<std::string>& hostile_words() {
    static const std::vector<std::string> words{"nan",
                                                "-inf",
                                                "1e400",
                                                "1e308",
                                                "-1e308",
                                                "1e-320",
                                                "-1",
                                                "0",
                                                "1",
                                                "-0",
                                                "255",
                                                "65536",
                                                "1000000",
                                                "2147483647",
                                                "2147483648",
                                                "3000000000",
                                                "4294967295",
                                                "4294967296",
                                                "9223372036854775806",
                                                "9223372036854775807",
                                                "-9223372036854775808",
                                                "18446744073709551615",
                                                "99999999999999999999",
                                                "0x10",
                                                "",
                                                "1.5",
                                                "\"",
                                                "{",
                                                "}",
                                                "[",
                                                "]",
                                                "null",
                                                "true",
                                                "/",
                                                "\\",
                                                "\xff\xfe",
                                                "#",
                                                "2//",
                                                "<!--",
                                                "&amp;",
                                                "../",
                                                std::string(300, '9'),
                                                std::string(1, '\0')};
    return words;
}

const std::vector<double>& hostile_numbers() {
    static const std::vector<double> numbers{0,    -0.0,  1,      -1,  2,   3,          0.5,        1e-9,       1e-320, 1e15,
                                             1e99, 1e308, -1e308, 255, 256, 2147483647, 2147483648, 4294967296, 1e6,    1e9};
    return numbers;
}

std::vector<std::string> make_texts() {
    const std::string out = canaries_mark;
    std::vector<std::string> texts{"",
                                   ".",
                                   "..",
                                   "/",
                                   "../canaries/secret.txt",
                                   "../canaries/secret.ply",
                                   "../../canaries/secret.ply",
                                   "../../canaries/folder",
                                   "../../../canaries/secret.ply",
                                   "x/../../canaries/secret.ply",
                                   "./../canaries/made",
                                   "link-out/secret.ply",
                                   "link-out/made",
                                   "link-out",
                                   "/dev/zero",
                                   "/dev/stdin",
                                   "/proc/self/mem",
                                   "memory:1/x",
                                   "a\nb",
                                   "a\tb\x1b[2J\x07",
                                   std::string("a\0b", 3),
                                   "<script>alert(1)</script>",
                                   "\"><img src=x onerror=alert(1)>",
                                   "](javascript:alert(1))",
                                   "javascript:alert(1)",
                                   "|x|\n|-|",
                                   "\\input{x}",
                                   "${study}/../canaries/secret.ply",
                                   "${folder}/../../../../canaries/made",
                                   "${a.output}",
                                   "${",
                                   "%2e%2e%2f",
                                   "none",
                                   "name=../canaries/secret.ply",
                                   "sh",
                                   "-",
                                   "--help",
                                   "*",
                                   "**/*",
                                   "../*/*",
                                   "\xe2\x80\xae",
                                   "\xff",
                                   std::string(100000, 'x'),
                                   std::string(300, '/'),
                                   std::string(400, 'n') + ".ply"};
    for (const char* name : {"", "/secret.txt", "/secret.ply", "/folder", "/made", "/program", "/*.ply"})
        texts.push_back(out + name);
    texts.push_back("file://" + out + "/secret.ply");
    texts.push_back("name=" + out + "/secret.ply");
    return texts;
}
const std::vector<std::string>& hostile_texts() {
    static const std::vector<std::string> texts = make_texts();
    return texts;
}

/// Paths to canaries, from folders of any depth.
std::vector<std::string> make_leading_out() {
    std::vector<std::string> texts;
    for (const char* name : {"secret.ply", "secret.txt", "secret.json", "made"}) {
        texts.push_back(std::string(canaries_mark) + "/" + name);
        for (const char* way : {"../canaries/", "../../canaries/", "../../../canaries/", "link-out/", "../link-out/"})
            texts.push_back(std::string(way) + name);
    }
    return texts;
}
const std::vector<std::string>& leading_out() {
    static const std::vector<std::string> texts = make_leading_out();
    return texts;
}

// ---- bytes ----

std::size_t stretch(const std::string& text, std::size_t at, Dice& dice) {
    const std::size_t most = dice.once_in(8) ? text.size() : 40;
    return std::min(1 + dice.below(most), text.size() - at);
}

/// Begin and end of the word around a place: the text between blanks and punctuation.
std::pair<std::size_t, std::size_t> word_at(const std::string& text, std::size_t at) {
    static constexpr const char* separators = " \t\r\n,:;[]{}\"/<>=";
    std::size_t begin = text.find_first_not_of(separators, at);
    if (begin == std::string::npos) return {at, std::min(at + 1, text.size())};
    std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    return {begin, std::min(end, begin + 400)};
}

std::size_t line_begin(const std::string& text, std::size_t at) {
    const std::size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    return before == std::string::npos ? 0 : before + 1;
}

void repeat(std::string& text, std::size_t at, std::size_t length, Dice& dice) {
    const std::string piece = text.substr(at, length);
    const std::size_t times = dice.once_in(6) ? std::min<std::size_t>(5000, 200000 / piece.size() + 1) : 1 + dice.below(3);
    std::string many;
    for (std::size_t i = 0; i < times; ++i) many += piece;
    text.insert(at, many);
}

void injure(std::string& text, const std::string& other, Dice& dice) {
    const std::size_t at = dice.below(text.size()), length = stretch(text, at, dice);
    const auto [begin, end] = word_at(text, at);
    switch (dice.below(12)) {
        case 0:
            text[at] = static_cast<char>(dice.next());
            break;
        case 1:
            text[at] = static_cast<char>(text[at] ^ static_cast<char>(1U << dice.below(8)));
            break;
        case 2:
            text.resize(at);
            break;
        case 3:
            text.erase(at, length);
            break;
        case 4:
            repeat(text, at, length, dice);
            break;
        case 5:
            std::fill_n(text.begin() + static_cast<std::ptrdiff_t>(at), length, dice.once_in(2) ? '\0' : '\xff');
            break;
        case 6:
            text.replace(begin, end - begin, dice.pick(hostile_words()));
            break;
        case 7:
            text.erase(begin, end - begin);
            break;
        case 8:
            text.insert(at, dice.pick(hostile_words()));
            break;
        case 9: {  // a line, duplicated or removed
            const std::size_t first = line_begin(text, at), last = std::min(text.find('\n', at), text.size() - 1) + 1;
            if (dice.once_in(2)) text.erase(first, last - first);
            else text.insert(first, text.substr(first, last - first));
            break;
        }
        case 10:  // joined with another file
            if (!other.empty()) text = text.substr(0, at) + other.substr(dice.below(other.size()));
            break;
        default:
            text.replace(begin, end - begin, dice.pick(hostile_texts()));
            break;
    }
}

// ---- JSON ----

/// A value with its holder.
struct Place {
    JsonValue* value;
    JsonValue* holder;  ///< null for the root
    std::size_t index;  ///< within the holder
};

void list_places(JsonValue& value, JsonValue* holder, std::size_t index, std::vector<Place>& places) {
    places.push_back({&value, holder, index});
    if (value.IsObject())
        for (std::size_t i = 0; i < value.MemberCount(); ++i)
            list_places((value.MemberBegin() + static_cast<std::ptrdiff_t>(i))->value, &value, i, places);
    else if (value.IsArray())
        for (rapidjson::SizeType i = 0; i < value.Size(); ++i) list_places(value[i], &value, i, places);
}

JsonValue nested(Dice& dice, JsonAllocator& a) {
    JsonValue value(rapidjson::kArrayType);
    const std::size_t depth = dice.once_in(2) ? 60 : 190;
    for (std::size_t i = 0; i < depth; ++i) {
        JsonValue outer(dice.once_in(2) ? rapidjson::kArrayType : rapidjson::kObjectType);
        if (outer.IsArray()) outer.PushBack(value, a);
        else outer.AddMember("a", value, a);
        value = outer;
    }
    return value;
}

JsonValue other_value(const JsonValue& old, Dice& dice, JsonAllocator& a) {
    const std::size_t choice = old.IsNumber() && dice.below(3) > 0 ? 0 : old.IsString() && dice.below(4) > 0 ? 1 : dice.below(9);
    switch (choice) {
        case 0:
            if (dice.once_in(5)) return JsonValue(std::int64_t{9223372036854775806});
            if (const double number = dice.pick(hostile_numbers()); dice.once_in(2) && number == static_cast<int>(number))
                return JsonValue(static_cast<int>(number));
            else return JsonValue(number);
        case 1:
            return json_string(dice.pick(dice.once_in(2) ? leading_out() : hostile_texts()), a);
        case 2:
            return JsonValue(rapidjson::kNullType);
        case 3:
            return JsonValue(dice.once_in(2));
        case 4:
            return JsonValue(rapidjson::kObjectType);
        case 5:
            return JsonValue(rapidjson::kArrayType);
        case 6:
            return nested(dice, a);
        case 7:
            return JsonValue(std::numeric_limits<std::uint64_t>::max());
        default: {
            JsonValue list(rapidjson::kArrayType);
            list.PushBack(JsonValue(old, a), a);
            return list;
        }
    }
}

void change_object(JsonValue& object, std::size_t index, Dice& dice, JsonAllocator& a) {
    auto member = object.MemberBegin() + static_cast<std::ptrdiff_t>(index);
    switch (dice.below(5)) {
        case 0:
            object.EraseMember(member);
            break;
        case 1: {
            JsonValue name(member->name, a), value(member->value, a);
            object.AddMember(name, value, a);
            break;
        }
        case 2:
            member->name = json_string(dice.pick(hostile_texts()), a);
            break;
        case 3: {
            auto other = object.MemberBegin() + static_cast<std::ptrdiff_t>(dice.below(object.MemberCount()));
            if (other != member) member->value.Swap(other->value);
            break;
        }
        default: {
            JsonValue name = json_string(dice.pick(hostile_texts()), a), value(member->value, a);
            object.AddMember(name, value, a);
        }
    }
}

void change_array(JsonValue& array, std::size_t index, Dice& dice, JsonAllocator& a) {
    auto* const element = array.Begin() + static_cast<std::ptrdiff_t>(index);
    switch (dice.below(4)) {
        case 0:
            array.Erase(element);
            break;
        case 1:
            array.PushBack(JsonValue(*element, a), a);
            break;
        case 2: {
            const JsonValue copy(*element, a);
            const std::size_t times = dice.once_in(4) ? 3000 : 20;
            for (std::size_t i = 0; i < times; ++i) array.PushBack(JsonValue(copy, a), a);
            break;
        }
        default:
            if (auto* const other = array.Begin() + static_cast<std::ptrdiff_t>(dice.below(array.Size())); other != element)
                element->Swap(*other);
    }
}

void change_document(Json& document, Dice& dice) {
    auto& a = document.GetAllocator();
    std::vector<Place> places;
    list_places(document, nullptr, 0, places);
    const Place place = places[dice.below(places.size())];
    const std::size_t how = dice.below(10);
    if (place.holder != nullptr && how < 3) {
        if (place.holder->IsObject()) change_object(*place.holder, place.index, dice, a);
        else change_array(*place.holder, place.index, dice, a);
    } else if (how == 3) {
        *place.value = JsonValue(*places[dice.below(places.size())].value, a);
    } else {
        *place.value = other_value(*place.value, dice, a);
    }
}

void plant(Json& document, const Plant& planting, Dice& dice) {
    auto& a = document.GetAllocator();
    JsonValue* const place = rapidjson::GenericPointer<JsonValue>(planting.pointer).Get(document);
    if (place == nullptr) return;
    const Json planted = parse_json(planting.value, "what is planted");
    JsonValue value(planted, a);
    if (place->IsArray()) {
        place->PushBack(value, a);
    } else if (place->IsObject()) {
        const std::string name = "planted" + std::to_string(dice.below(10));
        place->AddMember(json_string(name, a), value, a);
    }
}

}  // namespace

bool is_json_name(const std::string& file) { return file.ends_with(".json") || file.ends_with(".jsonld"); }

std::string mutate_bytes(const std::string& bytes, const std::string& other, Dice& dice) {
    constexpr std::size_t largest = 4'000'000;
    std::string text = bytes;
    const std::size_t injuries = 1 + dice.below(4) * dice.below(3);
    for (std::size_t i = 0; i < injuries && !text.empty() && text.size() < largest; ++i) injure(text, other, dice);
    return text;
}

std::string mutate_json(const std::string& text, const std::vector<Plant>& plants, Dice& dice) {
    try {
        Json document = parse_json(text, "a seed");
        if (!plants.empty() && dice.once_in(3)) {
            plant(document, dice.pick(plants), dice);
            if (dice.once_in(2)) return to_compact_text(document);
        }
        const std::size_t changes = 1 + dice.below(3) * dice.below(3);
        for (std::size_t i = 0; i < changes; ++i) change_document(document, dice);
        return to_compact_text(document);
    } catch (const Error&) {
        return mutate_bytes(text, {}, dice);
    }
}

std::string mutate_lines(const std::string& text, Dice& dice) {
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    const std::size_t changes = 1 + dice.below(6);
    for (std::size_t i = 0; i < changes; ++i) {
        std::string& line = lines[dice.below(lines.size())];
        if (dice.once_in(5)) line = mutate_bytes(line, dice.pick(lines), dice);
        else line = mutate_json(line, {}, dice);
        if (dice.once_in(4)) std::swap(lines[dice.below(lines.size())], lines[dice.below(lines.size())]);
    }
    std::string joined;
    for (const std::string& line : lines) joined += line + "\n";
    return joined;
}

std::string mutate_options(const std::string& text, const std::vector<std::string>& members, Dice& dice) {
    Json document = parse_json(text, "a call");
    auto& a = document.GetAllocator();
    if (members.empty()) return text;
    JsonValue& with = document["with"];
    const auto member = with.FindMember(dice.pick(members).c_str());
    if (member == with.MemberEnd()) return text;
    if (member->value.IsString()) {
        static const std::vector<std::string> words{"", "x", "none", "1", "1,2,3", "nan", "a=b", "\xff", "${x}", "1e999"};
        member->value = json_string(dice.pick(words), a);
    } else {
        member->value = JsonValue(dice.pick(hostile_numbers()));
        if (dice.once_in(6)) member->value = json_string("1,2", a);
    }
    return to_compact_text(document);
}

Change replace_file(const std::string& file, bool may_lead_out, Dice& dice) {
    using What = Change::What;
    const std::string out = canaries_mark;
    std::vector<Change> all{{What::gone, file, {}},
                            {What::bytes, file, {}},
                            {What::folder, file, {}},
                            {What::link, file, "nowhere"},
                            {What::link, file, Path(file).filename().string()}};
    if (may_lead_out) {
        for (const char* to : {"/secret.txt", "/secret.ply", "/folder", "/made", "/program"})
            all.push_back({What::link, file, out + to});
        all.push_back({What::link, file, "/dev/zero"});
        all.push_back({What::pipe, file, {}});
    }
    return dice.pick(all);
}

}  // namespace ostraka::fuzz

// MeshLab's picked points (.pp), read and written with pugixml, which resolves no external entities.
#include "interchange/landmark_formats.h"
#include "interchange/text.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"

#include <fmt/core.h>
#include <pugixml.hpp>

#include <algorithm>

namespace ostraka::interchange {

namespace {

/// Replaces characters that XML 1.0 cannot represent, and other control characters, by U+FFFD.
std::string for_xml(const std::string& text, std::size_t& changed) {
    std::string result;
    bool replaced = false;
    for (std::size_t position = 0; position < text.size();) {
        const Character character = character_at(text, position);
        const bool blank = character.code == '\t' || character.code == '\n' || character.code == '\r';
        const bool forbidden = is_control(character.code) && !blank;
        result += forbidden ? "\xEF\xBF\xBD" : text.substr(position, character.length);
        replaced = replaced || forbidden;
        position += character.length;
    }
    // U+FFFE and U+FFFF are not allowed in XML either.
    for (const std::string_view noncharacter : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"})
        for (std::size_t position = result.find(noncharacter); position != std::string::npos;
             position = result.find(noncharacter, position)) {
            result.replace(position, 3, "\xEF\xBF\xBD");
            replaced = true;
        }
    changed += replaced ? 1 : 0;
    return result;
}

}  // namespace

LandmarkSet read_picked_points(const std::string& bytes, const std::string& where) {
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_buffer(bytes.data(), bytes.size());
    if (!parsed) {
        const auto end = bytes.begin() + std::clamp<std::ptrdiff_t>(parsed.offset, 0, static_cast<std::ptrdiff_t>(bytes.size()));
        fail_input(fmt::format("{}, line {}", where, 1 + std::count(bytes.begin(), end, '\n')),
                   std::string("not valid XML: ") + parsed.description(), "correct or regenerate the file");
    }
    const pugi::xml_node root = document.child("PickedPoints");
    if (!root) fail_input(where, "has no element PickedPoints", "give a file of MeshLab's tool 'Pick Points'");
    LandmarkSet set;
    std::size_t inactive = 0, number = 0;
    for (const pugi::xml_node point : root.children("point")) {
        const std::string location = fmt::format("{}, point {}", where, ++number);
        const std::string active = point.attribute("active").as_string("1");
        if (active == "0" || active == "false") {
            ++inactive;
            continue;
        }
        Landmark landmark;
        for (std::size_t k = 0; k < 3; ++k) {
            const char* name = std::array{"x", "y", "z"}[k];
            const auto value = number_of(point.attribute(name).as_string());
            if (!value) fail_input(location, fmt::format("the attribute {} is not a number", name), "give x, y and z");
            landmark.position[k] = *value;
        }
        check_position(landmark.position, location);
        landmark.name = as_utf8(point.attribute("name").as_string(std::to_string(number).c_str()));
        set.landmarks.push_back(std::move(landmark));
    }
    if (inactive > 0) set.notes.push_back(counted(inactive, "point") + " not picked yet, left out");
    return set;
}

std::string write_picked_points(const LandmarkSet& set, const std::string& mesh_file, Notes& notes) {
    pugi::xml_document document;
    document.append_child(pugi::node_doctype).set_value("PickedPoints");
    pugi::xml_node root = document.append_child("PickedPoints");
    std::size_t changed = 0;
    pugi::xml_node data = root.append_child("DocumentData");
    data.append_child("User").append_attribute("name") = "ostraka";
    data.append_child("DataFileName").append_attribute("name") =
        for_xml(as_utf8(Path(mesh_file).filename().string()), changed).c_str();
    data.append_child("templateName").append_attribute("name") = "";
    changed = 0;
    for (const Landmark& landmark : set.landmarks) {
        pugi::xml_node point = root.append_child("point");
        for (std::size_t k = 0; k < 3; ++k)
            point.append_attribute(std::array{"x", "y", "z"}[k]) = digits(landmark.position[k]).c_str();
        point.append_attribute("active") = "1";
        point.append_attribute("name") = for_xml(landmark.name, changed).c_str();
    }
    if (changed > 0) notes.push_back(counted(changed, "name") + " contained characters that XML cannot represent");
    struct Text : pugi::xml_writer {
        std::string text;
        void write(const void* part, std::size_t size) override { text.append(static_cast<const char*>(part), size); }
    } writer;
    document.save(writer, " ", pugi::format_indent | pugi::format_no_declaration, pugi::encoding_utf8);
    return std::move(writer.text);
}

}  // namespace ostraka::interchange

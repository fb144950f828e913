#include "io/ply_content.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/files/file.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka::io {

namespace {

/// A role that a name can mean; candidates of lower rank come first.
struct RoleOfName {
    Role role = Role::none;
    int rank = 0;
};

RoleOfName scalar_role(const std::string& name, bool is_vertex) {
    struct Entry {
        const char* name;
        RoleOfName meaning;
    };
    static constexpr Entry common[] = {{"red", {Role::red, 0}},
                                       {"green", {Role::green, 0}},
                                       {"blue", {Role::blue, 0}},
                                       {"alpha", {Role::alpha, 0}},
                                       {"diffuse_red", {Role::red, 0}},
                                       {"diffuse_green", {Role::green, 0}},
                                       {"diffuse_blue", {Role::blue, 0}},
                                       {"diffuse_alpha", {Role::alpha, 0}},
                                       {"r", {Role::red, 1}},
                                       {"g", {Role::green, 1}},
                                       {"b", {Role::blue, 1}},
                                       {"a", {Role::alpha, 1}}};
    static constexpr Entry vertex[] = {{"x", {Role::x, 0}},         {"y", {Role::y, 0}},         {"z", {Role::z, 0}},
                                       {"s", {Role::s, 0}},         {"t", {Role::t, 0}},         {"texture_s", {Role::s, 0}},
                                       {"texture_t", {Role::t, 0}}, {"texture_u", {Role::s, 0}}, {"texture_v", {Role::t, 0}},
                                       {"u", {Role::s, 1}},         {"v", {Role::t, 1}}};
    for (const Entry& entry : common)
        if (name == entry.name) return entry.meaning;
    if (is_vertex)
        for (const Entry& entry : vertex)
            if (name == entry.name) return entry.meaning;
    if (!is_vertex && name == "texnumber") return {Role::image, 0};
    return {};
}

RoleOfName role_of(const PlyProperty& property, bool is_vertex) {
    if (property.is_list) {
        if (is_vertex) return {};
        if (property.name == "vertex_indices" || property.name == "vertex_index") return {Role::corners, 0};
        return {property.name == "texcoord" ? Role::texture : Role::none, 0};
    }
    const std::string name = lower_case(property.name);
    if (const RoleOfName meaning = scalar_role(name, is_vertex); meaning.role != Role::none) return meaning;
    if (!is_real(property.type) && (name.find("label") != std::string::npos || name.starts_with("segment")))
        return {Role::label, 0};
    if (name == "nx" || name == "ny" || name == "nz") return {};
    return {Role::value, 0};
}

/// Converts numbers of one type to colour channels: real numbers up to 1 and wider whole numbers above 255 are scaled.
class ChannelScale {
public:
    explicit ChannelScale(PlyType type) : is_real_(is_real(type)) {}
    void see(float value) {
        if (std::isfinite(value)) largest_ = std::max(largest_, value);
    }
    /// True if the numbers are real and exceed 1 so far that they count to 255.
    [[nodiscard]] bool exceeds_unit() const { return is_real_ && largest_ >= 2; }
    std::uint8_t operator()(float value, std::size_t& out_of_range) const {
        if (is_real_ && largest_ < 2) return channel_from_unit(value, out_of_range);
        return channel_from_byte(largest_ > 255 && largest_ <= 65535 ? std::round(value / 257) : value, out_of_range);
    }

private:
    bool is_real_;
    float largest_ = 0;
};

std::vector<Colour> bytes_of(PlyColours&& colours, std::size_t& out_of_range, bool& exceed_unit) {
    if (colours.numbers.empty()) return std::move(colours.colours);
    // Channels of one type share their scale; alpha has its own.
    std::vector<ChannelScale> scales;
    std::array<std::size_t, 4> scale_of{};
    for (std::size_t k = 0; k < 4; ++k) {
        scale_of[k] = scales.size();
        for (std::size_t other = 0; other < k && k < 3; ++other)
            if (colours.types[other] == colours.types[k]) scale_of[k] = scale_of[other];
        if (scale_of[k] == scales.size()) scales.emplace_back(colours.types[k]);
    }
    const std::size_t channels = colours.has_alpha ? 4 : 3;
    for (const auto& numbers : colours.numbers)
        for (std::size_t k = 0; k < channels; ++k) scales[scale_of[k]].see(numbers[k]);
    std::vector<Colour> result(colours.numbers.size(), white);
    for (std::size_t i = 0; i < result.size(); ++i)
        for (std::size_t k = 0; k < channels; ++k) result[i][k] = scales[scale_of[k]](colours.numbers[i][k], out_of_range);
    for (const ChannelScale& scale : scales) exceed_unit = exceed_unit || scale.exceeds_unit();
    colours.numbers = {};
    return result;
}

/// Makes the texture coordinates of vertices those of their corners.
void spread_vertex_texture(PlyContent& content) {
    PolygonSoup& soup = content.soup;
    if (content.vertex_texture.empty()) return;
    if (!soup.extras.corner_texture.empty()) {
        soup.notes.emplace_back("texture coordinates of vertices are not kept, since the faces have their own");
    } else if (soup.corners.empty()) {
        soup.notes.emplace_back("texture coordinates that no face uses are not kept");
    } else {
        soup.extras.corner_texture.reserve(soup.corners.size());
        for (const Index v : soup.corners) soup.extras.corner_texture.push_back(content.vertex_texture[v]);
    }
    content.vertex_texture = {};
}

/// Makes a material of each texture file and assigns them to the faces.
void add_texture_files(PlyContent& content, const PlyHeader& header, const Path& file) {
    PolygonSoup& soup = content.soup;
    auto& [materials, images] = soup.extras.appearance;
    const std::string stem = file.stem().string();
    for (std::string name : header.texture_files) {
        for (std::size_t at = name.find("<this>"); at != std::string::npos; at = name.find("<this>")) name.replace(at, 6, stem);
        Material& material = materials.emplace_back();
        material.image = add_image(soup, file, name);
        material.name = Path(name).filename().string();
        if (images[material.image] == nullptr) material.mtl_rest.push_back("map_Kd " + name);
    }
    if (materials.empty()) {
        if (!content.image_of_face.empty()) soup.notes.emplace_back("image numbers of faces are not kept: no image is named");
        return;
    }
    std::size_t unknown = 0;
    soup.extras.face_materials.assign(soup.polygon_count(), 0);
    if (content.image_of_face.empty()) {
        if (materials.size() > 1)
            soup.notes.emplace_back("the faces do not say which of the images is theirs: all have the first one");
        return;
    }
    for (std::size_t i = 0; i < soup.polygon_count(); ++i) {
        const std::int32_t number = content.image_of_face[i];
        const bool exists = number >= 0 && static_cast<std::size_t>(number) < materials.size();
        unknown += !exists && number != -1;
        soup.extras.face_materials[i] = exists ? static_cast<Index>(number) : no_index;
    }
    if (unknown > 0) soup.notes.push_back(fmt::format("{} faces have an image that is not named and were given none", unknown));
}

template <class Value>
void drop_entries(std::vector<Value>& values, const std::vector<Index>& new_index) {
    if (values.empty()) return;
    std::size_t kept = 0;
    for (std::size_t v = 0; v < new_index.size(); ++v)
        if (new_index[v] != no_index) values[kept++] = values[v];
    values.resize(kept);
}

/// Drops the vertices without finite coordinates, which no face may use.
void drop_unplaced_vertices(PolygonSoup& soup, const std::vector<Index>& unplaced, const std::string& file) {
    if (unplaced.empty()) return;
    std::vector<Index> new_index(soup.points.size(), 0);
    for (const Index v : unplaced) new_index[v] = no_index;
    for (const Index v : soup.corners)
        if (new_index[v] == no_index)
            fail_input(file, fmt::format("vertex {} has a coordinate that is not finite, and faces use it", v),
                       "correct or remove the vertex");
    Index count = 0;
    for (Index& v : new_index)
        if (v != no_index) v = count++;
    for (Index& v : soup.corners) v = new_index[v];
    drop_entries(soup.points, new_index);
    drop_entries(soup.extras.vertex_colours, new_index);
    drop_entries(soup.extras.vertex_labels, new_index);
    for (NamedValues& column : soup.extras.vertex_values) drop_entries(column.values, new_index);
    soup.notes.push_back(
        fmt::format("{} vertices that no face uses have a coordinate that is not finite and were dropped", unplaced.size()));
    soup.vertex_of_file_vertex = std::move(new_index);
}

}  // namespace

PlyPlan::PlyPlan(const PlyElement& element, bool is_vertex) : roles(element.properties.size(), Role::none) {
    for (const int rank : {0, 1})
        for (std::size_t k = 0; k < roles.size(); ++k) {
            const RoleOfName meaning = role_of(element.properties[k], is_vertex);
            if (meaning.rank != rank || roles[k] != Role::none || meaning.role == Role::none) continue;
            const auto r = static_cast<std::size_t>(meaning.role);
            const bool is_taken = meaning.role != Role::value && has_[r];
            roles[k] = is_taken ? (element.properties[k].is_list ? Role::none : Role::value) : meaning.role;
            if (is_taken) continue;
            has_[r] = true;
            type[r] = element.properties[k].type;
        }
    // Channels of an incomplete colour and single texture coordinates are values.
    const bool is_coloured = coloured(), is_textured = with(Role::s) && with(Role::t);
    for (std::size_t k = 0; k < roles.size(); ++k) {
        if ((!is_coloured && roles[k] >= Role::red && roles[k] <= Role::alpha) ||
            (!is_textured && (roles[k] == Role::s || roles[k] == Role::t)))
            roles[k] = Role::value;
        if (roles[k] == Role::none) unused.push_back(element.properties[k].name);
    }
    if (!is_coloured) has_[static_cast<std::size_t>(Role::alpha)] = false;
}

PlyColours::PlyColours(const PlyPlan& plan, std::size_t count) : are_bytes(true), has_alpha(plan.with(Role::alpha)) {
    for (std::size_t k = 0; k < 4; ++k) {
        types[k] = k < 3 || has_alpha ? plan.type[static_cast<std::size_t>(Role::red) + k] : PlyType::uint8;
        are_bytes = are_bytes && types[k] == PlyType::uint8;
    }
    if (are_bytes) colours.reserve(count);
    else numbers.reserve(count);
}

void PlyColours::add(const std::array<double, role_count>& row) {
    const double* channels = &row[static_cast<std::size_t>(Role::red)];
    if (are_bytes) {
        Colour& colour = colours.emplace_back(white);
        for (std::size_t k = 0; k < (has_alpha ? 4 : 3); ++k)
            colour[k] = static_cast<std::uint8_t>(std::clamp(channels[k], 0.0, 255.0));
    } else {
        auto& channel_numbers = numbers.emplace_back();
        for (std::size_t k = 0; k < 4; ++k) channel_numbers[k] = static_cast<float>(channels[k]);
    }
}

PolygonSoup finish_ply(PlyContent&& content, const PlyHeader& header, const std::string& file) {
    PolygonSoup& soup = content.soup;
    std::size_t out_of_range = 0;
    bool exceed_unit = false;
    soup.extras.vertex_colours = bytes_of(std::move(content.vertex_colours), out_of_range, exceed_unit);
    soup.extras.face_colours = bytes_of(std::move(content.face_colours), out_of_range, exceed_unit);
    if (exceed_unit) soup.notes.emplace_back("colours exceed 1 and were read as 0 to 255");
    if (out_of_range > 0) soup.notes.push_back(std::to_string(out_of_range) + " colour values are out of range and were clamped");
    spread_vertex_texture(content);
    add_texture_files(content, header, file);
    drop_unplaced_vertices(soup, content.unplaced, file);
    if (content.bad_texture > 0)
        soup.notes.push_back(std::to_string(content.bad_texture) +
                             " texture coordinates are missing or not finite and were set to 0");
    return std::move(soup);
}

}  // namespace ostraka::io

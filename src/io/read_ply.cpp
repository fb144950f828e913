#include "io/formats.h"
#include "io/ply_rows.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/text.h"
#include "ostraka/io/ply.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka::io {

namespace {

enum class Role : std::uint8_t { none, x, y, z, red, green, blue, alpha, label, s, t, corners, texture, count };
constexpr std::size_t role_count = static_cast<std::size_t>(Role::count);

Role vertex_role(const PlyProperty& property) {
    if (property.is_list) return Role::none;
    const std::string& name = property.name;
    if (name == "x") return Role::x;
    if (name == "y") return Role::y;
    if (name == "z") return Role::z;
    if (name == "s" || name == "u" || name == "texture_u" || name == "texture_s") return Role::s;
    if (name == "t" || name == "v" || name == "texture_v" || name == "texture_t") return Role::t;
    return Role::none;
}

/// Roles that vertices and faces share.
Role common_role(const PlyProperty& property) {
    if (property.is_list) return Role::none;
    const std::string& name = property.name;
    if (name == "red" || name == "diffuse_red") return Role::red;
    if (name == "green" || name == "diffuse_green") return Role::green;
    if (name == "blue" || name == "diffuse_blue") return Role::blue;
    if (name == "alpha" || name == "diffuse_alpha") return Role::alpha;
    const std::string lower = lower_case(name);
    if (!is_real(property.type) && (lower.find("label") != std::string::npos || lower.starts_with("segment"))) return Role::label;
    return Role::none;
}

Role face_role(const PlyProperty& property) {
    if (!property.is_list) return Role::none;
    if (property.name == "vertex_indices" || property.name == "vertex_index") return Role::corners;
    if (property.name == "texcoord") return Role::texture;
    return Role::none;
}

/// Assigns roles to the properties of an element; if several properties could have a role, the first one gets it.
struct Plan {
    std::vector<Role> roles;
    std::array<PlyType, role_count> type{};
    std::array<bool, role_count> has{};
    std::vector<std::string> unused;

    template <class RoleOf>
    Plan(const PlyElement& element, RoleOf role_of) {
        for (const PlyProperty& property : element.properties) {
            Role role = role_of(property);
            if (role == Role::none) role = common_role(property);
            const auto r = static_cast<std::size_t>(role);
            if (has[r]) role = Role::none;
            if (role == Role::none) {
                unused.push_back(property.name);
            } else {
                has[r] = true;
                type[r] = property.type;
            }
            roles.push_back(role);
        }
    }
    [[nodiscard]] bool with(Role role) const { return has[static_cast<std::size_t>(role)]; }
    [[nodiscard]] bool coloured() const { return with(Role::red) && with(Role::green) && with(Role::blue); }
};

template <class Rows>
class PlyBody {
public:
    PlyBody(Rows rows, const PlyHeader& header, const std::string& file) : rows_(std::move(rows)), header_(header), file_(file) {
        if (const PlyElement* vertex = header.find("vertex")) vertex_count_ = vertex->count;
    }

    PolygonSoup read() {
        if (header_.find("vertex") == nullptr && (header_.find("face") != nullptr || header_.find("tristrips") != nullptr))
            fail_input(file_, "the header declares faces but no vertices", "export it again");
        if (header_.find("face") != nullptr && header_.find("tristrips") != nullptr)
            fail_input(file_, "the header declares both faces and triangle strips", "export it with one of the two");
        for (const PlyElement& element : header_.elements) {
            check_size(element);
            if (element.name == "vertex") vertices(element);
            else if (element.name == "face") faces(element);
            else if (element.name == "tristrips") strips(element);
            else skip_element(element);
        }
        if (!rows_.only_space_left()) soup_.notes.emplace_back("the data after the last element is ignored");
        if (header_.has_texture_file) soup_.notes.emplace_back("the name of the texture image is not kept");
        if (wrapped_ > 0) soup_.notes.push_back(std::to_string(wrapped_) + " labels above 2147483647 were made negative");
        if (out_of_range_ > 0)
            soup_.notes.push_back(std::to_string(out_of_range_) + " colour values are out of range and were clamped");
        if (bad_texture_ > 0)
            soup_.notes.push_back(std::to_string(bad_texture_) +
                                  " texture coordinates are missing or not finite and were set to 0");
        return std::move(soup_);
    }

    /// The floating-point properties of an element for which `wanted` is true, in the order of the file; empty if there is no
    /// such element.
    template <class Wanted>
    std::vector<PlyColumn> columns(std::string_view element_name, Wanted wanted) {
        std::vector<PlyColumn> result;
        for (const PlyElement& element : header_.elements) {
            check_size(element);
            if (element.name != element_name) {
                skip_element(element);
                continue;
            }
            constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
            std::vector<std::size_t> column_index(element.properties.size(), none);
            for (std::size_t k = 0; k < column_index.size(); ++k) {
                const PlyProperty& property = element.properties[k];
                if (property.is_list || !is_real(property.type) || !wanted(property.name)) continue;
                column_index[k] = result.size();
                result.push_back({property.name, {}});
            }
            if (result.empty()) break;
            for (PlyColumn& column : result) column.values.reserve(element.count);
            for (std::size_t i = 0; i < element.count; ++i) {
                rows_.begin(element, i);
                for (std::size_t k = 0; k < column_index.size(); ++k) {
                    if (column_index[k] != none)
                        result[column_index[k]].values.push_back(rows_.value(element.properties[k].type));
                    else skip_property(element.properties[k]);
                }
                rows_.end(element, i);
            }
            break;
        }
        return result;
    }

private:
    /// Ensures that the file is large enough for the counts in its header before memory is allocated.
    void check_size(const PlyElement& element) {
        const std::size_t minimum = element.min_bytes(header_.format);
        if (minimum > 0 && element.count > rows_.remaining() / minimum)
            rows_.fail(fmt::format("the header promises {} elements '{}' of at least {} bytes, but only {} bytes follow",
                                   element.count, element.name, minimum, rows_.remaining()),
                       "the file is cut off or its header is wrong");
    }

    std::size_t list_length(const PlyProperty& property) {
        const double length = rows_.value(property.count_type);
        if (!(length >= 0) || Rows::minimum(property.type, 1) * length > static_cast<double>(rows_.remaining()))
            rows_.fail(fmt::format("a list '{}' claims {} entries", property.name, static_cast<std::int64_t>(length)),
                       "the file is cut off or damaged");
        return static_cast<std::size_t>(length);
    }

    void skip_property(const PlyProperty& property) { rows_.skip(property.type, property.is_list ? list_length(property) : 1); }

    void skip_element(const PlyElement& element) {
        if (element.properties.empty()) return;
        for (std::size_t row = 0; row < element.count; ++row) {
            rows_.begin(element, row);
            for (const PlyProperty& property : element.properties) skip_property(property);
            rows_.end(element, row);
        }
        if (element.count > 0) soup_.notes.push_back("element not kept: " + element.name);
    }

    void note_unused(const PlyElement& element, const Plan& plan) {
        if (element.count == 0 || plan.unused.empty()) return;
        soup_.notes.push_back(fmt::format("{} properties not kept: {}", element.name, joined(plan.unused)));
    }

    Colour colour(const std::array<double, role_count>& row, const Plan& plan) {
        Colour result = white;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t role = static_cast<std::size_t>(Role::red) + k;
            if (!plan.has[role]) continue;
            const PlyType type = plan.type[role];
            if (is_real(type)) result[k] = channel_from_unit(row[role], out_of_range_);
            else result[k] = channel_from_byte(type == PlyType::uint16 ? std::round(row[role] / 257) : row[role], out_of_range_);
        }
        return result;
    }

    std::int32_t label(double value) {
        if (value > std::numeric_limits<std::int32_t>::max()) {
            ++wrapped_;
            value -= 4294967296.0;
        }
        if (!(value >= std::numeric_limits<std::int32_t>::min() && value <= std::numeric_limits<std::int32_t>::max()))
            rows_.fail("a label does not fit 32 bits", "renumber the labels");
        return static_cast<std::int32_t>(value);
    }

    void vertices(const PlyElement& element) {
        const Plan plan(element, vertex_role);
        if (element.count > 0 && !(plan.with(Role::x) && plan.with(Role::y) && plan.with(Role::z)))
            fail_input(file_, "the vertices lack one of the properties x, y and z", "export it again with coordinates");
        note_unused(element, plan);
        auto& extras = soup_.extras;
        const bool coloured = plan.coloured(), labelled = plan.with(Role::label),
                   textured = plan.with(Role::s) && plan.with(Role::t);
        soup_.points.reserve(element.count);
        if (coloured) extras.vertex_colours.reserve(element.count);
        if (labelled) extras.vertex_labels.reserve(element.count);
        if (textured) extras.vertex_texture.reserve(element.count);
        std::array<double, role_count> row{};
        const auto value_of = [&row](Role role) { return row[static_cast<std::size_t>(role)]; };
        for (std::size_t i = 0; i < element.count; ++i) {
            rows_.begin(element, i);
            for (std::size_t k = 0; k < plan.roles.size(); ++k) {
                if (plan.roles[k] == Role::none) skip_property(element.properties[k]);
                else row[static_cast<std::size_t>(plan.roles[k])] = rows_.value(element.properties[k].type);
            }
            if (!(std::isfinite(value_of(Role::x)) && std::isfinite(value_of(Role::y)) && std::isfinite(value_of(Role::z))))
                rows_.fail(fmt::format("vertex {} has a coordinate that is not finite", i), "correct or remove the vertex");
            rows_.end(element, i);
            soup_.points.push_back({value_of(Role::x), value_of(Role::y), value_of(Role::z)});
            if (coloured) extras.vertex_colours.push_back(colour(row, plan));
            if (labelled) extras.vertex_labels.push_back(label(value_of(Role::label)));
            if (textured) {
                extras.vertex_texture.push_back({static_cast<float>(value_of(Role::s)), static_cast<float>(value_of(Role::t))});
                for (float& x : extras.vertex_texture.back()) {
                    if (std::isfinite(x)) continue;
                    x = 0;
                    ++bad_texture_;
                }
            }
        }
    }

    Index corner(PlyType type, const std::string& element, std::size_t row) {
        const double index = rows_.value(type);
        if (!(index >= 0 && index < static_cast<double>(vertex_count_)))
            rows_.fail(fmt::format("{} {} names vertex {} of {}", element, row, static_cast<std::int64_t>(index), vertex_count_),
                       "correct or remove the " + element);
        return static_cast<Index>(index);
    }

    void faces(const PlyElement& element) {
        const Plan plan(element, face_role);
        if (element.count > 0 && !plan.with(Role::corners))
            fail_input(file_, "the faces have no list vertex_indices", "export it again with faces");
        if (plan.with(Role::corners) && is_real(plan.type[static_cast<std::size_t>(Role::corners)]))
            fail_input(file_, "the vertex indices of the faces are real numbers", "export it again");
        note_unused(element, plan);
        auto& extras = soup_.extras;
        const bool coloured = plan.coloured(), labelled = plan.with(Role::label), textured = plan.with(Role::texture);
        soup_.polygon_begin.reserve(element.count + 1);
        soup_.corners.reserve(std::min(3 * element.count, rows_.remaining()));
        if (coloured) extras.face_colours.reserve(element.count);
        if (labelled) extras.face_labels.reserve(element.count);
        std::array<double, role_count> row{};
        std::vector<float> texture;
        for (std::size_t i = 0; i < element.count; ++i) {
            rows_.begin(element, i);
            for (std::size_t k = 0; k < plan.roles.size(); ++k) {
                const PlyProperty& property = element.properties[k];
                if (plan.roles[k] == Role::none) {
                    skip_property(property);
                } else if (plan.roles[k] == Role::corners) {
                    for (std::size_t n = list_length(property); n > 0; --n)
                        soup_.corners.push_back(corner(property.type, "face", i));
                } else if (plan.roles[k] == Role::texture) {
                    texture.clear();
                    for (std::size_t n = list_length(property); n > 0; --n)
                        texture.push_back(static_cast<float>(rows_.value(property.type)));
                } else {
                    row[static_cast<std::size_t>(plan.roles[k])] = rows_.value(property.type);
                }
            }
            rows_.end(element, i);
            close_polygon(soup_, file_);
            if (coloured) extras.face_colours.push_back(colour(row, plan));
            if (labelled) extras.face_labels.push_back(label(row[static_cast<std::size_t>(Role::label)]));
            if (textured) add_texture(texture);
        }
    }

    void add_texture(const std::vector<float>& coordinates) {
        auto& texture = soup_.extras.corner_texture;
        const std::size_t count = soup_.corners.size() - texture.size();
        const bool usable = coordinates.size() == 2 * count &&
                            std::all_of(coordinates.begin(), coordinates.end(), [](float x) { return std::isfinite(x); });
        if (!usable) ++bad_texture_;
        for (std::size_t k = 0; k < count; ++k)
            texture.push_back(usable ? std::array<float, 2>{coordinates[2 * k], coordinates[2 * k + 1]}
                                     : std::array<float, 2>{0, 0});
    }

    /// Each strip is a sequence of vertices; every three consecutive ones form a triangle, every second triangle is reversed;
    /// -1 starts a new strip.
    void strips(const PlyElement& element) {
        const Plan plan(element, face_role);
        if (element.count > 0 && !plan.with(Role::corners))
            fail_input(file_, "the triangle strips have no list vertex_indices", "export it again with faces");
        note_unused(element, plan);
        for (std::size_t i = 0; i < element.count; ++i) {
            rows_.begin(element, i);
            for (std::size_t k = 0; k < plan.roles.size(); ++k) {
                const PlyProperty& property = element.properties[k];
                if (plan.roles[k] == Role::corners) strip(property, i);
                else skip_property(property);
            }
            rows_.end(element, i);
        }
    }

    void strip(const PlyProperty& property, std::size_t row) {
        std::size_t strip_length = 0;
        Index a = 0, b = 0;
        for (std::size_t n = list_length(property); n > 0; --n) {
            const double value = rows_.value(property.type);
            if (value == -1) {
                strip_length = 0;
                continue;
            }
            if (!(value >= 0 && value < static_cast<double>(vertex_count_)) || value != std::floor(value))
                rows_.fail(fmt::format("strip {} names vertex {} of {}", row, std::to_string(value), vertex_count_));
            const auto c = static_cast<Index>(value);
            if (strip_length >= 2 && a != b && b != c && c != a) {  // a repeated vertex only connects two strips
                for (const Index v : {strip_length % 2 == 0 ? a : b, strip_length % 2 == 0 ? b : a, c})
                    soup_.corners.push_back(v);
                close_polygon(soup_, file_);
            }
            a = b;
            b = c;
            ++strip_length;
        }
    }

    Rows rows_;
    const PlyHeader& header_;
    std::string file_;
    PolygonSoup soup_;
    std::size_t vertex_count_ = 0, wrapped_ = 0, out_of_range_ = 0, bad_texture_ = 0;
};

/// Calls read(body) for a file in any of the three encodings.
template <class Read>
auto read_body(const std::string& bytes, const std::string& file, Read&& read) {
    const PlyHeader header = read_ply_header(bytes, file);
    const auto read_rows = [&](auto rows) { return read(PlyBody(std::move(rows), header, file)); };
    constexpr bool little = std::endian::native == std::endian::little;
    if (header.format == PlyFormat::ascii) return read_rows(AsciiRows(bytes, header.size, file));
    if ((header.format == PlyFormat::little_endian) == little) return read_rows(BinaryRows<false>(bytes, header.size, file));
    return read_rows(BinaryRows<true>(bytes, header.size, file));
}

}  // namespace

bool looks_like_ply(std::string_view bytes) { return bytes.starts_with("ply\n") || bytes.starts_with("ply\r"); }

PolygonSoup read_ply(const std::string& bytes, const std::string& file) {
    return read_body(bytes, file, [](auto body) { return body.read(); });
}

}  // namespace ostraka::io

namespace ostraka {

std::vector<std::array<double, 3>> read_ply_vectors(const Path& file, const std::array<std::string, 3>& names) {
    const std::string bytes = read_file(file);
    if (!io::looks_like_ply(bytes)) return {};
    const auto wanted = [&](const std::string& name) { return std::find(names.begin(), names.end(), name) != names.end(); };
    const auto columns = io::read_body(bytes, file.string(), [&](auto body) { return body.columns("vertex", wanted); });
    std::array<const std::vector<double>*, 3> axes{};
    for (std::size_t k = 0; k < 3; ++k)
        for (const PlyColumn& column : columns)
            if (column.name == names[k]) axes[k] = &column.values;
    std::vector<std::array<double, 3>> result;
    if (axes[0] == nullptr || axes[1] == nullptr || axes[2] == nullptr) return result;
    for (std::size_t i = 0; i < axes[0]->size(); ++i) result.push_back({(*axes[0])[i], (*axes[1])[i], (*axes[2])[i]});
    return result;
}

PlyNumbers read_ply_numbers(const Path& file) {
    const std::string bytes = read_file(file);
    if (!io::looks_like_ply(bytes)) return {};
    const auto numbers_of = [&](const char* element) {
        const auto wanted = [](const std::string& name) {
            const std::initializer_list<const char*> standard_names{"x",     "y",    "z",     "nx", "ny", "nz", "red",
                                                                    "green", "blue", "alpha", "s",  "t",  "u",  "v"};
            return std::find(standard_names.begin(), standard_names.end(), name) == standard_names.end() &&
                   !name.starts_with("texture_") && !name.starts_with("diffuse_");
        };
        return io::read_body(bytes, file.string(), [&](auto body) { return body.columns(element, wanted); });
    };
    return {numbers_of("vertex"), numbers_of("face")};
}

}  // namespace ostraka

#include "io/ply_content.h"
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

template <class Rows>
class PlyBody {
public:
    PlyBody(Rows rows, const PlyHeader& header, const std::string& file) : rows_(std::move(rows)), header_(header), file_(file) {
        if (const PlyElement* vertex = header.find("vertex")) vertex_count_ = vertex->count;
    }

    PlyBody(const PlyBody&) = delete;
    PlyBody& operator=(const PlyBody&) = delete;

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
        if (wrapped_ > 0) soup_.notes.push_back(std::to_string(wrapped_) + " labels above 2147483647 were made negative");
        return finish_ply(std::move(content_), header_, file_);
    }

    /// The floating-point properties of an element for which `wanted` is true, in the order of the file; empty if there is no
    /// such element.
    template <class Wanted>
    std::vector<NamedValues> columns(std::string_view element_name, Wanted wanted) {
        std::vector<NamedValues> result;
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
            for (NamedValues& column : result) column.values.reserve(element.count);
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

    void note_unused(const PlyElement& element, const PlyPlan& plan) {
        if (element.count == 0 || plan.unused.empty()) return;
        soup_.notes.push_back(fmt::format("{} properties not kept: {}", element.name, joined(plan.unused)));
    }

    /// Lists for the values of an element, in the order of its properties.
    static void add_value_lists(const PlyElement& element, const PlyPlan& plan, std::vector<NamedValues>& lists) {
        for (std::size_t k = 0; k < plan.roles.size(); ++k) {
            if (plan.roles[k] != Role::value) continue;
            lists.push_back({element.properties[k].name, {}});
            lists.back().values.reserve(element.count);
        }
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
        const PlyPlan plan(element, true);
        if (element.count > 0 && !(plan.with(Role::x) && plan.with(Role::y) && plan.with(Role::z)))
            fail_input(file_, "the vertices lack one of the properties x, y and z", "export it again with coordinates");
        note_unused(element, plan);
        auto& extras = soup_.extras;
        const bool coloured = plan.coloured(), labelled = plan.with(Role::label),
                   textured = plan.with(Role::s) && plan.with(Role::t);
        soup_.points.reserve(element.count);
        if (coloured) content_.vertex_colours = PlyColours(plan, element.count);
        if (labelled) extras.vertex_labels.reserve(element.count);
        if (textured) content_.vertex_texture.reserve(element.count);
        add_value_lists(element, plan, extras.vertex_values);
        std::array<double, role_count> row{};
        const auto value_of = [&row](Role role) { return row[static_cast<std::size_t>(role)]; };
        for (std::size_t i = 0; i < element.count; ++i) {
            rows_.begin(element, i);
            std::size_t list = 0;
            for (std::size_t k = 0; k < plan.roles.size(); ++k) {
                const PlyProperty& property = element.properties[k];
                if (plan.roles[k] == Role::none) skip_property(property);
                else if (plan.roles[k] == Role::value) extras.vertex_values[list++].values.push_back(rows_.value(property.type));
                else row[static_cast<std::size_t>(plan.roles[k])] = rows_.value(property.type);
            }
            rows_.end(element, i);
            soup_.points.push_back({value_of(Role::x), value_of(Role::y), value_of(Role::z)});
            if (!is_finite(soup_.points.back())) content_.unplaced.push_back(static_cast<Index>(i));
            if (coloured) content_.vertex_colours.add(row);
            if (labelled) extras.vertex_labels.push_back(label(value_of(Role::label)));
            if (textured) content_.vertex_texture.push_back(texture_point(value_of(Role::s), value_of(Role::t)));
        }
    }

    static bool is_finite(const std::array<double, 3>& point) {
        return std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]);
    }

    TexturePoint texture_point(double s, double t) {
        TexturePoint point{static_cast<float>(s), static_cast<float>(t)};
        for (float& x : point) {
            if (std::isfinite(x)) continue;
            x = 0;
            ++content_.bad_texture;
        }
        return point;
    }

    Index corner(PlyType type, const std::string& element, std::size_t row) {
        const double index = rows_.value(type);
        if (!(index >= 0 && index < static_cast<double>(vertex_count_)))
            rows_.fail(fmt::format("{} {} names vertex {} of {}", element, row, static_cast<std::int64_t>(index), vertex_count_),
                       "correct or remove the " + element);
        return static_cast<Index>(index);
    }

    void faces(const PlyElement& element) {
        const PlyPlan plan(element, false);
        if (element.count > 0 && !plan.with(Role::corners))
            fail_input(file_, "the faces have no list vertex_indices", "export it again with faces");
        if (plan.with(Role::corners) && is_real(plan.type[static_cast<std::size_t>(Role::corners)]))
            fail_input(file_, "the vertex indices of the faces are real numbers", "export it again");
        note_unused(element, plan);
        auto& extras = soup_.extras;
        const bool coloured = plan.coloured(), labelled = plan.with(Role::label), textured = plan.with(Role::texture),
                   numbered = plan.with(Role::image);
        soup_.polygon_begin.reserve(element.count + 1);
        soup_.corners.reserve(std::min(3 * element.count, rows_.remaining()));
        if (coloured) content_.face_colours = PlyColours(plan, element.count);
        if (labelled) extras.face_labels.reserve(element.count);
        if (numbered) content_.image_of_face.reserve(element.count);
        add_value_lists(element, plan, extras.face_values);
        std::array<double, role_count> row{};
        std::vector<float> texture;
        for (std::size_t i = 0; i < element.count; ++i) {
            rows_.begin(element, i);
            face_properties(element, plan, i, row, texture);
            rows_.end(element, i);
            close_polygon(soup_, file_);
            if (coloured) content_.face_colours.add(row);
            if (labelled) extras.face_labels.push_back(label(row[static_cast<std::size_t>(Role::label)]));
            if (numbered) content_.image_of_face.push_back(image_number(row[static_cast<std::size_t>(Role::image)]));
            if (textured) add_texture(texture);
        }
    }

    void face_properties(const PlyElement& element, const PlyPlan& plan, std::size_t face, std::array<double, role_count>& row,
                         std::vector<float>& texture) {
        std::size_t list = 0;
        for (std::size_t k = 0; k < plan.roles.size(); ++k) {
            const PlyProperty& property = element.properties[k];
            if (plan.roles[k] == Role::none) {
                skip_property(property);
            } else if (plan.roles[k] == Role::value) {
                soup_.extras.face_values[list++].values.push_back(rows_.value(property.type));
            } else if (plan.roles[k] == Role::corners) {
                for (std::size_t n = list_length(property); n > 0; --n)
                    soup_.corners.push_back(corner(property.type, "face", face));
            } else if (plan.roles[k] == Role::texture) {
                texture.clear();
                for (std::size_t n = list_length(property); n > 0; --n)
                    texture.push_back(static_cast<float>(rows_.value(property.type)));
            } else {
                row[static_cast<std::size_t>(plan.roles[k])] = rows_.value(property.type);
            }
        }
    }

    /// -1 (no image) for numbers that no image can have.
    static std::int32_t image_number(double number) {
        return number >= 0 && number <= std::numeric_limits<std::int32_t>::max() ? static_cast<std::int32_t>(number) : -1;
    }

    void add_texture(const std::vector<float>& coordinates) {
        auto& texture = soup_.extras.corner_texture;
        const std::size_t count = soup_.corners.size() - texture.size();
        const bool usable = coordinates.size() == 2 * count &&
                            std::all_of(coordinates.begin(), coordinates.end(), [](float x) { return std::isfinite(x); });
        if (!usable) ++content_.bad_texture;
        for (std::size_t k = 0; k < count; ++k)
            texture.push_back(usable ? TexturePoint{coordinates[2 * k], coordinates[2 * k + 1]} : TexturePoint{0, 0});
    }

    /// Each strip is a sequence of vertices; every three consecutive ones form a triangle, every second triangle is reversed;
    /// -1 starts a new strip.
    void strips(const PlyElement& element) {
        const PlyPlan plan(element, false);
        if (element.count > 0 && !plan.with(Role::corners))
            fail_input(file_, "the triangle strips have no list vertex_indices", "export it again with faces");
        std::vector<std::string> not_kept;
        for (std::size_t k = 0; k < plan.roles.size(); ++k)
            if (plan.roles[k] != Role::corners) not_kept.push_back(element.properties[k].name);
        if (element.count > 0 && !not_kept.empty())
            soup_.notes.push_back("properties of triangle strips not kept: " + joined(not_kept));
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
    PlyContent content_;
    PolygonSoup& soup_ = content_.soup;
    std::size_t vertex_count_ = 0, wrapped_ = 0;
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

bool looks_like_ply(std::string_view bytes) {
    bytes = without_byte_order_mark(bytes);
    return bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
}

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
        for (const NamedValues& column : columns)
            if (column.name == names[k]) axes[k] = &column.values;
    std::vector<std::array<double, 3>> result;
    if (axes[0] == nullptr || axes[1] == nullptr || axes[2] == nullptr) return result;
    for (std::size_t i = 0; i < axes[0]->size(); ++i) result.push_back({(*axes[0])[i], (*axes[1])[i], (*axes[2])[i]});
    return result;
}

}  // namespace ostraka

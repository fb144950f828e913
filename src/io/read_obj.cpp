#include "io/materials.h"
#include "io/text_reader.h"
#include "ostraka/core/message_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka::io {

namespace {

/// Statements of the format that do not concern the data we keep; any other word is an error, since a damaged keyword would
/// silently shift all later indices.
const std::set<std::string_view> ignored_statements{
    "vp",       "l",    "p",          "g",         "o",     "s",      "mg",   "maplib", "usemap", "bevel", "c_interp",
    "d_interp", "lod",  "shadow_obj", "trace_obj", "ctech", "stech",  "curv", "curv2",  "surf",   "parm",  "trim",
    "hole",     "scrv", "sp",         "end",       "con",   "cstype", "deg",  "bmat",   "step"};

/// "\" before a line end continues the line: both are replaced by blanks, the line end by one that still counts as a line.
void join_continued_lines(std::string& text) {
    for (std::size_t i = text.find('\\'); i != std::string::npos; i = text.find('\\', i + 1)) {
        std::size_t end = i + 1;
        while (end < text.size() && (text[end] == '\r' || text[end] == ' ' || text[end] == '\t')) ++end;
        if (end < text.size() && text[end] == '\n') {
            text[i] = ' ';
            text[end] = '\v';
        }
    }
}

class ObjReader {
public:
    ObjReader(std::string_view text, const std::string& file) : reader_(text, file, '#') {}

    PolygonSoup read() {
        while (reader_.next_line()) statement();
        check_forward_references();
        finish_colours();
        finish_appearance();
        if (has_normals_) ignored_.insert("vn");
        if (!ignored_.empty()) soup_.notes.push_back("statements not kept: " + joined(ignored_));
        if (weights_ > 0) soup_.notes.push_back(std::to_string(weights_) + " vertices have a weight, which is not kept");
        if (bad_alphas_ > 0)
            soup_.notes.push_back(std::to_string(bad_alphas_) +
                                  " vertices have an opacity that is not a number; they are opaque");
        if (last_face_may_be_cut_)
            soup_.notes.emplace_back("the last face has no line end: the file may be cut off in its last face");
        return std::move(soup_);
    }

private:
    /// The faces that follow a statement usemtl.
    struct MaterialRun {
        std::size_t first_face;
        std::string_view name;
    };

    void statement() {
        const char* line = reader_.position();
        const std::string_view keyword = reader_.word();
        if (keyword == "v") vertex();
        else if (keyword == "f" || keyword == "fo") face();
        else if (keyword == "vt") texture();
        else if (keyword == "vn") has_normals_ = true;
        else if (keyword == "usemtl") use_material();
        else if (keyword == "mtllib") libraries_.push_back(raw_line());
        else if (ignored_statements.contains(keyword)) ignored_.insert(keyword);
        else
            reader_.fail("unknown statement " + in_quotes(keyword), "correct the line, or start it with # to have it skipped",
                         line);
    }

    /// The remaining text of the line, with comments, since names of files and materials may contain #.
    [[nodiscard]] std::string_view raw_line() const {
        const std::string_view text(reader_.position(), reader_.remaining());
        return text.substr(0, std::min(text.find('\n'), text.size()));
    }

    void use_material() {
        const std::size_t face_count = soup_.polygon_count();
        if (!runs_.empty() && runs_.back().first_face == face_count) runs_.pop_back();
        runs_.push_back({face_count, raw_line()});
    }

    void vertex() {
        std::array<double, 3> point{};
        for (double& x : point) x = reader_.finite("a coordinate");
        soup_.points.push_back(point);
        if (reader_.line_done()) return;
        const char* first = reader_.position();
        std::array<float, 4> extra_values{0, 0, 0, 1};
        std::size_t count = 0;
        while (!reader_.line_done()) {
            if (count == 4) reader_.fail("a vertex has more than seven numbers", {}, first);
            extra_values[count] = count < 3 ? static_cast<float>(reader_.number("a colour or weight")) : opacity();
            ++count;
        }
        if (count == 1) {
            if (extra_values[0] != 1) ++weights_;
            return;
        }
        if (count == 2) reader_.fail("a vertex has five numbers", "write x y z, x y z w, or x y z red green blue", first);
        colours_.resize(soup_.points.size(), {-1, -1, -1, -1});
        if (count == 3) extra_values[3] = -1;
        colours_.back() = extra_values;
    }

    float opacity() {
        const auto value = number_of(reader_.word());
        if (!value) ++bad_alphas_;
        return value ? static_cast<float>(*value) : -1;
    }

    void texture() {
        std::array<float, 2> uv{};
        const char* first = reader_.position();
        uv[0] = static_cast<float>(reader_.finite("a texture coordinate"));
        if (!reader_.line_done()) uv[1] = static_cast<float>(reader_.finite("a texture coordinate"));
        if (!std::isfinite(uv[0]) || !std::isfinite(uv[1])) reader_.fail("a texture coordinate does not fit a float", {}, first);
        texture_.push_back(uv);
    }

    /// Converts an index from 1, or from -1 backwards, to an index from 0.
    Index resolve(std::int64_t value, std::size_t count, const char* element, const char* position, std::int64_t& largest,
                  const char*& largest_position) {
        const std::int64_t index = value > 0 ? value - 1 : static_cast<std::int64_t>(count) + value;
        if (value == 0 || index < 0 || index >= static_cast<std::int64_t>(no_index))
            reader_.fail(fmt::format("a face names {} {} of {}", element, value, count), "indices start at 1", position);
        if (index > largest) {
            largest = index;
            largest_position = position;
        }
        return static_cast<Index>(index);
    }

    void face() {
        while (!reader_.line_done()) {
            const char* start = reader_.position();
            soup_.corners.push_back(
                resolve(reader_.integer_part("a vertex index"), soup_.points.size(), "vertex", start, largest_, largest_at_));
            Index uv = no_index;
            if (reader_.take('/')) {
                if (reader_.at_integer())
                    uv = resolve(reader_.integer_part("a texture index"), texture_.size(), "texture coordinate", start,
                                 largest_uv_, largest_uv_at_);
                if (reader_.take('/') && reader_.at_integer()) reader_.integer_part("a normal index");
            }
            if (!reader_.at_word_end()) {
                reader_.set_position(start);
                reader_.fail(fmt::format("face corner {} is not of the form 1, 1/1, 1//1 or 1/1/1", in_quotes(reader_.word())),
                             {}, start);
            }
            if (uv != no_index) {
                if (corner_uv_.size() + 1 != soup_.corners.size()) corner_uv_.resize(soup_.corners.size() - 1, no_index);
                corner_uv_.push_back(uv);
            }
        }
        last_face_may_be_cut_ = reader_.remaining() == 0;
        close_polygon(soup_, reader_.file());
    }

    /// Faces may refer to later vertices, so the largest index is checked at the end.
    void check_forward_references() {
        if (largest_ >= static_cast<std::int64_t>(soup_.points.size()))
            reader_.fail(fmt::format("a face names vertex {} of {}", largest_ + 1, soup_.points.size()),
                         "the file may be cut off or damaged", largest_at_);
        if (largest_uv_ >= static_cast<std::int64_t>(texture_.size()))
            reader_.fail(fmt::format("a face names texture coordinate {} of {}", largest_uv_ + 1, texture_.size()),
                         "the file may be cut off or damaged", largest_uv_at_);
    }

    void finish_colours() {
        if (colours_.empty()) return;
        colours_.resize(soup_.points.size(), {-1, -1, -1, -1});
        float largest = 0;
        for (const auto& c : colours_)
            for (const float x : c)
                if (std::isfinite(x)) largest = std::max(largest, x);
        const bool byte_range = largest > 1;
        if (byte_range) soup_.notes.emplace_back("vertex colours exceed 1 and were read as 0 to 255");
        std::size_t missing = 0, out_of_range = 0;
        soup_.extras.vertex_colours.assign(soup_.points.size(), white);
        for (std::size_t v = 0; v < colours_.size(); ++v) {
            if (colours_[v][0] == -1 && colours_[v][1] == -1) {
                ++missing;
                continue;
            }
            for (std::size_t k = 0; k < 4; ++k) {
                if (k == 3 && colours_[v][3] == -1) continue;
                soup_.extras.vertex_colours[v][k] = byte_range ? channel_from_byte(colours_[v][k], out_of_range)
                                                               : channel_from_unit(colours_[v][k], out_of_range);
            }
        }
        if (missing > 0) soup_.notes.push_back(std::to_string(missing) + " vertices have no colour and were made white");
        if (out_of_range > 0)
            soup_.notes.push_back(std::to_string(out_of_range) + " colour values are out of range and were clamped");
    }

    void finish_appearance() {
        const Materials materials =
            libraries_.empty() && runs_.empty() ? Materials() : read_materials(soup_, reader_.file(), libraries_, !runs_.empty());
        finish_texture();
        if (runs_.empty()) {
            if (materials.index.size() != 1 || soup_.extras.corner_texture.empty()) return;
            runs_.push_back({0, materials.index.begin()->first});
            soup_.notes.emplace_back("no face names a material: the only one is that of all faces");
        }
        std::set<std::string> unknown;
        soup_.extras.face_materials.assign(materials.index.empty() ? 0 : soup_.polygon_count(), no_index);
        for (std::size_t r = 0; r < runs_.size(); ++r) {
            const std::size_t end = r + 1 < runs_.size() ? runs_[r + 1].first_face : soup_.polygon_count();
            const auto entry = materials.index.find(name_on_line(runs_[r].name));
            if (entry == materials.index.end()) {
                const std::string_view name = name_on_line(runs_[r].name);
                if (end > runs_[r].first_face && !name.empty() && name != "(null)" && unknown.size() <= max_named)
                    unknown.insert(printable(std::string(name), 100));
                continue;
            }
            std::fill(soup_.extras.face_materials.begin() + static_cast<std::ptrdiff_t>(runs_[r].first_face),
                      soup_.extras.face_materials.begin() + static_cast<std::ptrdiff_t>(end), entry->second);
            shift_texture(runs_[r].first_face, end, materials.shifts[entry->second]);
        }
        if (unknown.empty()) return;
        const bool are_more = unknown.size() > max_named;
        if (are_more) unknown.erase(std::prev(unknown.end()));
        soup_.notes.push_back(fmt::format("materials that no MTL file describes are not kept: {}{}", joined(unknown),
                                          are_more ? " and others" : ""));
    }

    void finish_texture() {
        if (corner_uv_.empty()) {
            if (!texture_.empty()) soup_.notes.emplace_back("texture coordinates that no face uses are not kept");
            return;
        }
        corner_uv_.resize(soup_.corners.size(), no_index);
        std::size_t missing = 0;
        soup_.extras.corner_texture.reserve(corner_uv_.size());
        for (const Index uv : corner_uv_) {
            missing += uv == no_index;
            soup_.extras.corner_texture.push_back(uv == no_index ? TexturePoint{0, 0} : texture_[uv]);
        }
        if (missing > 0)
            soup_.notes.push_back(std::to_string(missing) + " face corners have no texture coordinates and were given (0, 0)");
    }

    void shift_texture(std::size_t first_face, std::size_t end, const TextureShift& shift) {
        if (shift.is_identity() || soup_.extras.corner_texture.empty()) return;
        for (std::size_t c = soup_.polygon_begin[first_face]; c < soup_.polygon_begin[end]; ++c) {
            if (corner_uv_[c] == no_index) continue;
            TexturePoint& point = soup_.extras.corner_texture[c];
            point = shift(point);
            for (float& x : point)
                if (!std::isfinite(x)) x = 0;
        }
    }

    static constexpr std::size_t max_named = 20;
    TextReader reader_;
    PolygonSoup soup_;
    std::vector<std::array<float, 4>> colours_;  ///< -1 if the file gives no colour
    std::vector<TexturePoint> texture_;
    std::vector<Index> corner_uv_;
    std::vector<std::string_view> libraries_;
    std::vector<MaterialRun> runs_;
    std::int64_t largest_ = -1, largest_uv_ = -1;
    const char* largest_at_ = nullptr;
    const char* largest_uv_at_ = nullptr;
    std::set<std::string_view> ignored_;
    std::size_t weights_ = 0, bad_alphas_ = 0;
    bool has_normals_ = false, last_face_may_be_cut_ = false;
};

}  // namespace

PolygonSoup read_obj(std::string& bytes, const std::string& file) {
    normalise_text(bytes);
    join_continued_lines(bytes);
    return ObjReader(bytes, file).read();
}

}  // namespace ostraka::io

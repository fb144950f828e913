#include "io/formats.h"
#include "io/text_reader.h"
#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace ostraka::io {

namespace {

/// Prefixes of "OFF" in the first word: texture coordinates, colours, normals of the vertices. The number of vertices may
/// follow without a blank.
struct Header {
    bool texture = false, colours = false, normals = false;
    std::size_t length = 0;  ///< of the keyword
};

std::optional<Header> parse_header(std::string_view word) {
    Header header;
    const std::size_t full_length = word.size();
    const auto take = [&word](std::string_view prefix) {
        if (!word.starts_with(prefix)) return false;
        word.remove_prefix(prefix.size());
        return true;
    };
    header.texture = take("ST");
    header.colours = take("C");
    header.normals = take("N");
    if (!take("OFF") && !take("off")) return std::nullopt;
    if (word.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
    header.length = full_length - word.size();
    return header;
}

class OffReader {
public:
    OffReader(std::string_view text, const std::string& file) : reader_(text, file, '#') {}

    PolygonSoup read() {
        read_header();
        soup_.points.reserve(vertices_);
        soup_.polygon_begin.reserve(faces_ + 1);
        soup_.corners.reserve(std::min(3 * faces_, reader_.remaining() / 2));
        for (std::size_t v = 0; v < vertices_; ++v) vertex(v);
        for (std::size_t f = 0; f < faces_; ++f) face(f);
        if (!soup_.extras.face_colours.empty()) soup_.extras.face_colours.resize(faces_, white);
        if (header_.texture) {
            soup_.extras.corner_texture.reserve(soup_.corners.size());
            for (const Index v : soup_.corners) soup_.extras.corner_texture.push_back(texture_[v]);
        }
        if (header_.normals) soup_.notes.emplace_back("vertex normals are not kept");
        if (palette_ > 0) soup_.notes.push_back(std::to_string(palette_) + " faces refer to a palette colour, which is not kept");
        if (uncoloured_ > 0 && uncoloured_ < faces_)
            soup_.notes.push_back(std::to_string(uncoloured_) + " faces have no colour and were made white");
        if (out_of_range_ > 0)
            soup_.notes.push_back(std::to_string(out_of_range_) + " colour values are out of range and were clamped");
        if (reader_.skip_space()) soup_.notes.emplace_back("the data after the last face is ignored");
        return std::move(soup_);
    }

private:
    void read_header() {
        if (!reader_.skip_space()) fail_input(reader_.file(), "is empty", "export it again");
        const char* first = reader_.position();
        const std::string_view word = reader_.word();
        if (const auto header = parse_header(word)) {
            header_ = *header;
            reader_.set_position(first + header_.length);
            if (reader_.skip_space() && reader_.position()[0] == 'B')
                reader_.fail("binary OFF is not supported", "convert it to text OFF or PLY");
        } else if (!word.empty() && word.front() >= '0' && word.front() <= '9') {
            reader_.set_position(first);  // the keyword is optional
        } else {
            reader_.fail("does not start with OFF, COFF, NOFF or STOFF but with " + in_quotes(word),
                         "check that this is an OFF file", first);
        }
        vertices_ = count("the number of vertices");
        faces_ = count("the number of faces");
        if (!reader_.line_done()) reader_.integer("the number of edges");
        // A vertex has at least six characters, a face two.
        if (vertices_ > reader_.remaining() / 6 + 1 || faces_ > reader_.remaining() / 2 + 1)
            reader_.fail(fmt::format("the header promises {} vertices and {} faces, but only {} bytes follow", vertices_, faces_,
                                     reader_.remaining()),
                         "the file is cut off or its header is wrong");
        find_undeclared_colours();
    }

    std::size_t count(const char* quantity) {
        if (!reader_.skip_space())
            reader_.fail(fmt::format("the file ends where {} is expected", quantity), "the file is cut off");
        const std::int64_t value = reader_.integer(quantity);
        if (value < 0) reader_.fail(std::string(quantity) + " is negative");
        return static_cast<std::size_t>(value);
    }

    /// Some programs write vertex colours without declaring them in the header: six or seven numbers on the first vertex line,
    /// and one line per element.
    void find_undeclared_colours() {
        if (header_.colours || header_.normals || header_.texture || vertices_ == 0 || !reader_.skip_space()) return;
        const char* first = reader_.position();
        std::size_t numbers = 0, lines = 1;
        while (!reader_.line_done() && numbers < 8) {
            reader_.word();
            ++numbers;
        }
        if (numbers == 6 || numbers == 7) {
            while (lines < vertices_ + faces_ && reader_.next_line()) ++lines;
            if (lines == vertices_ + faces_) {
                header_.colours = true;
                soup_.notes.emplace_back(
                    "vertices have further numbers that the header does not declare; they were read as colours");
            }
        }
        reader_.set_position(first);
    }

    void vertex(std::size_t v) {
        if (!reader_.skip_space())
            reader_.fail(fmt::format("the file ends at vertex {} of {}", v, vertices_), "the file is cut off");
        std::array<double, 3> point{};
        for (double& x : point) x = coordinate("a coordinate");
        soup_.points.push_back(point);
        if (header_.normals)
            for (int k = 0; k < 3; ++k) {
                reader_.skip_space();
                reader_.number("a normal");
            }
        if (header_.colours) soup_.extras.vertex_colours.push_back(colour(header_.texture ? 2 : 0).value_or(white));
        if (header_.texture) {
            const auto s = static_cast<float>(coordinate("a texture coordinate"));
            const auto t = static_cast<float>(coordinate("a texture coordinate"));
            if (!std::isfinite(s) || !std::isfinite(t)) reader_.fail("a texture coordinate does not fit a float");
            texture_.push_back({s, t});
        }
    }

    double coordinate(const char* quantity) {
        reader_.skip_space();
        return reader_.finite(quantity);
    }

    /// The colour in the remaining words of the line, of which the last `after` belong to other data. Integers range from 0 to
    /// 255, other numbers from 0 to 1.
    std::optional<Colour> colour(std::size_t reserved_words) {
        std::array<double, 6> values{};
        const char* first = reader_.position();
        std::size_t words = 0;
        bool real = false;
        const char* before_last[3] = {first, first, first};
        while (words < 4 + reserved_words && !reader_.line_done()) {
            before_last[words % 3] = reader_.position();
            const char* start = reader_.position();
            values[words++] = reader_.number("a colour");
            if (words <= 4)
                for (const char* c = start; c != reader_.position(); ++c)
                    real = real || *c == '.' || *c == 'e' || *c == 'n' || *c == 'N';
        }
        if (words < reserved_words) reader_.fail("the line ends where texture coordinates are expected");
        const std::size_t channels = words - reserved_words;
        if (reserved_words > 0) reader_.set_position(before_last[channels % 3]);
        if (channels == 0) return std::nullopt;
        if (channels == 1) {
            ++palette_;
            return std::nullopt;
        }
        if (channels == 2) reader_.fail("a colour has two numbers", "write red, green, blue and perhaps alpha", first);
        Colour result = white;
        for (std::size_t k = 0; k < channels; ++k)
            result[k] = real ? channel_from_unit(values[k], out_of_range_) : channel_from_byte(values[k], out_of_range_);
        return result;
    }

    void face(std::size_t f) {
        if (!reader_.skip_space()) reader_.fail(fmt::format("the file ends at face {} of {}", f, faces_), "the file is cut off");
        const char* first = reader_.position();
        const std::int64_t size = reader_.integer("a number of corners");
        if (size < 0 || static_cast<std::size_t>(size) > reader_.remaining() / 2 + 1)
            reader_.fail(fmt::format("face {} promises {} corners", f, size), "the file is cut off or damaged", first);
        for (std::int64_t k = 0; k < size; ++k) {
            if (!reader_.skip_space()) reader_.fail("the file ends inside face " + std::to_string(f), "the file is cut off");
            const char* position = reader_.position();
            const std::int64_t index = reader_.integer("a vertex index");
            if (index < 0 || static_cast<std::size_t>(index) >= vertices_)
                reader_.fail(fmt::format("face {} names vertex {} of {}", f, index, vertices_),
                             "indices start at 0; correct or remove the face", position);
            soup_.corners.push_back(static_cast<Index>(index));
        }
        close_polygon(soup_, reader_.file());
        if (reader_.line_done()) {
            ++uncoloured_;
            return;
        }
        const auto face_colour = colour(0);
        if (!reader_.line_done())
            reader_.fail(fmt::format("face {} is followed by more than a colour", f), "put each face on its own line");
        if (!face_colour) return;
        soup_.extras.face_colours.resize(f + 1, white);
        soup_.extras.face_colours.back() = *face_colour;
    }

    TextReader reader_;
    PolygonSoup soup_;
    Header header_;
    std::vector<TexturePoint> texture_;  ///< texture coordinates of the vertices
    std::size_t vertices_ = 0, faces_ = 0, palette_ = 0, uncoloured_ = 0, out_of_range_ = 0;
};

}  // namespace

bool looks_like_off(std::string_view bytes) {
    TextReader reader(without_byte_order_mark(bytes).substr(0, 4096), {}, '#');
    return reader.skip_space() && parse_header(reader.word()).has_value();
}

PolygonSoup read_off(std::string& bytes, const std::string& file) {
    normalise_text(bytes);
    return OffReader(bytes, file).read();
}

}  // namespace ostraka::io

#include "io/formats.h"
#include "io/text_reader.h"
#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>

namespace ostraka::io {

namespace {

constexpr std::size_t header_size = 84, facet_size = 50;

std::size_t facet_count(std::string_view bytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, 4);
    return count;
}

/// Numbers points by first appearance; points with equal coordinates (negative zero equals zero) get the same number. Uses an
/// open-addressing hash table of point indices, at most half full.
class PointMerger {
public:
    explicit PointMerger(std::vector<std::array<double, 3>>& points) : points_(points), slots_(1024, no_index) {}

    Index operator()(std::array<double, 3> point) {
        for (double& x : point) x += 0.0;
        if (2 * (points_.size() + 1) > slots_.size()) grow();
        std::size_t slot = hash(point) & (slots_.size() - 1);
        while (slots_[slot] != no_index) {
            if (points_[slots_[slot]] == point) return slots_[slot];
            slot = (slot + 1) & (slots_.size() - 1);
        }
        slots_[slot] = static_cast<Index>(points_.size());
        points_.push_back(point);
        return slots_[slot];
    }

private:
    static std::size_t hash(const std::array<double, 3>& point) {
        std::uint64_t h = 0x9E3779B97F4A7C15U;
        for (const double x : point) {
            h ^= std::bit_cast<std::uint64_t>(x);
            h *= 0xBF58476D1CE4E5B9U;
            h ^= h >> 29;
        }
        h *= 0x94D049BB133111EBU;
        return h ^ (h >> 32);
    }
    void grow() {
        slots_.assign(2 * slots_.size(), no_index);
        for (std::size_t i = 0; i < points_.size(); ++i) {
            std::size_t slot = hash(points_[i]) & (slots_.size() - 1);
            while (slots_[slot] != no_index) slot = (slot + 1) & (slots_.size() - 1);
            slots_[slot] = static_cast<Index>(i);
        }
    }

    std::vector<std::array<double, 3>>& points_;
    std::vector<Index> slots_;
};

/// Colours in the two attribute bytes of the triangles of a binary file. VisCAM and SolidView: the highest bit is set if the
/// triangle has a colour, then come five bits each of red, green and blue. Magics: the header contains "COLOR=" and four bytes,
/// the colour of the object; the highest bit is set if the triangle has that colour, then come blue, green and red.
class FacetColours {
public:
    explicit FacetColours(std::string_view header) {
        const std::size_t at = header.find("COLOR=");
        is_magics_ = at != std::string_view::npos && at + 10 <= header.size();
        if (is_magics_) std::memcpy(object_colour_.data(), header.data() + at + 6, 4);
    }

    void add(std::uint16_t attribute) {
        any_bits_ = any_bits_ || attribute != 0;
        any_marked_ = any_marked_ || (attribute & 0x8000U) != 0;
        attributes_.push_back(attribute);
    }

    /// Moves the colours to the soup if the triangles have some.
    void finish(PolygonSoup& soup) const {
        // Magics files whose attributes are all zero have the colour of the object only.
        const bool coloured = is_magics_ ? any_bits_ || object_colour_ != white : any_marked_;
        if (any_bits_ && !coloured)
            soup.notes.emplace_back("attribute bytes of the triangles, which are not colours, are not kept");
        if (!coloured) return;
        std::size_t uncoloured = 0;
        soup.extras.face_colours.reserve(attributes_.size());
        for (const std::uint16_t attribute : attributes_) {
            const bool marked = (attribute & 0x8000U) != 0;
            if (is_magics_) {
                soup.extras.face_colours.push_back(marked || !any_bits_ ? object_colour_ : colour(attribute, 0, 10));
            } else {
                uncoloured += !marked;
                soup.extras.face_colours.push_back(marked ? colour(attribute, 10, 0) : white);
            }
        }
        if (uncoloured > 0) soup.notes.push_back(fmt::format("{} triangles have no colour and were made white", uncoloured));
    }

private:
    static Colour colour(std::uint16_t attribute, unsigned red_bit, unsigned blue_bit) {
        const auto channel = [attribute](unsigned bit) {
            const unsigned value = (attribute >> bit) & 31U;
            return static_cast<std::uint8_t>((value * 255 + 15) / 31);
        };
        return {channel(red_bit), channel(5), channel(blue_bit), 255};
    }
    bool is_magics_ = false, any_bits_ = false, any_marked_ = false;
    Colour object_colour_ = white;
    std::vector<std::uint16_t> attributes_;
};

/// True if the bytes of a triangle are finite numbers, not all zero.
bool is_facet(const char* facet) {
    bool any = false;
    for (std::size_t k = 3; k < 12; ++k) {
        float value = 0;
        std::memcpy(&value, facet + 4 * k, 4);
        if (!std::isfinite(value)) return false;
        any = any || value != 0;
    }
    return any;
}

/// Number of triangles in a binary file. A count in the header that is too small for the file is corrected if triangles follow.
std::size_t corrected_count(std::string_view bytes, const std::string& file, std::vector<std::string>& notes) {
    const std::size_t count = facet_count(bytes), room = (bytes.size() - header_size) / facet_size;
    if (count > room)
        fail_input(file, fmt::format("the header promises {} triangles, but the file has room for {}", count, room),
                   "the file is cut off or not an STL file");
    const bool is_whole = (bytes.size() - header_size) % facet_size == 0;
    bool all_facets = room > count && (is_whole || count == 0);
    for (std::size_t f = count; f < room && all_facets; ++f) all_facets = is_facet(bytes.data() + header_size + f * facet_size);
    if (all_facets)
        notes.push_back(fmt::format("the header says {} triangles, but the file has {}, which were read", count, room));
    const std::size_t result = all_facets ? room : count;
    if (const std::size_t rest = bytes.size() - header_size - result * facet_size; rest > 0)
        notes.push_back(fmt::format("the {} bytes after the last triangle are ignored", rest));
    return result;
}

PolygonSoup read_binary(std::string_view bytes, const std::string& file) {
    if (bytes.size() < header_size) fail_input(file, "is too short for an STL file", "the file is cut off");
    PolygonSoup soup;
    const std::size_t count = corrected_count(bytes, file, soup.notes);
    soup.corners.reserve(3 * count);
    soup.polygon_begin.reserve(count + 1);
    PointMerger merge(soup.points);
    FacetColours colours(bytes.substr(0, 80));
    for (std::size_t f = 0; f < count; ++f) {
        const char* facet = bytes.data() + header_size + f * facet_size;
        for (std::size_t k = 0; k < 3; ++k) {
            float values[3];
            std::memcpy(values, facet + 12 + 12 * k, sizeof values);
            for (const float x : values)
                if (!std::isfinite(x))
                    fail_input(fmt::format("{}, triangle {}", file, f), "has a coordinate that is not finite",
                               "correct or remove the triangle");
            soup.corners.push_back(merge({values[0], values[1], values[2]}));
        }
        close_polygon(soup, file);
        std::uint16_t attribute = 0;
        std::memcpy(&attribute, facet + 48, 2);
        colours.add(attribute);
    }
    colours.finish(soup);
    return soup;
}

/// Keywords are compared without regard to case.
bool same_word(std::string_view word, std::string_view lower) {
    return std::equal(word.begin(), word.end(), lower.begin(), lower.end(),
                      [](unsigned char a, char b) { return std::tolower(a) == b; });
}

class AsciiStl {
public:
    AsciiStl(std::string_view text, const std::string& file) : reader_(text, file, 0), merge_(soup_.points) {}

    PolygonSoup read() {
        bool in_solid = false;
        while (reader_.skip_space()) {
            const char* start = reader_.position();
            const std::string_view word = keyword();
            if (same_word(word, "solid") && !in_solid) {
                reader_.rest_of_line();
                in_solid = true;
            } else if (same_word(word, "endsolid") && in_solid) {
                reader_.rest_of_line();
                in_solid = false;
            } else if (same_word(word, "facet") && in_solid) {
                facet();
            } else {
                reader_.fail("unexpected word " + in_quotes(word), "a text STL file has solid, facet, endsolid", start);
            }
        }
        if (in_solid)
            reader_.fail("the file ends before endsolid", "the file is cut off; if it is complete, add a line endsolid");
        return std::move(soup_);
    }

private:
    std::string_view keyword() {
        if (!reader_.skip_space()) reader_.fail("the file ends inside a facet", "the file is cut off");
        return reader_.word();
    }

    void expect(const char* expected) {
        reader_.skip_space();
        const char* start = reader_.position();
        const std::string_view word = keyword();
        if (!same_word(word, expected))
            reader_.fail(fmt::format("expected {} instead of {}", expected, in_quotes(word)), {}, start);
    }

    void facet() {
        expect("normal");
        for (int k = 0; k < 3; ++k) keyword();  // the normal follows from the corners; some files contain nan here
        expect("outer");
        expect("loop");
        for (;;) {
            reader_.skip_space();
            const char* start = reader_.position();
            const std::string_view word = keyword();
            if (same_word(word, "endloop")) break;
            if (!same_word(word, "vertex")) reader_.fail("expected vertex or endloop instead of " + in_quotes(word), {}, start);
            std::array<double, 3> point{};
            for (double& x : point) {
                reader_.skip_space();
                x = reader_.finite("a coordinate");
            }
            soup_.corners.push_back(merge_(point));
        }
        expect("endfacet");
        close_polygon(soup_, reader_.file());
    }

    TextReader reader_;
    PolygonSoup soup_;
    PointMerger merge_;
};

}  // namespace

namespace {
bool is_binary_of_size(std::string_view bytes) {
    return bytes.size() >= header_size && bytes.size() == header_size + facet_count(bytes) * facet_size;
}
}  // namespace

/// Text files may start with any word and binary files with "solid": the size decides.
bool looks_like_stl(std::string_view bytes) {
    if (is_binary_of_size(bytes)) return true;
    TextReader reader(without_byte_order_mark(bytes).substr(0, 4096), {}, 0);
    return reader.skip_space() && reader.word() == "solid";
}

PolygonSoup read_stl(std::string& bytes, const std::string& file) {
    if (is_binary_of_size(bytes)) return read_binary(bytes, file);
    const std::string_view content = without_byte_order_mark(bytes);
    if (content.size() < bytes.size() && is_binary_of_size(content)) return read_binary(content, file);
    TextReader reader(content, file, 0);
    std::string_view word;
    if (reader.skip_space()) word = reader.word();
    // A binary header is padded with zero bytes or blanks and has a triangle count; text has no zero bytes.
    const bool text = bytes.find('\0') == std::string::npos;
    if (same_word(word, "solid") && (text || bytes.find("facet") != std::string::npos)) {
        normalise_text(bytes);
        return AsciiStl(bytes, file).read();
    }
    if (text && bytes.size() < header_size)
        fail_input(file, "starts with neither solid nor a binary header", "check that this is an STL file");
    return read_binary(bytes, file);
}

}  // namespace ostraka::io

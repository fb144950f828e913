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

PolygonSoup read_binary(std::string_view bytes, const std::string& file) {
    if (bytes.size() < header_size) fail_input(file, "is too short for an STL file", "the file is cut off");
    const std::size_t count = facet_count(bytes);
    if (count > (bytes.size() - header_size) / facet_size)
        fail_input(file,
                   fmt::format("the header promises {} triangles, but the file has room for {}", count,
                               (bytes.size() - header_size) / facet_size),
                   "the file is cut off or not an STL file");
    PolygonSoup soup;
    soup.corners.reserve(3 * count);
    soup.polygon_begin.reserve(count + 1);
    PointMerger merge(soup.points);
    bool attributes = false;
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
        attributes = attributes || facet[48] != 0 || facet[49] != 0;
    }
    if (attributes) soup.notes.emplace_back("attribute bytes of the triangles (colours, in some programs) are not kept");
    if (bytes.size() > header_size + count * facet_size) soup.notes.emplace_back("the data after the last triangle is ignored");
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

/// Text files may start with any word and binary files with "solid": the size decides.
bool looks_like_stl(std::string_view bytes) {
    if (bytes.size() >= header_size && bytes.size() == header_size + facet_count(bytes) * facet_size) return true;
    TextReader reader(bytes.substr(0, 4096), {}, 0);
    return reader.skip_space() && reader.word() == "solid";
}

PolygonSoup read_stl(std::string& bytes, const std::string& file) {
    const bool size_fits = bytes.size() >= header_size && bytes.size() == header_size + facet_count(bytes) * facet_size;
    if (!size_fits) {
        TextReader reader(bytes, file, 0);
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
    }
    return read_binary(bytes, file);
}

}  // namespace ostraka::io

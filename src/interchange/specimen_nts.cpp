// NTSYS files (.nts, .dta), as of Rohlf's NTSYSpc and IDAV Landmark: a header with the numbers of rows and columns, labels,
// numbers.
#include "interchange/specimen_formats.h"
#include "interchange/text.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka::interchange {

namespace {

enum class NtsLabels { none, list, at_begin, at_end };

/// A dimension of the matrix: "40", "40L" (labels follow as a list), "40B" (at the begin of each row), "40E" (at its end).
struct NtsExtent {
    std::size_t count = 0;
    NtsLabels labels = NtsLabels::none;
};

std::optional<NtsExtent> extent_of(std::string_view word) {
    NtsExtent extent;
    if (word.empty()) return {};
    switch (word.back()) {
        case 'L':
        case 'l':
            extent.labels = NtsLabels::list;
            break;
        case 'B':
        case 'b':
            extent.labels = NtsLabels::at_begin;
            break;
        case 'E':
        case 'e':
            extent.labels = NtsLabels::at_end;
            break;
        default:
            break;
    }
    if (extent.labels != NtsLabels::none) word.remove_suffix(1);
    const auto count = parse_int(word);
    if (!count || *count < 1) return {};
    extent.count = static_cast<std::size_t>(*count);
    return extent;
}

struct NtsHeader {
    NtsExtent rows, columns;
    std::optional<double> missing;
    std::size_t dimension = 0;
};

/// "1 40L 24 1 9999 DIM=2": kind of the matrix, rows, columns, whether values may be missing, their code, dimension.
NtsHeader header_of(std::string_view line, const std::string& location) {
    NtsHeader header;
    std::vector<std::string_view> words = split_words(line);
    for (auto word = words.begin(); word != words.end();) {
        if (lower_case(*word).starts_with("dim=")) {
            const auto dimension = parse_int(word->substr(4));
            if (!dimension || (*dimension != 2 && *dimension != 3))
                fail_input(location, "DIM= is neither 2 nor 3", "give landmarks in two or three dimensions");
            header.dimension = static_cast<std::size_t>(*dimension);
            word = words.erase(word);
        } else {
            ++word;
        }
    }
    const auto rows = words.size() > 1 ? extent_of(words[1]) : std::nullopt,
               columns = words.size() > 2 ? extent_of(words[2]) : std::nullopt;
    if (words.empty() || words[0] != "1" || !rows || !columns)
        fail_input(location, "is not a header such as '1 40L 24 0 DIM=2'",
                   "give kind 1, the number of rows, the number of columns, whether values are missing, and DIM=");
    header.rows = *rows;
    header.columns = *columns;
    if (words.size() > 4 && words[3] == "1") header.missing = number_of(words[4]);
    if (header.dimension == 0 && header.columns.count <= 3 && header.columns.count >= 2) header.dimension = header.columns.count;
    if (header.dimension == 0) fail_input(location, "does not state the dimension", "add DIM=2 or DIM=3 to the line");
    if (header.columns.count % header.dimension != 0)
        fail_input(location, fmt::format("{} columns are no multiple of DIM={}", header.columns.count, header.dimension),
                   "correct the numbers");
    return header;
}

/// The words of the file after the header, one by one.
class NtsWords {
public:
    NtsWords(std::string_view text, std::size_t line, const std::string& where) : where_(where) {
        for (std::size_t i = 0; i < text.size(); ++line)
            for (const std::string_view word : split_words(line_at(text, i), " \t\r,")) words_.emplace_back(word, line);
    }
    std::string_view next(const char* what) {
        if (place_ == words_.size())
            fail_input(where_, fmt::format("ends before the last {}", what), "the file may be cut off, or its header is wrong");
        return words_[place_++].first;
    }
    [[nodiscard]] std::string location() const {
        return fmt::format("{}, line {}", where_, words_[place_ == 0 ? 0 : place_ - 1].second);
    }
    [[nodiscard]] std::size_t left() const { return words_.size() - place_; }

private:
    const std::string& where_;
    std::vector<std::pair<std::string_view, std::size_t>> words_;
    std::size_t place_ = 0;
};

}  // namespace

LandmarkSpecimens read_nts(const std::string& bytes, const std::string& where) {
    std::size_t position = 0, number = 0;
    std::string_view line;
    while (position < bytes.size()) {
        line = trimmed(line_at(bytes, position));
        ++number;
        if (!line.empty() && line.front() != '"' && line.front() != '\'') break;  // other lines are titles
        line = {};
    }
    const NtsHeader header = header_of(line, fmt::format("{}, line {}", where, number));
    NtsWords words(std::string_view(bytes).substr(position), number + 1, where);
    const std::size_t needed = header.rows.count * header.columns.count;
    if (needed > words.left())
        fail_input(where, fmt::format("has fewer than {} numbers", needed), "the file may be cut off, or its header is wrong");
    std::vector<std::string> row_labels(header.rows.count);
    if (header.rows.labels == NtsLabels::list)
        for (std::string& label : row_labels) label = words.next("label");
    if (header.columns.labels == NtsLabels::list)
        for (std::size_t i = 0; i < header.columns.count; ++i) words.next("label");
    // A matrix with one row per landmark is one specimen; otherwise each row is a specimen.
    const bool single = header.columns.count == header.dimension;
    LandmarkSpecimens result;
    result.dimension = static_cast<int>(header.dimension);
    if (single) result.specimens.emplace_back();
    for (std::size_t row = 0; row < header.rows.count; ++row) {
        if (header.rows.labels == NtsLabels::at_begin) row_labels[row] = words.next("label");
        if (!single) result.specimens.emplace_back();
        LandmarkSpecimen& specimen = result.specimens.back();
        for (std::size_t column = 0; column < header.columns.count; column += header.dimension) {
            std::vector<std::string_view> coordinates;
            for (std::size_t k = 0; k < header.dimension; ++k) coordinates.push_back(words.next("number"));
            specimen.positions.push_back(point_of_words(coordinates, words.location(), header.missing));
            specimen.landmarks.push_back(std::to_string(specimen.positions.size()));
        }
        if (header.rows.labels == NtsLabels::at_end) row_labels[row] = words.next("label");
        if (single && !row_labels[row].empty()) specimen.landmarks.back() = as_utf8(row_labels[row]);
        if (!single) specimen.name = row_labels[row];
    }
    if (words.left() > 0)
        fail_input(words.location(), fmt::format("is followed by {} more words than the header states", words.left()),
                   "correct the numbers of rows and columns");
    return result;
}

}  // namespace ostraka::interchange

// Landmarks in plain text: .pts (IDAV Landmark, and files of two-dimensional face landmarks), and Morphologika.
#include "interchange/specimen_formats.h"
#include "interchange/text.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <map>

namespace ostraka::interchange {

LandmarkSpecimens read_pts(const std::string& bytes, const std::string& where) {
    LandmarkSpecimens result;
    LandmarkSpecimen specimen;
    std::optional<std::size_t> dimension, stated;
    std::size_t number = 0;
    for (std::size_t i = 0; i < bytes.size();) {
        const std::string_view line = trimmed(line_at(bytes, i));
        const std::string location = fmt::format("{}, line {}", where, ++number);
        auto words = split_words(line, " \t\r,");
        const std::string first = words.empty() ? std::string() : lower_case(words.front());
        if (words.empty() || first.starts_with("version") || first == "{" || first == "}") continue;
        if (first.starts_with("n_points")) words.erase(words.begin());
        if (words.size() == 1) {
            if (const auto count = parse_int(words.front()); count && *count >= 0 && !stated && specimen.positions.empty())
                stated = static_cast<std::size_t>(*count);
            else fail_input(location, "is not a point", "give a name and coordinates on each line");
            continue;
        }
        // A word that is no number, or one more than three, is the name of the point.
        std::string name;
        if (words.size() == 4 || (!number_of(words.front()) && !is_missing_word(words.front()))) {
            name = as_utf8(words.front());
            words.erase(words.begin());
        }
        if (!dimension) dimension = words.size();
        if (words.size() != *dimension)
            fail_input(location, fmt::format("has {} coordinates, the first point {}", words.size(), *dimension),
                       "give the same number of coordinates for each point");
        specimen.positions.push_back(point_of_words(words, location));
        specimen.landmarks.push_back(name.empty() ? std::to_string(specimen.positions.size()) : name);
    }
    if (stated && *stated != specimen.positions.size())
        fail_input(where, fmt::format("states {} points, but has {}", *stated, specimen.positions.size()),
                   "the file may be cut off");
    result.dimension = static_cast<int>(dimension.value_or(3));
    result.specimens.push_back(std::move(specimen));
    return result;
}

namespace {

/// The lines of each section "[name]" of a Morphologika file.
struct TextSection {
    std::vector<std::string> lines;
    std::vector<std::size_t> numbers;  ///< line numbers
};

std::map<std::string, TextSection> sections_of(const std::string& bytes) {
    std::map<std::string, TextSection> sections;
    std::string current;
    std::size_t number = 0;
    for (std::size_t i = 0; i < bytes.size();) {
        const std::string_view line = trimmed(line_at(bytes, i));
        ++number;
        if (line.empty()) continue;
        if (line.front() == '[' && line.back() == ']') {
            current = lower_case(line.substr(1, line.size() - 2));
            continue;
        }
        sections[current].lines.emplace_back(line);
        sections[current].numbers.push_back(number);
    }
    return sections;
}

}  // namespace

LandmarkSpecimens read_morphologika(const std::string& bytes, const std::string& where) {
    std::map<std::string, TextSection> sections = sections_of(bytes);
    const auto count_in = [&](const char* name) {
        const auto& lines = sections[name].lines;
        const auto count = lines.empty() ? std::nullopt : parse_int(lines.front());
        if (!count || *count < 1 || static_cast<std::size_t>(*count) > bytes.size())
            fail_input(where, fmt::format("[{}] is missing or not a positive number", name), "add it");
        return static_cast<std::size_t>(*count);
    };
    const std::size_t individuals = count_in("individuals"), landmarks = count_in("landmarks");
    const std::size_t dimension = sections["dimensions"].lines.empty() ? 3 : count_in("dimensions");
    if (dimension != 2 && dimension != 3)
        fail_input(where, "[dimensions] is neither 2 nor 3", "give landmarks in two or three dimensions");
    LandmarkSpecimens result;
    result.dimension = static_cast<int>(dimension);
    result.specimens.resize(individuals);
    const TextSection& points = sections["rawpoints"];
    std::size_t place = 0;
    for (std::size_t s = 0; s < individuals; ++s) {
        LandmarkSpecimen& specimen = result.specimens[s];
        for (; place < points.lines.size() && specimen.positions.size() < landmarks; ++place) {
            const std::string& line = points.lines[place];
            if (line.front() == '\'' || line.front() == '"') {
                specimen.name = line.substr(1, line.back() == line.front() ? line.size() - 2 : std::string::npos);
                continue;
            }
            const std::string location = fmt::format("{}, line {}", where, points.numbers[place]);
            const auto words = split_words(line, " \t,");
            if (words.size() != dimension)
                fail_input(location, fmt::format("does not contain {} coordinates", dimension),
                           "give one number for each axis, or NA for each coordinate of a missing landmark");
            specimen.positions.push_back(point_of_words(words, location));
            specimen.landmarks.push_back(std::to_string(specimen.positions.size()));
        }
        if (specimen.positions.size() < landmarks)
            fail_input(where, fmt::format("specimen {} has {} of {} landmarks", s + 1, specimen.positions.size(), landmarks),
                       "the file may be cut off");
        if (s < sections["names"].lines.size()) specimen.name = sections["names"].lines[s];
    }
    const auto labels = sections["labels"].lines.empty() ? std::vector<std::string_view>{}
                                                         : split_words(sections["labels"].lines.front(), " \t,");
    for (std::size_t s = 0; s < individuals && s < sections["labelvalues"].lines.size(); ++s) {
        const auto values = split_words(sections["labelvalues"].lines[s], " \t,");
        for (std::size_t k = 0; k < labels.size() && k < values.size(); ++k)
            result.specimens[s].properties[as_utf8(labels[k])] = as_utf8(values[k]);
    }
    return result;
}

}  // namespace ostraka::interchange

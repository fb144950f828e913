#include "ostraka/interchange/specimens.h"

#include "interchange/landmark_formats.h"
#include "interchange/specimen_formats.h"
#include "interchange/text.h"

#include "ostraka/core/error.h"
#include "ostraka/files/json_build.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace ostraka {

namespace {

using namespace interchange;

constexpr std::array<const char*, 10> specimen_endings{".mrk.json", ".fcsv", ".pp",  ".tps", ".nts",
                                                       ".dta",      ".pts",  ".csv", ".txt", ".morphologika"};

bool has_ending(const std::string& name, const char* ending) { return lower_case(name).ends_with(ending); }

LandmarkSpecimens read_format(const std::string& bytes, const std::string& where) {
    const auto named = [&](const char* ending) { return has_ending(where, ending); };
    if (named(".tps")) return read_tps_specimens(bytes, where);
    if (named(".nts") || named(".dta")) return read_nts(bytes, where);
    if (named(".pts")) return read_pts(bytes, where);
    if (named(".csv")) return read_specimen_table(bytes, where);
    if (named(".mrk.json")) return one_specimen(landmarks_from_text(bytes, LandmarkFormat::mrk, where));
    if (named(".fcsv")) return one_specimen(landmarks_from_text(bytes, LandmarkFormat::fcsv, where));
    if (named(".pp")) return one_specimen(landmarks_from_text(bytes, LandmarkFormat::pp, where));
    if (named(".morphologika") || lower_case(bytes).find("[individuals]") != std::string::npos)
        return read_morphologika(bytes, where);
    if (named(".txt")) return read_specimen_table(bytes, where);
    fail_input(where, "is not a landmark file", fmt::format("use one of: {}", joined(specimen_endings)));
}

/// Names specimens without a name after the file, and makes names unique.
void name_specimens(LandmarkSpecimens& set, const std::string& where) {
    const std::string file = Path(where).filename().string();
    std::string stem = file;
    for (const char* ending : specimen_endings)
        if (has_ending(file, ending)) {
            stem = file.substr(0, file.size() - std::string_view(ending).size());
            break;
        }
    std::set<std::string> used;
    std::vector<std::string> repeated;
    for (std::size_t i = 0; i < set.specimens.size(); ++i) {
        std::string& name = set.specimens[i].name;
        name = one_line(as_utf8(name));
        if (name.empty()) name = set.specimens.size() == 1 ? stem : stem + " " + padded(i + 1, set.specimens.size());
        if (!used.insert(name).second) {
            if (repeated.empty() || repeated.back() != name) repeated.push_back(name);
            std::string numbered;
            for (int number = 2; numbered.empty() || !used.insert(numbered).second; ++number)
                numbered = fmt::format("{} ({})", name, number);
            name = numbered;
        }
    }
    if (!repeated.empty())
        set.notes.push_back(fmt::format("several specimens are called {}; they were numbered", joined(repeated)));
}

}  // namespace

LandmarkSpecimens one_specimen(const LandmarkSet& set) {
    LandmarkSpecimens result;
    result.unit = set.unit;
    result.notes = set.notes;
    LandmarkSpecimen& specimen = result.specimens.emplace_back();
    for (const Landmark& landmark : set.landmarks) {
        specimen.landmarks.push_back(landmark.name);
        specimen.positions.emplace_back(landmark.position);
    }
    for (const LandmarkCurve& curve : set.curves) {
        SpecimenCurve points{curve.name, curve.closed, {}};
        for (std::size_t i = 0; i < curve.points.size(); ++i) {
            points.points.push_back(specimen.positions.size());
            specimen.landmarks.push_back(fmt::format("{} {}", curve.name, i + 1));
            specimen.positions.emplace_back(curve.points[i]);
        }
        specimen.curves.push_back(std::move(points));
    }
    return result;
}

namespace interchange {

bool is_missing_word(std::string_view word) {
    const std::string lower = lower_case(trimmed(word));
    return lower.empty() || lower == "na" || lower == "nan" || lower == "?";
}

std::optional<std::array<double, 3>> point_of_words(const std::vector<std::string_view>& words, const std::string& location,
                                                    std::optional<double> code) {
    if (words.size() != 2 && words.size() != 3)
        fail_input(location, fmt::format("has {} instead of two or three coordinates", words.size()),
                   "give x and y, or x, y and z; NA for each coordinate of a missing landmark");
    std::array<double, 3> point{};
    bool missing = false;
    for (std::size_t k = 0; k < words.size(); ++k) {
        if (is_missing_word(words[k])) {
            missing = true;
            continue;
        }
        const auto value = number_of(words[k]);
        if (!value)
            fail_input(location, fmt::format("'{}' is not a number", one_line(words[k]).substr(0, 40)),
                       "give coordinates with a decimal point, or NA for a missing landmark");
        point[k] = *value;
    }
    if (missing) return {};
    const auto all_are = [&](double mark) {
        return std::all_of(point.begin(), point.begin() + static_cast<std::ptrdiff_t>(words.size()),
                           [&](double x) { return x == mark; });
    };
    if (all_are(-999) || all_are(-9999) || all_are(9999) || (code && all_are(*code))) return {};
    return point;
}

}  // namespace interchange

bool is_specimen_file(const Path& file) {
    const std::string name = file.filename().string();
    return std::any_of(specimen_endings.begin(), specimen_endings.end(),
                       [&](const char* ending) { return has_ending(name, ending); });
}

LandmarkSpecimens specimens_from_text(const std::string& bytes, const std::string& where, const SpecimenOptions& options) {
    check_options(options, "landmarks");
    if (bytes.find_first_not_of(" \t\r\n") == std::string::npos) fail_input(where, "is empty", "give a file with landmarks");
    LandmarkSpecimens set = read_format(bytes, where);
    std::erase_if(set.specimens, [](const LandmarkSpecimen& specimen) { return specimen.positions.empty(); });
    if (set.specimens.empty()) fail_input(where, "contains no landmarks", "give a file with at least one specimen");
    if (options.negative_missing)
        for (LandmarkSpecimen& specimen : set.specimens)
            for (auto& position : specimen.positions)
                if (position && std::any_of(position->begin(), position->end(), [](double x) { return x < 0; })) position.reset();
    name_specimens(set, where);
    for (const LandmarkSpecimen& specimen : set.specimens)
        for (const auto& position : specimen.positions)
            if (position) check_position(*position, fmt::format("{}, specimen '{}'", where, specimen.name));
    return set;
}

LandmarkSpecimens read_specimens(const Path& file, const SpecimenOptions& options) {
    return specimens_from_text(read_file(file), file.string(), options);
}

std::string specimens_to_tps(const LandmarkSpecimens& set) {
    std::string text;
    for (const LandmarkSpecimen& specimen : set.specimens) {
        text += fmt::format("{}={}\n", set.dimension == 2 ? "LM" : "LM3", specimen.positions.size());
        for (const auto& position : specimen.positions) {
            std::vector<std::string> words;
            for (int k = 0; k < set.dimension; ++k)
                words.push_back(position ? digits((*position)[static_cast<std::size_t>(k)]) : "NA");
            text += joined(words, " ") + "\n";
        }
        if (&specimen == &set.specimens.front()) {
            Json comment(rapidjson::kObjectType);
            add_members(comment, comment.GetAllocator(), "names",
                        json_list(specimen.landmarks, comment.GetAllocator(), [](const std::string& name) { return name; }));
            std::string line = json_text(comment);
            std::replace(line.begin(), line.end(), '\n', ' ');
            text += fmt::format("COMMENT={}\n", trimmed(line));
        }
        text += fmt::format("ID={}\n", one_line(specimen.name));
    }
    return text;
}

void SpecimenOptions::declare_options(OptionList& list) {
    list("negative-missing", negative_missing,
         "landmarks with a negative coordinate are missing, as some digitising programs mark them", Anything{});
}

}  // namespace ostraka

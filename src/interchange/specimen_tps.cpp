// TPS files (Rohlf): two- and three-dimensional landmarks and curves of several specimens.
#include "interchange/specimen_formats.h"
#include "interchange/text.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"

#include <fmt/core.h>

namespace ostraka::interchange {

namespace {

/// Reads a TPS file line by line.
class TpsReader {
public:
    TpsReader(const std::string& bytes, const std::string& where) : bytes_(bytes), where_(where) {}

    std::vector<TpsSpecimen> read() {
        for (std::size_t i = 0; i < bytes_.size();) {
            const std::string_view line = trimmed(line_at(bytes_, i));
            ++number_;
            if (line.empty()) continue;
            if (expected_ > 0) add_point(line);
            else keyword(line);
        }
        if (expected_ > 0)
            fail_input(where_, counted(expected_, in_curve_ ? "point" : "landmark") + " fewer than the file states",
                       "the file may be cut off");
        if (specimens_.empty()) fail_input(where_, "contains no LM= or LM3=", "give a tps file");
        return std::move(specimens_);
    }

private:
    [[nodiscard]] std::string location() const { return fmt::format("{}, line {}", where_, number_); }

    void add_point(std::string_view line) {
        const auto words = split_words(line, " \t,");
        TpsSpecimen& specimen = specimens_.back();
        if (words.size() != static_cast<std::size_t>(specimen.dimension))
            fail_input(location(), fmt::format("does not contain {} coordinates", specimen.dimension == 3 ? "three" : "two"),
                       "give one number for each axis, or NA for each coordinate of a missing landmark");
        const auto point = point_of_words(words, location());
        if (in_curve_) {
            specimen.curves.back().push_back(point);
        } else {
            specimen.points.push_back(point);
            specimen.lines.push_back(number_);
        }
        --expected_;
    }

    [[nodiscard]] std::size_t count(std::string_view value, std::string_view key) const {
        const auto number = parse_int(value);
        if (!number || *number < 0 || static_cast<std::size_t>(*number) > bytes_.size())
            fail_input(location(), fmt::format("the number after {}= is invalid or exceeds the file", key), "correct it");
        return static_cast<std::size_t>(*number);
    }

    void keyword(std::string_view line) {
        const std::size_t equals = line.find('=');
        if (equals == std::string_view::npos)
            fail_input(location(), "is not KEYWORD=value", "a count of landmarks or points may be too small");
        const std::string key = lower_case(trimmed(line.substr(0, equals)));
        const std::string_view value = trimmed(line.substr(equals + 1));
        if (key == "lm" || key == "lm3") {
            specimens_.emplace_back().dimension = key == "lm" ? 2 : 3;
            expected_ = count(value, key);
            in_curve_ = false;
            return;
        }
        if (specimens_.empty())
            fail_input(location(), "precedes the first LM= or LM3=", "begin each specimen with LM=count or LM3=count");
        TpsSpecimen& specimen = specimens_.back();
        if (key == "points" || key == "points3") {
            expected_ = count(value, key);
            in_curve_ = true;
            specimen.curves.emplace_back();
        } else if (key == "id") {
            specimen.id = value;
        } else if (key == "image") {
            specimen.image = value;
        } else if (key == "comment") {
            specimen.comment = value;
        } else if (key == "variables") {
            specimen.variables = value;
        } else if (key == "scale") {
            const auto scale = number_of(value);
            if (!scale || !(*scale > 0)) fail_input(location(), "the scale is not a positive number", "correct SCALE=");
            specimen.scale = *scale;
            specimen.scaled = true;
        }
    }

    const std::string& bytes_;
    const std::string& where_;
    std::vector<TpsSpecimen> specimens_;
    std::size_t expected_ = 0, number_ = 0;
    bool in_curve_ = false;
};

std::optional<std::array<double, 3>> scaled(std::optional<std::array<double, 3>> point, double scale) {
    if (point)
        for (double& x : *point) x *= scale;
    return point;
}

}  // namespace

std::vector<TpsSpecimen> tps_specimens(const std::string& bytes, const std::string& where) {
    return TpsReader(bytes, where).read();
}

std::vector<std::string> tps_names(const TpsSpecimen& specimen, const std::string& where) {
    std::vector<std::string> names;
    if (!specimen.comment.starts_with("{")) return names;
    try {
        const Json comment = parse_json(specimen.comment, where);
        if (const auto list = list_in(comment, "names"); list.Size() == specimen.points.size())
            for (const auto& name : list) names.push_back(name.IsString() ? text_of(name) : std::string());
    } catch (const Error&) {
        names.clear();
    }
    return names;
}

LandmarkSpecimens read_tps_specimens(const std::string& bytes, const std::string& where) {
    LandmarkSpecimens result;
    const std::vector<TpsSpecimen> specimens = tps_specimens(bytes, where);
    result.dimension = specimens.front().dimension;
    const std::vector<std::string> names = tps_names(specimens.front(), where);
    std::size_t with_scale = 0;
    for (const TpsSpecimen& read : specimens) {
        if (read.dimension != result.dimension)
            fail_input(where, "contains two- and three-dimensional specimens", "put them into separate files");
        LandmarkSpecimen specimen;
        specimen.name = read.id.empty() ? read.image : read.id;
        if (!read.image.empty()) specimen.properties["image"] = read.image;
        if (!read.variables.empty()) specimen.properties["variables"] = read.variables;
        if (!read.comment.empty() && !read.comment.starts_with("{")) specimen.properties["comment"] = read.comment;
        with_scale += read.scaled ? 1 : 0;
        for (std::size_t i = 0; i < read.points.size(); ++i) {
            specimen.landmarks.push_back(names.size() == read.points.size() ? names[i] : std::to_string(i + 1));
            specimen.positions.push_back(scaled(read.points[i], read.scale));
        }
        for (std::size_t c = 0; c < read.curves.size(); ++c) {
            SpecimenCurve curve{fmt::format("curve {}", c + 1), false, {}};
            for (std::size_t i = 0; i < read.curves[c].size(); ++i) {
                curve.points.push_back(specimen.positions.size());
                specimen.landmarks.push_back(fmt::format("curve {} point {}", c + 1, i + 1));
                specimen.positions.push_back(scaled(read.curves[c][i], read.scale));
            }
            specimen.curves.push_back(std::move(curve));
        }
        result.specimens.push_back(std::move(specimen));
    }
    if (with_scale > 0 && with_scale < specimens.size())
        result.notes.push_back(fmt::format("{} of {} specimens have no SCALE=: their sizes cannot be compared",
                                           specimens.size() - with_scale, specimens.size()));
    return result;
}

}  // namespace ostraka::interchange

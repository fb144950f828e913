#include "ostraka/shape_classes/landmark_class.h"

#include "ostraka/core/error.h"
#include "ostraka/interchange/landmarks.h"
#include "ostraka/shape_classes/member_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>

namespace ostraka {

namespace {

constexpr std::array<std::pair<const char*, LandmarkFormat>, 4> landmark_endings{{{".mrk.json", LandmarkFormat::mrk},
                                                                                  {".fcsv", LandmarkFormat::fcsv},
                                                                                  {".tps", LandmarkFormat::tps},
                                                                                  {".pp", LandmarkFormat::pp}}};

LandmarkSet read_landmark_file(const Path& file) {
    for (const auto& [ending, format] : landmark_endings)
        if (file.string().ends_with(ending)) return read_landmarks(file, format);
    fail_input(file.string(), "is not a landmark file", "give landmarks for this class: .mrk.json, .fcsv, .tps or .pp");
}

std::map<std::string, Point> places_of(const LandmarkSet& set, const Path& file) {
    std::map<std::string, Point> places;
    for (const Landmark& landmark : set.landmarks)
        if (!places.emplace(landmark.name, Point(landmark.position[0], landmark.position[1], landmark.position[2])).second)
            fail_input(file.string(), fmt::format("two landmarks are called '{}'", landmark.name),
                       "give each landmark its own name");
    return places;
}

}  // namespace

bool is_landmark_file(const Path& file) {
    return std::any_of(landmark_endings.begin(), landmark_endings.end(),
                       [&](const auto& ending_and_format) { return file.string().ends_with(ending_and_format.first); });
}

LandmarkTemplate read_landmark_template(const Path& file) {
    const LandmarkSet set = read_landmark_file(file);
    static_cast<void>(places_of(set, file));
    LandmarkTemplate landmark_template;
    landmark_template.unit = set.unit;
    for (const Landmark& landmark : set.landmarks) {
        landmark_template.names.push_back(landmark.name);
        landmark_template.mesh.add_vertex(Point(landmark.position[0], landmark.position[1], landmark.position[2]));
    }
    if (landmark_template.names.size() < 4)
        fail_input(file.string(), fmt::format("has only {} landmarks", landmark_template.names.size()),
                   "give at least four landmarks");
    return landmark_template;
}

LearntMember read_landmark_member(const Path& file, const LandmarkTemplate& landmark_template) {
    const LandmarkSet set = read_landmark_file(file);
    if (!set.unit.empty() && !landmark_template.unit.empty() && set.unit != landmark_template.unit)
        fail_input(file.string(), fmt::format("uses the unit {}, but the class {}", set.unit, landmark_template.unit),
                   "convert all files to one unit");
    const auto places = places_of(set, file);
    LearntMember member;
    member.name = object_name(file);
    member.fit.placed_by = "correspondence";
    for (const std::string& name : landmark_template.names) {
        const auto place = places.find(name);
        if (place == places.end())
            fail_input(file.string(), fmt::format("has no landmark '{}'", name),
                       "add it, or leave this file out: all objects need the same landmarks");
        member.fit.points.push_back(place->second);
    }
    if (places.size() > landmark_template.names.size())
        member.fit.notes.push_back(std::to_string(places.size() - landmark_template.names.size()) +
                                   " landmarks that are missing in the first file are left out");
    const double size =
        centroid_size(landmarks_of({landmark_template.mesh.points().begin(), landmark_template.mesh.points().end()}));
    member.fit.scale = size > 0 ? centroid_size(landmarks_of(member.fit.points)) / size : 1;
    return member;
}

void write_landmark_mean(const Path& file, const LandmarkTemplate& landmark_template, const Landmarks& mean,
                         const Provenance& provenance) {
    LandmarkSet set;
    set.unit = landmark_template.unit;
    for (std::size_t i = 0; i < landmark_template.names.size(); ++i) {
        const auto row = mean.row(static_cast<Eigen::Index>(i));
        set.landmarks.push_back({landmark_template.names[i], {row[0], row[1], row[2]}, {}});
    }
    std::vector<std::string> notes;
    write_file(file, landmarks_to_text(set, LandmarkFormat::mrk, "", provenance, notes));
}

}  // namespace ostraka

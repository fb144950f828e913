#include "ostraka/shape_classes/landmark_class.h"

#include "ostraka/core/error.h"
#include "ostraka/interchange/landmarks.h"
#include "ostraka/shape_classes/member_file.h"

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
    fail_input(file.string(), "is no file of landmarks", "the class is one of landmarks: give .mrk.json, .fcsv, .tps or .pp");
}

std::map<std::string, Point> places_of(const LandmarkSet& set, const Path& file) {
    std::map<std::string, Point> places;
    for (const Landmark& one : set.landmarks)
        if (!places.emplace(one.name, Point(one.position[0], one.position[1], one.position[2])).second)
            fail_input(file.string(), "two landmarks are called '" + one.name + "'", "give each a name of its own");
    return places;
}

}  // namespace

bool is_landmark_file(const Path& file) {
    return std::any_of(landmark_endings.begin(), landmark_endings.end(),
                       [&](const auto& one) { return file.string().ends_with(one.first); });
}

LandmarkTemplate read_landmark_template(const Path& file) {
    const LandmarkSet set = read_landmark_file(file);
    static_cast<void>(places_of(set, file));
    LandmarkTemplate known;
    known.unit = set.unit;
    for (const Landmark& one : set.landmarks) {
        known.names.push_back(one.name);
        known.mesh.add_vertex(Point(one.position[0], one.position[1], one.position[2]));
    }
    if (known.names.size() < 4)
        fail_input(file.string(), "has " + std::to_string(known.names.size()) + " landmarks", "shapes need four or more");
    return known;
}

LearntMember read_landmark_member(const Path& file, const LandmarkTemplate& known) {
    const LandmarkSet set = read_landmark_file(file);
    if (!set.unit.empty() && !known.unit.empty() && set.unit != known.unit)
        fail_input(file.string(), "is in " + set.unit + ", and the class in " + known.unit, "bring all files to one unit");
    const auto places = places_of(set, file);
    LearntMember member;
    member.name = object_name(file);
    member.fit.placed_by = "correspondence";
    for (const std::string& name : known.names) {
        const auto found = places.find(name);
        if (found == places.end())
            fail_input(file.string(), "has no landmark '" + name + "'",
                       "pick it, or leave this file out: all need the same landmarks");
        member.fit.points.push_back(found->second);
    }
    if (places.size() > known.names.size())
        member.fit.notes.push_back(std::to_string(places.size() - known.names.size()) +
                                   " landmarks that the first file does not have are left out");
    const double size = centroid_size(landmarks_of({known.mesh.points().begin(), known.mesh.points().end()}));
    member.fit.scale = size > 0 ? centroid_size(landmarks_of(member.fit.points)) / size : 1;
    return member;
}

void write_landmark_mean(const Path& file, const LandmarkTemplate& known, const Landmarks& mean, const Provenance& provenance) {
    LandmarkSet set;
    set.unit = known.unit;
    for (std::size_t i = 0; i < known.names.size(); ++i) {
        const auto row = mean.row(static_cast<Eigen::Index>(i));
        set.landmarks.push_back({known.names[i], {row[0], row[1], row[2]}, {}});
    }
    std::vector<std::string> notes;
    write_file(file, landmarks_to_text(set, LandmarkFormat::mrk, "", provenance, notes));
}

}  // namespace ostraka

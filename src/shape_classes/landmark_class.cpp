#include "ostraka/shape_classes/landmark_class.h"

#include "ostraka/core/error.h"
#include "ostraka/interchange/landmarks.h"
#include "ostraka/shape_classes/member_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace ostraka {

namespace {

using Places = std::map<std::string, Point>;

/// The landmarks that a specimen has, by name.
Places places_of(const LandmarkSpecimen& specimen, const Path& file) {
    Places places;
    std::set<std::string> names;
    for (std::size_t k = 0; k < specimen.landmarks.size(); ++k) {
        const std::string& name = specimen.landmarks[k];
        if (!names.insert(name).second)
            fail_input(file.string(), fmt::format("two landmarks are called '{}'", name), "give each landmark its own name");
        if (const auto& position = specimen.positions[k])
            places.emplace(name, Point((*position)[0], (*position)[1], (*position)[2]));
    }
    return places;
}

LandmarkSpecimens read_landmark_file(const Path& file, const SpecimenOptions& options = {}) {
    if (is_landmark_file(file)) return read_specimens(file, options);
    fail_input(file.string(), "is not a landmark file", "give landmarks for this class: .mrk.json, .fcsv, .tps, .pp ...");
}

LandmarkTemplate template_of(const LandmarkSpecimens& set, const Path& file) {
    const LandmarkSpecimen& first = set.specimens.front();
    const Places places = places_of(first, file);
    LandmarkTemplate landmark_template;
    landmark_template.unit = set.unit;
    for (const std::string& name : first.landmarks) {
        const auto place = places.find(name);
        if (place == places.end())
            fail_input(file.string(), fmt::format("its first specimen lacks landmark '{}'", name),
                       "begin with a specimen that has all landmarks");
        landmark_template.names.push_back(name);
        landmark_template.mesh.add_vertex(place->second);
    }
    const std::size_t needed = set.dimension == 2 ? 3 : 4;
    if (landmark_template.names.size() < needed)
        fail_input(file.string(), fmt::format("has only {} landmarks", landmark_template.names.size()),
                   fmt::format("give at least {} landmarks", needed == 3 ? "three" : "four"));
    return landmark_template;
}

void check_unit(const LandmarkSpecimens& set, const Path& file, const LandmarkTemplate& landmark_template) {
    if (!set.unit.empty() && !landmark_template.unit.empty() && set.unit != landmark_template.unit)
        fail_input(file.string(), fmt::format("uses the unit {}, but the class {}", set.unit, landmark_template.unit),
                   "convert all files to one unit");
}

/// The landmarks of the template in a specimen; NaN for those that it lacks.
Landmarks configuration_in(const LandmarkSpecimen& specimen, const Path& file, const LandmarkTemplate& landmark_template) {
    const Places places = places_of(specimen, file);
    Landmarks x(static_cast<Eigen::Index>(landmark_template.names.size()), 3);
    for (std::size_t k = 0; k < landmark_template.names.size(); ++k) {
        const auto place = places.find(landmark_template.names[k]);
        const double none = std::numeric_limits<double>::quiet_NaN();
        if (place == places.end()) x.row(static_cast<Eigen::Index>(k)) << none, none, none;
        else x.row(static_cast<Eigen::Index>(k)) << place->second.x(), place->second.y(), place->second.z();
    }
    return x;
}

/// Refuses a specimen that lacks a landmark of the template.
void check_complete(const Landmarks& x, const std::string& where, const LandmarkTemplate& landmark_template) {
    for (std::size_t k = 0; k < landmark_template.names.size(); ++k)
        if (is_missing(x, k))
            fail_input(where, fmt::format("has no landmark '{}'", landmark_template.names[k]),
                       "add it, or leave this file out: all objects need the same landmarks ('template learn' can estimate it, "
                       "see --missing)");
}

LearntMember member_of(const std::string& name, const Landmarks& x, std::size_t landmarks_in_file,
                       const LandmarkTemplate& landmark_template) {
    LearntMember member;
    member.name = name;
    member.fit.placed_by = "correspondence";
    for (Eigen::Index k = 0; k < x.rows(); ++k) member.fit.points.emplace_back(x(k, 0), x(k, 1), x(k, 2));
    if (landmarks_in_file > landmark_template.names.size())
        member.fit.notes.push_back(std::to_string(landmarks_in_file - landmark_template.names.size()) +
                                   " landmarks that are missing in the first file are left out");
    const double size =
        centroid_size(landmarks_of({landmark_template.mesh.points().begin(), landmark_template.mesh.points().end()}));
    member.fit.scale = size > 0 ? centroid_size(x) / size : 1;
    return member;
}

}  // namespace

bool is_landmark_file(const Path& file) { return is_specimen_file(file); }

LandmarkTemplate read_landmark_template(const Path& file) { return template_of(read_landmark_file(file), file); }

LearntMember read_landmark_member(const Path& file, const LandmarkTemplate& landmark_template) {
    const LandmarkSpecimens set = read_landmark_file(file);
    check_unit(set, file, landmark_template);
    if (set.specimens.size() > 1)
        fail_input(file.string(), fmt::format("contains {} specimens", set.specimens.size()), "give one specimen in each file");
    const LandmarkSpecimen& specimen = set.specimens.front();
    const Landmarks x = configuration_in(specimen, file, landmark_template);
    check_complete(x, file.string(), landmark_template);
    return member_of(object_name(file), x, specimen.landmarks.size(), landmark_template);
}

LandmarkMembers read_landmark_members(const std::vector<Path>& files, MissingInMembers missing, const SpecimenOptions& options) {
    LandmarkMembers result;
    ShapeSample sample;
    std::vector<std::size_t> counts;
    for (const Path& file : files) {
        const LandmarkSpecimens set = read_landmark_file(file, options);
        if (&file == &files.front()) {
            result.landmark_template = template_of(set, file);
            sample.dimension = set.dimension;
            sample.landmarks = result.landmark_template.names;
        }
        check_unit(set, file, result.landmark_template);
        if (set.dimension != sample.dimension)
            fail_input(file.string(),
                       fmt::format("has landmarks in {} dimensions, the first file in {}", set.dimension, sample.dimension),
                       "leave it out");
        for (const LandmarkSpecimen& specimen : set.specimens) {
            const std::string name = set.specimens.size() == 1 ? object_name(file) : specimen.name;
            const bool taken = std::find(sample.specimens.begin(), sample.specimens.end(), name) != sample.specimens.end();
            sample.specimens.push_back(taken ? object_name(file) + " " + name : name);
            sample.configurations.push_back(configuration_in(specimen, file, result.landmark_template));
            counts.push_back(specimen.landmarks.size());
            if (missing == MissingInMembers::refuse)
                check_complete(sample.configurations.back(),
                               set.specimens.size() == 1 ? file.string() : fmt::format("{}, specimen '{}'", file.string(), name),
                               result.landmark_template);
        }
    }
    CompletedSample completed{sample, {}, {}, {}};
    if (missing != MissingInMembers::refuse) {
        const MissingMethod method = missing == MissingInMembers::tps          ? MissingMethod::tps
                                     : missing == MissingInMembers::regression ? MissingMethod::regression
                                                                               : MissingMethod::mirror;
        completed = complete_landmarks(sample, method, pairs_by_name(sample.landmarks));
    }
    for (std::size_t s = 0; s < sample.specimens.size(); ++s) {
        result.members.push_back(
            member_of(sample.specimens[s], completed.sample.configurations[s], counts[s], result.landmark_template));
        for (const MissingLandmark& estimated : completed.missing)
            if (estimated.specimen == s)
                result.members.back().fit.notes.push_back(fmt::format("landmark '{}' is missing and was estimated ({})",
                                                                      sample.landmarks[estimated.landmark], estimated.how));
    }
    return result;
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

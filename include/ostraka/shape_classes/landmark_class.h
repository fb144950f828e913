// Landmark classes: members are landmark files with the same landmark names, without a surface.
#pragma once

#include "ostraka/files/file.h"
#include "ostraka/shape_classes/shape_class.h"

namespace ostraka {

/// Tests the extension: .mrk.json, .fcsv, .tps, .pp.
bool is_landmark_file(const Path& file);

/// A template made of landmarks: one vertex per landmark, no faces, no annotations.
struct LandmarkTemplate : AnnotatedMesh {
    std::vector<std::string> names;
    std::string unit;
    RelationGraph graph;  ///< empty
    [[nodiscard]] ClassTemplate known() const { return {*this, graph}; }
};
/// Throws Error (input), naming the file, for fewer than four landmarks or two landmarks of the same name.
LandmarkTemplate read_landmark_template(const Path& file);

/// Reads a member and matches its landmarks to the template's by name; additional landmarks are noted. Throws Error (input),
/// naming file and landmark, if a landmark is missing or the unit differs.
LearntMember read_landmark_member(const Path& file, const LandmarkTemplate& landmark_template);

/// Writes the mean as a landmark file (.mrk.json).
void write_landmark_mean(const Path& file, const LandmarkTemplate& landmark_template, const Landmarks& mean,
                         const Provenance& provenance);

}  // namespace ostraka

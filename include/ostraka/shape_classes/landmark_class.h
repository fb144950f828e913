// Classes of landmark configurations: the members are landmark files with the same landmark names and have no surface.
#pragma once

#include "ostraka/files/file.h"
#include "ostraka/shape_classes/shape_class.h"

namespace ostraka {

/// True if the file has the extension of a landmark file: .mrk.json, .fcsv, .tps, .pp.
bool is_landmark_file(const Path& file);

/// A template that consists of landmarks: one vertex per landmark, no faces, no annotations.
struct LandmarkTemplate : AnnotatedMesh {
    std::vector<std::string> names;                                       ///< name of each landmark
    std::string unit;                                                     ///< unit of the coordinates
    RelationGraph graph;                                                  ///< empty
    [[nodiscard]] ClassTemplate known() const { return {*this, graph}; }  ///< template of a class; refers to this object
};
/// Reads a landmark file as a template. Throws Error (input), naming the file, for fewer than four landmarks or two landmarks of
/// the same name.
LandmarkTemplate read_landmark_template(const Path& file);

/// Reads a landmark file as a member and matches its landmarks to the template's by name; a note lists additional landmarks.
/// Throws Error (input), naming file and landmark, if a landmark is missing or the unit differs.
LearntMember read_landmark_member(const Path& file, const LandmarkTemplate& landmark_template);

/// Writes the mean configuration of a class as a landmark file (.mrk.json).
void write_landmark_mean(const Path& file, const LandmarkTemplate& landmark_template, const Landmarks& mean,
                         const Provenance& provenance);

}  // namespace ostraka

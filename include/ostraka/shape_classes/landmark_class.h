// Classes of landmarks: members are files of landmarks of the same names, without a surface.
#pragma once

#include "ostraka/core/file.h"
#include "ostraka/shape_classes/shape_class.h"

namespace ostraka {

/// By its ending: .mrk.json, .fcsv, .tps, .pp.
bool is_landmark_file(const Path& file);

/// Landmarks as a template: a vertex for each, no faces.
struct LandmarkTemplate {
    std::vector<std::string> names;
    Mesh mesh;
    std::string unit;
    AnnotationSet set;    ///< empty
    RelationGraph graph;  ///< empty
    [[nodiscard]] ClassTemplate known() const { return {mesh, set, graph}; }
};
/// Throws Error (input) naming the file: fewer than four landmarks, two of one name.
LandmarkTemplate read_landmark_template(const Path& file);

/// The template's landmarks, found by their names; others are noted. Throws Error (input) that names file and landmark where one
/// is missing, or the unit is another.
LearntMember read_landmark_member(const Path& file, const LandmarkTemplate& known);

/// The mean as a landmark file (.mrk.json).
void write_landmark_mean(const Path& file, const LandmarkTemplate& known, const Landmarks& mean, const Provenance& provenance);

}  // namespace ostraka

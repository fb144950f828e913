// Classes of landmark configurations: members are landmark files with the same landmark names, without a surface.
#pragma once

#include "ostraka/files/file.h"
#include "ostraka/interchange/specimens.h"
#include "ostraka/morphometrics/missing_landmarks.h"
#include "ostraka/shape_classes/shape_class.h"

namespace ostraka {

/// Whether the file has the extension of a landmark file (interchange/specimens.h).
bool is_landmark_file(const Path& file);

/// A template that consists of landmarks: one vertex per landmark, no faces, no annotations.
struct LandmarkTemplate : AnnotatedMesh {
    std::vector<std::string> names;                                       ///< name of each landmark
    std::string unit;                                                     ///< unit of the coordinates
    RelationGraph graph;                                                  ///< empty
    [[nodiscard]] ClassTemplate known() const { return {*this, graph}; }  ///< template of a class; refers to this object
};
/// Reads the first specimen of a landmark file as a template. Throws Error (input), naming the file, for fewer than four
/// landmarks (three in two dimensions), two landmarks of the same name, and a landmark that the first specimen lacks.
LandmarkTemplate read_landmark_template(const Path& file);

/// Reads a landmark file as a member and matches its landmarks to the template's by name; a note lists additional landmarks.
/// Throws Error (input), naming file and landmark, if a landmark is missing, the unit differs, or the file has several specimens.
LearntMember read_landmark_member(const Path& file, const LandmarkTemplate& landmark_template);

/// What is done about members that lack a landmark of the template.
enum class MissingInMembers {
    refuse,      ///< an error names the member and the landmark
    tps,         ///< as MissingMethod::tps
    regression,  ///< as MissingMethod::regression
    mirror       ///< as MissingMethod::mirror, with the pairs that the names of the landmarks give
};
/// The members of a class of landmarks.
struct LandmarkMembers {
    LandmarkTemplate landmark_template;  ///< the first specimen of the first file
    std::vector<LearntMember> members;   ///< every specimen of every file; notes name estimated landmarks
};
/// Reads all specimens of landmark files as members; specimens of files with several are named by the file. Throws Error (input)
/// as read_landmark_template and read_landmark_member, and as complete_landmarks.
LandmarkMembers read_landmark_members(const std::vector<Path>& files, MissingInMembers missing = MissingInMembers::refuse,
                                      const SpecimenOptions& options = {});

/// Writes the mean configuration of a class as a landmark file (.mrk.json).
void write_landmark_mean(const Path& file, const LandmarkTemplate& landmark_template, const Landmarks& mean,
                         const Provenance& provenance);

}  // namespace ostraka

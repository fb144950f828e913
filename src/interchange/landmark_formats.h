// The readers and writers behind landmarks_from_text and landmarks_to_text, one pair per format.
#pragma once

#include "ostraka/core/message_text.h"
#include "ostraka/interchange/landmarks.h"

namespace ostraka::interchange {

using Notes = std::vector<std::string>;  ///< messages about data that a format cannot store

LandmarkSet read_landmark_table(const std::string& bytes, const std::string& where, const LandmarkFileOptions& options);
LandmarkSet read_tps(const std::string& bytes, const std::string& where, const LandmarkFileOptions& options);
LandmarkSet read_fcsv(const std::string& bytes, const std::string& where, const LandmarkFileOptions& options);
LandmarkSet read_picked_points(const std::string& bytes, const std::string& where);
LandmarkSet read_markups(const std::string& bytes, const std::string& where, const LandmarkFileOptions& options);

std::string write_landmark_table(const LandmarkSet& set);
std::string write_tps(const LandmarkSet& set, const std::string& mesh_file);
std::string write_fcsv(const LandmarkSet& set, const LandmarkFileOptions& options, Notes& notes);
std::string write_picked_points(const LandmarkSet& set, const std::string& mesh_file, Notes& notes);
std::string write_markups(const LandmarkSet& set, const LandmarkFileOptions& options, const Provenance& provenance);

/// Converts a position from `file_space` (nullopt: the space of the mesh) to the space of the mesh: x and y are negated between
/// LPS and RAS.
std::array<double, 3> in_mesh_space(std::array<double, 3> position, std::optional<AnatomicalSpace> file_space,
                                    AnatomicalSpace mesh_space);

/// Throws Error (input), naming `location`, if the position exceeds the limit for mesh coordinates.
void check_position(const std::array<double, 3>& position, const std::string& location);

}  // namespace ostraka::interchange

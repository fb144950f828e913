// Rigid and similarity motions in files: 4 x 4 matrices as JSON or text.
#pragma once

#include "ostraka/files/json.h"
#include "ostraka/geom/rigid_fit.h"

#include <string>
#include <vector>

namespace ostraka {

/// Writes a pose as the rows of a 4 x 4 matrix.
JsonValue pose_to_json(const Motion& pose, JsonAllocator& allocator);

/// A motion that was read from a file.
struct StoredMotion {
    Motion motion;
    std::string unit_before, unit_after;  ///< units of length before and after the motion; empty: the file does not state them
    std::vector<std::string> notes;       ///< remarks on the matrix
};

/// Converts a 4 x 4 matrix to a motion: a rotation, possibly with a reflection, a uniform scale and a translation. A matrix
/// that deviates from such a motion by at most 1e-5 (relative), for example because it was written with few digits, is replaced
/// by the nearest motion (polar decomposition); above 1e-9 a note reports the deviation. Throws Error (input) that names
/// `where` for shear, unequal scales, a last row other than 0 0 0 1, a matrix without inverse, and numbers that are not finite.
StoredMotion motion_of_matrix(const Eigen::Matrix4d& matrix, const std::string& where);

/// Reads a motion from a file: 16 numbers as text, row by row (CloudCompare, MeshLab), or JSON: the rows of the matrix as an
/// array (as 'mesh register --matrix' writes them), an object with the member `matrix` or `pose` (as 'mesh move --transform'
/// writes it), a report with one of these in `result`, or an assembly (as 'fit' writes it), from which the pose of the fragment
/// `name` is taken. Throws Error (input) for other content, and the errors of motion_of_matrix.
StoredMotion read_motion(const Path& file, const std::string& name = {});

}  // namespace ostraka

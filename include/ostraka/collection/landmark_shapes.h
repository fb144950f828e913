// Landmark configurations of the objects of a collection.
#pragma once

#include "ostraka/collection/objects.h"
#include "ostraka/registration/procrustes.h"

namespace ostraka {

/// Reads the landmarks of every object from the object's markups file (.mrk.json). The result of an object with two landmarks of
/// the same name is an error.
std::vector<ObjectResult> read_object_landmarks(const Collection& collection, const ResultStore& store = ResultStore());

/// An object whose shape differs from the other objects.
struct ShapeOutlier {
    std::string name, why;  ///< name of the object; message with the difference and the remedy
    bool left_out = false;  ///< true: the object was left out of the analysis
};

/// Objects, and the landmarks that every one of these objects has.
struct LandmarkShapes {
    /// For each object whose landmarks could be read: its name; its known class label (empty: unknown).
    std::vector<std::string> objects, labels;
    std::vector<std::string> names;         ///< names of the landmarks, in the order of the first object that has them
    std::string unit;                       ///< unit of all landmarks; empty if the units differ or are not given
    std::vector<Landmarks> configurations;  ///< landmarks of each object, in the order of `names`
    std::vector<std::string> notes;         ///< messages about landmarks that were left out
    std::vector<ShapeOutlier> odd;          ///< objects that were left out, with reasons
};

/// Selects the landmarks common to all objects in `read` (the result of `read_object_landmarks`). Objects are left out (member
/// `odd`) if they have fewer than half of the landmarks that at least half of the objects have. Without `scaling`, objects are
/// also left out if their unit is not the unit of more than half of the objects. Throws Error (input) if no object could be read,
/// if fewer than three landmarks are common to all objects, and, without `scaling`, if units differ and none of them is the unit
/// of more than half of the objects. `where` names the source of the collection in error messages.
LandmarkShapes common_landmarks(const Collection& collection, const std::vector<ObjectResult>& read, bool scaling,
                                const std::string& where);

/// Finds objects whose landmarks are mirrored and objects of unusual size. An object is mirrored if its mirror image is less
/// than half as far from the mean of the other objects as the object itself. The size is unusual for objects whose centroid
/// size is more than three times or less than a third of the median. The objects found are reported, not removed.
std::vector<ShapeOutlier> shape_outliers(const LandmarkShapes& shapes);

/// A copy of `shapes` without the objects listed in `outliers`.
LandmarkShapes without(const LandmarkShapes& shapes, const std::vector<ShapeOutlier>& outliers);

}  // namespace ostraka

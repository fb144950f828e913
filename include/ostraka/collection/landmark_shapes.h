// Landmark configurations of the objects of a collection.
#pragma once

#include "ostraka/collection/objects.h"
#include "ostraka/registration/procrustes.h"

namespace ostraka {

/// Reads the landmarks of every object from its markups (.mrk.json). Two landmarks of the same name are an error of the object.
std::vector<ObjectResult> read_object_landmarks(const Collection& collection, const ResultStore& store = ResultStore());

/// An object that differs from the others. `why` is a message with the remedy.
struct ShapeOutlier {
    std::string name, why;
    bool left_out = false;
};

/// Objects with the landmarks that all of them share.
struct LandmarkShapes {
    std::vector<std::string> objects, labels;  ///< names and known labels of the objects whose landmarks could be read
    std::vector<std::string> names;            ///< names of the landmarks, in the order of the first object that has them
    std::string unit;                          ///< unit of all landmarks; empty if the units differ or are not given
    std::vector<Landmarks> configurations;     ///< one per object
    std::vector<std::string> notes;            ///< messages on the landmarks that are left out
    std::vector<ShapeOutlier> odd;             ///< objects that were left out
};

/// Landmarks common to the objects in `read`, the result of `read_object_landmarks`. Left out as odd are objects with fewer
/// than half of the usual landmarks (those that at least half of the objects have) and, without `scaling`, objects in a unit
/// other than the unit of more than half of the objects. Throws Error (input) if no object could be read, if fewer than three
/// landmarks are common to all objects, and, without `scaling`, if units differ and none of them is the unit of more than half
/// of the objects. `where` names the source of the collection in error messages.
LandmarkShapes common_landmarks(const Collection& collection, const std::vector<ObjectResult>& read, bool scaling,
                                const std::string& where);

/// Objects whose landmarks are mirrored (the mirror image is less than half as far from the mean of the others), and objects
/// whose centroid size is more than three times the median or less than a third of it. These objects are not removed.
std::vector<ShapeOutlier> shape_outliers(const LandmarkShapes& shapes);

/// The shapes without the objects listed in `odd`.
LandmarkShapes without(const LandmarkShapes& shapes, const std::vector<ShapeOutlier>& outliers);

}  // namespace ostraka

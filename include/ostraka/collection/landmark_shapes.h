// Configurations of landmarks of the objects of a collection.
#pragma once

#include "ostraka/collection/objects.h"
#include "ostraka/registration/procrustes.h"

namespace ostraka {

/// Reads the landmarks of every object, its markups (.mrk.json); two of one name are an error of the object.
std::vector<ObjectResult> read_object_landmarks(const Collection& collection, const ResultStore& store = ResultStore());

/// An object that is not as the others, and why, in words with the remedy.
struct OddSpecimen {
    std::string name, why;
    bool left_out = false;
};

/// Objects with the landmarks that all of them have.
struct LandmarkShapes {
    std::vector<std::string> objects, labels;  ///< those whose landmarks could be read, their known answers
    std::vector<std::string> names;            ///< of the landmarks, in the order of the first object that has them
    std::string unit;                          ///< of all of them; empty where they differ or do not say
    std::vector<Landmarks> configurations;     ///< one an object
    std::vector<std::string> notes;            ///< which landmarks are left out, in words
    std::vector<OddSpecimen> odd;              ///< objects that were left out
};

/// Of what `read_object_landmarks` read. Left out as odd are objects with fewer than half of the usual landmarks (those that half
/// of the objects have), and without `scaling` those in another unit than more than half of the objects. Throws Error (input)
/// where no object could be read, for fewer than three landmarks in common, and without `scaling` for different units of which
/// none is that of most; `where` is what the collection was read from.
LandmarkShapes common_landmarks(const Collection& collection, const std::vector<ObjectResult>& read, bool scaling,
                                const std::string& where);

/// Objects whose landmarks are mirrored (their mirror image is less than half as far from the mean of the others), and those
/// whose centroid size is more than three times the median, or less than a third. They stay in.
std::vector<OddSpecimen> odd_specimens(const LandmarkShapes& shapes);

/// The shapes without those of these names.
LandmarkShapes without(const LandmarkShapes& shapes, const std::vector<OddSpecimen>& odd);

}  // namespace ostraka

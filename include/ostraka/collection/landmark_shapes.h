// Configurations of landmarks of the objects of a collection.
#pragma once

#include "ostraka/collection/objects.h"
#include "ostraka/registration/procrustes.h"

namespace ostraka {

/// Reads the landmarks of every object, its markups (.mrk.json); two of one name are an error of the object.
std::vector<ObjectResult> read_object_landmarks(const Collection& collection, const ResultStore& store = ResultStore());

/// Objects with the landmarks that all of them have.
struct LandmarkShapes {
    std::vector<std::string> objects, labels;  ///< those whose landmarks could be read, their known answers
    std::vector<std::string> names;            ///< of the landmarks, in the order of the first object that has them
    std::string unit;                          ///< of all of them; empty where they differ or do not say
    std::vector<Landmarks> configurations;     ///< one an object
    std::vector<std::string> notes;            ///< which landmarks are left out, in words
};

/// Of what `read_object_landmarks` read. Throws Error (input) where no object could be read, for fewer than three landmarks in
/// common, and without `scaling` for different units; `where` is what the collection was read from.
LandmarkShapes common_landmarks(const Collection& collection, const std::vector<ObjectResult>& read, bool scaling,
                                const std::string& where);

}  // namespace ostraka

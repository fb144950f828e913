// Experiments on classes of objects.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka::experiments {

/// Classification of a benchmark's models: templates are fitted to them, and each model is left out when its class is learnt.
struct ClassMembershipOptions {
    std::string models, labels, output = "experiments-output/classes";
    std::size_t members = 1000;  ///< max number per class
    std::uint64_t template_vertices = 1000, object_vertices = 3000;
    int tries = 1;
    double search_radius = 0.1;
};
void class_membership(const ClassMembershipOptions& options);

/// Required number of members: eight synthetic classes whose members differ in proportions, taper and bend.
struct ClassSizeOptions {
    std::string output = "experiments-output/class-size";
    std::uint64_t vertices = 4000, seed = 1;  ///< min for the handles
};
void class_size(const ClassSizeOptions& options);

/// Objects in known correspondence: shape modes learnt from it, and the accuracy of fits.
struct ClassCorrespondenceOptions {
    std::vector<std::string> faces;  ///< the neutral one first
    std::string landmarks;           ///< file of vertex indices, one per line
    std::string body;
    std::vector<std::string> targets;                          ///< files with lines "vertex dx dy dz"
    std::size_t face_vertices = 11248, body_vertices = 13380;  ///< number of leading vertices that are skin
    int made = 30;
    std::uint64_t seed = 1;
};
void class_correspondence(const ClassCorrespondenceOptions& options);

}  // namespace ostraka::experiments

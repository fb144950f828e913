// Experiments on classes of objects.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka::experiments {

/// Which class an object belongs to: templates fitted to a benchmark's models, each left out of what its class learns.
struct ClassMembershipOptions {
    std::string models, labels, output = "experiments-output/classes";
    std::size_t members = 1000;  ///< of each class, at most
    std::uint64_t template_vertices = 1000, object_vertices = 3000;
    int tries = 1;
    double search_radius = 0.1;
};
void class_membership(const ClassMembershipOptions& options);

/// How many members it takes: eight classes made by rule, whose members differ in proportions, taper and bend.
struct ClassSizeOptions {
    std::string output = "experiments-output/class-size";
    std::uint64_t vertices = 4000, seed = 1;  ///< fewer do not hold the handles
};
void class_size(const ClassSizeOptions& options);

/// Objects whose correspondence is known: modes learnt from it, and what a fit finds of it.
struct ClassCorrespondenceOptions {
    std::vector<std::string> faces;  ///< the neutral one first
    std::string landmarks;           ///< vertex indices, one a line
    std::string body;
    std::vector<std::string> targets;                          ///< "vertex dx dy dz" a line
    std::size_t face_vertices = 11248, body_vertices = 13380;  ///< the first ones are skin
    int made = 30;
    std::uint64_t seed = 1;
};
void class_correspondence(const ClassCorrespondenceOptions& options);

}  // namespace ostraka::experiments

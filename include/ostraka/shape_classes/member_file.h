// Files of members of a class, and of classes with their templates.
#pragma once

#include "ostraka/shape_classes/class_file.h"
#include "ostraka/shape_classes/landmark_class.h"

namespace ostraka {

/// The name of an object: its file name without folder and extension (".mrk.json" is one extension).
std::string object_name(const Path& file);
/// Throws Error (usage) if two files have the same name without folder and extension.
void check_object_names(const std::vector<std::string>& files);

/// Reads a mesh file and the annotations beside it (NAME.ant.json), if they exist.
WholeObject read_member(const Path& file);

/// The template of a class, from a template with a mesh. `package` must outlive the result.
ClassTemplate class_template(const Template& package);

/// A class with its template or its landmarks.
struct ClassWithTemplate {
    ShapeClass learnt;
    Template package;
    std::optional<LandmarkTemplate> landmarks;
    [[nodiscard]] ClassTemplate known() const { return landmarks ? landmarks->known() : class_template(package); }
};
/// Throws the Errors (input) of read_class, check_usable and check_topology.
ClassWithTemplate read_class_with_template(const Path& file);

}  // namespace ostraka

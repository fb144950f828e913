// Files of members of a class, and of classes with their templates.
#pragma once

#include "ostraka/shape_classes/class_file.h"
#include "ostraka/shape_classes/landmark_class.h"

namespace ostraka {

/// The name of an object: its file name without folder and extension; ".mrk.json" counts as one extension.
std::string object_name(const Path& file);
/// Throws Error (usage) if two files have the same name without folder and extension.
void check_object_names(const std::vector<std::string>& files);

/// Reads a mesh file and, if it exists, the annotation file beside it (NAME.ant.json).
WholeObject read_member(const Path& file);

/// The class template of a template package with a mesh. `package` must outlive the result.
ClassTemplate class_template(const Template& package);

/// A learnt class with its template package or its landmark template.
struct ClassWithTemplate {
    ShapeClass learnt;                          ///< the learnt class
    Template package;                           ///< the template package of the class; without a mesh for landmark classes
    std::optional<LandmarkTemplate> landmarks;  ///< landmark template; empty: the class has a template with a mesh
    /// Template of the class; refers to this object.
    [[nodiscard]] ClassTemplate known() const { return landmarks ? landmarks->known() : class_template(package); }
};
/// Reads a class file and the template beside it. Throws the Errors (input) of read_class, check_usable and check_topology.
ClassWithTemplate read_class_with_template(const Path& file);

}  // namespace ostraka

// Members of a class, and classes with their templates, as files.
#pragma once

#include "ostraka/shape_classes/class_file.h"
#include "ostraka/shape_classes/landmark_class.h"

namespace ostraka {

/// The name of an object: its file's without folder and ending (".mrk.json" is one ending).
std::string object_name(const Path& file);
/// Throws Error (usage) where two files have one name without folder and ending.
void check_object_names(const std::vector<std::string>& files);

/// A mesh file and the annotations beside it (NAME.ant.json), if there are.
WholeObject read_member(const Path& file);

/// A template with a mesh as that of a class. It outlives what is returned.
ClassTemplate class_template(const Template& package);

/// A class with its template, or with its landmarks.
struct ClassWithTemplate {
    ShapeClass learnt;
    Template package;
    std::optional<LandmarkTemplate> landmarks;
    [[nodiscard]] ClassTemplate known() const { return landmarks ? landmarks->known() : class_template(package); }
};
/// Throws Error (input) as read_class, check_usable and check_topology do.
ClassWithTemplate read_class_with_template(const Path& file);

}  // namespace ostraka

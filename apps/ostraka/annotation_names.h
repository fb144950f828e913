// Annotations as they are named on the command line.
#pragma once

#include "ostraka/annotation/annotation.h"

namespace ostraka::app {

/// The annotation of this id, or of this tag if exactly one has it. Throws Error (input) that names the file.
const Annotation& find_annotation(const AnnotationSet& set, const std::string& name, const std::string& file);

/// The title of a column of quantities such as "area" with the unit they are in, if the set has one.
std::string in_unit(const std::string& quantity, const AnnotationSet& set);

}  // namespace ostraka::app

// Result of a fit as a file that can be inspected, edited and read back (*.assembly.json, doc/schema/assembly.schema.json).
#pragma once

#include "ostraka/reconstruction/reconstruct.h"

namespace ostraka {

/// File names of the template and the fragments in an assembly file.
struct AssemblyNames {
    std::string template_file;           ///< file name of the template
    std::vector<std::string> fragments;  ///< file name of each fragment
};

/// JSON of a reconstruction: scale, poses (4 x 4, from a fragment's file to the scaled template), residuals, matches of
/// annotations, constraints, verdict.
JsonValue assembly_to_json(const Reconstruction& result, const AssemblyNames& names, JsonAllocator& allocator);

/// Matches stated by the user ("stated": true) in an assembly file for the fragment of this name. `file` names the assembly in
/// errors. Throws Error (input), with the JSON pointer, for a file that is no assembly, two entries with one fragment name, a
/// stated match without its annotation, and an annotation stated twice.
std::vector<StatedMatch> stated_matches(const JsonValue& assembly, const std::string& fragment,
                                        const std::string& file = "assembly");
/// Matches stated by the user in an assembly file for this fragment; also checks that the fragment and the template have the
/// stated annotations, and that matched annotations have one type. Throws Error (input).
std::vector<StatedMatch> stated_matches(const JsonValue& assembly, const Fragment& fragment, const AnnotationSet& of_template,
                                        const std::string& file);

/// Fragment names in an assembly file that have stated matches but are not among `fragments`, in the order of the file.
std::vector<std::string> unused_statements(const JsonValue& assembly, const std::vector<std::string>& fragments);

}  // namespace ostraka

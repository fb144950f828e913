// Assembly files: the result of a fit, which can be inspected, edited and read again (*.assembly.json,
// doc/schema/assembly.schema.json).
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
/// errors. Throws Error (input), with the JSON pointer, for a file that is not an assembly, two entries with the same fragment
/// name, a stated match that names no annotation of the fragment, and two stated matches for one annotation.
std::vector<StatedMatch> stated_matches(const JsonValue& assembly, const std::string& fragment,
                                        const std::string& file = "assembly");
/// Matches stated by the user in an assembly file for this fragment; also checks that the fragment and the template have the
/// annotations, and that matched annotations have the same type. Throws Error (input).
std::vector<StatedMatch> stated_matches(const JsonValue& assembly, const Fragment& fragment, const AnnotationSet& of_template,
                                        const std::string& file);

/// Names of fragments for which an assembly file states matches but which are not in `fragments`, in the order of the file.
std::vector<std::string> unused_statements(const JsonValue& assembly, const std::vector<std::string>& fragments);

}  // namespace ostraka

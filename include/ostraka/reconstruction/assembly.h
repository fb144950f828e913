// Result of a fit as a file that can be inspected, edited and read back (*.assembly.json, doc/schema/assembly.schema.json).
#pragma once

#include "ostraka/reconstruction/reconstruct.h"

namespace ostraka {

/// File names of the template and the fragments in the assembly.
struct AssemblyNames {
    std::string template_file;
    std::vector<std::string> fragments;  ///< name of each
};

/// The report of a reconstruction: scale, poses (4 x 4, from a fragment's file to the scaled template), residuals, matches of
/// annotations, constraints, verdict.
JsonValue assembly_to_json(const Reconstruction& result, const AssemblyNames& names, JsonAllocator& allocator);

/// The matches stated by the user in an assembly for the fragment of this name: matches with "stated": true. `file` names the
/// assembly in errors. Throws Error (input), with the JSON pointer, for a file that is no assembly, two entries of one name, a
/// stated match without its annotation, and an annotation stated twice.
std::vector<StatedMatch> stated_matches(const JsonValue& assembly, const std::string& fragment,
                                        const std::string& file = "assembly");
/// As above; also checks that fragment and template have these annotations, each pair of one type.
std::vector<StatedMatch> stated_matches(const JsonValue& assembly, const Fragment& fragment, const AnnotationSet& of_template,
                                        const std::string& file);

/// Names in an assembly that have stated matches but are not among `fragments`, in the order of the file.
std::vector<std::string> unused_statements(const JsonValue& assembly, const std::vector<std::string>& fragments);

}  // namespace ostraka

// What a fit did, as a file that can be looked at, edited and given back (*.assembly.json, doc/schema/assembly.schema.json).
#pragma once

#include "ostraka/fitting/reconstruct.h"

namespace ostraka {

/// A fragment's files as the assembly names them.
struct AssemblyNames {
    std::string template_file;
    std::vector<std::string> fragments;  ///< name of each
};

/// The report of a reconstruction: scale, poses (4 x 4, from a fragment's file to the scaled template), residuals, matches of
/// annotations, constraints, verdict.
JsonValue assembly_to_json(const Reconstruction& result, const AssemblyNames& names, JsonAllocator& allocator);

/// What a person stated in an assembly for the fragment of this name: matches with "stated": true. Throws Error (input) for what
/// is no assembly.
std::vector<StatedMatch> stated_matches(const JsonValue& assembly, const std::string& fragment);

}  // namespace ostraka

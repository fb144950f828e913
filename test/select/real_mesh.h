// A real scan for the tests of selections.
#pragma once

#include "ostraka/io/mesh_file.h"
#include "scratch.h"

namespace ostraka::test {

inline const char* const scan_archive = "/usr/share/doc/libcgal-dev/data.tar.gz";

/// A mesh from the CGAL distribution (package libcgal-demo); empty if the archive is missing.
inline std::optional<Mesh> scan(const std::string& name) {
    if (!std::filesystem::exists(scan_archive)) return std::nullopt;
    const Scratch scratch;
    const std::string line = std::string("tar -xzf ") + scan_archive + " -C " + scratch.path().string() +
                             " --strip-components=2 data/meshes/" + name + " 2>/dev/null";
    if (std::system(line.c_str()) != 0) return std::nullopt;
    return read_mesh(scratch / name).mesh;
}

}  // namespace ostraka::test

#define OSTRAKA_SCAN(mesh, name)                                                                 \
    const auto scan_of_test = ostraka::test::scan(name);                                         \
    if (!scan_of_test) GTEST_SKIP() << "no " << (name) << " in " << ostraka::test::scan_archive; \
    const ostraka::Mesh& mesh = *scan_of_test

#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/mesh.h"

#include <string>
#include <vector>

namespace ostraka::experiments {

struct TableOptions {
    std::vector<std::string> made{"teapot", "statuette", "hand"};
    std::vector<std::string> scans;
    std::size_t full = 2000000;
    std::vector<std::size_t> rungs{50000, 5000, 100000, 1000000};
    std::string metric;
    std::string csv;
    bool no_independent = false, truth_only = false;
};
void transfer_table(const TableOptions& options);

struct LabelOptions {
    std::string models, labels, csv;
    std::size_t limit = 0;
};
void label_transfer(const LabelOptions& options);

struct CageTableOptions {
    std::vector<std::string> meshes;
    std::vector<std::uint64_t> vertices{100, 200, 500};
    std::string csv;
};
void cages(const CageTableOptions& options);

/// The faces nearest to a seed vertex (by edge paths), up to a share of the mesh's area.
std::vector<Index> disc(const Mesh& mesh, Vertex seed, double share);

}  // namespace ostraka::experiments

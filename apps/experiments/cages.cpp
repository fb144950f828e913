// Cages of many meshes: how many are valid, their resolution, and the time.
#include "experiments.h"

#include "ostraka/cage/cage.h"
#include "ostraka/core/error.h"
#include "ostraka/core/file.h"
#include "ostraka/io/mesh_file.h"

#include <cstdio>
#include <ctime>
#include <iostream>

namespace ostraka::experiments {

namespace {

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::string fixed(double value, int digits) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.*f", digits, value);
    return buffer;
}

}  // namespace

void cages(const CageTableOptions& options) {
    std::string rows = "mesh,mesh vertices,wanted,vertices,valid,genus,mesh genus,alpha,clearance,seconds,why not\n";
    std::cout << "| mesh | vertices | wanted | cage | sound | genus | clearance, % of the diagonal | s "
                 "|\n|---|---|---|---|---|---|---|---|\n";
    std::size_t tried = 0, sound = 0, reached = 0;
    double longest = 0, total = 0;
    for (const std::string& file : options.meshes) {
        Mesh mesh;
        try {
            mesh = read_mesh(file).mesh;
        } catch (const Error& error) {
            std::cout << "| " << Path(file).filename().string() << " | not read: " << error.problem() << " | | | | | | |\n";
            continue;
        }
        const CageCheck shape = check_cage(mesh, Mesh());
        if (!shape.closed) {
            std::cout << "| " << Path(file).filename().string() << " | open, left out | | | | | | |\n";
            continue;
        }
        for (const std::uint64_t wanted : options.vertices) {
            ++tried;
            const double start = processor_seconds();
            CageResult result;
            std::string why;
            try {
                result = make_cage(mesh, {.vertices = wanted});
            } catch (const Error& error) {
                why = error.problem();
            }
            const double seconds = processor_seconds() - start;
            const CageCheck check = check_cage(result.cage, mesh);
            if (why.empty() && !result.reached) why = "fewer vertices were not reached";
            if (why.empty() && !check.valid()) why = findings(check, "").front().text;
            sound += check.valid();
            reached += check.valid() && result.reached;
            longest = std::max(longest, seconds);
            total += seconds;
            const double clearance = 100 * check.clearance / box_diagonal(mesh);
            std::cout << "| " << Path(file).filename().string() << " | " << mesh.number_of_vertices() << " | " << wanted << " | "
                      << result.cage.number_of_vertices() << " | " << (check.valid() ? "yes" : "no: " + why) << " | "
                      << check.genus << " | " << fixed(clearance, 3) << " | " << fixed(seconds, 2) << " |\n"
                      << std::flush;
            rows += Path(file).filename().string() + ',' + std::to_string(mesh.number_of_vertices()) + ',' +
                    std::to_string(wanted) + ',' + std::to_string(result.cage.number_of_vertices()) + ',' +
                    (check.valid() ? "1" : "0") + ',' + std::to_string(check.genus) + ',' + std::to_string(shape.genus) + ',' +
                    fixed(result.alpha, 4) + ',' + fixed(clearance, 4) + ',' + fixed(seconds, 3) + ",\"" + why + "\"\n";
        }
    }
    std::cout << "\n"
              << sound << " of " << tried << " sound, " << reached << " with the wanted number of vertices; processor time "
              << fixed(tried == 0 ? 0 : total / static_cast<double>(tried), 2) << " s in the mean, at most " << fixed(longest, 2)
              << " s\n";
    if (!options.csv.empty()) write_file(options.csv, rows);
}

}  // namespace ostraka::experiments

// Cages of many meshes: how many are valid, their resolution, and the time.
#include "harness.h"

#include "ostraka/cage/cage.h"
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"

#include <algorithm>

namespace ostraka::experiments {

namespace {

struct CageTableOptions {
    std::vector<std::string> meshes;
    std::vector<int> vertices{100, 200, 500};
    std::string csv;
    void list_options(OptionList& list) {
        list("meshes", meshes, "closed meshes; open ones are left out").positional().required();
        list("vertices", vertices, "wanted numbers of vertices", Range{4, 1e6});
        list("csv", csv, "file for the raw rows");
    }
};

void cages(const CageTableOptions& options) {
    Rows rows("mesh,mesh vertices,wanted,vertices,valid,genus,mesh genus,alpha,clearance,seconds,why not");
    Table table("mesh | vertices | wanted | cage | sound | genus | clearance, % of the diagonal | s");
    std::size_t sound = 0, reached = 0;
    std::vector<double> times;
    for (const std::string& file : options.meshes) {
        const std::string name = Path(file).filename().string();
        Mesh mesh;
        try {
            mesh = read_mesh(file).mesh;
        } catch (const Error& error) {
            table.row("{} | not read: {} | | | | | |", name, error.problem());
            continue;
        }
        const CageCheck shape = check_cage(mesh, Mesh());
        if (!shape.closed) {
            table.row("{} | open, left out | | | | | |", name);
            continue;
        }
        for (const int wanted : options.vertices) {
            CageResult result;
            std::string why;
            const Stopwatch watch;
            try {
                result = make_cage(mesh, {.vertices = static_cast<std::uint64_t>(wanted)});
            } catch (const Error& error) {
                why = error.problem();
            }
            times.push_back(watch.seconds().processor);
            const CageCheck check = check_cage(result.cage, mesh);
            if (why.empty() && !result.reached) why = "fewer vertices were not reached";
            if (why.empty() && !check.valid()) why = findings(check, "").front().text;
            sound += check.valid();
            reached += check.valid() && result.reached;
            const double clearance = 100 * check.clearance / box_diagonal(mesh);
            table.row("{} | {} | {} | {} | {} | {} | {:.3f} | {:.2f}", name, mesh.number_of_vertices(), wanted,
                      result.cage.number_of_vertices(), check.valid() ? "yes" : "no: " + why, check.genus, clearance,
                      times.back());
            rows(name, mesh.number_of_vertices(), wanted, result.cage.number_of_vertices(), check.valid(), check.genus,
                 shape.genus, result.alpha, clearance, times.back(), why);
        }
    }
    const auto [mean, max] = mean_and_max(times);
    fmt::print("\n{} of {} sound, {} with the wanted number of vertices; processor time {:.2f} s in the mean, at most {:.2f} s\n",
               sound, times.size(), reached, mean, max);
    rows.write(options.csv);
}

const Registration registered("cages", "cages of many meshes: how many are sound, and how long they take", cages);

}  // namespace

}  // namespace ostraka::experiments

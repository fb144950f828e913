// Figures 6.1 and 6.2 of the thesis: edits through cages, and how well cages can satisfy constraints.
#include "experiments.h"

#include "coloured_mesh.h"
#include "report.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/semantic/deform.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <numeric>

namespace ostraka::experiments {

namespace {

/// Name of a file in tables: up to the first dot.
std::pair<std::string, std::string> named(const std::string& file) {
    const std::string name = Path(file).filename().string();
    return {name.substr(0, name.find('.')), file};
}

std::string deviations(const ConstraintReport& report, bool before) {
    std::string text;
    for (std::size_t i = 0; i < report.deviations.size(); ++i) {
        const Deviation& d = report.deviations[i];
        text += (i > 0 ? ", " : "") + format("%.3g ", before ? report.before_values.at(i) : d.value.value_or(-1)) + d.unit;
    }
    return text.empty() ? report.text : text;
}

struct SpaceVariant {
    std::string name, about;
    std::string space;
    double spread;
};
/// With a short spread, regions of the cage without constraints stay fixed.
const std::vector<SpaceVariant> variants{{"by-mesh", "mesh", "mesh", DeformOptions().spread},
                                         {"by-cage", "cage", "cage", DeformOptions().spread},
                                         {"by-held-cage", "cage, spread 0.03", "cage", 0.03}};

}  // namespace

void cage_reach(const CageReachOptions& options) {
    const Path folder(options.output);
    std::filesystem::create_directories(folder);
    const Mesh mesh = read_mesh(options.mesh).mesh;
    const AnnotationSet set = read_annotations(options.annotations, mesh);
    const RelationGraph graph = read_graph(options.graph, set);
    const double diagonal = box_diagonal(mesh);
    std::string text =
                    "| edit | cage | control points | solved over | constraint: after the edit -> solved | solved - edited, mean "
                    "(most), % of the diagonal | s |\n|---|---|---|---|---|---|---|\n",
                rows =
                    "edit,cage,cage_vertices,control_points,space,spread,seconds,relationship,quantity,before,after,tolerance,"
                    "unit,verdict,mean_moved,max_moved\n";
    for (const std::string& edit_item : options.edits) {
        const auto [edit_name, edit_file] = named(edit_item);
        const Edit edit = edit_from_json(read_json(edit_file), edit_file);
        for (const std::string& cage_item : options.cages) {
            const auto [cage_name, cage_file] = named(cage_item);
            const Mesh cage = read_mesh(cage_file).mesh;
            const Coordinates coordinates = compute_coordinates("mean-value", cage, mesh);
            const HandleSpace space{mesh, set, &cage, &coordinates};
            const std::vector<EditState> states = follow_edit(edit, space, edit_file);
            const long handles = std::count(states.back().touched.begin(), states.back().touched.end(), true);
            const std::string stem = edit_name + '-' + cage_name + '-';
            for (const SpaceVariant& way : variants) {
                DeformOptions deforming;
                set_option(deforming, "space", way.space);
                deforming.spread = way.spread;
                deforming.conflicts = false;
                deforming.solve.iterations = options.iterations;
                const Stopwatch watch;
                const DeformResult result = deform(space, graph, edit, edit_file, deforming);
                const double seconds = watch.seconds().wall;
                const std::vector<double> lengths = displacements(result.edited, result.points);
                const double mean = std::accumulate(lengths.begin(), lengths.end(), 0.0) / static_cast<double>(lengths.size()),
                             maximum = *std::max_element(lengths.begin(), lengths.end());
                std::string how;
                for (const ConstraintReport& constraint : result.constraints) {
                    how += (how.empty() ? "" : "; ") + std::to_string(constraint.id) + ": " + deviations(constraint, true) +
                           " -> " + deviations(constraint, false) + ", " + to_string(constraint.verdict);
                    for (std::size_t i = 0; i < constraint.deviations.size(); ++i) {
                        const Deviation& d = constraint.deviations[i];
                        rows += edit_name + ',' + cage_name + format(",%u,%ld,", cage.number_of_vertices(), handles) + way.space +
                                format(",%g,%.4g,%d,", way.spread, seconds, constraint.id) + d.quantity +
                                format(",%.6g,%.6g,%.6g,", constraint.before_values.at(i), d.value.value_or(-1),
                                       d.tolerance.value_or(-1)) +
                                d.unit + ',' + to_string(constraint.verdict) + format(",%.6g,%.6g\n", mean, maximum);
                    }
                }
                text += "| " + edit_name + " | " + cage_name + format(" | %ld of %u | ", handles, cage.number_of_vertices()) +
                        way.about + " | " + how +
                        format(" | %.3f (%.2f) | %.2f |\n", 100 * mean / diagonal, 100 * maximum / diagonal, seconds);
                write_coloured(folder / (stem + way.name + ".ply"), with_points(mesh, result.points), lengths);
                if (way.space == "cage") write_mesh(folder / (stem + way.name + "-cage.ply"), with_points(cage, result.cage));
                if (&way == &variants.front())
                    write_coloured(folder / (stem + "edited.ply"), with_points(mesh, result.edited),
                                   displacements(ostraka::points_of(mesh), result.edited));
            }
        }
    }
    write_file(folder / "table.md", text);
    write_file(folder / "table.csv", rows);
    std::cout << text;
}

}  // namespace ostraka::experiments

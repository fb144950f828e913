// Figures 6.1 and 6.2 of the thesis: edits through cages, and how well cages can satisfy constraints.
#include "harness.h"
#include "scenes.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/semantic/deform.h"

#include <algorithm>

namespace ostraka::experiments {

namespace {

struct CageReachOptions {
    std::string mesh, annotations, graph, output = "experiments-output/figures-6-1-6-2";
    std::vector<std::string> edits, cages;
    int iterations = 100;
    void list_options(OptionList& list) {
        list("mesh", mesh, "mesh file").positional().required();
        list("annotations", annotations, "annotations of the mesh (.ant.json)").positional().required();
        list("graph", graph, "relationships, some of them constraints").positional().required();
        list("edit", edits, "files of edits, NAME.edit.json").required();
        list("cage", cages, "files of cages, NAME.ply").required();
        list("iterations", iterations, "maximum number of iterations", Range{1, 100000});
        list("output", output, "output folder");
    }
};

struct SpaceVariant {
    std::string name, about, space;
    double spread;
};
/// With a short spread, regions of the cage without constraints stay fixed.
const std::vector<SpaceVariant> variants{{"by-mesh", "mesh", "mesh", DeformOptions().spread},
                                         {"by-cage", "cage", "cage", DeformOptions().spread},
                                         {"by-held-cage", "cage, spread 0.03", "cage", 0.03}};

/// Name of a file in tables: up to the first dot.
std::string name_of_file(const std::string& file) {
    const std::string name = Path(file).filename().string();
    return name.substr(0, name.find('.'));
}

/// "ID: before -> after, verdict".
std::string constraint_text(const ConstraintReport& report) {
    std::string before, after;
    for (std::size_t i = 0; i < report.deviations.size(); ++i) {
        const Deviation& d = report.deviations[i];
        const char* comma = i > 0 ? ", " : "";
        before += fmt::format("{}{:.3g} {}", comma, report.before_values.at(i), d.unit);
        after += fmt::format("{}{:.3g} {}", comma, d.value.value_or(-1), d.unit);
    }
    if (before.empty()) before = after = report.text;
    return fmt::format("{}: {} -> {}, {}", report.id, before, after, to_string(report.verdict));
}

void cage_reach(const CageReachOptions& options) {
    const Path folder(options.output);
    const Mesh mesh = read_mesh(options.mesh).mesh;
    const AnnotationSet set = read_annotations(options.annotations, mesh);
    const RelationGraph graph = read_graph(options.graph, set);
    const double diagonal = box_diagonal(mesh);
    Table table(
        "edit | cage | control points | solved over | constraint: after the edit -> solved | solved - edited, mean (most), % of "
        "the diagonal | s");
    Rows rows(
        "edit,cage,cage_vertices,control_points,space,spread,seconds,relationship,quantity,before,after,tolerance,unit,verdict,"
        "mean_moved,max_moved");
    for (const std::string& edit_file : options.edits) {
        const std::string edit_name = name_of_file(edit_file);
        const Edit edit = edit_from_json(read_json(edit_file), edit_file);
        for (const std::string& cage_file : options.cages) {
            const std::string cage_name = name_of_file(cage_file);
            const Mesh cage = read_mesh(cage_file).mesh;
            const Coordinates coordinates = compute_coordinates("mean-value", cage, mesh);
            const HandleSpace space{{mesh, set}, &cage, &coordinates};
            const std::vector<bool> touched = follow_edit(edit, space, edit_file).back().touched;
            const auto handles = std::count(touched.begin(), touched.end(), true);
            const std::string stem = edit_name + '-' + cage_name + '-';
            for (const SpaceVariant& variant : variants) {
                DeformOptions deforming;
                set_option(deforming, "space", variant.space);
                deforming.spread = variant.spread;
                deforming.conflicts = false;
                deforming.solve.iterations = options.iterations;
                const Stopwatch watch;
                const DeformResult result = deform(space, graph, edit, edit_file, deforming);
                const double seconds = watch.seconds().wall;
                const std::vector<double> lengths = displacements(result.edited, result.points);
                const auto [mean, max] = mean_and_max(lengths);
                std::string texts;
                for (const ConstraintReport& report : result.constraints) {
                    texts += (texts.empty() ? "" : "; ") + constraint_text(report);
                    for (std::size_t i = 0; i < report.deviations.size(); ++i) {
                        const Deviation& d = report.deviations[i];
                        rows(edit_name, cage_name, cage.number_of_vertices(), handles, variant.space, variant.spread, seconds,
                             report.id, d.quantity, report.before_values.at(i), d.value.value_or(-1), d.tolerance.value_or(-1),
                             d.unit, to_string(report.verdict), mean, max);
                    }
                }
                table.row("{} | {} | {} of {} | {} | {} | {:.3f} ({:.2f}) | {:.2f}", edit_name, cage_name, handles,
                          cage.number_of_vertices(), variant.about, texts, 100 * mean / diagonal, 100 * max / diagonal, seconds);
                write_coloured(folder / (stem + variant.name + ".ply"), with_points(mesh, result.points), lengths);
                if (variant.space == "cage")
                    write_mesh(folder / (stem + variant.name + "-cage.ply"), with_points(cage, result.cage));
                if (&variant == &variants.front())
                    write_coloured(folder / (stem + "edited.ply"), with_points(mesh, result.edited),
                                   displacements(ostraka::points_of(mesh), result.edited));
            }
        }
    }
    write_file(folder / "table.md", table.text());
    rows.write(folder / "table.csv");
}

const Registration registered("cage-reach", "how near cages come to what constraints ask for (figures 6.1, 6.2)", cage_reach);

}  // namespace

}  // namespace ostraka::experiments

// Figure 5.11 of the thesis: the cage vertices that are control points of each annotation, by level. Figures 6.1 and 6.2: edits
// through cages, and how well cages can satisfy constraints.
#include "harness.h"
#include "scenes.h"

#include "ostraka/coords/coordinate_file.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/coords/influence.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/relation/topology.h"
#include "ostraka/semantic/deform.h"
#include "ostraka/semantic/edit.h"

#include <algorithm>
#include <map>

namespace ostraka::experiments {

namespace {

struct ControlPointOptions : AnnotatedOptions {
    ControlPointOptions() { output = "experiments-output/figures-5-11-5-12"; }
    std::string cage, weights;
    double threshold = 0.4;
    void declare_options(OptionList& list) {
        AnnotatedOptions::declare_options(list);
        list("cage", cage, "cage of the mesh").positional().required();
        list("weights", weights, "file of 'ostraka cage weights'").positional().required();
        list("threshold", threshold, "min influence of a control point", Range{0, 1});
    }
};

/// For each cage vertex, the number of annotations of one level of which it is a control point, and its colour: that of the
/// annotation, black for none, white for several.
struct Owners {
    std::vector<int> count;
    std::vector<Colour> colours;
    explicit Owners(std::size_t vertices) : count(vertices, 0), colours(vertices, Colour{40, 40, 40, 255}) {}
    void add(const std::vector<Index>& vertices, const Annotation& annotation) {
        const auto channel = [&](std::size_t i) { return static_cast<std::uint8_t>(annotation.colour[i]); };
        for (const Index v : vertices)
            colours[v] = count[v]++ > 0 ? Colour{255, 255, 255, 255} : Colour{channel(0), channel(1), channel(2), 255};
    }
    [[nodiscard]] long with(int min, int max) const {
        return std::count_if(count.begin(), count.end(), [&](int n) { return n >= min && n <= max; });
    }
};

void control_points(const ControlPointOptions& options) {
    const Path folder(options.output);
    const auto [mesh, set] = options.read();
    const Mesh cage = read_mesh(options.cage).mesh;
    const Coordinates coordinates = read_coordinates(options.weights, mesh, cage);
    const std::vector<std::pair<std::string, double>> rules{{fmt::format("{:g}", options.threshold), options.threshold},
                                                            {"auto-mesh", influence_threshold(coordinates.vertex, "auto-mesh")},
                                                            {"auto-cage", influence_threshold(coordinates.vertex, "auto-cage")}};
    std::string columns = "level | annotation | vertices";
    for (const auto& [rule, threshold] : rules) columns += fmt::format(" | {} ({:.4f})", rule, threshold);
    const std::string title = fmt::format("Figure 5.11: control points, mesh of {} vertices, cage of {}.\n\n",
                                          mesh.number_of_vertices(), cage.number_of_vertices());
    fmt::print("{}", title);
    Table table(columns + " | auto-mesh of the part | auto-cage of the part");
    Rows rows("level,annotation,vertices,rule,threshold,control_points");
    std::map<std::size_t, std::vector<Owners>> levels;
    for (const TreeEntry& entry : containment_tree(topology({mesh, set}).order)) {
        const Annotation& annotation = set.annotations[entry.annotation];
        if (annotation.faces.empty()) continue;
        const std::vector<Index> vertices = vertices_of(mesh, annotation);
        auto& owners = levels.try_emplace(entry.depth, rules.size(), Owners(cage.number_of_vertices())).first->second;
        std::string cells = fmt::format("{} | {} | {}", entry.depth, annotation.tag, vertices.size());
        const auto column = [&](const std::string& rule, double threshold, Owners* of_level) {
            const std::vector<Index> points = influential(coordinates, vertices, threshold);
            cells += fmt::format(" | {}", points.size()) + (of_level != nullptr ? "" : fmt::format(" ({:.4f})", threshold));
            rows(entry.depth, annotation.tag, vertices.size(), rule, threshold, points.size());
            if (of_level != nullptr) of_level->add(points, annotation);
        };
        for (std::size_t i = 0; i < rules.size(); ++i) column(rules[i].first, rules[i].second, &owners[i]);
        for (const std::string rule : {"auto-mesh", "auto-cage"})
            column(rule + " of the part", influence_threshold(coordinates.vertex, rule, vertices), nullptr);
        table.add(cells);
    }
    fmt::print("\n");
    Table sums("level | rule | of no annotation | of one | of several");
    Rows sum_rows("level,rule,threshold,of_none,of_one,of_several");
    for (const auto& [level, owners] : levels)
        for (std::size_t i = 0; i < rules.size(); ++i) {
            const auto& [rule, threshold] = rules[i];
            const long none = owners[i].with(0, 0), single = owners[i].with(1, 1), several = owners[i].with(2, 1 << 30);
            sums.row("{} | {} | {} | {} | {}", level, rule, none, single, several);
            sum_rows(level, rule, threshold, none, single, several);
            MeshExtras extras;
            extras.vertex_colours = owners[i].colours;
            write_mesh(folder / fmt::format("level-{}-{}.ply", level, rule), cage, extras);
        }
    write_file(folder / "control-points.md", title + table.text() + "\n" + sums.text());
    rows.write(folder / "control-points.csv");
    sum_rows.write(folder / "levels.csv");
}

const Registration registered_points("control-points", "control points of annotations, level by level (figure 5.11)",
                                     control_points);

struct CageReachOptions : AnnotatedOptions {
    CageReachOptions() { output = "experiments-output/figures-6-1-6-2"; }
    std::string graph;
    std::vector<std::string> edits, cages;
    int iterations = 100;
    void declare_options(OptionList& list) {
        AnnotatedOptions::declare_options(list);
        list("graph", graph, "relationships, some of them constraints").positional().required();
        list("edit", edits, "files of edits, NAME.edit.json").required();
        list("cage", cages, "files of cages, NAME.ply").required();
        list("iterations", iterations, "maximum number of iterations", Range{1, 100000});
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
    const auto [mesh, set] = options.read();
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

const Registration registered_reach("cage-reach", "how near cages come to what constraints ask for (figures 6.1, 6.2)",
                                    cage_reach);

}  // namespace

}  // namespace ostraka::experiments

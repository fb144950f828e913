// Figure 5.11 of the thesis: the cage vertices that are control points of each annotation, by level.
#include "harness.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/coords/coordinate_file.h"
#include "ostraka/coords/influence.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/relation/topology.h"
#include "ostraka/semantic/edit.h"

#include <algorithm>
#include <map>

namespace ostraka::experiments {

namespace {

struct ControlPointOptions {
    std::string mesh, annotations, cage, weights, output = "experiments-output/figures-5-11-5-12";
    double threshold = 0.4;
    void list_options(OptionList& list) {
        list("mesh", mesh, "mesh file").positional().required();
        list("annotations", annotations, "annotations of the mesh (.ant.json)").positional().required();
        list("cage", cage, "cage of the mesh").positional().required();
        list("weights", weights, "file of 'ostraka cage weights'").positional().required();
        list("threshold", threshold, "min influence of a control point", Range{0, 1});
        list("output", output, "output folder");
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
    const Mesh mesh = read_mesh(options.mesh).mesh, cage = read_mesh(options.cage).mesh;
    const AnnotationSet set = read_annotations(options.annotations, mesh);
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
            const long none = owners[i].with(0, 0), one = owners[i].with(1, 1), several = owners[i].with(2, 1 << 30);
            sums.row("{} | {} | {} | {} | {}", level, rule, none, one, several);
            sum_rows(level, rule, threshold, none, one, several);
            MeshExtras extras;
            extras.vertex_colours = owners[i].colours;
            write_mesh(folder / fmt::format("level-{}-{}.ply", level, rule), cage, extras);
        }
    write_file(folder / "control-points.md", title + table.text() + "\n" + sums.text());
    rows.write(folder / "control-points.csv");
    sum_rows.write(folder / "levels.csv");
}

const Registration registered("control-points", "control points of annotations, level by level (figure 5.11)", control_points);

}  // namespace

}  // namespace ostraka::experiments

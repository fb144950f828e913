// Figure 5.11 of the thesis: the cage vertices that are control points of each annotation, by level.
#include "experiments.h"

#include "report.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/coords/coordinate_file.h"
#include "ostraka/coords/influence.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/relation/topology.h"
#include "ostraka/semantic/edit.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>

namespace ostraka::experiments {

namespace {

constexpr Colour nobody{40, 40, 40, 255}, several_mark{255, 255, 255, 255};

struct Rule {
    std::string name;
    double threshold;
};

/// For each cage vertex, the number of annotations of one level of which it is a control point, and its colour: that of the
/// annotation, black for none, white for several.
struct Owners {
    std::vector<int> count;
    std::vector<Colour> colours;
    explicit Owners(std::size_t vertices) : count(vertices, 0), colours(vertices, nobody) {}
    void add(const std::vector<Index>& vertices, const Annotation& annotation) {
        const auto channel = [&](int i) { return static_cast<std::uint8_t>(annotation.colour[static_cast<std::size_t>(i)]); };
        for (const Index v : vertices)
            colours[v] = count[v]++ > 0 ? several_mark : Colour{channel(0), channel(1), channel(2), 255};
    }
    [[nodiscard]] long of(int minimum, int maximum) const {
        return std::count_if(count.begin(), count.end(), [&](int n) { return n >= minimum && n <= maximum; });
    }
};

}  // namespace

void control_points(const ControlPointOptions& options) {
    const Path folder(options.output);
    std::filesystem::create_directories(folder);
    const Mesh mesh = read_mesh(options.mesh).mesh, cage = read_mesh(options.cage).mesh;
    const AnnotationSet set = read_annotations(options.annotations, mesh);
    const Coordinates coordinates = read_coordinates(options.weights, mesh, cage);
    const std::vector<Rule> rules{{format("%g", options.threshold), options.threshold},
                                  {"auto-mesh", influence_threshold(coordinates.vertex, "auto-mesh")},
                                  {"auto-cage", influence_threshold(coordinates.vertex, "auto-cage")}};

    std::map<std::size_t, std::vector<Owners>> levels;
    std::string table = "| level | annotation | vertices |", rule_line = "|---|---|---|",
                rows = "level,annotation,vertices,rule,threshold,control_points\n";
    for (const Rule& rule : rules) {
        table += ' ' + rule.name + format(" (%.4f) |", rule.threshold);
        rule_line += "---|";
    }
    table += " auto-mesh of the part | auto-cage of the part |\n" + rule_line + "---|---|\n";
    for (const TreeEntry& entry : containment_tree(topology(mesh, set).order)) {
        const Annotation& annotation = set.annotations[entry.annotation];
        if (annotation.faces.empty()) continue;
        const std::vector<Index> vertices = vertices_of(mesh, annotation);
        auto& owners = levels.try_emplace(entry.depth, rules.size(), Owners(cage.number_of_vertices())).first->second;
        table += format("| %zu | ", entry.depth) + annotation.tag + format(" | %zu |", vertices.size());
        const auto column = [&](const std::string& rule, double threshold, Owners* of_level) {
            const std::vector<Index> points = influential(coordinates, vertices, threshold);
            table += of_level != nullptr ? format(" %zu |", points.size()) : format(" %zu (%.4f) |", points.size(), threshold);
            rows += format("%zu,\"", entry.depth) + annotation.tag + format("\",%zu,", vertices.size()) + rule +
                    format(",%.6g,%zu\n", threshold, points.size());
            if (of_level != nullptr) of_level->add(points, annotation);
        };
        for (std::size_t i = 0; i < rules.size(); ++i) column(rules[i].name, rules[i].threshold, &owners[i]);
        for (const std::string rule : {"auto-mesh", "auto-cage"})
            column(rule + " of the part", influence_threshold(coordinates.vertex, rule, vertices), nullptr);
        table += '\n';
    }

    std::string sums = "\n| level | rule | of no annotation | of one | of several |\n|---|---|---|---|---|\n",
                sum_rows = "level,rule,threshold,of_none,of_one,of_several\n";
    for (const auto& [level, owners] : levels)
        for (std::size_t i = 0; i < rules.size(); ++i) {
            const long none = owners[i].of(0, 0), one = owners[i].of(1, 1), several = owners[i].of(2, 1 << 30);
            sums += format("| %zu | ", level) + rules[i].name + format(" | %ld | %ld | %ld |\n", none, one, several);
            sum_rows +=
                format("%zu,", level) + rules[i].name + format(",%.6g,%ld,%ld,%ld\n", rules[i].threshold, none, one, several);
            MeshExtras extras;
            extras.vertex_colours = owners[i].colours;
            write_mesh(folder / (format("level-%zu-", level) + rules[i].name + ".ply"), cage, extras);
        }
    const std::string text = format("Figure 5.11: control points, mesh of %u vertices, cage of %u.\n\n",
                                    mesh.number_of_vertices(), cage.number_of_vertices()) +
                             table + sums;
    write_file(folder / "control-points.md", text);
    write_file(folder / "control-points.csv", rows);
    write_file(folder / "levels.csv", sum_rows);
    std::cout << text;
}

}  // namespace ostraka::experiments

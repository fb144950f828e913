// How far each annotation moves from one shape of a mesh to others.
#include "experiments.h"

#include "coloured_mesh.h"
#include "report.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"

#include <algorithm>
#include <filesystem>
#include <iostream>

namespace ostraka::experiments {

void moved(const MovedOptions& options) {
    const Path folder(options.output);
    std::filesystem::create_directories(folder);
    const Mesh mesh = read_mesh(options.mesh).mesh;
    const AnnotationSet set = read_annotations(options.annotations, mesh);
    const std::vector<Point> rest = ostraka::points_of(mesh);
    const double diagonal = box_diagonal(mesh);
    std::vector<std::vector<double>> ways;
    double farthest = 0;
    std::string head = "| annotation |", rule = "|---|", rows = "annotation,shape,mean,max,max_of_diagonal\n";
    for (const std::string& file : options.shapes) {
        const Mesh shape = read_mesh(file).mesh;
        if (shape.number_of_vertices() != mesh.number_of_vertices())
            fail_input(file, "has another number of vertices than " + options.mesh);
        ways.push_back(displacements(rest, ostraka::points_of(shape)));
        farthest = std::max(farthest, *std::max_element(ways.back().begin(), ways.back().end()));
        head += ' ' + Path(file).stem().string() + ": mean (most), % of the diagonal |";
        rule += "---|";
    }
    for (std::size_t i = 0; i < ways.size(); ++i)
        write_coloured(folder / (Path(options.shapes[i]).stem().string() + "-moved.ply"), read_mesh(options.shapes[i]).mesh,
                       ways[i], farthest);
    std::string body;
    for (const Annotation& annotation : set.annotations) {
        if (annotation.faces.empty()) continue;
        const std::vector<Index> vertices = touched_vertices(mesh, annotation);
        body += "| " + annotation.tag + " |";
        for (std::size_t i = 0; i < ways.size(); ++i) {
            double sum = 0, maximum = 0;
            for (const Index v : vertices) sum += ways[i][v], maximum = std::max(maximum, ways[i][v]);
            const double mean = sum / static_cast<double>(vertices.size());
            body += format(" %.3f (%.3f) |", 100 * mean / diagonal, 100 * maximum / diagonal);
            rows += '"' + annotation.tag + "\",\"" + Path(options.shapes[i]).stem().string() +
                    format("\",%.6g,%.6g,%.6g\n", mean, maximum, maximum / diagonal);
        }
        body += '\n';
    }
    const std::string text = "How far vertices move from " + Path(options.mesh).filename().string() +
                             format("; colours of the meshes from 0 to %.4g.\n\n", farthest) + head + '\n' + rule + '\n' + body;
    write_file(folder / "moved.md", text);
    write_file(folder / "moved.csv", rows);
    std::cout << text;
}

}  // namespace ostraka::experiments

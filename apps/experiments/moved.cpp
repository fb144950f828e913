// Displacement of each annotation between one shape of a mesh and others.
#include "experiments.h"

#include "coloured_mesh.h"
#include "report.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/core/error.h"
#include "ostraka/core/json.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/io/mesh_file.h"

#include <algorithm>
#include <filesystem>
#include <iostream>

namespace ostraka::experiments {

namespace {

Motion motion_of(const JsonValue& matrix) {
    Motion motion;
    for (rapidjson::SizeType i = 0; i < 3; ++i)
        for (rapidjson::SizeType j = 0; j < 4; ++j)
            (j < 3 ? motion.rotation(i, j) : motion.translation(i)) = matrix[i][j].GetDouble();
    return motion;
}

/// Pose of the single fragment of a fit, from the fragment's frame.
Motion laid(const std::string& file) {
    const Json assembly = read_json(file);
    const auto fragments = list_in(assembly, "fragments");
    const JsonValue* pose = fragments.Size() == 1 ? find_member(fragments[0], "pose") : nullptr;
    if (pose == nullptr) fail_input(file, "is no assembly of one fragment that has a pose");
    return motion_of(*pose);
}

/// Writes the fitted shape and the placed fragment as one coloured mesh.
void write_laid(const Path& file, const Mesh& shape, Mesh fragment, const Motion& motion) {
    for (const Vertex v : fragment.vertices()) fragment.point(v) = point_of(motion(eigen(fragment.point(v))));
    Mesh both = shape;
    both.join(fragment);
    MeshExtras extras;
    extras.vertex_colours.assign(both.number_of_vertices(), Colour{150, 175, 205, 255});
    std::fill(extras.vertex_colours.begin() + shape.number_of_vertices(), extras.vertex_colours.end(), Colour{205, 90, 60, 255});
    write_mesh(file, both, extras);
}

}  // namespace

void moved(const MovedOptions& options) {
    const Path folder(options.output);
    std::filesystem::create_directories(folder);
    const Mesh mesh = read_mesh(options.mesh).mesh;
    const AnnotationSet set = read_annotations(options.annotations, mesh);
    std::vector<Point> rest = ostraka::points_of(mesh);
    std::vector<std::string> shapes = options.shapes;
    if (!options.fit.empty()) {
        const Motion motion = laid((Path(options.fit) / "fit.assembly.json").string());
        const Motion broken = options.pose.empty() ? Motion() : motion_of(read_json(options.pose));
        const Motion from_rest = motion.after(broken.inverse());
        for (Point& p : rest) p = point_of(from_rest(eigen(p)));
        shapes = {(Path(options.fit) / "completed.ply").string()};
        if (!options.fragment.empty())
            write_laid(folder / "laid.ply", read_mesh(shapes[0]).mesh, read_mesh(options.fragment).mesh, motion);
    }
    if (shapes.empty()) fail_usage("no shapes are given", "give mesh files, or --fit");
    const double diagonal = box_diagonal(mesh);
    std::vector<std::vector<double>> ways;
    double farthest = 0;
    std::string head = "| annotation |", rule = "|---|", rows = "annotation,shape,mean,max,max_of_diagonal\n";
    for (const std::string& file : shapes) {
        const Mesh shape = read_mesh(file).mesh;
        if (shape.number_of_vertices() != mesh.number_of_vertices())
            fail_input(file, "has another number of vertices than " + options.mesh);
        ways.push_back(displacements(rest, ostraka::points_of(shape)));
        farthest = std::max(farthest, *std::max_element(ways.back().begin(), ways.back().end()));
        head += ' ' + Path(file).stem().string() + ": mean (most), % of the diagonal |";
        rule += "---|";
    }
    for (std::size_t i = 0; i < ways.size(); ++i)
        write_coloured(folder / (Path(shapes[i]).stem().string() + "-moved.ply"), read_mesh(shapes[i]).mesh, ways[i], farthest);
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
            rows += '"' + annotation.tag + "\",\"" + Path(shapes[i]).stem().string() +
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

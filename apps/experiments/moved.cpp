// Displacement of each annotation between one shape of a mesh and others.
#include "harness.h"
#include "scenes.h"

#include "ostraka/coords/coordinates.h"
#include "ostraka/core/error.h"
#include "ostraka/files/json.h"
#include "ostraka/fracture/fragment.h"
#include "ostraka/io/mesh_file.h"

#include <algorithm>

namespace ostraka::experiments {

namespace {

struct MovedOptions : AnnotatedOptions {
    MovedOptions() { output = "experiments-output/moved"; }
    std::string fit, pose, fragment;
    std::vector<std::string> shapes;
    void declare_options(OptionList& list) {
        AnnotatedOptions::declare_options(list);
        list("shapes", shapes, "mesh files with the same vertices").positional();
        list("fit", fit,
             "instead of shapes: folder of 'ostraka fit --no-join' for a fragment of the mesh; its completed.ply is the shape, "
             "and "
             "the shape at rest is moved to the frame in which the fragment was placed");
        list("pose", pose, "file of 'ostraka mesh break --pose-out', if the fragment was moved");
        list("fragment", fragment, "mesh file of the fragment: laid.ply shows where it was placed");
    }
};

/// Pose of the single fragment of a fit, from the fragment's frame.
Motion placed(const std::string& file) {
    const Json assembly = read_json(file);
    const auto fragments = list_in(assembly, "fragments");
    const JsonValue* pose = fragments.Size() == 1 ? find_member(fragments[0], "pose") : nullptr;
    if (pose == nullptr) fail_input(file, "is no assembly of one fragment that has a pose");
    return motion_of(*pose);
}

/// Writes the fitted shape and the placed fragment as one coloured mesh.
void write_placed(const Path& file, const Mesh& shape, const Mesh& fragment) {
    Mesh both = shape;
    both.join(fragment);
    MeshExtras extras;
    extras.vertex_colours.assign(both.number_of_vertices(), Colour{150, 175, 205, 255});
    std::fill(extras.vertex_colours.begin() + shape.number_of_vertices(), extras.vertex_colours.end(), Colour{205, 90, 60, 255});
    write_mesh(file, both, extras);
}

void moved_annotations(const MovedOptions& options) {
    const Path folder(options.output), fit(options.fit);
    const auto [mesh, set] = options.read();
    std::vector<Point> rest = ostraka::points_of(mesh);
    std::vector<std::string> shapes = options.shapes;
    if (options.fit.empty() == shapes.empty()) fail_usage("the shapes are not clear", "give either mesh files or --fit");
    if (!options.fit.empty()) {
        const Motion motion = placed((fit / "fit.assembly.json").string());
        const Motion broken = options.pose.empty() ? Motion() : motion_of(read_json(options.pose));
        rest = warped(rest, motion.after(broken.inverse()));
        shapes = {(fit / "completed.ply").string()};
        if (!options.fragment.empty())
            write_placed(folder / "laid.ply", read_mesh(shapes[0]).mesh, moved(read_mesh(options.fragment).mesh, motion));
    }
    const double diagonal = box_diagonal(mesh);
    std::vector<std::vector<double>> lengths;
    std::vector<std::string> names;
    double farthest = 0;
    std::string columns = "annotation";
    for (const std::string& file : shapes) {
        const Mesh shape = read_mesh(file).mesh;
        if (shape.number_of_vertices() != mesh.number_of_vertices())
            fail_input(file, "has another number of vertices than " + options.mesh);
        lengths.push_back(displacements(rest, ostraka::points_of(shape)));
        farthest = std::max(farthest, mean_and_max(lengths.back()).max);
        names.push_back(Path(file).stem().string());
        columns += fmt::format(" | {}: mean (most), % of the diagonal", names.back());
    }
    for (std::size_t i = 0; i < shapes.size(); ++i)
        write_coloured(folder / (names[i] + "-moved.ply"), read_mesh(shapes[i]).mesh, lengths[i], farthest);
    const std::string title = fmt::format("How far vertices move from {}; colours of the meshes from 0 to {:.4g}.\n\n",
                                          Path(options.mesh).filename().string(), farthest);
    fmt::print("{}", title);
    Table table(columns);
    Rows rows("annotation,shape,mean,max,max_of_diagonal");
    for (const Annotation& annotation : set.annotations) {
        if (annotation.faces.empty()) continue;
        const std::vector<Index> vertices = touched_vertices(mesh, annotation);
        std::string cells = annotation.tag;
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            const auto [mean, max] = mean_and_max(lengths[i], vertices);
            cells += fmt::format(" | {:.3f} ({:.3f})", 100 * mean / diagonal, 100 * max / diagonal);
            rows(annotation.tag, names[i], mean, max, max / diagonal);
        }
        table.add(cells);
    }
    write_file(folder / "moved.md", title + table.text());
    rows.write(folder / "moved.csv");
}

const Registration registered("moved", "how far each annotation moves from one shape of a mesh to others", moved_annotations);

}  // namespace

}  // namespace ostraka::experiments

#include "coloured_mesh.h"

#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/render/colour_scale.h"

#include <cmath>

namespace ostraka::experiments {

std::vector<double> displacements(const std::vector<Point>& from, const std::vector<Point>& to) {
    if (from.size() != to.size()) fail_usage("the shapes have different numbers of vertices");
    std::vector<double> lengths;
    lengths.reserve(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) lengths.push_back(std::sqrt(CGAL::squared_distance(from[i], to[i])));
    return lengths;
}

void write_coloured(const Path& file, const Mesh& mesh, const std::vector<double>& values, std::optional<double> maximum) {
    const ColourScale scale = maximum ? ColourScale{0, *maximum, false, ""} : scale_of({&values}, file.string());
    MeshExtras extras;
    for (const double value : values) {
        const Rgb c = colour_of(scale, value);
        extras.vertex_colours.push_back({c.red, c.green, c.blue, 255});
    }
    WriteOptions options;
    options.vertex_quality = values;
    write_mesh(file, mesh, extras, options);
}

}  // namespace ostraka::experiments

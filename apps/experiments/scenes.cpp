#include "scenes.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/geodesic.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/measure.h"
#include "ostraka/remesh/refine.h"
#include "ostraka/remesh/remesh.h"
#include "ostraka/remesh/simplify.h"
#include "ostraka/render/colour_scale.h"
#include "ostraka/synthetic/make_mesh.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace ostraka::experiments {

using Eigen::Vector3d;

std::string size_name(std::size_t vertices) {
    return vertices % 1000000 == 0 ? fmt::format("{}M", vertices / 1000000)
           : vertices % 1000 == 0  ? fmt::format("{}K", vertices / 1000)
                                   : std::to_string(vertices);
}

Mesh made_mesh(const std::string& object, std::uint64_t vertices, std::uint64_t seed) {
    return make_mesh(synthetic_object(object), {.vertices = vertices, .seed = seed}).mesh;
}

Mesh read_or_make(const std::string& source, std::uint64_t vertices, std::uint64_t seed) {
    return source.starts_with("made:") ? made_mesh(source.substr(5), vertices, seed) : read_mesh(source).mesh;
}

Mesh simplified(Mesh mesh, std::uint64_t vertices) {
    SimplifyOptions options;
    options.vertices = vertices;
    if (mesh.number_of_vertices() > vertices) simplify(mesh, options);
    return mesh;
}

Mesh refined(Mesh mesh, std::uint64_t vertices) {
    RefineOptions options;
    options.scheme = RefineOptions::Scheme::loop;
    options.levels = 1;
    while (mesh.number_of_vertices() < vertices) refine(mesh, options);
    return mesh;
}

Mesh remeshed(const Mesh& mesh, std::uint64_t vertices) {
    RemeshOptions options;
    options.vertices = vertices;
    return remesh(mesh, options).mesh;
}

std::pair<std::string, std::string> split_pair(const std::string& pair) {
    const auto at = pair.find('=');
    if (at == std::string::npos) fail_usage(fmt::format("'{}' is no pair", pair), "write TEMPLATE=MEMBER");
    return {pair.substr(0, at), pair.substr(at + 1)};
}

std::vector<Index> disc(const Mesh& mesh, Vertex seed, double share) {
    const std::vector<double> distance = edge_distances(mesh, {{seed, 0.0}});
    std::vector<std::pair<double, Index>> order;
    for (const Face f : mesh.faces()) {
        double sum = 0;
        for (const Vertex v : corners(mesh, f)) sum += distance[v];
        order.emplace_back(sum, f);
    }
    std::sort(order.begin(), order.end());
    std::vector<Index> faces;
    double area = 0;
    const double wanted = share * surface_area(mesh);
    for (auto place = order.begin(); place != order.end() && area < wanted; ++place) {
        area += face_area(mesh, Face(place->second));
        faces.push_back(place->second);
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

std::vector<Index> spread_out(const Mesh& mesh, const std::vector<Index>& among, std::size_t count) {
    std::vector<double> off(among.size(), std::numeric_limits<double>::infinity());
    Vector3d last = Vector3d::Zero();
    for (const Point& p : mesh.points()) last += eigen(p) / static_cast<double>(mesh.number_of_vertices());
    std::vector<Index> chosen;
    while (chosen.size() < std::min(count, among.size())) {
        std::size_t farthest = 0;
        for (std::size_t i = 0; i < among.size(); ++i) {
            const double d = (eigen(mesh.point(Vertex(among[i]))) - last).norm();
            off[i] = chosen.empty() ? d : std::min(off[i], d);
            if (off[i] > off[farthest]) farthest = i;
        }
        if (chosen.empty()) std::fill(off.begin(), off.end(), std::numeric_limits<double>::infinity());
        chosen.push_back(among[farthest]);
        last = eigen(mesh.point(Vertex(among[farthest])));
    }
    return chosen;
}

std::vector<Index> all_vertices(const Mesh& mesh) {
    std::vector<Index> vertices(mesh.number_of_vertices());
    std::iota(vertices.begin(), vertices.end(), Index(0));
    return vertices;
}

const Annotation& tagged(const AnnotationSet& set, const std::string& tag) {
    for (const Annotation& annotation : set.annotations)
        if (annotation.tag == tag) return annotation;
    fail_input(tag, "no annotation has this tag", "see the recipe of the experiment");
}

Subject AnnotatedOptions::read() const {
    Mesh shape = read_mesh(mesh).mesh;
    AnnotationSet set = read_annotations(annotations, shape);
    return {{std::move(shape), std::move(set)}};
}

Annotation landmark(int id, const std::string& tag, Index vertex) {
    Annotation point;
    point.id = id;
    point.tag = tag;
    point.type = AnnotationType::point;
    point.points = {vertex};
    return point;
}

Relationship constraint(int id, const std::string& type, std::vector<int> members, const std::string& parameters, double weight) {
    Relationship r;
    r.id = id;
    r.type = type;
    r.annotations = std::move(members);
    r.is_constraint = true;
    r.weight = weight;
    r.constraint = parameters;
    return r;
}

double add_height(const Mesh& mesh, Annotation& part, const std::string& name) {
    Measure height;
    height.tool = "bounding";
    height.direction = {0, 0, 1};
    height.unit = "mm";
    for (const Index pin : extremes(mesh, part, *height.direction)) height.points.push_back(pin);
    height.value = evaluate(mesh, part, height);
    part.attributes.push_back({50, name, height});
    return *height.value;
}

double degrees_of(const Motion& motion) { return 180 / std::numbers::pi * Eigen::AngleAxisd(motion.rotation).angle(); }

double off_of(const Mesh& mesh, const Motion& motion) {
    double squares = 0;
    for (const Vertex v : mesh.vertices()) squares += (motion(eigen(mesh.point(v))) - eigen(mesh.point(v))).squaredNorm();
    return std::sqrt(squares / static_cast<double>(mesh.number_of_vertices()));
}

std::vector<Point> mesh_points(const Eigen::Matrix3Xd& columns) {
    std::vector<Point> points;
    for (Eigen::Index i = 0; i < columns.cols(); ++i) points.push_back(point_of(columns.col(i)));
    return points;
}

std::vector<double> displacements(const std::vector<Point>& from, const std::vector<Point>& to) {
    if (from.size() != to.size()) fail_usage("the shapes have different numbers of vertices");
    std::vector<double> lengths;
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
    extras.vertex_values.push_back({"quality", values});
    write_mesh(file, mesh, extras);
}

}  // namespace ostraka::experiments

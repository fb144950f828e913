#include "lower.h"

#include "reader.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka::semantic {

namespace {

using Eigen::Vector3d;

std::vector<int> ids_of(const std::vector<Index>& vertices) { return {vertices.begin(), vertices.end()}; }

/// The vertex of an annotation that stands for its place: nearest to the mean of its vertices on its plane (section 5.2.1).
Index reference_vertex(const Points& rest, const std::vector<Index>& vertices) {
    Vector3d mean = Vector3d::Zero();
    for (const Index v : vertices) mean += rest.col(v);
    mean /= static_cast<double>(vertices.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Index v : vertices) spread += (rest.col(v) - mean) * (rest.col(v) - mean).transpose();
    const Vector3d normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
    Index best = vertices.front();
    double least = std::numeric_limits<double>::infinity();
    for (const Index v : vertices) {
        const Vector3d d = rest.col(v) - mean;
        const double off = (d - normal * normal.dot(d)).squaredNorm();
        if (off < least) least = off, best = v;
    }
    return best;
}

/// Vertices of a region that other faces use as well: where it joins the rest.
std::vector<Index> joint(const Mesh& mesh, const Annotation& annotation) {
    std::vector<bool> inside(mesh.number_of_faces(), false);
    for (const Index f : annotation.faces) inside[f] = true;
    std::set<Index> list;
    for (const Index f : annotation.faces)
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(Face(f)))) {
            const Face other = mesh.face(mesh.opposite(h));
            if (other != Mesh::null_face() && !inside[other]) list.insert({mesh.target(h).idx(), mesh.source(h).idx()});
        }
    return {list.begin(), list.end()};
}

Lowered keep_shape(const Reader& read) {
    read.need(1, 0);
    const bool similar = read.word("mode", "rigid", {"rigid", "similar"}) == "similar";
    Lowered result;
    for (std::size_t i = 0; i < read.relationship().annotations.size(); ++i)
        result.constraints.push_back(read.make(similar ? "Similarity" : "Rigid", ids_of(read.vertices(i)), {}));
    return result;
}

Lowered same_level(const Reader& read) {
    read.need(2, 0);
    Lowered result;
    ConstraintParameters level;
    level.direction = read.up();
    const bool shapes = read.word("shapes", "keep", {"keep", "free"}) == "keep";
    // The thesis takes a reference vertex of each part, whose place on the part is as fine as the mesh: at rest such vertices are
    // not on one level themselves. Means of parts are.
    const bool means = read.word("reference", "mean", {"mean", "vertex"}) == "mean";
    std::vector<int> references;
    for (std::size_t i = 0; i < read.relationship().annotations.size(); ++i) {
        const auto vertices = read.vertices(i);
        if (means) {
            for (const Index v : vertices) {
                references.push_back(static_cast<int>(v));
                level.stations.push_back(static_cast<int>(i));
            }
        } else {
            references.push_back(static_cast<int>(reference_vertex(read.shape().rest, vertices)));
        }
        if (shapes && vertices.size() > 1) result.constraints.push_back(read.make("Rigid", ids_of(vertices), {}));
    }
    result.constraints.push_back(read.make(means ? "MeansOnLevel" : "Orientation", references, level));
    return result;
}

Lowered co_planarity(const Reader& read) {
    read.need(1, 0);
    std::set<Index> all;
    for (std::size_t i = 0; i < read.relationship().annotations.size(); ++i)
        for (const Index v : read.vertices(i)) all.insert(v);
    Lowered result;
    result.constraints.push_back(read.make("Plane", {all.begin(), all.end()}, {}));
    return result;
}

Lowered co_linearity(const Reader& read) {
    read.need(1, 0);
    std::set<Index> all;
    for (std::size_t i = 0; i < read.relationship().annotations.size(); ++i)
        for (const Index v : read.vertices(i)) all.insert(v);
    Lowered result;
    result.constraints.push_back(read.make("Line", {all.begin(), all.end()}, {}));
    return result;
}

Lowered proportion(const Reader& read) {
    read.need(2, 2);
    const Range range = read.range();
    const Pins first = pins_of(read, read.measure("measure1", read.member(0)));
    const Pins second = pins_of(read, read.measure("measure2", read.member(1)));
    std::vector<Index> part = read.vertices(0);
    ConstraintParameters parameters;
    const auto place = [&](Index v, std::size_t end) {
        const auto found = std::find(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(end), v);
        if (found != part.begin() + static_cast<std::ptrdiff_t>(end)) return static_cast<int>(found - part.begin());
        part.push_back(v);
        return static_cast<int>(part.size() - 1);
    };
    for (const Index v : {first.from, first.to})
        if (std::find(part.begin(), part.end(), v) == part.end()) part.push_back(v);
    parameters.split = static_cast<int>(part.size());
    parameters.min = range.min;
    parameters.max = range.max;
    parameters.direction = first.direction;
    parameters.second_direction = second.direction;
    parameters.pins = {place(first.from, part.size()), place(first.to, part.size())};
    // It stretches from where it joins the rest.
    Lowered result;
    result.anchors = joint(read.shape().mesh, read.member(0));
    for (const Index v : result.anchors) parameters.anchors.push_back(place(v, part.size()));
    parameters.pins.push_back(place(second.from, part.size()));
    parameters.pins.push_back(place(second.to, part.size()));
    result.constraints.push_back(read.make("Proportion", ids_of(part), parameters));
    return result;
}

Lowered keep_measure(const Reader& read) {
    read.need(1, 1);
    const Range range = read.range();
    const Pins pins = pins_of(read, read.measure("measure", read.member(0)));
    if (pins.direction) read.fail("a bounding measure cannot be kept by itself", "take a ruler, or state a proportion");
    ConstraintParameters parameters;
    parameters.min = range.min;
    parameters.max = range.max;
    parameters.absolute = true;
    Lowered result;
    result.constraints.push_back(read.make("EdgeStrain", {static_cast<int>(pins.from), static_cast<int>(pins.to)}, parameters));
    return result;
}

Lowered co_axiality(const Reader& read) {
    read.need(2, 2);
    Lowered result;
    const auto axis = [&](std::size_t i) {
        if (read.member(i).faces.empty())
            read.fail("annotation " + std::to_string(read.member(i).id) + " is no region", "use regions");
        const Axis found = find_axis(read.shape().mesh, read.member(i).faces);
        if (!found.found)
            read.fail("annotation " + std::to_string(read.member(i).id) + " has no axis: " + found.reason,
                      "use another relation");
        return found;
    };
    const Axis moved = axis(0), reference = axis(1);
    ConstraintParameters parameters;
    parameters.direction = eigen(reference.direction);
    parameters.point = eigen(reference.point);
    parameters.rest_direction = eigen(moved.direction);
    parameters.rest_point = eigen(moved.point);
    result.constraints.push_back(read.make("CoAxiality", ids_of(read.vertices(0)), parameters));
    return result;
}

Lowered structural_continuity(const Reader& read) {
    const auto [segment, reference] = continuity_of(read);
    ConstraintParameters parameters;
    parameters.direction = eigen(reference.direction);
    parameters.point = eigen(reference.point);
    parameters.stations = segment.stations;
    Lowered result;
    result.constraints.push_back(read.make("AxisOnLine", segment.vertices, parameters));
    return result;
}

using Lowering = Lowered (*)(const Reader&);
const std::map<std::string, Lowering>& table() {
    static const std::map<std::string, Lowering> rows{
        {"keep shape", keep_shape},     {"same level", same_level},
        {"co-planarity", co_planarity}, {"co-linearity", co_linearity},
        {"proportion", proportion},     {"keep measure", keep_measure},
        {"co-axiality", co_axiality},   {"structural continuity", structural_continuity},
    };
    return rows;
}

}  // namespace

Points columns_of(const Mesh& mesh) {
    Points points(3, static_cast<Eigen::Index>(mesh.number_of_vertices()));
    for (const Vertex v : mesh.vertices()) points.col(v.idx()) = eigen(mesh.point(v));
    return points;
}

Lowered lower(const Shape& shape, const Relationship& relationship, const std::string& where) {
    const auto row = table().find(relationship.type);
    if (row == table().end()) return {};
    return row->second(Reader(shape, relationship, where));
}

}  // namespace ostraka::semantic

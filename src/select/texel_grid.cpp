#include "select/texel_grid.h"

#include "ostraka/core/memory.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/measure/surface_colour.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// Builds the division of a face: n parts an edge, `finer[k]` times as many nodes along the edge from corner k.
class DivisionBuilder {
public:
    DivisionBuilder(Index n, const std::array<Index, 3>& finer) : n_(n), finer_(finer) { made_.n = n; }

    FaceDivision build() {
        for (Index j = 0; j <= n_; ++j)
            for (Index i = 0; i + j <= n_; ++i) add_grid_node(i, j);
        for (Index j = 0; j < n_; ++j)
            for (Index i = 0; i + j < n_; ++i) {
                made_.cell_begin.push_back(static_cast<Index>(made_.triangles.size()));
                add_upper(i, j);
                made_.cell_begin.push_back(static_cast<Index>(made_.triangles.size()));
                if (i + j + 2 <= n_) made_.triangles.push_back({grid(i + 1, j), grid(i + 1, j + 1), grid(i, j + 1)});
            }
        made_.cell_begin.push_back(static_cast<Index>(made_.triangles.size()));
        return std::move(made_);
    }

private:
    [[nodiscard]] Index grid(Index i, Index j) const { return j * (n_ + 1) - j * (j - 1) / 2 + i; }

    Index add(const std::array<double, 3>& weights, int place, Index index) {
        made_.nodes.push_back({weights, place, index});
        return static_cast<Index>(made_.nodes.size() - 1);
    }

    void add_grid_node(Index i, Index j) {
        const double count = n_;
        const std::array<double, 3> weights{(count - i - j) / count, i / count, j / count};
        if (i == 0 && j == 0) add(weights, 0, 0);
        else if (i == n_) add(weights, 1, 0);
        else if (j == n_) add(weights, 2, 0);
        else if (j == 0) add(weights, 3, i * finer_[0]);
        else if (i + j == n_) add(weights, 4, j * finer_[1]);
        else if (i == 0) add(weights, 5, (n_ - j) * finer_[2]);
        else add(weights, 6, made_.inner++);
    }

    /// Adds the nodes of the finer neighbour along a part of the edge from corner k.
    void add_finer(std::vector<Index>& polygon, std::size_t k, Index part) {
        const double count = double(n_) * finer_[k];
        for (Index step = 1; step < finer_[k]; ++step) {
            const Index index = part * finer_[k] + step;
            std::array<double, 3> weights{0, 0, 0};
            weights[k] = (count - index) / count;
            weights[(k + 1) % 3] = index / count;
            polygon.push_back(add(weights, 3 + static_cast<int>(k), index));
        }
    }

    void add_upper(Index i, Index j) {
        std::vector<Index> polygon{grid(i, j)};
        if (j == 0) add_finer(polygon, 0, i);
        polygon.push_back(grid(i + 1, j));
        if (i + j + 1 == n_) add_finer(polygon, 1, j);
        polygon.push_back(grid(i, j + 1));
        if (i == 0) add_finer(polygon, 2, n_ - j - 1);
        if (polygon.size() == 3) {
            made_.triangles.push_back({polygon[0], polygon[1], polygon[2]});
            return;
        }
        const double count = 3.0 * n_;
        const Index centre =
            add({(count - 3.0 * (i + j) - 2) / count, (3.0 * i + 1) / count, (3.0 * j + 1) / count}, 6, made_.inner++);
        for (std::size_t k = 0; k < polygon.size(); ++k)
            made_.triangles.push_back({polygon[k], polygon[(k + 1) % polygon.size()], centre});
    }

    Index n_;
    std::array<Index, 3> finer_;
    FaceDivision made_;
};

double longest_edge(const Mesh& mesh, Face face) {
    double longest = 0;
    for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(face)))
        longest = std::max(longest, CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h))));
    return std::sqrt(longest);
}

/// The halfedge of a face from corner k to the next corner.
std::array<Halfedge, 3> sides(const Mesh& mesh, Face face) {
    const Halfedge first = mesh.next(mesh.halfedge(face));
    return {first, mesh.next(first), mesh.next(mesh.next(first))};
}

}  // namespace

TexelGrid::TexelGrid(const Mesh& mesh, double spacing) : mesh_(mesh), spacing_(spacing) {
    divide(spacing);
    number();
    connect();
}

void TexelGrid::divide(double spacing) {
    std::vector<double> lengths(mesh_.number_of_faces());
    parallel_for(lengths.size(), 4096, [&](std::size_t f) { lengths[f] = longest_edge(mesh_, Face(static_cast<Index>(f))); });
    face_log_.resize(lengths.size());
    const double top = std::log2(double(max_edge_divisions));
    for (;; spacing *= std::sqrt(2.0)) {
        double nodes = 0;
        for (std::size_t f = 0; f < lengths.size(); ++f) {
            const double parts = spacing > 0 && lengths[f] > 0 ? std::log2(lengths[f] / spacing) : 0;
            face_log_[f] = static_cast<std::uint8_t>(std::lround(std::clamp(parts, 0.0, top)));
            nodes += 0.5 * std::ldexp(1.0, 2 * face_log_[f]);
        }
        spacing_ = spacing;
        const bool coarsest = std::all_of(face_log_.begin(), face_log_.end(), [](std::uint8_t log) { return log == 0; });
        if (nodes <= max_grid_nodes || coarsest) break;
    }
    edge_log_.assign(mesh_.number_of_edges(), 0);
    for (const Face face : mesh_.faces())
        for (const Halfedge h : sides(mesh_, face)) {
            auto& log = edge_log_[mesh_.edge(h)];
            log = std::max(log, face_log_[face]);
        }
}

void TexelGrid::number() {
    division_.resize(mesh_.number_of_faces());
    for (const Face face : mesh_.faces()) {
        std::array<std::uint8_t, 4> key{face_log_[face], 0, 0, 0};
        std::array<Index, 3> finer{};
        const auto side = sides(mesh_, face);
        for (std::size_t k = 0; k < 3; ++k) {
            key[k + 1] = static_cast<std::uint8_t>(edge_log_[mesh_.edge(side[k])] - face_log_[face]);
            finer[k] = Index{1} << key[k + 1];
        }
        auto found = divisions_.find(key);
        if (found == divisions_.end())
            found = divisions_.emplace(key, DivisionBuilder(Index{1} << face_log_[face], finer).build()).first;
        division_[face] = &found->second;
    }
    size_ = mesh_.number_of_vertices();
    edge_begin_.reserve(mesh_.number_of_edges());
    for (const Edge edge : mesh_.edges()) {
        edge_begin_.push_back(static_cast<Index>(size_));
        size_ += edge_divisions(edge) - 1;
    }
    face_begin_.reserve(mesh_.number_of_faces());
    for (const Face face : mesh_.faces()) {
        face_begin_.push_back(static_cast<Index>(size_));
        size_ += division_[face]->inner;
    }
    require_memory(60.0 * static_cast<double>(size_), "a grid at the resolution of the image", "reduce the image");
}

Index TexelGrid::node_on_edge(Edge edge, Index position) const {
    const Halfedge h = mesh_.halfedge(edge, 0);
    if (position == 0) return mesh_.source(h);
    if (position == edge_divisions(edge)) return mesh_.target(h);
    return edge_begin_[edge] + position - 1;
}

void TexelGrid::nodes_of(Face face, std::vector<Index>& numbers) const {
    const FaceDivision& division = *division_[face];
    const auto corner = corners(mesh_, face);
    const auto side = sides(mesh_, face);
    numbers.resize(division.nodes.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const FaceDivision::Node& node = division.nodes[i];
        if (node.place == 6) {
            numbers[i] = face_begin_[face] + node.index;
        } else if (node.place < 3) {
            numbers[i] = corner[static_cast<std::size_t>(node.place)];
        } else {
            const Halfedge h = side[static_cast<std::size_t>(node.place - 3)];
            const Edge edge = mesh_.edge(h);
            numbers[i] = node_on_edge(edge, mesh_.halfedge(edge, 0) == h ? node.index : edge_divisions(edge) - node.index);
        }
    }
}

void TexelGrid::connect() {
    std::vector<Index> numbers;
    area_.assign(size_, 0);
    neighbour_begin_.assign(size_ + 1, 0);
    // Each triangle adds to each corner the next one; along the border of the mesh the other direction is added too.
    const auto border_parts = [&](const auto& use) {
        for (const Edge edge : mesh_.edges()) {
            const Halfedge h = mesh_.halfedge(edge, 0);
            if (!mesh_.is_border(h) && !mesh_.is_border(mesh_.opposite(h))) continue;
            for (Index i = 0; i < edge_divisions(edge); ++i) {
                const Index a = node_on_edge(edge, i), b = node_on_edge(edge, i + 1);
                if (mesh_.is_border(h)) use(a, b);  // the face on the other side adds b, a
                else use(b, a);
            }
        }
    };
    for (const Face face : mesh_.faces()) {
        nodes_of(face, numbers);
        const FaceDivision& division = *division_[face];
        const double whole = face_area(mesh_, face);
        const auto share = [&](const std::array<Index, 3>& t) {
            const auto &a = division.nodes[t[0]].weights, &b = division.nodes[t[1]].weights, &c = division.nodes[t[2]].weights;
            return std::abs((b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]));
        };
        for (const auto& triangle : division.triangles) {
            const auto third = static_cast<float>(whole * share(triangle) / 3);
            for (const Index node : triangle) {
                area_[numbers[node]] += third;
                ++neighbour_begin_[numbers[node] + 1];
            }
        }
    }
    border_parts([&](Index a, Index) { ++neighbour_begin_[a + 1]; });
    for (std::size_t i = 0; i < size_; ++i) neighbour_begin_[i + 1] += neighbour_begin_[i];
    neighbour_.resize(neighbour_begin_.back());
    std::vector<std::size_t> next(neighbour_begin_.begin(), neighbour_begin_.end() - 1);
    for (const Face face : mesh_.faces()) {
        nodes_of(face, numbers);
        for (const auto& triangle : division_[face]->triangles)
            for (std::size_t k = 0; k < 3; ++k) neighbour_[next[numbers[triangle[k]]]++] = numbers[triangle[(k + 1) % 3]];
    }
    border_parts([&](Index a, Index b) { neighbour_[next[a]++] = b; });
}

std::size_t TexelGrid::triangle_at(Face face, const std::array<double, 3>& weights) const {
    const FaceDivision& division = *division_[face];
    const Index n = division.n;
    const double x = std::clamp(weights[1], 0.0, 1.0) * n, y = std::clamp(weights[2], 0.0, 1.0) * n;
    const auto row = std::min(static_cast<Index>(y), n - 1), column = std::min(static_cast<Index>(x), n - 1 - row);
    const bool lower = x - column + (y - row) > 1 && column + row + 2 <= n;
    const std::size_t cell = 2 * std::size_t{row * n - row * (row - 1) / 2 + column} + (lower ? 1 : 0);
    const Index begin = division.cell_begin[cell], end = division.cell_begin[cell + 1];
    // In a fan: the triangle in which the smallest barycentric weight of the point is largest.
    std::size_t best = begin;
    double best_inside = -2;
    for (Index t = begin; t < end && end - begin > 1; ++t) {
        const auto& [i, j, k] = division.triangles[t];
        const auto &a = division.nodes[i].weights, &b = division.nodes[j].weights, &c = division.nodes[k].weights;
        const auto cross = [](const auto& p, const auto& q, const auto& r) {
            return (q[1] - p[1]) * (r[2] - p[2]) - (q[2] - p[2]) * (r[1] - p[1]);
        };
        const double whole = cross(a, b, c);
        const double inside =
            std::min({cross(a, b, weights) / whole, cross(b, c, weights) / whole, cross(c, a, weights) / whole});
        if (inside > best_inside) best = t, best_inside = inside;
    }
    return best;
}

Index TexelGrid::nearest_node(Face face, const std::array<double, 3>& weights) const {
    const FaceDivision& division = *division_[face];
    std::vector<Index> numbers;
    nodes_of(face, numbers);
    const auto [a, b, c] = corners(mesh_, face);
    const auto place = [&](const std::array<double, 3>& w) {
        return CGAL::ORIGIN + (w[0] * (mesh_.point(a) - CGAL::ORIGIN) + w[1] * (mesh_.point(b) - CGAL::ORIGIN) +
                               w[2] * (mesh_.point(c) - CGAL::ORIGIN));
    };
    const Point wanted = place(weights);
    Index best = no_index;
    double distance = std::numeric_limits<double>::infinity();
    for (const Index node : division.triangles[triangle_at(face, weights)]) {
        const double d = CGAL::squared_distance(place(division.nodes[node].weights), wanted);
        if (d < distance) best = numbers[node], distance = d;
    }
    return best == no_index ? Index{a} : best;
}

SurfacePoint TexelGrid::between(Face face, Index a, Index b, const std::vector<Index>& numbers, double share) const {
    if (numbers[a] > numbers[b]) std::swap(a, b);
    const FaceDivision& division = *division_[face];
    const FaceDivision::Node &from = division.nodes[a], &to = division.nodes[b];
    const auto side = sides(mesh_, face);
    const auto on_side = [](const FaceDivision::Node& node, int k) {
        return node.place == 3 + k || node.place == k || node.place == (k + 1) % 3;
    };
    for (int k = 0; k < 3; ++k) {
        if (!on_side(from, k) || !on_side(to, k)) continue;
        const Halfedge h = side[static_cast<std::size_t>(k)];
        const Edge edge = mesh_.edge(h);
        const Index count = edge_divisions(edge);
        const bool along = mesh_.halfedge(edge, 0) == h;
        const auto position = [&](const FaceDivision::Node& node) {
            const Index index = node.place == k ? 0 : node.place < 3 ? count : node.index;
            return double(along ? index : count - index);
        };
        const double at = position(from) + share * (position(to) - position(from));
        const Halfedge first = mesh_.halfedge(edge, 0);
        return ordered_edge_point(mesh_.source(first), mesh_.target(first), at / count);
    }
    std::array<double, 3> weights{};
    for (std::size_t k = 0; k < 3; ++k) weights[k] = from.weights[k] + share * (to.weights[k] - from.weights[k]);
    return stored_point(mesh_, face_point(face, weights));
}

namespace {

float plus(float a, float b) { return a + b; }
float scaled(float a, float s) { return a * s; }
LabNode plus(const LabNode& a, const LabNode& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
LabNode scaled(const LabNode& a, float s) { return {a[0] * s, a[1] * s, a[2] * s}; }

}  // namespace

template <class Value>
void TexelGrid::blur(std::vector<Value>& values, int rounds) const {
    std::vector<Value> next(rounds > 0 ? values.size() : 0);
    for (int round = 0; round < rounds; ++round) {
        parallel_for(values.size(), 16384, [&](std::size_t i) {
            const auto [begin, end] = neighbours(i);
            Value sum{};
            for (const Index* j = begin; j != end; ++j) sum = plus(sum, values[*j]);
            next[i] =
                begin == end ? values[i] : plus(scaled(values[i], 0.5F), scaled(sum, 0.5F / static_cast<float>(end - begin)));
        });
        std::swap(values, next);
    }
}
template void TexelGrid::blur(std::vector<float>&, int) const;
template void TexelGrid::blur(std::vector<LabNode>&, int) const;

namespace {

/// Root of the area of the faces with an image per texel; 0 without an image.
double texel_size(const Mesh& mesh, const MeshExtras& extras, const SurfaceColour& surface) {
    if (extras.face_materials.empty() || extras.corner_texture.empty()) return 0;
    double area = 0, texels = 0;
    for (const Face face : mesh.faces()) {
        const auto size = surface.image_size(extras.face_materials[face]);
        if (size[0] == 0) continue;
        const auto* corner = &extras.corner_texture[3 * static_cast<std::size_t>(face)];
        const auto along = [&](std::size_t k, std::size_t axis) {
            return static_cast<double>(corner[k][axis]) - static_cast<double>(corner[0][axis]);
        };
        area += face_area(mesh, face);
        texels += 0.5 * std::abs(along(1, 0) * along(2, 1) - along(1, 1) * along(2, 0)) * size[0] * size[1];
    }
    return texels > 0 ? std::sqrt(area / texels) : 0;
}

double spacing_of(const Mesh& mesh, const MeshExtras& extras, const SurfaceColour& surface) {
    const double texel = texel_size(mesh, extras, surface);
    if (texel > 0) return texel;
    return mean_edge_length(mesh) / (extras.vertex_colours.empty() && !extras.face_colours.empty() ? 6 : 2);
}

/// Reads the colours of nodes; those on edges and vertices as means over the faces around them, a little within each face.
class NodeColours {
public:
    NodeColours(const TexelGrid& grid, const SurfaceColour& surface, double texel)
        : grid_(grid), mesh_(grid.mesh()), surface_(surface), width_(grid.spacing() > 1.5 * texel ? grid.spacing() : 0) {}

    std::vector<LabNode> read() const {
        std::vector<LabNode> lab(grid_.size(), LabNode{0, 0, 0});
        parallel_for(mesh_.number_of_vertices(), 1024, [&](std::size_t i) {
            const Vertex vertex(static_cast<Index>(i));
            if (mesh_.is_isolated(vertex)) return;
            Sum sum;
            for (const Halfedge h : CGAL::halfedges_around_target(vertex, mesh_)) {
                if (mesh_.is_border(h)) continue;
                const Face face = mesh_.face(h);
                const auto corner = corners(mesh_, face);
                std::array<double, 3> weights{};
                for (std::size_t k = 0; k < 3; ++k) weights[k] = corner[k] == vertex ? 1 : 0;
                add(sum, face, weights);
            }
            lab[i] = sum.lab();
        });
        parallel_for(mesh_.number_of_edges(), 1024, [&](std::size_t e) { read_edge(Edge(static_cast<Index>(e)), lab); });
        parallel_for(mesh_.number_of_faces(), 256, [&](std::size_t f) {
            const Face face(static_cast<Index>(f));
            std::vector<Index> numbers;
            grid_.nodes_of(face, numbers);
            const auto& nodes = grid_.division(face).nodes;
            for (std::size_t i = 0; i < nodes.size(); ++i) {
                if (nodes[i].place != 6) continue;
                Sum sum;
                sum.add(surface_.at(face, nodes[i].weights, width_), 1);
                lab[numbers[i]] = sum.lab();
            }
        });
        return lab;
    }

private:
    struct Sum {
        std::array<double, 3> light{};
        double weight = 0;
        void add(const std::array<float, 3>& colour, double w) {
            for (std::size_t k = 0; k < 3; ++k) light[k] += w * static_cast<double>(colour[k]);
            weight += w;
        }
        [[nodiscard]] LabNode lab() const {
            if (!(weight > 0)) return {0, 0, 0};
            const Lab lab = lab_from_linear({static_cast<float>(light[0] / weight), static_cast<float>(light[1] / weight),
                                             static_cast<float>(light[2] / weight)});
            return {static_cast<float>(lab[0]), static_cast<float>(lab[1]), static_cast<float>(lab[2])};
        }
    };

    void add(Sum& sum, Face face, std::array<double, 3> weights) const {
        const double inward = std::min(0.3, 1.0 / grid_.division(face).n);
        for (double& w : weights) w += inward * (1.0 / 3 - w);
        sum.add(surface_.at(face, weights, width_), std::max(face_area(mesh_, face), 1e-300));
    }

    void read_edge(Edge edge, std::vector<LabNode>& lab) const {
        const Index count = grid_.edge_divisions(edge);
        for (Index position = 1; position < count; ++position) {
            Sum sum;
            for (const int side : {0, 1}) {
                const Halfedge h = mesh_.halfedge(edge, static_cast<unsigned>(side));
                if (mesh_.is_border(h)) continue;
                const Face face = mesh_.face(h);
                const auto corner = corners(mesh_, face);
                const Halfedge first = mesh_.halfedge(edge, 0);
                const double share = double(position) / count;
                std::array<double, 3> weights{};
                for (std::size_t k = 0; k < 3; ++k)
                    weights[k] = corner[k] == mesh_.source(first) ? 1 - share : corner[k] == mesh_.target(first) ? share : 0;
                add(sum, face, weights);
            }
            lab[grid_.node_on_edge(edge, position)] = sum.lab();
        }
    }

    const TexelGrid& grid_;
    const Mesh& mesh_;
    const SurfaceColour& surface_;
    double width_;
};

}  // namespace

TexelColours::TexelColours(const Mesh& mesh, const MeshExtras& extras, const std::string& where)
    : TexelColours(mesh, extras, SurfaceColour(mesh, extras, where)) {}

TexelColours::TexelColours(const Mesh& mesh, const MeshExtras& extras, const SurfaceColour& surface)
    : grid(mesh, spacing_of(mesh, extras, surface)), lab(NodeColours(grid, surface, spacing_of(mesh, extras, surface)).read()) {}

}  // namespace ostraka

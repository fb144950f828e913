#include "transfer/face_parts.h"

#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <utility>

namespace ostraka {

namespace {

constexpr std::size_t block_size = 16384;

/// Concurrent union-find over faces: each face points to a lower one of its set, the lowest to itself.
class FaceSets {
public:
    explicit FaceSets(std::size_t count) : parent_(count) {
        for (std::size_t i = 0; i < count; ++i) parent_[i] = static_cast<Index>(i);
    }
    [[nodiscard]] Index lowest(Index face) {
        for (;;) {
            const Index parent = load(face);
            if (parent == face) return face;
            const Index next = load(parent);
            // Path halving for later searches; concurrent stores lead to the same root.
            if (next != parent) std::atomic_ref(parent_[face]).store(next, std::memory_order_relaxed);
            face = next;
        }
    }
    void unite(Index a, Index b) {
        for (;;) {
            a = lowest(a);
            b = lowest(b);
            if (a == b) return;
            if (a < b) std::swap(a, b);
            Index expected = a;
            if (std::atomic_ref(parent_[a]).compare_exchange_strong(expected, b, std::memory_order_relaxed)) return;
        }
    }

private:
    [[nodiscard]] Index load(Index face) { return std::atomic_ref(parent_[face]).load(std::memory_order_relaxed); }

    std::vector<Index> parent_;
};

}  // namespace

double edge_length(const Mesh& mesh, Halfedge h) {
    return std::sqrt(CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h))));
}

FaceParts::FaceParts(const Mesh& mesh, std::vector<Edge> walls) : mesh_(mesh), part_(mesh.number_of_faces()) {
    std::sort(walls.begin(), walls.end());
    walls.erase(std::unique(walls.begin(), walls.end()), walls.end());
    number(walls);
    measure();
    std::map<std::pair<Index, Index>, std::size_t> between;
    for (const Edge e : walls) {
        const Halfedge h = mesh.halfedge(e, 0), g = mesh.halfedge(e, 1);
        if (!mesh.is_border(h) && !mesh.is_border(g)) ++between[std::minmax({part_at(h), part_at(g)})];
    }
    links_.resize(areas_.size());
    for (const auto& [parts, edges] : between) {
        links_[parts.first].push_back({parts.second, edges});
        links_[parts.second].push_back({parts.first, edges});
    }
}

Index FaceParts::part_at(Halfedge h) const { return part_[mesh_.face(h)]; }

void FaceParts::number(const std::vector<Edge>& walls) {
    std::vector<bool> is_wall(mesh_.number_of_edges(), false);
    for (const Edge e : walls) is_wall[e] = true;
    FaceSets sets(part_.size());
    std::vector<std::vector<Halfedge>> border((is_wall.size() + block_size - 1) / block_size);
    parallel_for(is_wall.size(), block_size, [&](std::size_t i) {
        const Edge e(static_cast<Index>(i));
        const Halfedge h = mesh_.halfedge(e, 0), g = mesh_.halfedge(e, 1);
        const Face a = mesh_.face(h), b = mesh_.face(g);
        if (a == Mesh::null_face() || b == Mesh::null_face()) border[i / block_size].push_back(a == Mesh::null_face() ? h : g);
        else if (!is_wall[i]) sets.unite(a, b);
    });
    for (const auto& part : border) border_.insert(border_.end(), part.begin(), part.end());
    parallel_for(part_.size(), block_size, [&](std::size_t f) { part_[f] = sets.lowest(static_cast<Index>(f)); });
    // The lowest face of a part precedes all its others.
    for (std::size_t f = 0; f < part_.size(); ++f) {
        if (part_[f] == f) {
            part_[f] = static_cast<Index>(begin_.size());
            begin_.push_back(0);
        } else {
            part_[f] = part_[part_[f]];
        }
        ++begin_[part_[f]];
    }
    Index sum = 0;
    for (Index& begin : begin_) sum += std::exchange(begin, sum);
    begin_.push_back(sum);
    std::vector<Index> next = begin_;
    faces_.resize(part_.size());
    for (std::size_t f = 0; f < part_.size(); ++f) faces_[next[part_[f]]++] = static_cast<Index>(f);
}

void FaceParts::measure() {
    areas_.assign(begin_.size() - 1, 0);
    borders_.assign(areas_.size(), 0);
    // Areas are computed in parallel, in batches; sums are formed in the order of the faces.
    constexpr std::size_t at_once = 64 * block_size;
    std::vector<double> area(std::min(part_.size(), at_once));
    for (std::size_t begin = 0; begin < part_.size(); begin += at_once) {
        const std::size_t count = std::min(at_once, part_.size() - begin);
        parallel_for(count, block_size, [&](std::size_t i) { area[i] = face_area(mesh_, Face(static_cast<Index>(begin + i))); });
        for (std::size_t i = 0; i < count; ++i) areas_[part_[begin + i]] += area[i];
    }
    for (const Halfedge h : border_) borders_[part_at(mesh_.opposite(h))] += edge_length(mesh_, h);
}

FaceParts::Choice FaceParts::left_of(const std::vector<Halfedge>& edges) const {
    check_cancelled();
    // Net number of traversals of each edge along its first halfedge. (An Edge made from a halfedge remembers that halfedge.)
    std::map<Index, int> net;
    for (const Halfedge h : edges) {
        const Index e = mesh_.edge(h).idx();
        net[e] += mesh_.halfedge(Edge(e), 0) == h ? 1 : -1;
    }
    std::vector<Halfedge> walls;                         // halfedges whose left side is inside
    std::map<std::pair<Index, Index>, std::size_t> own;  // number of walls between each two parts
    for (const auto& [e, count] : net) {
        if (count == 0) continue;
        const Halfedge left = mesh_.halfedge(Edge(e), count > 0 ? 0 : 1), right = mesh_.opposite(left);
        walls.push_back(left);
        if (!mesh_.is_border(left) && !mesh_.is_border(right)) ++own[std::minmax({part_at(left), part_at(right)})];
    }
    Choice choice;
    choice.parts.assign(areas_.size(), false);
    std::vector<Index> stack;
    const auto take = [&](Index part) {
        if (choice.parts[part]) return;
        choice.parts[part] = true;
        choice.area += areas_[part];
        choice.perimeter += borders_[part];
        stack.push_back(part);
    };
    for (const Halfedge left : walls)
        if (!mesh_.is_border(left)) take(part_at(left));
    while (!stack.empty()) {
        const Index part = stack.back();
        stack.pop_back();
        for (const Link& link : links_[part]) {
            const auto blocked = own.find(std::minmax({part, link.part}));
            if (blocked == own.end() || blocked->second < link.edges) take(link.part);
        }
    }
    for (const Halfedge left : walls) {
        const Halfedge right = mesh_.opposite(left);
        if (mesh_.is_border(left) || mesh_.is_border(right)) continue;
        if (choice.parts[part_at(right)]) choice.crossing = true;
        else choice.perimeter += edge_length(mesh_, left);
    }
    return choice;
}

std::vector<bool> FaceParts::faces(const Choice& choice) const {
    std::vector<bool> selected(part_.size(), false);
    for (std::size_t part = 0; part < choice.parts.size(); ++part)
        if (choice.parts[part])
            for (Index i = begin_[part]; i < begin_[part + 1]; ++i) selected[faces_[i]] = true;
    return selected;
}

}  // namespace ostraka

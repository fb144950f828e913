#include "reconstruction/shared_faces.h"

#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/mesh/flood.h"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace ostraka {

namespace {

constexpr std::size_t neighbourhood = 30;      // number of vertices whose degrees identify an edge
constexpr std::size_t max_seeds = 64;          // max number of edges that are searched: one bit of a mask each
constexpr std::size_t min_piece_faces = 50;    // min faces of a piece
constexpr std::size_t max_positions = 64;      // max candidate positions of an edge, for symmetries
constexpr std::size_t max_followed_seeds = 8;  // max number of seeds that are followed
using Degrees = std::vector<std::uint8_t>;     // 0: at a border or a fracture

Degrees degrees_of(const Mesh& mesh, const std::vector<bool>& broken) {
    Degrees degrees(mesh.number_of_vertices(), 0);
    parallel_for(degrees.size(), [&](std::size_t i) {
        const Vertex v(static_cast<Index>(i));
        if (mesh.is_isolated(v)) return;
        std::size_t count = 0;
        for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v))) {
            if (mesh.is_border(h) || (!broken.empty() && broken[mesh.face(h)])) return;
            ++count;
        }
        degrees[i] = static_cast<std::uint8_t>(std::min<std::size_t>(count, 255));
    });
    return degrees;
}

/// Visits the vertices around a halfedge, each once, in an order that depends on the connectivity alone; `visit` returns
/// whether to continue.
template <class Visit>
void walk(const Mesh& mesh, Halfedge start, Visit&& visit) {
    std::vector<Halfedge> entries{mesh.opposite(start), start};  // each points to a visited vertex
    std::vector<Vertex> visited{mesh.source(start), mesh.target(start)};
    if (!visit(visited[0]) || !visit(visited[1])) return;
    for (std::size_t next = 0; next < entries.size(); ++next) {
        const Halfedge entry = entries[next];
        Halfedge h = entry;
        do {
            const Vertex other = mesh.source(h);
            if (std::find(visited.begin(), visited.end(), other) == visited.end()) {
                if (!visit(other)) return;
                visited.push_back(other);
                entries.push_back(mesh.opposite(h));
            }
            h = mesh.opposite(mesh.next(h));
        } while (h != entry);
    }
}

/// An edge of the fragment, and the degrees around it.
struct Seed {
    Halfedge edge;
    Degrees degrees;
    std::vector<Halfedge> positions;  ///< candidate positions; more than `max_positions`: too many
};

std::optional<Seed> seed_at(const Mesh& mesh, const Degrees& degrees, Halfedge edge) {
    Seed seed;
    seed.edge = edge;
    bool inside = true;
    walk(mesh, edge, [&](Vertex v) {
        inside = degrees[v] > 0;
        if (inside) seed.degrees.push_back(degrees[v]);
        return inside && seed.degrees.size() < neighbourhood;
    });
    if (!inside || seed.degrees.size() < neighbourhood) return std::nullopt;
    return seed;
}

/// Seeds spread over the faces of one piece, most irregular first.
std::vector<Seed> seeds_of(const Mesh& mesh, const Degrees& degrees, const std::vector<Index>& faces) {
    constexpr std::size_t tried = 512;
    constexpr std::uint8_t regular = 6;
    std::vector<std::pair<std::ptrdiff_t, Seed>> candidates;
    const std::size_t stride = std::max<std::size_t>(1, faces.size() / tried);
    for (std::size_t k = 0; k < faces.size(); k += stride)
        if (auto seed = seed_at(mesh, degrees, mesh.halfedge(Face(faces[k]))))
            candidates.emplace_back(std::count(seed->degrees.begin(), seed->degrees.end(), regular), std::move(*seed));
    std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    if (candidates.size() > max_seeds) candidates.resize(max_seeds);
    std::vector<Seed> seeds;
    for (auto& [count, seed] : candidates) seeds.push_back(std::move(seed));
    return seeds;
}

/// Finds the candidate positions of each seed on `mesh`; keeps the seeds with few positions, fewest first.
void find_seeds(const Mesh& mesh, const Degrees& degrees, std::vector<Seed>& seeds) {
    std::vector<std::uint64_t> matching_seeds(mesh.number_of_halfedges(), 0);
    const std::uint64_t all_seeds = seeds.size() == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << seeds.size()) - 1;
    parallel_for(matching_seeds.size(), 256, [&](std::size_t i) {
        const Halfedge h(static_cast<Index>(i));
        if (mesh.is_border(h) || mesh.is_border(mesh.opposite(h))) return;
        std::uint64_t remaining = all_seeds;
        std::size_t position = 0;
        walk(mesh, h, [&](Vertex v) {
            for (std::size_t s = 0; s < seeds.size(); ++s)
                if ((remaining >> s & 1U) != 0 && seeds[s].degrees[position] != degrees[v]) remaining &= ~(std::uint64_t{1} << s);
            if (degrees[v] == 0) remaining = 0;
            return remaining != 0 && ++position < neighbourhood;
        });
        if (position == neighbourhood) matching_seeds[i] = remaining;
    });
    for (std::size_t i = 0; i < matching_seeds.size(); ++i)
        for (std::size_t s = 0; matching_seeds[i] != 0 && s < seeds.size(); ++s) {
            if ((matching_seeds[i] >> s & 1U) != 0 && seeds[s].positions.size() <= max_positions)
                seeds[s].positions.emplace_back(static_cast<Index>(i));
        }
    std::erase_if(seeds, [](const Seed& seed) { return seed.positions.empty() || seed.positions.size() > max_positions; });
    std::stable_sort(seeds.begin(), seeds.end(),
                     [](const Seed& a, const Seed& b) { return a.positions.size() < b.positions.size(); });
    if (seeds.size() > max_followed_seeds) seeds.resize(max_followed_seeds);
}

using Pairs = std::vector<std::pair<Index, Index>>;  // vertices of the fragment and of the mesh

/// One piece of the fragment, with buffers for the traversal.
struct Piece {
    const Mesh& fragment;
    const std::vector<Index>& piece_of;  ///< per face
    std::size_t faces = 0;
    std::vector<Index> vertices;  ///< per vertex of the fragment, that of the mesh; restored after use
    std::vector<bool> done;       ///< per face; restored after use

    Piece(const Mesh& fragment_mesh, const std::vector<Index>& pieces)
        : fragment(fragment_mesh),
          piece_of(pieces),
          vertices(fragment_mesh.number_of_vertices(), no_index),
          done(fragment_mesh.number_of_faces(), false) {}

    /// Vertex pairs from traversing both meshes from an edge; empty if the faces differ.
    Pairs follow(const Mesh& mesh, Halfedge edge, Halfedge edge_there) {
        Pairs pairs;
        std::vector<Face> walked;
        const bool is_same = walk_both(mesh, edge, edge_there, pairs, walked) && walked.size() == faces && each_once(pairs);
        for (const auto& [v, there] : pairs) vertices[v] = no_index;
        for (const Face face : walked) done[face] = false;
        return is_same ? pairs : Pairs();
    }

private:
    bool walk_both(const Mesh& mesh, Halfedge edge, Halfedge edge_there, Pairs& pairs, std::vector<Face>& walked) {
        const Index piece = piece_of[fragment.face(edge)];
        std::vector<std::pair<Halfedge, Halfedge>> stack{{edge, edge_there}};
        const auto mark_visited = [&](Halfedge h) {
            done[fragment.face(h)] = true;
            walked.push_back(fragment.face(h));
        };
        mark_visited(edge);
        while (!stack.empty()) {
            auto [h, g] = stack.back();
            stack.pop_back();
            for (int side = 0; side < 3; ++side, h = fragment.next(h), g = mesh.next(g)) {
                Index& mapped = vertices[fragment.target(h)];
                const auto there = static_cast<Index>(mesh.target(g));
                if (mapped == no_index) pairs.emplace_back(static_cast<Index>(fragment.target(h)), mapped = there);
                if (mapped != there) return false;
                const Halfedge across = fragment.opposite(h), across_there = mesh.opposite(g);
                if (fragment.is_border(across) || piece_of[fragment.face(across)] != piece || done[fragment.face(across)])
                    continue;
                if (mesh.is_border(across_there)) return false;
                mark_visited(across);
                stack.emplace_back(across, across_there);
            }
        }
        return true;
    }
    /// Two vertices of the fragment must not map to one of the mesh.
    static bool each_once(const Pairs& pairs) {
        std::vector<Index> used;
        for (const auto& [v, there] : pairs) used.push_back(there);
        std::sort(used.begin(), used.end());
        return std::adjacent_find(used.begin(), used.end()) == used.end();
    }
};

/// The candidate position of the seeds at which the piece lies nearest.
Pairs nearest_position(Piece& piece, const Mesh& mesh, double scale, const std::vector<Seed>& seeds) {
    Pairs best;
    double min_sum = 0;
    for (const Seed& seed : seeds) {
        for (const Halfedge there : seed.positions) {
            Pairs pairs = piece.follow(mesh, seed.edge, there);
            if (pairs.empty()) continue;
            double sum = 0;
            for (const auto& [v, ours] : pairs)
                sum += (scale * eigen(mesh.point(Vertex(ours))) - eigen(piece.fragment.point(Vertex(v)))).squaredNorm();
            if (!best.empty() && !(sum < min_sum)) continue;
            min_sum = sum;
            best = std::move(pairs);
        }
        if (!best.empty()) break;
    }
    return best;
}

}  // namespace

std::vector<Index> shared_vertices(const Mesh& mesh, const Mesh& fragment, double scale, const std::vector<bool>& broken) {
    std::vector<Index> vertices(fragment.number_of_vertices(), no_index);
    const FacePieces pieces = face_pieces(fragment, [&](Face f) { return broken.empty() || !broken[f]; });
    std::vector<std::vector<Index>> faces(pieces.count);
    for (Index f = 0; f < pieces.of_face.size(); ++f)
        if (pieces.of_face[f] != no_index) faces[pieces.of_face[f]].push_back(f);
    const Degrees ours = degrees_of(mesh, {}), theirs = degrees_of(fragment, broken);
    Piece piece(fragment, pieces.of_face);
    for (const std::vector<Index>& piece_faces : faces) {
        if (piece_faces.size() < min_piece_faces || piece_faces.size() > mesh.number_of_faces()) continue;
        std::vector<Seed> seeds = seeds_of(fragment, theirs, piece_faces);
        if (seeds.empty()) continue;
        find_seeds(mesh, ours, seeds);
        piece.faces = piece_faces.size();
        for (const auto& [v, there] : nearest_position(piece, mesh, scale, seeds)) vertices[v] = there;
    }
    return vertices;
}

}  // namespace ostraka

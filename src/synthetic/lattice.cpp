#include "synthetic/lattice.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/random.h"

#include <algorithm>

namespace ostraka::shapes {

namespace {

constexpr int block_cubes = 4;                     // cubes along a block's edge
constexpr int block_points = 2 * block_cubes + 2;  // in half-cube steps, including the first centres of the next block
constexpr int coordinate_bits = 20;

/// Lattice points have integer coordinates in half cubes: cube corners even, cube centres odd.
using Place = std::array<int, 3>;

Vector3d position(const Lattice& lattice, const Place& place) {
    return lattice.origin + lattice.rotation * (0.5 * lattice.cube * Vector3d(place[0], place[1], place[2]));
}

/// The seven directions of lattice edges, with a positive first non-zero coordinate.
constexpr std::array<std::array<int, 3>, 7> directions{
    {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {1, -1, -1}}};

using EdgeKey = std::uint64_t;

EdgeKey edge_key(Place a, Place b) {
    Place d{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const int first = d[0] != 0 ? d[0] : d[1] != 0 ? d[1] : d[2];
    if (first < 0) {
        std::swap(a, b);
        for (int& x : d) x = -x;
    }
    std::uint64_t direction = 0;
    if (d[0] == 1) direction = 3 + (d[1] < 0 ? 2 : 0) + (d[2] < 0 ? 1 : 0);
    else direction = d[0] == 2 ? 0 : d[1] == 2 ? 1 : 2;
    EdgeKey key = 0;
    for (const int x : a) key = key << coordinate_bits | static_cast<std::uint64_t>(x);
    return key << 3 | direction;
}

std::pair<Place, Place> edge_ends(EdgeKey key) {
    const auto& d = directions[key & 7];
    key >>= 3;
    constexpr std::uint64_t mask = (std::uint64_t{1} << coordinate_bits) - 1;
    const Place a{static_cast<int>(key >> (2 * coordinate_bits)), static_cast<int>(key >> coordinate_bits & mask),
                  static_cast<int>(key & mask)};
    return {a, {a[0] + d[0], a[1] + d[1], a[2] + d[2]}};
}

/// Blocks that the surface may intersect, in depth-first order of an octree.
class BlockFinder {
public:
    BlockFinder(const SyntheticObject& object, const Lattice& lattice)
        : object_(object), lattice_(lattice), slack_(object.slack()) {}
    void visit(const Place& corner, int cubes) {
        // A block owns the tetrahedra that extend half a cube beyond its upper sides.
        const Vector3d low = position(lattice_, corner);
        const Vector3d half = lattice_.rotation * Vector3d::Constant(0.5 * lattice_.cube * (cubes + 0.5));
        const double radius = half.norm();
        const double value = object_.sample(low + half).value;
        if (value > radius + slack_ || value < -radius - slack_) return;
        if (cubes == block_cubes) {
            blocks.push_back(corner);
            return;
        }
        for (int child = 0; child < 8; ++child) {
            visit({corner[0] + (child & 1) * cubes, corner[1] + (child >> 1 & 1) * cubes, corner[2] + (child >> 2) * cubes},
                  cubes / 2);
        }
    }
    std::vector<Place> blocks;

private:
    const SyntheticObject& object_;
    const Lattice& lattice_;
    double slack_;
};

/// Output of one block: its edges cut by the surface (sorted) and the triangles over them.
struct Piece {
    std::vector<EdgeKey> edges;
    std::vector<std::array<std::uint16_t, 3>> triangles;
};

class BlockMarcher {
public:
    BlockMarcher(const SyntheticObject& object, const Lattice& lattice, const Place& corner) : corner_(corner) {
        for (int x = 0; x < block_points; ++x) {
            for (int y = x & 1; y < block_points; y += 2) {
                for (int z = x & 1; z < block_points; z += 2) {
                    if ((x & 1) == 0 && std::max({x, y, z}) > 2 * block_cubes) continue;
                    inside_[index({x, y, z})] = object.sample(position(lattice, global({x, y, z}))).value < 0;
                }
            }
        }
    }

    Piece run() {
        for (int x = 0; x < block_cubes; ++x) {
            for (int y = 0; y < block_cubes; ++y) {
                for (int z = 0; z < block_cubes; ++z) cube({x, y, z});
            }
        }
        Piece piece;
        piece.edges.reserve(keys_.size() / 4);
        for (const auto& triangle : keys_) piece.edges.insert(piece.edges.end(), triangle.begin(), triangle.end());
        std::sort(piece.edges.begin(), piece.edges.end());
        piece.edges.erase(std::unique(piece.edges.begin(), piece.edges.end()), piece.edges.end());
        for (const auto& triangle : keys_) {
            auto& local = piece.triangles.emplace_back();
            for (int k = 0; k < 3; ++k) {
                local[k] = static_cast<std::uint16_t>(std::lower_bound(piece.edges.begin(), piece.edges.end(), triangle[k]) -
                                                      piece.edges.begin());
            }
        }
        return piece;
    }

private:
    static std::size_t index(const Place& p) {
        return static_cast<std::size_t>((p[0] * block_points + p[1]) * block_points + p[2]);
    }
    [[nodiscard]] Place global(const Place& p) const { return {corner_[0] + p[0], corner_[1] + p[1], corner_[2] + p[2]}; }

    /// The twelve tetrahedra around the cube's three upper faces: two cube centres and an edge of the shared face.
    void cube(const Place& c) {
        const Place centre{2 * c[0] + 1, 2 * c[1] + 1, 2 * c[2] + 1};
        for (int axis = 0; axis < 3; ++axis) {
            const int second = (axis + 1) % 3, third = (axis + 2) % 3;
            Place next = centre;
            next[axis] += 2;
            std::array<Place, 4> face;
            for (int k = 0; k < 4; ++k) {
                face[k] = centre;
                face[k][axis] += 1;
                face[k][second] += k == 1 || k == 2 ? 1 : -1;
                face[k][third] += k >= 2 ? 1 : -1;
            }
            for (int k = 0; k < 4; ++k) tetrahedron({centre, next, face[k], face[(k + 1) % 4]});
        }
    }

    /// Corners in positive orientation.
    void tetrahedron(const std::array<Place, 4>& corners) {
        // Even permutations that move one corner, or a pair of corners, to the front.
        static constexpr std::array<std::array<int, 4>, 4> single_corner_permutations{
            {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}}};
        static constexpr std::array<std::array<int, 4>, 6> corner_pair_permutations{
            {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {2, 3, 0, 1}, {3, 1, 0, 2}, {1, 2, 0, 3}}};
        int signs = 0, count = 0;
        for (int k = 0; k < 4; ++k) {
            if (inside_[index(corners[k])]) signs |= 1 << k, ++count;
        }
        if (count == 0 || count == 4) return;
        const auto key = [&](int a, int b) { return edge_key(global(corners[a]), global(corners[b])); };
        if (count == 2) {
            for (const auto& [i, j, k, l] : corner_pair_permutations) {
                if (signs != (1 << i | 1 << j)) continue;
                const EdgeKey ik = key(i, k), il = key(i, l), jl = key(j, l), jk = key(j, k);
                keys_.push_back({ik, il, jl});
                keys_.push_back({ik, jl, jk});
            }
            return;
        }
        const int single_corner = count == 1 ? signs : 15 - signs;
        for (const auto& [i, j, k, l] : single_corner_permutations) {
            if (single_corner != 1 << i) continue;
            if (count == 1) keys_.push_back({key(i, j), key(i, k), key(i, l)});
            else keys_.push_back({key(i, j), key(i, l), key(i, k)});
        }
    }

    Place corner_;
    std::array<bool, block_points * block_points * block_points> inside_{};
    std::vector<std::array<EdgeKey, 3>> keys_;
};

/// Intersection of the surface with a lattice edge: false position (Illinois), kept away from the ends so that no triangle
/// degenerates.
Vector3d crossing(const SyntheticObject& object, const Vector3d& a, const Vector3d& b) {
    double low = 0, high = 1, low_value = object.sample(a).value, high_value = object.sample(b).value;
    double t = 0.5;
    for (int i = 0; i < 5; ++i) {
        t = std::clamp(low + (high - low) * low_value / (low_value - high_value), 0.0, 1.0);
        const double value = object.sample(a + t * (b - a)).value;
        if ((value < 0) == (low_value < 0)) {
            low = t, low_value = value;
            high_value *= 0.5;
        } else {
            high = t, high_value = value;
            low_value *= 0.5;
        }
        if (value == 0) break;
    }
    constexpr double margin = 0.01;
    return a + std::clamp(t, margin, 1 - margin) * (b - a);
}

}  // namespace

double area(const Triangles& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.faces)
        sum += 0.5 * (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]).norm();
    return sum;
}

Lattice seeded_lattice(const SyntheticObject& object, double cube, std::uint64_t seed) {
    const auto share = [&](std::uint64_t counter) { return random_share(seed, counter); };
    // A quaternion from four random numbers: the rotation need not be uniform, only in general position.
    const Eigen::Quaterniond rotation =
        Eigen::Quaterniond(0.3 + share(0), share(1) - 0.5, share(2) - 0.5, share(3) - 0.5).normalized();
    Lattice lattice{rotation.toRotationMatrix(), Vector3d::Zero(), cube};
    const auto box = object.box();
    const double radius = 0.5 * box.diagonal().norm() + 2 * cube;
    const Vector3d shift(share(4), share(5), share(6));
    lattice.origin = box.center() - lattice.rotation * (Vector3d::Constant(radius) + cube * shift);
    return lattice;
}

Triangles march(const SyntheticObject& object, const Lattice& lattice) {
    const double across = object.box().diagonal().norm() + 6 * lattice.cube;
    int cubes = block_cubes;
    while (cubes * lattice.cube < across) cubes *= 2;
    if (2 * cubes + block_points >= 1 << coordinate_bits) {
        throw Error(ErrorKind::failure, object.name, "the lattice is too fine for this object", "ask for fewer vertices");
    }
    BlockFinder finder(object, lattice);
    finder.visit({0, 0, 0}, cubes);
    const auto& blocks = finder.blocks;

    std::vector<Piece> pieces(blocks.size());
    parallel_for(blocks.size(), 16, [&](std::size_t i) { pieces[i] = BlockMarcher(object, lattice, blocks[i]).run(); });

    std::vector<EdgeKey> edges;
    std::vector<std::size_t> first_face(pieces.size() + 1, 0);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        edges.insert(edges.end(), pieces[i].edges.begin(), pieces[i].edges.end());
        first_face[i + 1] = first_face[i] + pieces[i].triangles.size();
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());

    Triangles result;
    result.faces.resize(first_face.back());
    parallel_for(pieces.size(), 64, [&](std::size_t i) {
        std::vector<Index> global;
        for (const EdgeKey key : pieces[i].edges) {
            global.push_back(static_cast<Index>(std::lower_bound(edges.begin(), edges.end(), key) - edges.begin()));
        }
        std::size_t face = first_face[i];
        for (const auto& [a, b, c] : pieces[i].triangles) result.faces[face++] = {global[a], global[b], global[c]};
        pieces[i] = {};
    });
    result.points.resize(edges.size());
    parallel_for(edges.size(), [&](std::size_t i) {
        const auto [a, b] = edge_ends(edges[i]);
        result.points[i] = crossing(object, position(lattice, a), position(lattice, b));
    });
    return result;
}

}  // namespace ostraka::shapes

#include "ostraka/slicing/capacity.h"

#include "slicing/flood.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/limits.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

using namespace detail;

namespace {

/// A pool at its overflow, with the state of the plane at this level.
struct Pool {
    WetPlace seed;
    Cavity cavity;
    Waterline line;
    PoolSize size;
    Index set = no_index;
    bool sealed = false;
};

SliceFrame centred_frame(const Mesh& mesh, const Vector& up) {
    const CGAL::Bbox_3 box = bounding_box(mesh);
    return slice_frame(Point(box.xmin() / 2 + box.xmax() / 2, box.ymin() / 2 + box.ymax() / 2, box.zmin() / 2 + box.zmax() / 2),
                       up);
}

/// The sides of pieces that belong to a set.
std::vector<std::uint8_t> sides_of(Waterline& line, Index set) {
    std::vector<std::uint8_t> selected(2 * line.pieces, 0);
    for (Index node = 0; node < selected.size(); ++node) selected[node] = line.sets.find(node) == set ? 1 : 0;
    return selected;
}

/// A pool at some level: its volume there and its lowest place.
struct Candidate {
    double volume = 0, level = 0;
    WetPlace seed;
};

std::vector<Candidate> candidates_at(const Flood& flood, double level) {
    Waterline line = flood.at(level);
    const std::vector<double> volumes = flood.side_volumes(line);
    std::map<Index, Candidate> pools;
    for (std::size_t i = 0; i < line.loops.size(); ++i) {
        const Index set = line.sets.find(line.region(i));
        if (!line.loops[i].clay && set != line.sets.find(line.unbounded())) pools[set].level = level;
    }
    std::erase_if(pools, [&](const auto& pool) { return line.between_walls(pool.first); });
    std::vector<Index> lowest(line.pieces, no_index);
    for (Index v = 0; v < line.piece.size(); ++v)
        if (const Index p = line.piece[v]; p != no_index && (lowest[p] == no_index || flood.height(v) < flood.height(lowest[p])))
            lowest[p] = v;
    for (Index node = 0; node < volumes.size(); ++node) {
        const auto pool = pools.find(line.sets.find(node));
        if (pool == pools.end()) continue;
        Candidate& candidate = pool->second;
        candidate.volume += volumes[node];
        const Index v = lowest[node / 2];
        if (candidate.seed.vertex == no_index || flood.height(v) < flood.height(candidate.seed.vertex))
            candidate.seed = {v, static_cast<int>(node % 2)};
    }
    std::vector<Candidate> result;
    for (const auto& [set, candidate] : pools)
        if (candidate.volume > 0 && candidate.seed.vertex != no_index) result.push_back(candidate);
    return result;
}

/// Levels at which pools are searched: equal steps of the height, and quantiles of the vertices' heights.
std::vector<double> search_levels(const Flood& flood) {
    constexpr std::size_t count = 40;
    const std::vector<double>& heights = flood.heights();
    std::vector<double> levels;
    for (std::size_t i = 0; i < count; ++i) {
        const double share = (double(i) + 0.5) / count;
        levels.push_back(heights.front() + share * (heights.back() - heights.front()));
        levels.push_back(heights[static_cast<std::size_t>(share * double(heights.size()))]);
    }
    return levels;
}

void fill(const Flood& flood, Pool& pool, double level) {
    pool.line = flood.at(level);
    pool.set = pool.line.set_of(pool.seed);
    pool.size = flood.size(pool.line, sides_of(pool.line, pool.set));
}

/// The border loop of each border vertex, by its smallest vertex, and the highest point of each loop.
struct Borders {
    explicit Borders(const Mesh& mesh) : sets(mesh.num_vertices()) {
        for (const Halfedge h : mesh.halfedges())
            if (mesh.is_border(h)) sets.unite(mesh.source(h), mesh.target(h));
    }
    DisjointSets sets;
};

/// Whether the pool overflows over the border of a hole: a border that is not the highest border of the surface.
Overflow kind_of(const Mesh& mesh, const Flood& flood, Index vertex) {
    if (!mesh.is_border(Vertex(vertex))) return Overflow::rim;
    Borders borders(mesh);
    double highest = -std::numeric_limits<double>::infinity(), own = highest;
    for (const Vertex v : mesh.vertices()) {
        if (mesh.is_isolated(v) || !mesh.is_border(v)) continue;
        highest = std::max(highest, flood.height(v));
        if (borders.sets.find(v) == borders.sets.find(vertex)) own = std::max(own, flood.height(v));
    }
    return own < highest || own < flood.heights().front() + 0.5 * (flood.heights().back() - flood.heights().front())
               ? Overflow::hole
               : Overflow::rim;
}

/// The vertex over which a pool overflows: at its level, beside the pool, and beside what is not the pool.
Index overflow_vertex(const Mesh& mesh, const Flood& flood, Pool& pool) {
    Index any = no_index;
    for (const Vertex v : mesh.vertices()) {
        if (flood.height(v) != pool.line.level || mesh.is_isolated(v)) continue;
        if (any == no_index) any = v;
        bool beside = false;
        std::size_t changes = 0;
        bool last_below = pool.line.piece[mesh.source(mesh.halfedge(v))] != no_index;
        for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v))) {
            const Index piece = pool.line.piece[mesh.source(h)];
            beside = beside || (piece != no_index &&
                                (pool.line.sets.find(2 * piece) == pool.set || pool.line.sets.find(2 * piece + 1) == pool.set));
            changes += (piece != no_index) != last_below ? 1 : 0;
            last_below = piece != no_index;
        }
        if (beside && (mesh.is_border(v) || changes > 2)) return v;
        if (beside) any = v;
    }
    return any;
}

Cavity cavity_of(const Mesh& mesh, const Flood& flood, Pool& pool) {
    Cavity cavity;
    cavity.lowest = mesh.point(Vertex(pool.size.lowest));
    cavity.full.level = pool.line.level;
    cavity.full.height = pool.line.level - flood.height(pool.size.lowest);
    cavity.full.volume = pool.size.volume;
    cavity.full.surface = pool.size.surface;
    cavity.open_wall = pool.size.open;
    cavity.wetted_area = pool.size.wetted;
    cavity.over = Overflow::sealed;
    cavity.overflow = cavity.lowest;
    if (pool.sealed) return cavity;
    const Index vertex = overflow_vertex(mesh, flood, pool);
    cavity.overflow = mesh.point(Vertex(vertex));
    cavity.over = kind_of(mesh, flood, vertex);
    return cavity;
}

/// The pools of a mesh, each at its overflow, by decreasing volume.
std::vector<Pool> pools_of(const Mesh& mesh, const Flood& flood) {
    const std::vector<double> levels = search_levels(flood);
    std::vector<std::vector<Candidate>> found(levels.size());
    parallel_for(levels.size(), 1, [&](std::size_t i) { found[i] = candidates_at(flood, levels[i]); });
    std::vector<Candidate> candidates;
    for (const auto& list : found) candidates.insert(candidates.end(), list.begin(), list.end());
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.volume > b.volume; });
    std::vector<Pool> pools, clay;
    for (const Candidate& candidate : candidates) {
        constexpr std::size_t max_pools = 8;
        if (pools.size() == max_pools || candidate.volume < 0.01 * candidates.front().volume) break;
        const auto holds = [&](Pool& pool) { return pool.line.set_of(candidate.seed) == pool.set; };
        if (std::any_of(pools.begin(), pools.end(), holds) || std::any_of(clay.begin(), clay.end(), holds)) continue;
        Pool pool;
        pool.seed = candidate.seed;
        const std::optional<double> level = flood.overflow(candidate.seed, candidate.level);
        pool.sealed = !level;
        fill(flood, pool, level.value_or(flood.heights().back()));
        if (pool.set == no_index) continue;
        // What is a hollow at a low level may be the inside of a wall higher up.
        if (pool.line.between_walls(pool.set)) clay.push_back(std::move(pool));
        else pools.push_back(std::move(pool));
    }
    for (Pool& pool : pools) pool.cavity = cavity_of(mesh, flood, pool);
    std::stable_sort(pools.begin(), pools.end(), [](const Pool& a, const Pool& b) { return a.size.volume > b.size.volume; });
    return pools;
}

/// Volumes of one pool: full, and for each request.
struct Fillings {
    std::vector<LiquidVolume> all;  ///< the full pool, then the requests
    std::vector<PoolSize> sizes;
};

double requested_level(const FillRequest& request, const SliceFrame& frame, double lowest, double full) {
    if (request.kind == FillRequest::Kind::share) return lowest + request.value * (full - lowest);
    return (request.from ? frame.height(*request.from) : lowest) + request.value;
}

/// `pool` is at its overflow.
Fillings fillings_of(const Flood& flood, const SliceFrame& frame, Pool& pool, const std::vector<FillRequest>& requests) {
    Fillings result;
    const double full = pool.line.level, lowest = flood.height(pool.size.lowest);
    const auto add = [&](double level, const PoolSize& size) {
        LiquidVolume& filling = result.all.emplace_back();
        filling.level = level, filling.height = level - lowest;
        filling.volume = size.volume, filling.surface = size.surface;
        result.sizes.push_back(size);
    };
    add(full, pool.size);
    for (const FillRequest& request : requests) {
        const double level = requested_level(request, frame, lowest, full), tolerance = 1e-9 * (full - lowest);
        if (level > full + tolerance || level < lowest - tolerance) {
            add(level, {});
            result.all.back().volume = result.all.back().surface = LiquidVolume::unknown;
            result.all.back().reason =
                level < lowest ? fmt::format("the level is {:.5g} below the lowest point of the cavity", lowest - level)
                               : fmt::format("the level is {:.5g} above the overflow", level - full);
            continue;
        }
        if (level >= full) {
            add(full, pool.size);
            continue;
        }
        Waterline line = flood.at(level);
        std::vector<std::uint8_t> selected(2 * line.pieces, 0);
        for (Index v = 0; v < line.piece.size(); ++v) {
            if (line.piece[v] == no_index) continue;
            for (const int side : {0, 1})
                selected[2 * line.piece[v] + static_cast<Index>(side)] = pool.line.set_of({v, side}) == pool.set ? 1 : 0;
        }
        add(level, flood.size(line, selected));
    }
    return result;
}

/// Root mean square change of each filling if the upward direction is tilted.
void add_direction_errors(const Mesh& mesh, const SliceFrame& frame, const WetPlace& seed,
                          const std::vector<FillRequest>& requests, double up_error, std::vector<LiquidVolume>& fillings) {
    constexpr std::size_t directions = 8;
    std::vector<std::vector<double>> changes(directions);
    const double tilt = std::sqrt(2.0) * up_error * degree;
    parallel_for(directions, 1, [&](std::size_t k) {
        const double angle = 2 * pi * double(k) / directions;
        const Vector up =
            std::cos(tilt) * frame.normal + std::sin(tilt) * (std::cos(angle) * frame.u + std::sin(angle) * frame.v);
        const SliceFrame tilted = slice_frame(frame.origin, up);
        const Flood flood(mesh, tilted);
        Pool pool;
        pool.seed = seed;
        const std::optional<double> level = flood.overflow(seed, flood.height(seed.vertex));
        if (!level) return;
        fill(flood, pool, *level);
        changes[k].assign(fillings.size(), 0);
        if (pool.set == no_index) {  // empty in this direction
            changes[k][0] = -fillings[0].volume;
            return;
        }
        const Fillings moved = fillings_of(flood, tilted, pool, requests);
        for (std::size_t i = 0; i < fillings.size(); ++i) {
            // A level above the overflow of the tilted vessel: it is full.
            const double volume = moved.all[i].reason.empty() ? moved.all[i].volume : moved.all[0].volume;
            if (fillings[i].reason.empty()) changes[k][i] = volume - fillings[i].volume;
        }
    });
    for (std::size_t i = 0; i < fillings.size(); ++i) {
        double sum = 0;
        for (const auto& change : changes) sum += i < change.size() ? change[i] * change[i] : 0;
        fillings[i].by_direction = std::sqrt(sum / directions);
    }
}

void check_input(const Mesh& mesh, const Vector& up) {
    if (!(up.squared_length() > 0) || !std::isfinite(up.squared_length()))
        fail_usage("the upward direction has no length", "give a vector that is not zero");
    if (mesh.number_of_faces() == 0) fail_input("mesh", "has no faces", "give the surface of a vessel");
}

std::string reason_of(const Capacity& capacity) {
    if (capacity.main) {
        if (!capacity.cavities[*capacity.main].open_wall) return {};
        return "the wall of the cavity has a hole below its rim, and what lies behind the hole was not scanned: the volume is an "
               "upper bound";
    }
    for (const Cavity& cavity : capacity.cavities)
        if (cavity.over == Overflow::sealed)
            return fmt::format("the cavity of volume {:.6g} is closed on all sides, so that nothing can be poured in",
                               cavity.full.volume);
    return "there is no cavity that holds liquid in this upward direction";
}

}  // namespace

double LiquidVolume::uncertainty() const { return std::hypot(by_noise, by_wall, by_direction); }

std::vector<Cavity> find_cavities(const Mesh& mesh, const Vector& up) {
    check_input(mesh, up);
    const Flood flood(mesh, centred_frame(mesh, up));
    std::vector<Cavity> cavities;
    for (const Pool& pool : pools_of(mesh, flood)) cavities.push_back(pool.cavity);
    return cavities;
}

Capacity find_capacity(const Mesh& mesh, const Vector& up, const std::vector<FillRequest>& requests,
                       const CapacityOptions& options) {
    check_options(options, "capacity");
    check_input(mesh, up);
    const SliceFrame frame = centred_frame(mesh, up);
    const Flood flood(mesh, frame);
    Capacity result;
    result.up = frame.normal;
    result.height = flood.heights().back() - flood.heights().front();
    result.box = flood.box_volume();
    result.full.volume = result.full.surface = LiquidVolume::unknown;
    std::vector<Pool> pools = pools_of(mesh, flood);
    for (const Pool& pool : pools) result.cavities.push_back(pool.cavity);
    const double origin_height = (frame.origin - CGAL::ORIGIN) * frame.normal;
    for (std::size_t i = 0; i < pools.size() && !result.main; ++i) {
        if (pools[i].sealed || pools[i].size.volume < min_cavity_share * result.box) continue;
        result.main = i;
        result.crossing = pools[i].line.crossing;
        Fillings fillings = fillings_of(flood, frame, pools[i], requests);
        result.noise = options.noise ? *options.noise : surface_noise(mesh);
        for (std::size_t k = 0; k < fillings.all.size(); ++k) {
            const PoolSize& size = fillings.sizes[k];
            fillings.all[k].by_noise = result.noise * std::sqrt(size.squared_areas + size.surface * size.surface);
            fillings.all[k].by_wall = options.wall_error * size.wetted;
        }
        if (options.up_error > 0) add_direction_errors(mesh, frame, pools[i].seed, requests, options.up_error, fillings.all);
        result.full = fillings.all.front();
        result.levels.assign(fillings.all.begin() + 1, fillings.all.end());
    }
    result.reason = reason_of(result);
    if (!result.main) {
        result.levels.assign(requests.size(), LiquidVolume());
        for (LiquidVolume& level : result.levels) level.reason = result.reason;
    }
    // Levels above the origin of the coordinates.
    result.full.level += origin_height;
    for (LiquidVolume& level : result.levels) level.level += origin_height;
    for (Cavity& cavity : result.cavities) cavity.full.level += origin_height;
    return result;
}

double surface_noise(const Mesh& mesh) {
    std::vector<Vertex> interior;
    const auto is_interior = [&](Vertex v) {
        if (mesh.is_isolated(v) || mesh.is_border(v)) return false;
        bool inside = true;
        for (const Vertex u : mesh.vertices_around_target(mesh.halfedge(v))) inside = inside && !mesh.is_border(u);
        return inside;
    };
    for (const Vertex v : mesh.vertices())
        if (is_interior(v)) interior.push_back(v);
    if (interior.size() < 10) return 0;
    constexpr std::size_t sample = 20000;
    const std::size_t step = (interior.size() + sample - 1) / sample;
    std::vector<double> deviations((interior.size() + step - 1) / step);
    parallel_for(deviations.size(), [&](std::size_t i) {
        const Vertex v = interior[i * step];
        std::map<Index, double> weights;  // of the vertices' displacements in the difference
        const auto add = [&](Vertex at, double share) {
            const Vector normal = vertex_normal(mesh, at);
            double height = 0;
            const double valence = mesh.degree(at);
            weights[at] += share;
            for (const Vertex u : mesh.vertices_around_target(mesh.halfedge(at))) {
                height += (mesh.point(at) - mesh.point(u)) * normal / valence;
                weights[u] -= share / valence;
            }
            return share * height;
        };
        const double valence = mesh.degree(v);
        double difference = add(v, 1);
        for (const Vertex u : mesh.vertices_around_target(mesh.halfedge(v))) difference += add(u, -1 / valence);
        double squares = 0;
        for (const auto& [vertex, weight] : weights) squares += weight * weight;
        deviations[i] = std::abs(difference) / std::sqrt(squares);
    });
    std::nth_element(deviations.begin(), deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 2),
                     deviations.end());
    return 1.4826 * deviations[deviations.size() / 2];  // median of |x| of a normal distribution
}

Mesh revolve_profile(const std::vector<Eigen::Vector2d>& profile, int columns) {
    if (columns < 3) fail_usage("a surface of revolution needs three columns", "give at least 3");
    std::vector<Eigen::Vector2d> points;
    for (const auto& p : profile) {
        if (!p.allFinite() || std::abs(p.x()) > max_coordinate || std::abs(p.y()) > max_coordinate)
            fail_input("profile", "has coordinates that are not finite or too large", "correct the numbers");
        if (p.x() < 0)
            fail_input("profile", "has points on both sides of the axis", "give one half of the section, radii from 0 up");
        if (points.empty() || points.back() != p) points.push_back(p);
    }
    const bool ring = points.size() > 2 && points.front() == points.back();
    if (ring) points.pop_back();
    if (points.size() < 2)
        fail_input("profile", "has fewer than two different points", "give the points of the section in order");
    if (std::all_of(points.begin(), points.end(), [](const auto& p) { return p.x() == 0; }))
        fail_input("profile", "lies on the axis", "give the distance from the axis in the first column");
    // Regular polygons with the area of the circle.
    const double scale = std::sqrt(2 * pi / (columns * std::sin(2 * pi / columns)));
    TriangleSoup soup;
    std::vector<Index> first;
    for (const auto& p : points) {
        first.push_back(static_cast<Index>(soup.points.size()));
        for (int k = 0; k < (p.x() > 0 ? columns : 1); ++k) {
            const double angle = 2 * pi * k / columns;
            soup.points.push_back({scale * p.x() * std::cos(angle), scale * p.x() * std::sin(angle), p.y()});
        }
    }
    const auto at = [&](std::size_t i, int k) {
        return points[i].x() > 0 ? first[i] + static_cast<Index>(k % columns) : first[i];
    };
    for (std::size_t i = 0; i + (ring ? 0 : 1) < points.size(); ++i) {
        const std::size_t next = (i + 1) % points.size();
        for (int k = 0; k < columns; ++k) {
            const Index a = at(i, k), b = at(i, k + 1), c = at(next, k + 1), d = at(next, k);
            if (a != b) soup.triangles.push_back({a, b, c});
            if (c != d) soup.triangles.push_back({a, c, d});
        }
    }
    return build_mesh(soup);
}

void CapacityOptions::declare_options(OptionList& list) {
    list("up-error", up_error, "standard deviation of the upward direction", Range{0, 30}, "degrees");
    list("noise", noise, "standard deviation of the wall's noise; by default estimated from the surface", Range{0, 1e60},
         "the mesh's unit");
    list("wall-error", wall_error, "standard deviation of an offset that the whole inner wall has in common, as of a scanner",
         Range{0, 1e60}, "the mesh's unit");
}

}  // namespace ostraka

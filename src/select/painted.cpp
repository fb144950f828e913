#include "select/painted.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/disjoint_sets.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

constexpr float on_border = 1e-6F;  ///< value instead of 0, which would be neither inside nor outside

Lab lab_of(const LabNode& node) {
    return {static_cast<double>(node[0]), static_cast<double>(node[1]), static_cast<double>(node[2])};
}

/// The node and those around it, `rings` rings.
std::vector<Index> nodes_around(const TexelGrid& grid, Index node, int rings) {
    std::vector<Index> nodes{node};
    std::size_t begin = 0;
    for (int ring = 0; ring < rings; ++ring) {
        const std::size_t end = nodes.size();
        for (std::size_t i = begin; i < end; ++i) {
            const auto [first, last] = grid.neighbours(nodes[i]);
            for (const Index* next = first; next != last; ++next)
                if (std::find(nodes.begin(), nodes.end(), *next) == nodes.end()) nodes.push_back(*next);
        }
        begin = end;
    }
    return nodes;
}

Lab median_lab(const TexelColours& colours, Index node) {
    const std::vector<Index> nodes = nodes_around(colours.grid, node, 3);
    Lab median{};
    std::vector<float> values(nodes.size());
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < nodes.size(); ++i) values[i] = colours.lab[nodes[i]][k];
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        median[k] = static_cast<double>(*middle);
    }
    return median;
}

/// How far a value lies within an interval; negative outside.
double margin(double value, const PaintedFigureQuery::Interval& interval) {
    return std::min(value - interval[0], interval[1] - value);
}

/// How far a hue lies within an interval of angles, as a difference of colour.
double hue_margin(const Lab& lab, const PaintedFigureQuery::Interval& interval) {
    double width = std::fmod(interval[1] - interval[0], 360);
    if (width < 0) width += 360;
    if (width == 0 && interval[1] != interval[0]) return std::numeric_limits<double>::infinity();
    const double angle = std::atan2(lab[2], lab[1]) * 180 / std::acos(-1.0);
    const double away = std::abs(std::remainder(angle - (interval[0] + width / 2), 360));
    return std::hypot(lab[1], lab[2]) * std::clamp(width / 2 - away, -90.0, 90.0) * std::acos(-1.0) / 180;
}

/// Finds the figure of a query.
class FigureFinder {
public:
    FigureFinder(const TexelColours& colours, const PaintedFigureQuery& query, const std::string& where)
        : colours_(colours), grid_(colours.grid), query_(query), where_(where), tolerance_(query.tolerance) {}

    std::vector<float> find() {
        std::vector<LabNode> lab = colours_.lab;
        grid_.blur(lab, query_.blur);
        for (const SurfaceHit& place : query_.places) seeds_.push_back(grid_.nearest_node(Face(place.face), place.barycentric));
        references_ = query_.like;
        const bool bounded = query_.lightness || query_.chroma || query_.hue;
        if (references_.empty() && !(bounded && !query_.sharpest))
            for (const Index seed : seeds_) references_.push_back(median_lab(colours_, seed));
        if (query_.sharpest) tolerance_ = sharpest_tolerance(lab);
        value_.resize(grid_.size());
        parallel_for(value_.size(), 4096, [&](std::size_t i) { value_[i] = value_of(lab_of(lab[i])); });
        grid_.blur(value_, query_.blur);
        for (float& value : value_)
            if (std::abs(value) < on_border) value = value > 0 ? on_border : -on_border;
        clean(true);
        clean(false);
        keep_figures_at_places();
        return std::move(value_);
    }
    [[nodiscard]] double tolerance() const { return tolerance_; }

private:
    [[nodiscard]] double difference(const Lab& lab) const {
        double least = std::numeric_limits<double>::infinity();
        for (const Lab& reference : references_) least = std::min(least, colour_difference(lab, reference));
        return least;
    }

    /// Positive inside, limited so that the zero level after smoothing lies half way between two colours.
    [[nodiscard]] float value_of(const Lab& lab) const {
        double limit = references_.empty() ? 5 : std::max(tolerance_, 1e-3);
        double inside = limit;
        if (!references_.empty()) inside = tolerance_ - difference(lab);
        if (query_.lightness) inside = std::min(inside, margin(lab[0], *query_.lightness));
        if (query_.chroma) inside = std::min(inside, margin(std::hypot(lab[1], lab[2]), *query_.chroma));
        if (query_.hue) inside = std::min(inside, hue_margin(lab, *query_.hue));
        return static_cast<float>(std::clamp(inside, -limit, limit));
    }

    static constexpr double level_width = 0.125;  ///< width of the classes of differences in `sharpest_tolerance`

    /// For each node the class of the least tolerance at which a figure around a place includes it: the largest difference on
    /// the best path, by classes of `level_width`. Stops at half of the area.
    [[nodiscard]] std::vector<std::uint16_t> levels_from_places(const std::vector<LabNode>& lab,
                                                                std::vector<double>& area) const {
        const auto count = static_cast<std::size_t>(std::ceil(query_.tolerance / level_width)) + 1;
        std::vector<std::uint16_t> level(grid_.size(), static_cast<std::uint16_t>(count));
        std::vector<std::vector<Index>> waiting(count);
        std::vector<bool> seen(grid_.size(), false);
        double total = 0, reached = 0;
        for (const float a : grid_.areas()) total += static_cast<double>(a);
        const auto add = [&](Index node, std::size_t from) {
            if (seen[node]) return;
            seen[node] = true;
            const double d = difference(lab_of(lab[node])) / level_width;
            const std::size_t own = d < static_cast<double>(count) ? static_cast<std::size_t>(d) : count;
            if (std::max(own, from) < count) waiting[std::max(own, from)].push_back(node);
        };
        for (const Index seed : seeds_)
            for (const Index node : nodes_around(grid_, seed, 2)) add(node, 0);
        area.assign(count, 0);
        for (std::size_t now = 0; now < count; ++now) {
            while (!waiting[now].empty()) {
                const Index node = waiting[now].back();
                waiting[now].pop_back();
                level[node] = static_cast<std::uint16_t>(now);
                reached += static_cast<double>(grid_.areas()[node]);
                const auto [begin, end] = grid_.neighbours(node);
                for (const Index* next = begin; next != end; ++next) add(*next, now);
            }
            area[now] = reached;
            if (reached > total / 2) break;
        }
        return level;
    }

    /// The tolerance at which the outline of the figures around the places has the largest mean contrast.
    [[nodiscard]] double sharpest_tolerance(const std::vector<LabNode>& lab) const {
        if (seeds_.empty()) fail_input(where_, "a figure by its edge needs a place in it", "add a place");
        std::vector<double> area;
        const std::vector<std::uint16_t> level = levels_from_places(lab, area);
        std::vector<double> contrast(area.size() + 1, 0), pieces(area.size() + 1, 0);
        for (std::size_t i = 0; i < level.size(); ++i) {
            if (level[i] >= area.size()) continue;
            const auto [begin, end] = grid_.neighbours(i);
            for (const Index* next = begin; next != end; ++next) {
                if (level[*next] <= level[i]) continue;
                double step = 0;
                for (std::size_t k = 0; k < 3; ++k) {
                    const auto d = static_cast<double>(lab[i][k]) - static_cast<double>(lab[*next][k]);
                    step += d * d;
                }
                contrast[level[i]] += std::sqrt(step), pieces[level[i]] += 1;
                contrast[level[*next]] -= std::sqrt(step), pieces[level[*next]] -= 1;
            }
        }
        double best = 0, tolerance = query_.tolerance, sum = 0, count = 0;
        for (std::size_t now = 0; now < area.size(); ++now) {
            sum += contrast[now], count += pieces[now];
            if (area[now] < smallest_area() || count < 6) continue;
            if (sum / count > best) best = sum / count, tolerance = (static_cast<double>(now) + 1) * level_width;
        }
        return tolerance;
    }

    [[nodiscard]] double smallest_area() const {
        if (query_.smallest > 0) return query_.smallest * query_.smallest;
        return 36 * grid_.spacing() * grid_.spacing();
    }

    /// Connected sets of nodes that are all inside or all outside.
    [[nodiscard]] DisjointSets components(bool of_inside) const {
        DisjointSets sets(grid_.size());
        for (std::size_t i = 0; i < value_.size(); ++i) {
            if ((value_[i] > 0) != of_inside) continue;
            const auto [begin, end] = grid_.neighbours(i);
            for (const Index* next = begin; next != end; ++next)
                if (*next < i && (value_[*next] > 0) == of_inside) sets.unite(i, *next);
        }
        return sets;
    }

    /// Turns small components that border on the other side into parts of it. Pieces of the mesh stay as they are.
    void clean(bool of_inside) {
        DisjointSets sets = components(of_inside);
        std::vector<float> area(value_.size(), 0);
        std::vector<bool> bordered(value_.size(), false);
        for (std::size_t i = 0; i < value_.size(); ++i) {
            if ((value_[i] > 0) != of_inside) continue;
            const Index root = sets.find(i);
            area[root] += grid_.areas()[i];
            const auto [begin, end] = grid_.neighbours(i);
            if (!bordered[root])
                bordered[root] = std::any_of(begin, end, [&](Index next) { return (value_[next] > 0) != of_inside; });
        }
        const auto smallest = static_cast<float>(smallest_area());
        for (std::size_t i = 0; i < value_.size(); ++i)
            if ((value_[i] > 0) == of_inside)
                if (const Index root = sets.find(i); bordered[root] && area[root] < smallest)
                    marked_.push_back(static_cast<Index>(i));
        for (const Index i : marked_) value_[i] = -value_[i];
        marked_.clear();
    }

    void keep_figures_at_places() {
        if (seeds_.empty()) return;
        DisjointSets sets = components(true);
        std::vector<Index> wanted;
        for (const Index seed : seeds_) {
            const std::vector<Index> near = nodes_around(grid_, seed, 5);
            const auto hit = std::find_if(near.begin(), near.end(), [&](Index node) { return value_[node] > 0; });
            if (hit == near.end())
                fail_input(where_, "the surface does not have the colour of the figure at a place that is to lie in it",
                           "give a larger tolerance, or a place well within the figure that is larger than a few texels");
            wanted.push_back(sets.find(*hit));
        }
        std::sort(wanted.begin(), wanted.end());
        for (std::size_t i = 0; i < value_.size(); ++i)
            if (value_[i] > 0 && !std::binary_search(wanted.begin(), wanted.end(), sets.find(i))) value_[i] = -value_[i];
    }

    const TexelColours& colours_;
    const TexelGrid& grid_;
    const PaintedFigureQuery& query_;
    const std::string& where_;
    double tolerance_;
    std::vector<Index> seeds_, marked_;
    std::vector<Lab> references_;
    std::vector<float> value_;
};

}  // namespace

PaintedFigure::PaintedFigure(std::shared_ptr<const TexelColours> colours, const PaintedFigureQuery& query,
                             const std::string& where)
    : colours_(std::move(colours)), tolerance_(query.tolerance) {
    FigureFinder finder(*colours_, query, where);
    value_ = finder.find();
    tolerance_ = finder.tolerance();
}

bool PaintedFigure::inside(Face face, const std::array<double, 3>& weights) const {
    const TexelGrid& grid = colours_->grid;
    const FaceDivision& division = grid.division(face);
    std::vector<Index> numbers;
    grid.nodes_of(face, numbers);
    const auto& triangle = division.triangles[grid.triangle_at(face, weights)];
    const auto &a = division.nodes[triangle[0]].weights, &b = division.nodes[triangle[1]].weights,
               &c = division.nodes[triangle[2]].weights;
    const auto cross = [](const auto& p, const auto& q, const auto& r) {
        return (q[1] - p[1]) * (r[2] - p[2]) - (q[2] - p[2]) * (r[1] - p[1]);
    };
    const auto is_in = [&](std::size_t k) { return value_[numbers[triangle[k]]] > 0; };
    if (is_in(0) == is_in(1) && is_in(1) == is_in(2)) return is_in(0);
    // One corner lies on its own side of the outline's piece.
    const std::size_t alone = is_in(1) == is_in(2) ? 0 : is_in(0) == is_in(2) ? 1 : 2;
    const std::array<double, 3> part{cross(b, c, weights), cross(c, a, weights), cross(a, b, weights)};
    const double whole = part[0] + part[1] + part[2];
    double away = 0;
    for (const std::size_t k : {(alone + 1) % 3, (alone + 2) % 3}) {
        const Index from = numbers[triangle[alone]], to = numbers[triangle[k]];
        const double share = crossing(std::min(from, to), std::max(from, to));
        away += part[k] / whole / (from < to ? share : 1 - share);
    }
    return is_in(alone) == (away < 1);
}

double PaintedFigure::crossing(Index low, Index high) const {
    const auto from = static_cast<double>(value_[low]), to = static_cast<double>(value_[high]);
    return std::clamp(from / (from - to), nearest_to_node, 1 - nearest_to_node);
}

std::vector<bool> PaintedFigure::faces() const {
    const TexelGrid& grid = colours_->grid;
    std::vector<char> inside(grid.mesh().number_of_faces(), 0);
    parallel_for(inside.size(), 1024, [&](std::size_t f) {
        const Face face(static_cast<Index>(f));
        std::vector<Index> numbers;
        grid.nodes_of(face, numbers);
        const FaceDivision& division = grid.division(face);
        double balance = 0;
        for (const auto& triangle : division.triangles) {
            double sum = 0, size = 0;
            for (const Index node : triangle) sum += value_[numbers[node]] > 0 ? 1 : -1;
            const auto &a = division.nodes[triangle[0]].weights, &b = division.nodes[triangle[1]].weights,
                       &c = division.nodes[triangle[2]].weights;
            size = std::abs((b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]));
            balance += sum * size;
        }
        inside[f] = balance > 0 ? 1 : 0;
    });
    return {inside.begin(), inside.end()};
}

std::vector<SurfaceCurve> PaintedFigure::outline() const {
    const TexelGrid& grid = colours_->grid;
    const std::size_t count = grid.mesh().number_of_faces(), block = 1024;
    std::vector<std::vector<SurfaceCurve>> parts((count + block - 1) / block);
    parallel_blocks(count, block, [&](std::size_t begin, std::size_t end) {
        std::vector<Index> numbers;
        for (std::size_t f = begin; f < end; ++f) {
            const Face face(static_cast<Index>(f));
            grid.nodes_of(face, numbers);
            for (const auto& triangle : grid.division(face).triangles) {
                SurfaceCurve piece;
                for (std::size_t k = 0; k < 3; ++k) {
                    Index a = triangle[k], b = triangle[(k + 1) % 3];
                    if (numbers[a] > numbers[b]) std::swap(a, b);
                    if ((value_[numbers[a]] > 0) == (value_[numbers[b]] > 0)) continue;
                    piece.points.push_back(grid.between(face, a, b, numbers, crossing(numbers[a], numbers[b])));
                }
                if (piece.points.size() != 2) continue;
                piece.faces.push_back(face);
                parts[begin / block].push_back(std::move(piece));
            }
        }
    });
    std::vector<SurfaceCurve> all;
    for (auto& part : parts) std::move(part.begin(), part.end(), std::back_inserter(all));
    return all;
}

}  // namespace ostraka

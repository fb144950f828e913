#include "ostraka/annotation/smooth_regions.h"

#include "ostraka/core/progress.h"
#include "ostraka/geom/chains.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace ostraka {

namespace {

/// Labels with their weights, by ascending label.
using Shares = std::vector<std::pair<int, double>>;

void add_share(Shares& shares, int label, double share) {
    const auto at = std::lower_bound(shares.begin(), shares.end(), label, [](const auto& one, int l) { return one.first < l; });
    if (at != shares.end() && at->first == label) at->second += share;
    else shares.insert(at, {label, share});
}

double share_of(const Shares& shares, int label) {
    const auto at = std::lower_bound(shares.begin(), shares.end(), label, [](const auto& one, int l) { return one.first < l; });
    return at != shares.end() && at->first == label ? at->second : 0;
}

void normalise(Shares& shares) {
    double sum = 0;
    for (const auto& [label, share] : shares) sum += share;
    for (auto& [label, share] : shares) share = sum > 0 ? share / sum : 1.0 / static_cast<double>(shares.size());
}

/// End point of a border line in a face, on which two labels have equal weights and no other has a larger one.
struct Crossing {
    std::array<double, 3> weights;  // barycentric coordinates
    std::size_t side = 3;           // the side of the face that the point lies on; 3: interior
};

class Smoothing {
public:
    Smoothing(const Mesh& mesh, const std::vector<int>& labels, int rounds) : mesh_(mesh), labels_(labels) {
        shares_.resize(mesh.number_of_vertices());
        for (const Face face : mesh.faces()) {
            const double area = std::sqrt(triangle_area_squared(face));
            for (const Vertex v : corners(mesh, face)) add_share(shares_[v.idx()], labels[face.idx()], area);
        }
        for (Shares& shares : shares_) normalise(shares);
        for (int round = 0; round < rounds; ++round) {
            check_cancelled();
            smooth();
        }
        keep_what_would_vanish();
    }

    [[nodiscard]] SmoothRegions result() {
        SmoothRegions made;
        for (const Face face : mesh_.faces()) {
            const std::vector<int> candidates = candidates_of(face);
            if (candidates.size() < 2) continue;
            const auto vertices = corners(mesh_, face);
            std::vector<std::array<double, 3>> weights;
            for (const int label : candidates) {
                std::array<double, 3> at{};
                for (std::size_t k = 0; k < 3; ++k) at[k] = share_of(shares_[vertices[k].idx()], label);
                weights.push_back(at);
                SmoothRegions::Patch& patch = made.patches.emplace_back();
                patch.face = face.idx();
                patch.label = label;
                for (std::size_t k = 0; k < 3; ++k) patch.weights[k] = static_cast<float>(at[k]);
            }
            for (std::size_t a = 0; a < candidates.size(); ++a)
                for (std::size_t b = a + 1; b < candidates.size(); ++b) add_border(face, candidates, weights, a, b);
        }
        for (const Edge edge : mesh_.edges()) add_kept_border(edge);
        for (const auto& chain : chains_of(segments_)) {
            std::vector<Point>& line = made.outlines.emplace_back();
            for (const std::size_t end : chain) line.push_back(points_[end]);
        }
        return made;
    }

private:
    [[nodiscard]] double triangle_area_squared(Face face) const {
        const auto [a, b, c] = corners(mesh_, face);
        const Vector cross = CGAL::cross_product(mesh_.point(b) - mesh_.point(a), mesh_.point(c) - mesh_.point(a));
        return cross.squared_length();
    }

    void smooth() {
        std::vector<std::pair<Index, Shares>> changed;
        for (const Vertex v : mesh_.vertices()) {
            if (mesh_.is_isolated(v)) continue;
            Shares sum;
            double count = 0;
            bool mixed = shares_[v.idx()].size() > 1;
            for (const Vertex w : CGAL::vertices_around_target(mesh_.halfedge(v), mesh_)) {
                mixed = mixed || shares_[w.idx()] != shares_[v.idx()];
                count += 1;
            }
            if (!mixed || count == 0) continue;
            for (const Vertex w : CGAL::vertices_around_target(mesh_.halfedge(v), mesh_))
                for (const auto& [label, share] : shares_[w.idx()]) add_share(sum, label, 0.5 * share / count);
            for (const auto& [label, share] : shares_[v.idx()]) add_share(sum, label, 0.5 * share);
            changed.emplace_back(v.idx(), std::move(sum));
        }
        for (auto& [v, shares] : changed) shares_[v] = std::move(shares);
    }

    void keep_what_would_vanish() {
        std::set<int> seen;
        for (const Shares& shares : shares_)
            if (!shares.empty())
                seen.insert(std::max_element(shares.begin(), shares.end(), [](const auto& a, const auto& b) {
                                return a.second < b.second;
                            })->first);
        for (const int label : labels_)
            if (!seen.contains(label)) kept_.insert(label);
        if (kept_.empty()) return;
        for (Shares& shares : shares_) {
            std::erase_if(shares, [&](const auto& one) { return kept_.contains(one.first); });
            if (!shares.empty()) normalise(shares);
        }
    }

    [[nodiscard]] bool is_kept(Face face) const { return kept_.contains(labels_[face.idx()]); }

    [[nodiscard]] std::vector<int> candidates_of(Face face) const {
        std::vector<int> list;
        if (is_kept(face)) return list;
        for (const Vertex v : corners(mesh_, face))
            for (const auto& [label, share] : shares_[v.idx()]) list.push_back(label);
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
        return list;
    }

    void add_border(Face face, const std::vector<int>& labels, const std::vector<std::array<double, 3>>& weights, std::size_t a,
                    std::size_t b) {
        std::array<double, 3> difference{};
        for (std::size_t k = 0; k < 3; ++k) difference[k] = weights[a][k] - weights[b][k];
        std::vector<Crossing> ends;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            if ((difference[k] < 0) == (difference[next] < 0)) continue;
            Crossing& end = ends.emplace_back();
            end.weights = {0, 0, 0};
            end.side = k;
            end.weights[next] = difference[k] / (difference[k] - difference[next]);
            end.weights[k] = 1 - end.weights[next];
        }
        if (ends.size() != 2) return;
        // Clips the border where a third label has a larger weight.
        const auto at = [&](std::size_t label, const Crossing& place) {
            double weight = 0;
            for (std::size_t k = 0; k < 3; ++k) weight += weights[label][k] * place.weights[k];
            return weight;
        };
        double begin = 0, end = 1;
        std::size_t begin_with = labels.size(), end_with = labels.size();
        for (std::size_t c = 0; c < labels.size(); ++c) {
            if (c == a || c == b) continue;
            const double first = at(a, ends[0]) - at(c, ends[0]), last = at(a, ends[1]) - at(c, ends[1]);
            if (first < 0 && last < 0) return;
            if (first >= 0 && last >= 0) continue;
            const double share = first / (first - last);
            if (first < 0 && share > begin) begin = share, begin_with = c;
            if (last < 0 && share < end) end = share, end_with = c;
        }
        if (!(begin < end)) return;
        const auto number = [&](double share, std::size_t with, const Crossing& whole) {
            Crossing place = whole;
            std::array<std::int64_t, 4> key{};
            if (with == labels.size()) {
                const auto halfedge = side_of(face, whole.side);
                key = {0, static_cast<std::int64_t>(mesh_.edge(halfedge).idx()), labels[a], labels[b]};
            } else {
                for (std::size_t k = 0; k < 3; ++k)
                    place.weights[k] = (1 - share) * ends[0].weights[k] + share * ends[1].weights[k];
                std::array<int, 3> three{labels[a], labels[b], labels[with]};
                std::sort(three.begin(), three.end());
                key = {1 + static_cast<std::int64_t>(face.idx()), three[0], three[1], three[2]};
            }
            return numbered(key, point_at(face, place.weights));
        };
        const std::size_t from = number(begin, begin_with, ends[0]), to = number(end, end_with, ends[1]);
        if (from != to) segments_.push_back({from, to});
    }

    /// The edge from corner k to the next corner.
    [[nodiscard]] Halfedge side_of(Face face, std::size_t k) const {
        const auto vertices = corners(mesh_, face);
        return mesh_.halfedge(vertices[k], vertices[(k + 1) % 3]);
    }

    [[nodiscard]] Point point_at(Face face, const std::array<double, 3>& weights) const {
        const auto vertices = corners(mesh_, face);
        Vector sum(0, 0, 0);
        for (std::size_t k = 0; k < 3; ++k) sum = sum + weights[k] * (mesh_.point(vertices[k]) - CGAL::ORIGIN);
        return CGAL::ORIGIN + sum;
    }

    std::size_t numbered(const std::array<std::int64_t, 4>& key, const Point& point) {
        const auto [at, fresh] = numbers_.try_emplace(key, points_.size());
        if (fresh) points_.push_back(point);
        return at->second;
    }

    void add_kept_border(Edge edge) {
        if (kept_.empty()) return;
        const Halfedge halfedge = mesh_.halfedge(edge);
        const Face left = mesh_.face(halfedge), right = mesh_.face(mesh_.opposite(halfedge));
        const bool left_kept = left != Mesh::null_face() && is_kept(left),
                   right_kept = right != Mesh::null_face() && is_kept(right);
        if (!left_kept && !right_kept) return;
        if (left_kept && right_kept && labels_[left.idx()] == labels_[right.idx()]) return;
        const auto end = [&](Vertex v) { return numbered({-1, static_cast<std::int64_t>(v.idx()), 0, 0}, mesh_.point(v)); };
        segments_.push_back({end(mesh_.source(halfedge)), end(mesh_.target(halfedge))});
    }

    const Mesh& mesh_;
    const std::vector<int>& labels_;
    std::vector<Shares> shares_;
    std::set<int> kept_;
    std::map<std::array<std::int64_t, 4>, std::size_t> numbers_;
    std::vector<Point> points_;
    std::vector<std::array<std::size_t, 2>> segments_;
};

}  // namespace

SmoothRegions smooth_regions(const Mesh& mesh, const std::vector<int>& label_of_face, int rounds) {
    return Smoothing(mesh, label_of_face, rounds).result();
}

}  // namespace ostraka

#include "ostraka/select/creases.h"

#include "ostraka/annotation/outline.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/text.h"
#include "ostraka/fields/curvature.h"
#include "ostraka/fields/statistics.h"
#include "ostraka/measure/descriptors.h"
#include "ostraka/mesh/flood.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <set>

namespace ostraka {

namespace {

/// Beside a strong crease the surroundings respond with the opposite sign: a response below this share of the crease's is an
/// echo.
constexpr double echo = 0.3;

struct Response {
    std::vector<double> curvature, values;
    double deviation = 0;
};

double robust_deviation(const Mesh& mesh, const std::vector<double>& values) {
    std::vector<double> sizes(values.size()), areas(values.size(), 0);
    for (std::size_t i = 0; i < values.size(); ++i) sizes[i] = std::abs(values[i]);
    for (const Face f : mesh.faces())
        for (const Vertex v : corners(mesh, f)) areas[v] += face_area(mesh, f) / 3;
    return 1.4826 * quantile(sizes, areas, 0.5, "creases");
}

std::string text(double value) { return digits(value, 3); }

void check(const Mesh& mesh, const CreaseOptions& options) {
    check_options(options, "creases");
    if (options.lower_threshold > options.upper_threshold)
        fail_usage("creases begin at a response of " + text(options.lower_threshold) + " (weak), but need to reach " +
                       text(options.upper_threshold) + " (strong) only",
                   "let --weak be at most --strong");
    const double edge = mean_edge_length(mesh), radius = options.scale * box_diagonal(mesh);
    // A ball smaller than an edge contains nothing to average over.
    if (radius >= edge) return;
    const double minimum = std::ceil(1000 * edge / box_diagonal(mesh)) / 1000;
    fail_usage("a scale of " + text(options.scale) + " of the diagonal is a radius of " + text(radius) +
                   ", but the mesh's edges are " + text(edge) + " long in the mean: it is too coarse for that",
               (minimum <= 0.5 ? "use --scale " + text(minimum) + " or more, or refine" : std::string("refine")) +
                   " the mesh (ostraka mesh refine)");
}

Response respond(const Mesh& mesh, const CreaseOptions& options) {
    check(mesh, options);
    const double radius = options.scale * box_diagonal(mesh);
    Response response;
    response.curvature = curvature(mesh, {options.scale}).mean;
    const std::vector<double> wide = curvature(mesh, {std::min(1.0, options.scale * options.background_scale)}).mean;
    std::vector<double>& values = response.values;
    values.assign(wide.size(), 0);
    // Beside a border few faces of the ball are left, so that noise counts more than anywhere else.
    const auto is_beside_border = [&](Vertex v) {
        if (mesh.is_isolated(v)) return true;
        const auto ring = mesh.vertices_around_target(mesh.halfedge(v));
        return std::any_of(ring.begin(), ring.end(), [&](Vertex w) { return mesh.is_border(w); });
    };
    for (const Vertex v : mesh.vertices()) {
        if (!std::isnan(response.curvature[v]) && !std::isnan(wide[v]) && !is_beside_border(v))
            values[v] = radius * (response.curvature[v] - wide[v]);
        else response.curvature[v] = 0;
    }
    if (mesh.number_of_faces() > 0) response.deviation = robust_deviation(mesh, values);
    for (const Vertex v : mesh.vertices())
        if (values[v] * response.curvature[v] < 0) values[v] = 0;
    return response;
}

/// A connected set of vertices of one sign, with path searches along its crest.
class Patch {
public:
    /// `place` has one entry per vertex of the mesh.
    Patch(const Mesh& mesh, const std::vector<double>& strength, std::vector<Index> vertices, std::vector<Index>& place)
        : mesh_(mesh), strength_(strength), place_(place), vertices_(std::move(vertices)) {
        for (std::size_t i = 0; i < vertices_.size(); ++i) place_[vertices_[i]] = static_cast<Index>(i);
        std::set<Index> faces;
        for (const Index v : vertices_)
            for (const Face f : mesh_.faces_around_target(mesh_.halfedge(Vertex(v))))
                if (f != Mesh::null_face() && holds(f)) faces.insert(f.idx());
        faces_.assign(faces.begin(), faces.end());
    }

    [[nodiscard]] const std::vector<Index>& faces() const { return faces_; }

    /// The line along the crest; a loop if the patch is a ring.
    [[nodiscard]] std::vector<Index> line() const {
        std::vector<Index> open = open_line();
        std::vector<Outline> outlines = faces_.empty() ? std::vector<Outline>() : extract_outlines(mesh_, faces_);
        if (outlines.size() < 2) return open;
        std::stable_sort(outlines.begin(), outlines.end(),
                         [&](const Outline& a, const Outline& b) { return length_of(a) > length_of(b); });
        // A ring has two borders of similar length; a hole in a patch is shorter.
        if (length_of(outlines[1]) < 0.3 * length_of(outlines[0])) return open;
        std::vector<Index> ring = loop(outlines[0], outlines[1]);
        return ring.empty() ? open : ring;
    }

    [[nodiscard]] double length_of(const std::vector<Index>& line) const {
        double sum = 0;
        for (std::size_t i = 1; i < line.size(); ++i) sum += distance(line[i - 1], line[i]);
        return sum;
    }

private:
    static constexpr double infinite = std::numeric_limits<double>::infinity();
    using State = std::size_t;  ///< two per vertex of the patch: the sheets of the double cover
    static constexpr State none = std::numeric_limits<State>::max();

    [[nodiscard]] State state(Index v, int sheet = 0) const { return 2 * State{place_[v]} + static_cast<State>(sheet); }
    [[nodiscard]] Index vertex(State s) const { return vertices_[s / 2]; }

    [[nodiscard]] bool holds(Index v) const { return place_[v] < vertices_.size() && vertices_[place_[v]] == v; }
    [[nodiscard]] bool holds(Face f) const {
        const auto c = corners(mesh_, f);
        return holds(c[0].idx()) && holds(c[1].idx()) && holds(c[2].idx());
    }
    [[nodiscard]] double distance(Index a, Index b) const {
        return std::sqrt(CGAL::squared_distance(mesh_.point(Vertex(a)), mesh_.point(Vertex(b))));
    }
    /// Edge length, weighted less where the response is strong.
    [[nodiscard]] double cost(Index a, Index b) const {
        const double s = (strength_[a] + strength_[b]) / 2;
        return distance(a, b) / (s * s);
    }

    struct Tree {
        std::vector<double> costs, lengths;  ///< one per state; infinite if unreachable
        std::vector<State> previous;
    };
    /// Cheapest paths from some vertices on the first sheet. `step` returns the sheet that an edge leads to, or -1 for a
    /// forbidden edge.
    template <class Step>
    [[nodiscard]] Tree search(const std::vector<Index>& sources, const Step& step) const {
        const std::size_t states = 2 * vertices_.size();
        Tree tree{std::vector<double>(states, infinite), std::vector<double>(states, infinite), std::vector<State>(states, none)};
        using Entry = std::pair<double, State>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        for (const Index v : sources) {
            tree.costs[state(v)] = tree.lengths[state(v)] = 0;
            queue.emplace(0, state(v));
        }
        CancelCheck check;
        while (!queue.empty()) {
            check();
            const auto [spent, here] = queue.top();
            queue.pop();
            if (spent > tree.costs[here]) continue;
            const Index v = vertex(here);
            for (const Vertex n : mesh_.vertices_around_target(mesh_.halfedge(Vertex(v)))) {
                if (!holds(n.idx())) continue;
                const int sheet = step(v, n.idx(), static_cast<int>(here % 2));
                if (sheet < 0) continue;
                const State next = state(n.idx(), sheet);
                const double total = spent + cost(v, n.idx());
                if (!(total < tree.costs[next])) continue;
                tree.costs[next] = total;
                tree.lengths[next] = tree.lengths[here] + distance(v, n.idx());
                tree.previous[next] = here;
                queue.emplace(total, next);
            }
        }
        return tree;
    }
    [[nodiscard]] Tree search(const std::vector<Index>& sources) const {
        return search(sources, [](Index, Index, int sheet) { return sheet; });
    }
    [[nodiscard]] std::vector<Index> way(const Tree& tree, State to) const {
        std::vector<Index> path;
        for (State s = to; s != none; s = tree.previous[s]) path.push_back(vertex(s));
        std::reverse(path.begin(), path.end());
        return path;
    }

    /// The path along the crest from the end of the patch farthest from its strongest vertex to the opposite end.
    [[nodiscard]] std::vector<Index> open_line() const {
        const auto farthest = [&](Index from) {
            const Tree tree = search({from});
            State best = state(from);
            for (State s = 0; s < tree.lengths.size(); ++s)
                if (tree.lengths[s] < infinite && tree.lengths[s] > tree.lengths[best]) best = s;
            return way(tree, best);
        };
        const Index top =
            *std::max_element(vertices_.begin(), vertices_.end(), [&](Index a, Index b) { return strength_[a] < strength_[b]; });
        return farthest(farthest(top).back());
    }

    /// Adds the edges from a vertex of the cut to its neighbours on the left of the cut.
    void left_of(const std::vector<Index>& cut, std::size_t i, std::set<std::pair<Index, Index>>& left) const {
        const bool forward = i + 1 < cut.size();
        const Halfedge start = find_halfedge(mesh_, Vertex(cut[i]), Vertex(forward ? cut[i + 1] : cut[i - 1]));
        const Index stop = forward && i > 0 ? cut[i - 1] : no_index;
        // Counter-clockwise from the next vertex of the cut, or clockwise from the previous one.
        Halfedge h = start;
        while (true) {
            const Halfedge side = forward ? h : mesh_.opposite(h);
            if (mesh_.is_border(side) || !holds(mesh_.face(side))) return;
            h = forward ? mesh_.opposite(mesh_.prev(h)) : mesh_.next(mesh_.opposite(h));
            if (h == start || mesh_.target(h).idx() == stop) return;
            left.emplace(cut[i], mesh_.target(h).idx());
        }
    }

    /// The cheapest loop that runs once around the ring between its two borders.
    [[nodiscard]] std::vector<Index> loop(const Outline& one, const Outline& other) const {
        const Tree across = search(one);
        State end = state(other.front());
        for (const Index v : other)
            if (across.costs[state(v)] < across.costs[end]) end = state(v);
        const std::vector<Index> cut = way(across, end);
        if (!(across.costs[end] < infinite) || cut.size() < 2) return {};
        const std::set<Index> on_cut(cut.begin(), cut.end());
        std::set<std::pair<Index, Index>> left;
        for (std::size_t i = 0; i < cut.size(); ++i) left_of(cut, i, left);
        const auto step = [&](Index from, Index to, int sheet) {
            const bool leaves = on_cut.contains(from) && !on_cut.contains(to) && left.contains({from, to});
            const bool enters = on_cut.contains(to) && !on_cut.contains(from) && left.contains({to, from});
            const int next = sheet + (leaves ? 1 : 0) - (enters ? 1 : 0);
            return next == 0 || next == 1 ? next : -1;
        };
        std::vector<Index> best;
        double best_cost = infinite;
        for (const Index v : cut) {
            const Tree tree = search({v}, step);
            if (!(tree.costs[state(v, 1)] < best_cost)) continue;
            best_cost = tree.costs[state(v, 1)];
            best = way(tree, state(v, 1));
        }
        return best;
    }

    const Mesh& mesh_;
    const std::vector<double>& strength_;
    std::vector<Index>& place_;  ///< index in vertices_, for vertices of the patch
    std::vector<Index> vertices_, faces_;
};

/// The largest response of the other sign among the vertices connected with `top` within the search radius.
double rival(const Mesh& mesh, const std::vector<double>& strength, Index top, double search_radius) {
    std::set<Index> met{top};
    std::vector<Index> queue{top};
    double maximum = 0;
    for (std::size_t k = 0; k < queue.size(); ++k)
        for (const Vertex n : mesh.vertices_around_target(mesh.halfedge(Vertex(queue[k])))) {
            if (CGAL::squared_distance(mesh.point(n), mesh.point(Vertex(top))) > search_radius * search_radius ||
                !met.insert(n.idx()).second)
                continue;
            maximum = std::max(maximum, -strength[n]);
            queue.push_back(n.idx());
        }
    return maximum;
}

}  // namespace

std::vector<Crease> find_creases(const Mesh& mesh, const CreaseOptions& options) {
    const Response response = respond(mesh, options);
    if (mesh.number_of_faces() == 0) return {};
    const double deviation = response.deviation, diagonal = box_diagonal(mesh);
    const double weak = std::max(options.floor, options.lower_threshold * deviation),
                 strong = std::max(weak, options.upper_threshold * deviation);
    std::vector<Crease> creases;
    std::vector<Index> place(mesh.number_of_vertices(), no_index);
    for (const bool ridge : {true, false}) {
        if (options.kind == (ridge ? CreaseOptions::Kind::hollow : CreaseOptions::Kind::ridge)) continue;
        std::vector<double> strength(response.values.size());
        for (std::size_t i = 0; i < strength.size(); ++i) strength[i] = (ridge ? 1 : -1) * response.values[i];
        std::vector<bool> seen(strength.size(), false);
        for (const Vertex seed : mesh.vertices()) {
            if (seen[seed] || !(strength[seed] > weak)) continue;
            const std::vector<Vertex> reached = flood_vertices(mesh, seed, seen, [&](Vertex v) { return strength[v] > weak; });
            const Index top =
                *std::max_element(reached.begin(), reached.end(), [&](Vertex a, Vertex b) { return strength[a] < strength[b]; });
            std::vector<Index> patch(reached.begin(), reached.end());
            if (!(strength[top] > strong) ||
                strength[top] < echo * rival(mesh, strength, top, options.background_scale * options.scale * diagonal))
                continue;
            std::sort(patch.begin(), patch.end());
            const Patch ground(mesh, strength, std::move(patch), place);
            Crease crease;
            crease.ridge = ridge;
            crease.faces = ground.faces();
            crease.line = ground.line();
            crease.length = ground.length_of(crease.line);
            if (crease.faces.empty() || !(crease.length >= options.shortest * diagonal)) continue;
            crease.closed = crease.line.front() == crease.line.back();
            crease.width = area_of(mesh, crease.faces) / crease.length;
            for (const Index v : crease.line) {
                crease.mean_curvature += response.curvature[v] / double(crease.line.size());
                crease.strength += strength[v] / double(crease.line.size());
            }
            crease.strength = std::min(1e6, deviation > 0 ? crease.strength / deviation : 1e6);
            creases.push_back(std::move(crease));
        }
    }
    std::stable_sort(creases.begin(), creases.end(),
                     [](const Crease& a, const Crease& b) { return a.length * a.strength > b.length * b.strength; });
    return creases;
}

namespace {
/// Colours: warm for ridges, cold for hollows, six tones of each in turn.
std::array<int, 3> shade(bool ridge, int number) {
    static constexpr std::array<std::array<int, 3>, 6> warm{
        {{213, 94, 0}, {230, 159, 0}, {153, 27, 30}, {240, 120, 110}, {120, 70, 20}, {250, 200, 90}}};
    static constexpr std::array<std::array<int, 3>, 6> cold{
        {{0, 114, 178}, {86, 180, 233}, {0, 140, 110}, {60, 50, 150}, {120, 200, 170}, {150, 130, 220}}};
    return (ridge ? warm : cold).at(static_cast<std::size_t>(number - 1) % 6);
}
}  // namespace

AnnotationSet annotate_creases(const std::vector<Crease>& creases, bool regions, const std::string& unit) {
    AnnotationSet set;
    set.unit = unit;
    int ridges = 0, hollows = 0;
    for (const Crease& crease : creases) {
        const int number = crease.ridge ? ++ridges : ++hollows;
        Annotation annotation;
        annotation.id = free_id(set);
        annotation.tag = (crease.ridge ? "ridge " : "hollow ") + std::to_string(number);
        annotation.colour = shade(crease.ridge, number);
        annotation.type = regions ? AnnotationType::region : AnnotationType::line;
        if (regions) annotation.faces = crease.faces;
        else annotation.polylines = {crease.line};
        std::vector<Quantity> quantities{{"width", {crease.width}, false, 1, {}},
                                         {"mean curvature", {crease.mean_curvature}, false, -1, {}},
                                         {"strength", {crease.strength}, false, 0, {}}};
        if (!regions) quantities.insert(quantities.begin(), {"length", {crease.length}, false, 1, {}});
        store(annotation, quantities, unit);
        set.annotations.push_back(std::move(annotation));
    }
    return set;
}

void CreaseOptions::declare_options(OptionList& list) {
    list("kind", kind, "kind of crease: ridges (clay that stands out), hollows (where parts meet), or both",
         Choices{"ridge", "hollow", "both"});
    list("scale", scale, "radius over which curvature is averaged: about the crease width", Range{1e-6, 0.5},
         "share of the box diagonal");
    list("background-scale", background_scale,
         "radius of the neighbourhood with which a place is compared, as a multiple of --scale", Range{1.1, 20});
    list("weak", lower_threshold,
         "lower hysteresis threshold of the crease response, in robust standard deviations over the surface", Range{0, 1000});
    list("strong", upper_threshold,
         "upper hysteresis threshold, which each crease exceeds somewhere, in robust standard deviations", Range{0, 1000});
    list("floor", floor, "minimum response (curvature times scale) of a crease", Range{0, 100});
    list("shortest", shortest, "minimum length of a crease", Range{0, 10}, "share of the box diagonal");
}

}  // namespace ostraka

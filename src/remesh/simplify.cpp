#include "ostraka/remesh/simplify.h"
#include "ostraka/core/angles.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/mesh/disjoint_sets.h"
#include "remesh/collapse.h"
#include "remesh/collapse_rules.h"
#include "remesh/indexed_heap.h"
#include "remesh/metric.h"
#include "remesh/seam_drift.h"

#include <fmt/core.h>

#include <cmath>

namespace ostraka {

namespace {

/// Requirements on a collapse; relaxed from stage to stage while the number is not reached.
struct Stage {
    double max_normal_change;  ///< degrees
    bool good_shapes;          ///< no face becomes thinner than `thinnest` unless it was before
    bool keep_outlines;
};

class Simplifier {
public:
    Simplifier(Mesh& mesh, const SimplifyOptions& options, Marks marks, CollapseVisitor* visitor)
        : mesh_(mesh),
          options_(options),
          visitor_(visitor),
          frame_(make_frame(mesh)),
          marks_(std::move(marks)),
          rules_(mesh, marks_, options.outlines == SimplifyOptions::Outlines::protect),
          metric_(options.method == SimplifyOptions::Method::qem ? make_quadric_metric(mesh, frame_, marks_, options)
                                                                 : make_lindstrom_turk_metric(frame_)),
          drift_(mesh, frame_, marks_.seams, 0.9 * options.seam_drift),  // the rest: places between the points of a stretch
          heap_(mesh.number_of_edges()),
          merged_(mesh.number_of_vertices()),
          remaining_(mesh.number_of_vertices()) {}

    void run(std::size_t target, SimplifyResult& result) {
        const bool can_break = options_.outlines == SimplifyOptions::Outlines::follow && rules_.any_marks();
        std::vector<Stage> stages{{options_.max_normal_change, true, true}, {90, false, true}};
        if (can_break) stages.insert(stages.end(), {{options_.max_normal_change, true, false}, {90, false, false}});
        Progress progress("simplify", remaining_ - std::min(remaining_, target));
        for (const Stage& stage : stages) {
            stage_ = stage;
            rules_.keep_outlines(mesh_, stage.keep_outlines);
            // Refused collapses may be possible after the neighbourhood has changed: repeat as long as that helps.
            std::size_t previous;
            do {
                previous = remaining_;
                sweep(target, progress);
            } while (remaining_ > target && previous > remaining_ + remaining_ / 100);
            if (remaining_ <= target) break;
        }
        result.collapses = collapses_;
        result.outlines_broken = rules_.broken();
        result.reached = remaining_ == target;
        result.stop_reason = result.reached ? "the requested number of vertices was reached" : explain(target);
        result.vertex_map.resize(merged_.size());
        for (std::size_t v = 0; v < merged_.size(); ++v) result.vertex_map[v] = merged_.find(v);
    }

private:
    /// Collapses in the order of cost until the number is reached or no edge may be collapsed.
    void sweep(std::size_t target, Progress& progress) {
        refused_topology_ = refused_shape_ = refused_drift_ = 0;
        CancelCheck check;
        for (const Edge e : mesh_.edges()) {
            check();
            evaluate(e);
        }
        while (remaining_ > target && !heap_.empty()) {
            check();
            const Edge e(heap_.top());
            heap_.remove(e);
            if (try_collapse(e)) progress.advance();
        }
    }

    /// Inserts the edge into the heap with its cost, or removes it.
    void evaluate(Edge e) {
        const std::optional<CollapsePlan> plan = rules_.plan(mesh_, e);
        if (!plan) return heap_.remove(e);
        heap_.set(e, places(*plan).front().cost);
    }

    /// The candidate positions, the best first.
    struct Places {
        std::array<CollapsePlace, 4> positions;
        std::size_t count = 0;
        [[nodiscard]] const CollapsePlace& front() const { return positions[0]; }
        void add(const CollapsePlace& p) { positions[count++] = p; }
    };
    [[nodiscard]] Places places(const CollapsePlan& plan) const {
        Places result;
        const Vector v = frame_.local(mesh_.point(mesh_.target(plan.halfedge)));
        if (plan.pinned) {
            result.add({v, metric_->cost(mesh_, plan.halfedge, v)});
            return result;
        }
        const Vector u = frame_.local(mesh_.point(mesh_.source(plan.halfedge)));
        const Vector middle = u + (v - u) / 2;
        const std::optional<CollapsePlace> best = metric_->best(mesh_, plan.halfedge);
        // An ill-conditioned position far away would only be refused later.
        if (best && (best->position - middle).squared_length() <= 4 * (v - u).squared_length()) {
            result.add(*best);
            return result;
        }
        for (const Vector& x : {middle, u, v}) result.add({x, metric_->cost(mesh_, plan.halfedge, x)});
        std::stable_sort(result.positions.begin(), result.positions.begin() + 3,
                         [](const CollapsePlace& a, const CollapsePlace& b) { return a.cost < b.cost; });
        return result;
    }

    bool try_collapse(Edge e) {
        const std::optional<CollapsePlan> plan = rules_.plan(mesh_, e);
        if (!plan) return false;
        const Halfedge h = plan->halfedge;
        if (!may_collapse(mesh_, h)) return ++refused_topology_, false;
        const Vertex u = mesh_.source(h), v = mesh_.target(h);
        Places candidates = places(*plan);
        if (!plan->pinned && candidates.count == 1) {
            const Vector a = frame_.local(mesh_.point(u)), b = frame_.local(mesh_.point(v));
            for (const Vector& x : {Vector(a + (b - a) / 2), a, b}) candidates.add({x, 0});
        }
        const CollapsePlace* chosen = nullptr;
        bool drifts = false;
        for (std::size_t i = 0; i < candidates.count && chosen == nullptr; ++i) {
            const CollapsePlace& place = candidates.positions[i];
            if (!keeps_shape(h, place.position, plan->pinned)) continue;
            if (drift_.keeps(mesh_, h, place.position, plan->pinned)) chosen = &place;
            else drifts = true;
        }
        if (chosen == nullptr) return ++(drifts ? refused_drift_ : refused_shape_), false;
        drift_.apply();
        const Point position = plan->pinned ? mesh_.point(v) : frame_.world(chosen->position);
        if (visitor_ != nullptr) visitor_->place_vertex(mesh_, h, position);
        mesh_.point(v) = position;
        merge(h);
        return true;
    }

    void merge(Halfedge h) {
        const Vertex u = mesh_.source(h), v = mesh_.target(h);
        for (const Halfedge side : {h, mesh_.opposite(h)})
            if (!mesh_.is_border(side)) heap_.remove(mesh_.edge(mesh_.source(side) == u ? mesh_.prev(side) : mesh_.next(side)));
        heap_.remove(mesh_.edge(h));
        rules_.before_collapse(mesh_, h);
        collapse(mesh_, h, visitor_);
        metric_->merged(v, u);
        merged_.unite_into(v, u);
        --remaining_;
        ++collapses_;
        for_each_incoming(mesh_, v, [&](Halfedge g) { evaluate(mesh_.edge(g)); });
        if (!metric_->reaches_second_ring()) return;
        for_each_incoming(mesh_, v, [&](Halfedge g) {
            for_each_incoming(mesh_, mesh_.source(g), [&](Halfedge k) {
                if (mesh_.source(k) != v) evaluate(mesh_.edge(k));
            });
        });
    }

    /// Whether no face around the ends of h is flipped, rotated too far or flattened when both ends move to x.
    [[nodiscard]] bool keeps_shape(Halfedge h, const Vector& x, bool target_stays) const {
        constexpr double thinnest = 0.02;  // area over sum of squared edge lengths, twice; 0.29 for an equilateral triangle
        constexpr double flat = 1e-9;
        const double min_cosine = std::max(1e-3, std::cos(stage_.max_normal_change * pi / 180));
        bool acceptable = true;
        const auto check = [&](Halfedge g) {  // g ends in the moved vertex
            if (mesh_.is_border(g) || mesh_.face(g) == mesh_.face(h) || mesh_.face(g) == mesh_.face(mesh_.opposite(h))) return;
            const Vector old = frame_.local(mesh_.point(mesh_.target(g)));
            const Vector p = frame_.local(mesh_.point(mesh_.source(g))),
                         q = frame_.local(mesh_.point(mesh_.target(mesh_.next(g))));
            const Vector n_old = CGAL::cross_product(q - old, p - old), n_new = CGAL::cross_product(q - x, p - x);
            const double side = (p - q).squared_length();
            const double sides_old = (q - old).squared_length() + (p - old).squared_length() + side;
            const double sides_new = (q - x).squared_length() + (p - x).squared_length() + side;
            const double length_old = std::sqrt(n_old.squared_length()), length_new = std::sqrt(n_new.squared_length());
            acceptable = length_new > flat * sides_new;
            if (!acceptable || !(length_old > flat * sides_old)) return;  // a face that was flat has no orientation to preserve
            acceptable = n_old * n_new >= min_cosine * length_old * length_new;
            if (acceptable && stage_.good_shapes)
                acceptable = length_new >= thinnest * sides_new || length_new * sides_old >= length_old * sides_new;
        };
        const auto check_ring = [&](Halfedge first) {
            Halfedge g = first;
            do {
                check(g);
                g = mesh_.opposite(mesh_.next(g));
            } while (acceptable && g != first);
        };
        check_ring(mesh_.opposite(h));
        if (acceptable && !target_stays) check_ring(h);
        return acceptable;
    }

    [[nodiscard]] std::string explain(std::size_t target) const {
        const std::size_t bound =
            mesh_.number_of_edges() -
            std::min<std::size_t>(mesh_.number_of_edges(), refused_topology_ + refused_shape_ + refused_drift_);
        return fmt::format(
            "stopped at {} vertices instead of {}: of the remaining {} edges {} would change the topology, {} would flip or "
            "flatten a face{}{}",
            remaining_, target, mesh_.number_of_edges(), refused_topology_, refused_shape_,
            refused_drift_ > 0 ? fmt::format(", {} would move a seam of the texture by more than {:g} of the diagonal",
                                             refused_drift_, options_.seam_drift)
                               : std::string(),
            bound > 0 ? fmt::format(", {} belong to protected parts, to seams of the texture or to the border", bound)
                      : std::string());
    }

    Mesh& mesh_;
    const SimplifyOptions& options_;
    CollapseVisitor* visitor_;
    Frame frame_;
    Marks marks_;
    CollapseRules rules_;
    std::unique_ptr<CollapseMetric> metric_;
    SeamDrift drift_;
    IndexedHeap heap_;
    DisjointSets merged_;
    std::size_t remaining_;
    std::size_t collapses_ = 0;
    std::size_t refused_topology_ = 0, refused_shape_ = 0, refused_drift_ = 0;
    Stage stage_{};
};

struct GarbageMaps {
    std::vector<Index>* vertex_map;
    std::vector<Index>* face_map;
    template <class VertexMap, class HalfedgeMap, class FaceMap>
    void operator()(const VertexMap& vertices, const HalfedgeMap&, const FaceMap& faces) {
        for (Index& v : *vertex_map)
            if (v != no_index) v = vertices[Vertex(v)];
        for (Index& f : *face_map)
            if (f != no_index) f = faces[Face(f)];
    }
};

}  // namespace

SimplifyResult simplify(Mesh& mesh, const SimplifyOptions& options, const MarkedParts& marked, CollapseVisitor* visitor) {
    check_options(options, "simplify");
    if (mesh.has_garbage()) throw std::logic_error("simplify: collect the garbage first");
    if (!marked.edges.empty() && marked.edges.size() != mesh.number_of_edges())
        fail_usage(fmt::format("simplify: there are {} edge flags for {} edges", marked.edges.size(), mesh.number_of_edges()),
                   "give one flag for each edge");
    if (!marked.vertices.empty() && marked.vertices.size() != mesh.number_of_vertices())
        fail_usage(
            fmt::format("simplify: there are {} vertex flags for {} vertices", marked.vertices.size(), mesh.number_of_vertices()),
            "give one flag for each vertex");
    if (!marked.seams.empty() && marked.seams.size() != mesh.number_of_edges())
        fail_usage(fmt::format("simplify: there are {} seam flags for {} edges", marked.seams.size(), mesh.number_of_edges()),
                   "give one flag for each edge");
    for (const Face f : mesh.faces())
        if (mesh.next(mesh.next(mesh.next(mesh.halfedge(f)))) != mesh.halfedge(f))
            fail_input("face " + std::to_string(Index(f)), "is not a triangle");

    // Border vertices must refer to a border halfedge, which not every algorithm guarantees.
    for (const Halfedge h : mesh.halfedges())
        if (mesh.is_border(h)) mesh.set_halfedge(mesh.target(h), h);
    SimplifyResult result;
    std::vector<Vertex> isolated;
    for (const Vertex v : mesh.vertices())
        if (mesh.is_isolated(v)) isolated.push_back(v);
    const std::size_t count = mesh.number_of_vertices() - isolated.size();
    if (options.vertices > count)
        fail_usage(fmt::format("the mesh has {} vertices, fewer than the {} requested", count, options.vertices),
                   "use: ostraka mesh refine");
    Marks marks{marked.edges, marked.vertices, marked.seams, options.keep_border};
    if (marks.seams.empty()) marks.seams.assign(mesh.number_of_edges(), false);
    if (marks.edges.empty() || options.outlines == SimplifyOptions::Outlines::ignore)
        marks.edges.assign(mesh.number_of_edges(), false);
    if (marks.vertices.empty() || options.outlines == SimplifyOptions::Outlines::ignore)
        marks.vertices.assign(mesh.number_of_vertices(), false);

    const std::size_t face_count = mesh.number_of_faces();
    {
        Simplifier simplifier(mesh, options, std::move(marks), visitor);
        simplifier.run(options.vertices + isolated.size(), result);
    }
    for (const Vertex v : isolated) {
        mesh.remove_vertex(v);
        result.vertex_map[v] = no_index;
    }
    result.isolated_dropped = isolated.size();
    result.face_map.resize(face_count);
    for (Index f = 0; f < face_count; ++f) result.face_map[f] = mesh.is_removed(Face(f)) ? no_index : f;
    GarbageMaps maps{&result.vertex_map, &result.face_map};
    mesh.collect_garbage(maps);
    return result;
}

void SimplifyOptions::declare_options(OptionList& list) {
    list("vertices", vertices, "target number of vertices of the mesh", Range{1, 5e8});
    list("method", method,
         "cost and vertex position of an edge collapse: qem (Garland and Heckbert 1997) or lindstrom-turk (1998, memoryless)",
         Choices{"qem", "lindstrom-turk"});
    list("outlines", outlines,
         "treatment of annotated outlines, lines and points: follow (they move and lose vertices, and keep their topology as "
         "long as possible), protect (they stay unchanged) or ignore",
         Choices{"follow", "protect", "ignore"});
    list("max-normal-change", max_normal_change,
         "maximum rotation of a face normal in one edge collapse, in degrees (relaxed up to 90 if the target number of vertices "
         "cannot be reached otherwise)",
         Range{1, 90});
    list("outline-weight", outline_weight, "qem: weight of the distance to outlines, relative to the distance to the surface",
         Range{0, 1e6});
    list("border-weight", border_weight, "qem: weight of the distance to the border, relative to the distance to the surface",
         Range{0, 1e6});
    list("seam-drift", seam_drift, "maximum distance of seams of the texture from where they were", Range{0, 1},
         "share of the box diagonal");
    list("keep-border", keep_border, "keep the border of an open mesh exactly, so that neighbouring tiles still fit");
}

}  // namespace ostraka

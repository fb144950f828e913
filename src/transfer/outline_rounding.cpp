#include "outline_rounding.h"

#include "scores.h"

#include <algorithm>
#include <set>

namespace ostraka {

OutlineRounding::OutlineRounding(const Mesh& source, const AnnotationSet& set, const Mesh& target,
                                 const std::vector<std::vector<SourcePath>>& vertex_paths, PathTracer& tracer)
    : source_(source),
      set_(set),
      target_(target),
      tracer_(tracer),
      source_edge_(mean_edge_length(source)),
      steps_(vertex_paths.size()) {
    for (std::size_t i = 0; i < vertex_paths.size(); ++i) {
        if (set.annotations[i].type != AnnotationType::region) continue;
        TransferScore ignored;  // the same places were settled, and counted, for the paths
        for (const SourcePath& vertex_path : vertex_paths[i])
            for (const PathTracer::Step& step : tracer.trace_curves(vertex_path, ignored)) steps_[i].push_back(step);
    }
    users_.assign(tracer.curves().size(), 0);
    for (const auto& steps : steps_)
        for (const PathTracer::Step& step : steps) ++users_[step.curve];
}

void OutlineRounding::round(std::size_t region, std::vector<bool>& selected, double edge, bool balance) {
    if (steps_[region].empty()) return;
    std::vector<SurfaceCurve> curves;
    std::set<Index> shared;  // vertices along outlines that other regions have in common with this one
    for (const PathTracer::Step& step : steps_[region]) {
        const SurfaceCurve& curve = tracer_.curves()[step.curve];
        if (users_[step.curve] > 1)
            for (const Index f : curve.faces)
                for (const Vertex v : corners(target_, Face(f))) shared.insert(v);
        curves.push_back(curve);
        if (step.backwards) {
            std::reverse(curves.back().nodes.begin(), curves.back().nodes.end());
            std::reverse(curves.back().faces.begin(), curves.back().faces.end());
        }
    }
    std::vector<std::pair<Index, double>> shares = left_shares(target_, curves, 2);
    const auto is_shared = [&](const std::pair<Index, double>& entry) {
        const auto vertices = corners(target_, Face(entry.first));
        return std::any_of(vertices.begin(), vertices.end(), [&](Vertex v) { return shared.count(v) > 0; });
    };
    for (const auto& entry : shares)
        if (is_shared(entry)) put_aside_.push_back({entry.first, region, entry.second});
    shares.erase(std::remove_if(shares.begin(), shares.end(), is_shared), shares.end());
    const Annotation& annotation = set_.annotations[region];
    RoundingGoal goal;
    goal.area = area_of(source_, annotation.faces);
    goal.perimeter = length_of(segments_of(source_, annotation));
    goal.edge = edge;
    goal.coarser = edge > 1.5 * source_edge_;
    round_region(target_, selected, shares, goal, balance);
}

}  // namespace ostraka

#include "select/evaluator.h"

#include "ostraka/core/error.h"
#include "ostraka/core/overloaded.h"
#include "ostraka/core/progress.h"
#include "ostraka/mesh/limits.h"
#include "ostraka/select/selections.h"
#include "select/growth.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka {

namespace {

using std::to_string;

}  // namespace

ExpressionEvaluator::ExpressionEvaluator(AnnotatedMeshView object, const std::vector<std::int32_t>& face_labels,
                                         std::string where)
    : mesh_(object.mesh),
      face_labels_(face_labels),
      set_(object.annotations),
      where_(std::move(where)),
      bounds_(bounding_box(object.mesh)) {}

ExpressionEvaluator::ExpressionEvaluator(const ExpressionEvaluator& whole, const CutMesh& cut,
                                         const std::vector<std::int32_t>& face_labels, const SelectionBorders& borders)
    : ExpressionEvaluator(cut, face_labels, whole.where_) {
    surroundings_ = whole.surroundings_;
    whole_ = &whole;
    cut_ = &cut;
    borders_ = &borders;
}

void ExpressionEvaluator::fail(const std::string& at, const std::string& what, const std::string& remedy) const {
    fail_input(where_, "at " + at + ": " + what, remedy);
}

Point ExpressionEvaluator::point(const selection::Position& position, const std::string& at) const {
    const auto [x, y, z] = position.coordinates;
    const Point place = position.frame.box ? Point(bounds_.xmin() + x * (bounds_.xmax() - bounds_.xmin()),
                                                   bounds_.ymin() + y * (bounds_.ymax() - bounds_.ymin()),
                                                   bounds_.zmin() + z * (bounds_.zmax() - bounds_.zmin()))
                                           : Point(x, y, z);
    if (!is_place(place))
        fail(at, "a place beyond what can be computed with (coordinates up to 1e60)", "give one near the mesh, in its unit");
    return place;
}

Index ExpressionEvaluator::vertex(const selection::Pick& pick) const {
    if (whole_ != nullptr) return whole_->vertex(pick);  // vertices of the uncut mesh keep their index
    return std::visit(
        Overloaded{[&](Index index) {
                       if (index >= mesh_.number_of_vertices())
                           fail(pick.at,
                                "vertex " + to_string(index) + " of a mesh with " + to_string(mesh_.number_of_vertices()) +
                                    " vertices",
                                "pick by coordinates, or another vertex");
                       return index;
                   },
                   [&](const selection::Position& position) { return nearest_vertex(mesh_, point(position, pick.at)); },
                   [&](const selection::PixelPick& pixel) -> Index {
                       const SurfaceHit hit = seen(pixel, pick.at);
                       const auto corner = corners(mesh_, Face(hit.face));
                       return *std::min_element(corner.begin(), corner.end(), [&](Vertex a, Vertex b) {
                           return std::make_pair(CGAL::squared_distance(mesh_.point(a), hit.point), a) <
                                  std::make_pair(CGAL::squared_distance(mesh_.point(b), hit.point), b);
                       });
                   }},
        pick.place);
}

Index ExpressionEvaluator::face(const selection::Pick& pick) const {
    return std::visit(
        Overloaded{[&](Index index) { return checked_face(index, pick.at); },
                   [&](const selection::Position& position) { return nearest_face(mesh_, point(position, pick.at)); },
                   [&](const selection::PixelPick& pixel) -> Index { return seen(pixel, pick.at).face; }},
        pick.place);
}

Index ExpressionEvaluator::checked_face(Index face, const std::string& at) const {
    if (whole_ != nullptr) {
        const auto& origin = cut_->face_origin;
        return static_cast<Index>(std::lower_bound(origin.begin(), origin.end(), whole_->checked_face(face, at)) -
                                  origin.begin());
    }
    if (face >= mesh_.number_of_faces())
        fail(at, "face " + to_string(face) + " of a mesh with " + to_string(mesh_.number_of_faces()) + " faces",
             "pick by coordinates, or another face");
    return face;
}

std::vector<Index> ExpressionEvaluator::picks(const std::vector<selection::Pick>& list) const {
    std::vector<Index> vertices;
    for (const selection::Pick& pick : list) vertices.push_back(vertex(pick));
    return vertices;
}

double ExpressionEvaluator::length(const selection::Length& length) const {
    return length.frame.box ? length.value * box_diagonal(mesh_) : length.value;
}

std::function<bool(const Point&)> ExpressionEvaluator::volume(const selection::Volume& volume, const std::string& at) const {
    using Inside = std::function<bool(const Point&)>;
    return std::visit(Overloaded{[&](const selection::Box& box) -> Inside {
                                     const Point min = point(box.min, at + "/min"), max = point(box.max, at + "/max");
                                     if (min.x() > max.x() || min.y() > max.y() || min.z() > max.z())
                                         fail(at, "min exceeds max", "exchange the two");
                                     return box_volume(min, max);
                                 },
                                 [&](const selection::Sphere& sphere) -> Inside {
                                     const double scale = sphere.centre.frame.box ? std::hypot(bounds_.xmax() - bounds_.xmin(),
                                                                                               bounds_.ymax() - bounds_.ymin(),
                                                                                               bounds_.zmax() - bounds_.zmin())
                                                                                  : 1;
                                     return sphere_volume(point(sphere.centre, at + "/centre"), scale * sphere.radius);
                                 },
                                 [&](const selection::Halfspace& halfspace) -> Inside {
                                     return halfspace_volume(point(halfspace.point, at + "/point"), halfspace.normal);
                                 }},
                      volume);
}

const Annotation& ExpressionEvaluator::earlier(const selection::EarlierAnnotation& annotation, AnnotationType type,
                                               const std::string& at) const {
    const Annotation* found = set_.find(annotation.id);
    if (found == nullptr) fail(at, "no earlier annotation has the id " + to_string(annotation.id), "define it before it is used");
    if (found->type != type)
        fail(at,
             "annotation " + to_string(found->id) + " is a " + to_string(found->type) + ", where a " + to_string(type) +
                 " is needed",
             "use one of that type");
    return *found;
}

std::vector<bool> ExpressionEvaluator::listed_faces(const selection::FaceList& list, const std::string& at) const {
    std::vector<bool> result(mesh_.number_of_faces(), false);
    for (std::size_t i = 0; i < list.faces.size(); ++i) result[checked_face(list.faces[i], at + '/' + to_string(i))] = true;
    return result;
}

std::vector<bool> ExpressionEvaluator::lasso_faces(const selection::Lasso& lasso, const std::string& at) const {
    if (whole_ != nullptr) return lassoed(lasso, at);
    const Index seed = face(lasso.seed);
    std::optional<Point> place_of_seed;
    if (const auto* pixel = std::get_if<selection::PixelPick>(&lasso.seed.place)) {
        place_of_seed = seen(*pixel, lasso.seed.at).point;
    } else if (const auto* position = std::get_if<selection::Position>(&lasso.seed.place)) {
        const auto [a, b, c] = corners(mesh_, Face(seed));
        place_of_seed =
            point_at(mesh_, seed, nearest_barycentric(mesh_.point(a), mesh_.point(b), mesh_.point(c), point(*position, at)));
    }
    return ostraka::lasso(mesh_, picks(lasso.points), seed, lasso.metric, location(at), place_of_seed);
}

std::vector<bool> ExpressionEvaluator::component_faces(const selection::Component& component) const {
    const Index seed = face(component.seed);
    std::vector<bool> within;
    if (component.of != nullptr) {
        within = faces(*component.of);
        if (!within[seed])
            fail(component.seed.at, "face " + to_string(seed) + " does not belong to the selection", "put the seed within it");
    }
    return component_of(mesh_, seed, within);
}

std::vector<bool> ExpressionEvaluator::labelled_faces(const selection::LabelledFaces& labelled, const std::string& at) const {
    if (face_labels_.empty())
        fail(at, "the mesh has no face labels", "give a mesh with labels, e.g. a PLY file with a face property \"label\"");
    std::vector<bool> result(mesh_.number_of_faces());
    for (std::size_t i = 0; i < face_labels_.size(); ++i) result[i] = labelled.labels.contains(face_labels_[i]);
    return result;
}

std::vector<bool> ExpressionEvaluator::annotated_faces(const selection::EarlierAnnotation& annotation,
                                                       const std::string& at) const {
    std::vector<bool> result(mesh_.number_of_faces(), false);
    for (const Index i : earlier(annotation, AnnotationType::region, at).faces) result[i] = true;
    return result;
}

std::vector<bool> ExpressionEvaluator::combined_faces(const selection::Combination& combination) const {
    using Operator = selection::SetOperator;
    std::vector<bool> result = faces(combination.operands.front());
    for (std::size_t i = 1; i < combination.operands.size(); ++i) {
        const std::vector<bool> part = faces(combination.operands[i]);
        for (std::size_t f = 0; f < result.size(); ++f) {
            if (combination.combine == Operator::unite) result[f] = result[f] || part[f];
            else result[f] = result[f] && part[f] == (combination.combine == Operator::intersect);
        }
    }
    return result;
}

std::vector<bool> ExpressionEvaluator::faces(const SelectionExpression& expression) const {
    check_cancelled();
    if (whole_ != nullptr) {
        if (const SelectionLevel* level = whole_->level_of(expression)) return faces_at_level(*level);
        if (whole_->keeps_to_edges(expression)) return cut_->face_values(whole_->faces(expression));
    }
    const std::string& at = expression.at;
    return std::visit(Overloaded{[&](const selection::WholeMesh&) { return std::vector<bool>(mesh_.number_of_faces(), true); },
                                 [&](const selection::FaceList& list) { return listed_faces(list, at); },
                                 [&](const selection::Volume& body) { return faces_within(mesh_, volume(body, at)); },
                                 [&](const selection::DrawnArea& drawn) {
                                     const ScreenCamera& from = camera(*drawn.camera);
                                     return faces_seen(mesh_, from.camera, screen_area(drawn, at), visibility(drawn, at));
                                 },
                                 [&](const selection::Brush& brush) { return brush_faces(brush, at); },
                                 [&](const selection::Threshold& threshold) { return threshold_faces(threshold, at); },
                                 [&](const selection::Painted& painted) { return painted_faces(painted, at); },
                                 [&](const selection::Segments& segments) { return segment_faces(segments, at); },
                                 [&](const selection::Growth& growth) { return growth_faces(growth); },
                                 [&](const selection::Lasso& lasso) { return lasso_faces(lasso, at); },
                                 [&](const selection::Component& component) { return component_faces(component); },
                                 [&](const selection::LabelledFaces& labelled) { return labelled_faces(labelled, at); },
                                 [&](const selection::EarlierAnnotation& annotation) { return annotated_faces(annotation, at); },
                                 [&](const selection::Combination& combination) { return combined_faces(combination); },
                                 [&](const selection::Complement& complement) {
                                     std::vector<bool> result = faces(*complement.of);
                                     result.flip();
                                     return result;
                                 },
                                 [&](const auto&) -> std::vector<bool> {
                                     fail(at, "does not select faces, which a region is made of",
                                          "use it for a line or a point, or select faces");
                                 }},
                      expression.kind);
}

std::vector<Index> ExpressionEvaluator::combined_vertices(const selection::Combination& combination) const {
    using Operator = selection::SetOperator;
    std::vector<Index> result = vertices(combination.operands.front());
    for (std::size_t i = 1; i < combination.operands.size(); ++i) {
        const std::vector<Index> part = vertices(combination.operands[i]);
        const std::set<Index> members(part.begin(), part.end());
        if (combination.combine == Operator::unite) result.insert(result.end(), part.begin(), part.end());
        else std::erase_if(result, [&](Index v) { return members.contains(v) != (combination.combine == Operator::intersect); });
    }
    return result;
}

std::vector<Index> ExpressionEvaluator::complement_vertices(const selection::Complement& complement) const {
    const std::vector<Index> part = vertices(*complement.of);
    const std::set<Index> members(part.begin(), part.end());
    std::vector<Index> result;
    for (const Vertex v : mesh_.vertices())
        if (!mesh_.is_isolated(v) && !members.contains(v)) result.push_back(v);
    return result;
}

std::vector<Index> ExpressionEvaluator::vertices(const SelectionExpression& expression) const {
    const std::string& at = expression.at;
    std::vector<Index> result = std::visit(
        Overloaded{
            [&](const selection::VertexPicks& list) { return picks(list.picks); },
            [&](const selection::NearestVertex& nearest) {
                return std::vector<Index>{nearest_vertex(mesh_, point(nearest.position, at))};
            },
            [&](const selection::Volume& body) { return vertices_within(mesh_, volume(body, at)); },
            [&](const selection::DrawnArea& drawn) {
                const ScreenCamera& from = camera(*drawn.camera);
                return vertices_seen(mesh_, from.camera, screen_area(drawn, at), visibility(drawn, at));
            },
            [&](const selection::Brush& brush) {
                return brushed_vertices(mesh_, brush_centres(brush, at), length(brush.radius));
            },
            [&](const selection::Threshold& threshold) { return threshold_vertices(threshold, at); },
            [&](const selection::Growth& growth) { return growth_vertices(growth, at); },
            [&](const selection::EarlierAnnotation& annotation) { return earlier(annotation, AnnotationType::point, at).points; },
            [&](const selection::Combination& combination) { return combined_vertices(combination); },
            [&](const selection::Complement& complement) { return complement_vertices(complement); },
            [&](const auto&) -> std::vector<Index> {
                fail(at, "does not select points",
                     "use vertices, nearest, a volume, rectangle, brush or threshold, or a set operation of these");
            }},
        expression.kind);
    std::set<Index> seen;  // keeps the order, drops repeats
    std::erase_if(result, [&](Index v) { return !seen.insert(v).second; });
    return result;
}

std::vector<std::vector<Index>> ExpressionEvaluator::polylines(const SelectionExpression& expression) const {
    using Lines = std::vector<std::vector<Index>>;
    const std::string& at = expression.at;
    const auto refuse = [&]() -> Lines { fail(at, "does not select poly-lines", "use path, vertices, or a union of these"); };
    return std::visit(Overloaded{[&](const selection::SurfacePath& path) -> Lines {
                                     return {path_through(mesh_, picks(path.points), path.closed, path.metric, location(at))};
                                 },
                                 [&](const selection::VertexPicks& list) -> Lines { return {picks(list.picks)}; },
                                 [&](const selection::EarlierAnnotation& annotation) -> Lines {
                                     return earlier(annotation, AnnotationType::line, at).polylines;
                                 },
                                 [&](const selection::Combination& combination) -> Lines {
                                     if (combination.combine != selection::SetOperator::unite) return refuse();
                                     Lines result;
                                     for (const SelectionExpression& operand : combination.operands)
                                         for (auto& line : polylines(operand)) result.push_back(std::move(line));
                                     return result;
                                 },
                                 [&](const auto&) -> Lines { return refuse(); }},
                      expression.kind);
}

}  // namespace ostraka

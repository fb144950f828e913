// Expressions computed from distances and other scalars on the surface.
#include "select/evaluator.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/overloaded.h"
#include "ostraka/core/text.h"
#include "ostraka/fields/curvature.h"
#include "ostraka/fields/thickness.h"
#include "ostraka/measure/surface_colour.h"
#include "ostraka/render/values.h"
#include "ostraka/select/selections.h"
#include "select/growth.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

using std::to_string;

std::string key_of(const char* name, double a, double b = 0) { return std::string(name) + ' ' + digits(a) + ' ' + digits(b); }

/// Vertices without a value, as at the border, get the mean of their neighbours' values, or 0.
std::vector<double> extended_to_border(const Mesh& mesh, std::vector<double> values) {
    const std::vector<double> original = values;
    for (const Vertex v : mesh.vertices()) {
        if (!std::isnan(values[v])) continue;
        double sum = 0, count = 0;
        if (!mesh.is_isolated(v))
            for (const Vertex u : mesh.vertices_around_target(mesh.halfedge(v)))
                if (!std::isnan(original[u])) sum += original[u], count += 1;
        values[v] = count > 0 ? sum / count : 0;
    }
    return values;
}

constexpr double unbounded = std::numeric_limits<double>::infinity();

}  // namespace

std::vector<Index> ExpressionEvaluator::surface_picks(const std::vector<selection::Pick>& list) const {
    std::vector<Index> vertices = picks(list);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        if (mesh_.is_isolated(Vertex(vertices[i])))
            fail(list[i].at, "vertex " + to_string(vertices[i]) + " has no face", "pick another one");
    return vertices;
}

std::vector<Index> ExpressionEvaluator::brush_centres(const selection::Brush& brush, const std::string& at) const {
    std::vector<Index> centres = surface_picks(brush.points);
    if (!brush.stroke || centres.size() < 2) return centres;
    return path_through(mesh_, centres, false, PathMetric::combined, location(at));
}

std::vector<bool> ExpressionEvaluator::brush_faces(const selection::Brush& brush, const std::string& at) const {
    const double radius = length(brush.radius);
    if (whole_ == nullptr) return brushed_faces(mesh_, brush_centres(brush, at), radius);
    const std::vector<double> distance = distances_within(whole_->mesh_, whole_->brush_centres(brush, at), radius);
    return faces_between(mesh_, {cut_->vertex_values(whole_->mesh_, distance), false}, {-unbounded, radius});
}

ScalarMap ExpressionEvaluator::scalar(const selection::Threshold& threshold, const std::string& at) const {
    if (whole_ != nullptr) {
        ScalarMap map = uncut_ = whole_->scalar(threshold, at);
        map.values = map.on_faces ? cut_->face_values(map.values) : cut_->vertex_values(whole_->mesh_, map.values);
        return map;
    }
    if (mesh_.number_of_faces() == 0) fail(at, "the mesh has no faces", "give another mesh");
    return std::visit([&](const auto& quantity) { return values_of(quantity, threshold); }, threshold.quantity);
}

ScalarMap ExpressionEvaluator::values_of(const selection::CoordinateQuantity& quantity,
                                         const selection::Threshold& threshold) const {
    return coordinate_map(mesh_, quantity.direction, threshold.frame.box, location(threshold.quantity_at));
}

ScalarMap ExpressionEvaluator::values_of(const selection::CurvatureQuantity& quantity,
                                         const selection::Threshold& threshold) const {
    CurvatureOptions options;
    options.scale = quantity.scale;
    const std::string key = key_of("curvature", quantity.scale, quantity.mean ? 1 : 0);
    if (!maps_.contains(key)) {
        Curvature found;
        in_place(threshold.quantity_at, [&] { found = curvature(mesh_, options); });
        maps_[key].values = extended_to_border(mesh_, std::move(quantity.mean ? found.mean : found.gaussian));
    }
    ScalarMap map = maps_[key];
    const double unit = length({1, threshold.frame});
    for (double& x : map.values) x *= quantity.mean ? unit : unit * unit;
    return map;
}

ScalarMap ExpressionEvaluator::values_of(const selection::ThicknessQuantity& /*quantity*/,
                                         const selection::Threshold& threshold) const {
    ScalarMap map;
    in_place(threshold.quantity_at, [&] { map = thickness_map(); });
    const double unit = length({1, threshold.frame});
    for (double& x : map.values) x /= unit;
    return map;
}

ScalarMap ExpressionEvaluator::values_of(const selection::DistanceQuantity& quantity,
                                         const selection::Threshold& threshold) const {
    const double unit = length({1, threshold.frame});
    const double limit = threshold.quantiles ? unbounded : unit * std::max(0.0, threshold.below.value_or(unbounded));
    ScalarMap map{distances_within(mesh_, surface_picks(quantity.from), limit), false};
    for (double& x : map.values) x /= unit;
    return map;
}

ScalarMap ExpressionEvaluator::values_of(const selection::ColourQuantity& quantity, const selection::Threshold& threshold) const {
    const std::string& at = threshold.quantity_at;
    need_colours(at);
    if (lab_.empty()) in_place(at, [&] { lab_ = vertex_lab(mesh_, *surroundings_.attributes, where_); });
    const Lab reference = std::visit(
        Overloaded{
            [](const Rgb& rgb) {
                return lab_from_linear({linear_from_srgb(rgb.red), linear_from_srgb(rgb.green), linear_from_srgb(rgb.blue)});
            },
            [&](const selection::Pick& pick) { return lab_[vertex(pick)]; }},
        quantity.reference);
    ScalarMap map;
    map.values.reserve(lab_.size());
    for (const Lab& lab : lab_) map.values.push_back(colour_difference(lab, reference));
    return map;
}

ScalarMap ExpressionEvaluator::values_of(const selection::NamedQuantity& quantity, const selection::Threshold& threshold) const {
    std::vector<std::string> names;
    if (surroundings_.attributes != nullptr)
        for (const bool on_faces : {false, true})
            for (const NamedValues& column :
                 on_faces ? surroundings_.attributes->face_values : surroundings_.attributes->vertex_values) {
                if (column.name == quantity.name) return {column.values, on_faces};
                names.push_back(column.name);
            }
    fail(threshold.quantity_at, "the mesh file has no values '" + printable(quantity.name, 60) + "'",
         names.empty() ? "it has none: give a PLY file with properties of vertices or faces" : "it has " + joined(names));
}

ScalarMap ExpressionEvaluator::values_of(const selection::MapQuantity& quantity, const selection::Threshold& threshold) const {
    ScalarMap map{read_values(quantity.file), false};
    const bool vertices = map.values.size() == mesh_.number_of_vertices(), faces = map.values.size() == mesh_.number_of_faces();
    map.on_faces = quantity.on_faces.value_or(!vertices);
    if (!(map.on_faces ? faces : vertices))
        fail(threshold.quantity_at,
             quantity.file.filename().string() + " holds " + to_string(map.values.size()) + " values for a mesh of " +
                 to_string(mesh_.number_of_vertices()) + " vertices and " + to_string(mesh_.number_of_faces()) + " faces",
             "give one value a vertex or a face of this mesh");
    return map;
}

const ScalarMap& ExpressionEvaluator::thickness_map() const {
    if (!maps_.contains("thickness")) maps_["thickness"] = {thickness(mesh_), true};
    return maps_["thickness"];
}

bool ExpressionEvaluator::on_faces(const selection::Threshold& threshold, const std::string& at) const {
    return std::visit(Overloaded{[&](const selection::ThicknessQuantity&) { return scalar(threshold, at).on_faces; },
                                 [&](const selection::NamedQuantity&) { return scalar(threshold, at).on_faces; },
                                 [&](const selection::MapQuantity&) { return scalar(threshold, at).on_faces; },
                                 // These are on vertices, and expensive to compute.
                                 [](const auto&) { return false; }},
                      threshold.quantity);
}

ScalarRange ExpressionEvaluator::interval(const selection::Threshold& threshold, const ScalarMap& map,
                                          const std::string& at) const {
    if (whole_ != nullptr) return whole_->interval(threshold, uncut_, at);
    const auto bound = [&](const std::optional<double>& stated, double otherwise) {
        if (!stated || !threshold.quantiles) return stated.value_or(otherwise);
        return quantile_of(mesh_, map, *stated, location(at));
    };
    ScalarRange result;
    result.above = bound(threshold.above, result.above);
    result.below = bound(threshold.below, result.below);
    if (result.above > result.below) fail(at, "above exceeds below", "exchange the two");
    return result;
}

std::vector<bool> ExpressionEvaluator::threshold_faces(const selection::Threshold& threshold, const std::string& at) const {
    const ScalarMap map = scalar(threshold, at);
    return faces_between(mesh_, map, interval(threshold, map, at));
}

std::vector<Index> ExpressionEvaluator::threshold_vertices(const selection::Threshold& threshold, const std::string& at) const {
    const ScalarMap map = scalar(threshold, at);
    return vertices_between(mesh_, map, interval(threshold, map, at));
}

void ExpressionEvaluator::need_colours(const std::string& at) const {
    if (surroundings_.attributes == nullptr || !has_colours(*surroundings_.attributes))
        fail(at, "the mesh has neither an image nor colours", "give the file with its image or colours, or select by shape");
}

SurfaceHit ExpressionEvaluator::place_on_surface(const selection::Pick& pick) const {
    if (const auto* pixel = std::get_if<selection::PixelPick>(&pick.place)) return seen(*pixel, pick.at);
    if (const auto* position = std::get_if<selection::Position>(&pick.place))
        return search(pick.at).closest(point(*position, pick.at));
    const Vertex picked(vertex(pick));
    if (mesh_.is_isolated(picked))
        fail(pick.at, "vertex " + to_string(static_cast<Index>(picked)) + " has no face", "pick another one");
    SurfaceHit hit;
    hit.face =
        mesh_.face(mesh_.is_border(mesh_.halfedge(picked)) ? mesh_.opposite(mesh_.halfedge(picked)) : mesh_.halfedge(picked));
    const auto corner = corners(mesh_, Face(hit.face));
    for (std::size_t k = 0; k < 3; ++k) hit.barycentric[k] = corner[k] == picked ? 1 : 0;
    hit.point = mesh_.point(picked);
    return hit;
}

const PaintedFigure& ExpressionEvaluator::painted(const selection::Painted& description, const std::string& at) const {
    const auto known = figures_.find(at);
    if (known != figures_.end()) return known->second;
    need_colours(at);
    if (mesh_.number_of_faces() == 0) fail(at, "the mesh has no faces", "give another mesh");
    PaintedFigureQuery query = description.query;
    for (const selection::Pick& pick : description.places) query.places.push_back(place_on_surface(pick));
    query.smallest = length(description.smallest);
    if (figures_.size() >= 8) figures_.clear();  // each holds a number per texel
    in_place(at, [&] {
        if (texels_ == nullptr) texels_ = std::make_shared<const TexelColours>(mesh_, *surroundings_.attributes, where_);
        figures_.emplace(at, PaintedFigure(texels_, query, location(at)));
    });
    return figures_.at(at);
}

std::vector<bool> ExpressionEvaluator::painted_faces(const selection::Painted& description, const std::string& at) const {
    if (whole_ == nullptr) return painted(description, at).faces();
    const PaintedFigure& figure = whole_->painted(description, at);
    std::vector<bool> selected(mesh_.number_of_faces());
    for (const Face face : mesh_.faces()) {
        const Face origin(cut_->face_origin[face]);
        const auto [a, b, c] = corners(whole_->mesh_, origin);
        selected[face] = figure.inside(origin, nearest_barycentric(whole_->mesh_.point(a), whole_->mesh_.point(b),
                                                                   whole_->mesh_.point(c), centroid(mesh_, face)));
    }
    return selected;
}

void ExpressionEvaluator::in_place(const std::string& at, const std::function<void()>& work) const {
    try {
        work();
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input || error.where().starts_with(where_)) throw;
        fail(at, error.problem(), error.remedy().empty() ? "select by another tool" : error.remedy());
    }
}

std::vector<bool> ExpressionEvaluator::segment_faces(const selection::Segments& segments, const std::string& at) const {
    const SegmentOptions& options = segments.options;
    const std::string key = key_of("segments", options.clusters, options.smoothing);
    if (!segments_.contains(key)) in_place(at, [&] { segments_[key] = segment(mesh_, thickness_map().values, options); });
    const std::vector<Index>& number_of = segments_[key];
    const Index count = *std::max_element(number_of.begin(), number_of.end()) + 1;
    std::vector<bool> wanted(count, false);
    if (const auto* seeds = std::get_if<std::vector<selection::Pick>>(&segments.parts))
        for (const selection::Pick& seed : *seeds) wanted[number_of[face(seed)]] = true;
    if (const auto* numbers = std::get_if<std::vector<Index>>(&segments.parts))
        for (std::size_t i = 0; i < numbers->size(); ++i) {
            const Index n = (*numbers)[i];
            if (n >= count)
                fail(at + "/numbers/" + to_string(i), "segment " + to_string(n) + " of " + to_string(count),
                     "segments are numbered from 0, the largest");
            wanted[n] = true;
        }
    std::vector<bool> faces(mesh_.number_of_faces());
    for (std::size_t f = 0; f < faces.size(); ++f) faces[f] = wanted[number_of[f]];
    return faces;
}

std::vector<bool> ExpressionEvaluator::growth_faces(const selection::Growth& growth) const {
    const std::vector<bool> part = faces(*growth.of);
    return std::visit(Overloaded{[&](int rings) { return growth.larger ? grow(mesh_, part, rings) : shrink(mesh_, part, rings); },
                                 [&](const selection::Length& extent) {
                                     const double distance = length(extent);
                                     return growth.larger ? grow_by(mesh_, part, distance) : shrink_by(mesh_, part, distance);
                                 }},
                      growth.extent);
}

std::vector<Index> ExpressionEvaluator::growth_vertices(const selection::Growth& growth, const std::string& at) const {
    const std::vector<Index> part = vertices(*growth.of);
    const int* rings = std::get_if<int>(&growth.extent);
    if (rings == nullptr) fail(at + "/distance", "points grow by rings only", "give rings");
    return growth.larger ? grow_vertices(mesh_, part, *rings) : shrink_vertices(mesh_, part, *rings);
}

}  // namespace ostraka

// Expressions computed from distances and other scalars on the surface.
#include "select/expression.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/text.h"
#include "ostraka/fields/curvature.h"
#include "ostraka/fields/thickness.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/measure/surface_colour.h"
#include "ostraka/render/picture.h"
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

}  // namespace

double ExpressionEvaluator::length(double value, PlaceFrame frame) const {
    return frame.box ? value * box_diagonal(mesh_) : value;
}

std::vector<Index> ExpressionEvaluator::surface_picks(const JsonValue& list, PlaceFrame frame, const std::string& at) const {
    std::vector<Index> vertices = picks(list, frame, at);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        if (mesh_.is_isolated(Vertex(vertices[i])))
            fail(at + '/' + to_string(i), "vertex " + to_string(vertices[i]) + " has no face", "pick another one");
    return vertices;
}

std::vector<Index> ExpressionEvaluator::brush_centres(const JsonValue& value, PlaceFrame frame, const std::string& at) const {
    std::vector<Index> centres = surface_picks(value["points"], frame, at + "/points");
    if (!flag_in(value, "stroke") || centres.size() < 2) return centres;
    return path_through(mesh_, centres, false, PathMetric::combined, where_ + ", at " + at);
}

ScalarMap ExpressionEvaluator::scalar(const JsonValue& value, PlaceFrame frame, const std::string& at) const {
    if (whole_ != nullptr) {
        ScalarMap map = uncut_ = whole_->scalar(value, frame, at);
        map.values = map.on_faces ? cut_->face_values(map.values) : cut_->vertex_values(whole_->mesh_, map.values);
        return map;
    }
    std::string chosen;
    for (const char* name : {"coordinate", "curvature", "thickness", "distance", "colour", "values", "map"}) {
        if (find_member(value, name) == nullptr) continue;
        if (!chosen.empty()) fail(at, "a threshold on both " + chosen + " and " + name, "give one, and join two by intersection");
        chosen = name;
    }
    if (chosen.empty())
        fail(at, "a threshold on nothing", "name one of coordinate, curvature, thickness, distance, colour, values, map");
    const std::string here = at + '/' + chosen;
    const JsonValue& of = value[chosen.c_str()];
    if (mesh_.number_of_faces() == 0) fail(at, "the mesh has no faces", "give another mesh");
    if (chosen == "coordinate") {
        const auto [x, y, z] = triple_of(of);
        return coordinate_map(mesh_, Vector(x, y, z), frame.box, where_ + ", at " + here);
    }
    if (chosen == "colour") return colour_map(of, frame, here);
    if (chosen == "values") return file_values(text_of(of), here);
    const double unit = length(1, frame);
    ScalarMap map;
    if (chosen == "distance") {
        const double limit = number_or(value, "below", std::numeric_limits<double>::infinity());
        const bool quantiles = flag_in(value, "quantiles");
        map.values = distances_within(mesh_, surface_picks(of, frame, here),
                                      quantiles ? std::numeric_limits<double>::infinity() : unit * std::max(0.0, limit));
        for (double& x : map.values) x /= unit;
        return map;
    }
    if (chosen == "map") {
        const Path file =
            file_inside(text_of(of), surroundings_.folder, where_, here, "the recipe's folder", "move the map beside the recipe");
        map.values = read_values(file);
        const JsonValue* on = find_member(value, "on");
        const bool vertices = map.values.size() == mesh_.number_of_vertices(),
                   faces = map.values.size() == mesh_.number_of_faces();
        map.on_faces = on == nullptr ? !vertices : std::string(on->GetString()) == "face";
        if (!(map.on_faces ? faces : vertices))
            fail(here,
                 file.filename().string() + " holds " + to_string(map.values.size()) + " values for a mesh of " +
                     to_string(mesh_.number_of_vertices()) + " vertices and " + to_string(mesh_.number_of_faces()) + " faces",
                 "give one value a vertex or a face of this mesh");
        return map;
    }
    if (chosen == "curvature") {
        const bool mean = std::string(of.GetString()) == "mean";
        CurvatureOptions options;
        options.scale = number_or(value, "scale", 0);
        const std::string key = key_of("curvature", options.scale, mean ? 1 : 0);
        if (!maps_.contains(key)) {
            Curvature found;
            in_place(here, [&] { found = curvature(mesh_, options); });
            maps_[key].values = extended_to_border(mesh_, std::move(mean ? found.mean : found.gaussian));
        }
        map = maps_[key];
        for (double& x : map.values) x *= mean ? unit : unit * unit;
        return map;
    }
    in_place(here, [&] { map = thickness_map(); });
    for (double& x : map.values) x /= unit;
    return map;
}

ScalarMap ExpressionEvaluator::colour_map(const JsonValue& colour, PlaceFrame frame, const std::string& at) const {
    need_colours(at);
    if (lab_.empty()) in_place(at, [&] { lab_ = vertex_lab(mesh_, *surroundings_.attributes, where_); });
    Lab reference;
    if (colour.IsString()) {
        const Rgb rgb = parse_colour(text_of(colour));
        reference = lab_from_linear({linear_from_srgb(rgb.red), linear_from_srgb(rgb.green), linear_from_srgb(rgb.blue)});
    } else {
        reference = lab_[vertex(colour["at"], frame, at + "/at")];
    }
    ScalarMap map;
    map.values.reserve(lab_.size());
    for (const Lab& lab : lab_) map.values.push_back(colour_difference(lab, reference));
    return map;
}

void ExpressionEvaluator::need_colours(const std::string& at) const {
    if (surroundings_.attributes == nullptr || !has_colours(*surroundings_.attributes))
        fail(at, "the mesh has neither an image nor colours", "give the file with its image or colours, or select by shape");
}

SurfaceHit ExpressionEvaluator::place_on_surface(const JsonValue& pick, PlaceFrame frame, const std::string& at) const {
    if (pick.IsObject()) return seen(pick, frame, at);
    if (pick.IsArray()) return search(at).closest(point(pick, frame, at));
    const Vertex picked(vertex(pick, frame, at));
    if (mesh_.is_isolated(picked))
        fail(at, "vertex " + to_string(static_cast<Index>(picked)) + " has no face", "pick another one");
    SurfaceHit hit;
    hit.face =
        mesh_.face(mesh_.is_border(mesh_.halfedge(picked)) ? mesh_.opposite(mesh_.halfedge(picked)) : mesh_.halfedge(picked));
    const auto corner = corners(mesh_, Face(hit.face));
    for (std::size_t k = 0; k < 3; ++k) hit.barycentric[k] = corner[k] == picked ? 1 : 0;
    hit.point = mesh_.point(picked);
    return hit;
}

const PaintedFigure& ExpressionEvaluator::painted(const JsonValue& value, PlaceFrame frame, const std::string& at) const {
    const auto known = figures_.find(at);
    if (known != figures_.end()) return known->second;
    need_colours(at);
    if (mesh_.number_of_faces() == 0) fail(at, "the mesh has no faces", "give another mesh");
    PaintedFigureQuery query;
    const auto add_colour = [&](const JsonValue& text) {
        const Rgb rgb = parse_colour(text_of(text));
        query.like.push_back(
            lab_from_linear({linear_from_srgb(rgb.red), linear_from_srgb(rgb.green), linear_from_srgb(rgb.blue)}));
    };
    if (const JsonValue* like = find_member(value, "like")) {
        if (like->IsString()) add_colour(*like);
        else
            for (const auto& one : like->GetArray()) add_colour(one);
    }
    if (const JsonValue* places = find_member(value, "at"))
        for (rapidjson::SizeType i = 0; i < places->Size(); ++i)
            query.places.push_back(place_on_surface((*places)[i], frame, at + "/at/" + to_string(i)));
    const auto interval_of = [&](const char* name, std::optional<PaintedFigureQuery::Interval>& interval) {
        const JsonValue* found = find_member(value, name);
        if (found == nullptr) return;
        interval = {(*found)[0].GetDouble(), (*found)[1].GetDouble()};
        if (std::string(name) != "hue" && (*interval)[0] > (*interval)[1])
            fail(at + '/' + name, "the first bound exceeds the second", "exchange the two");
    };
    interval_of("lightness", query.lightness);
    interval_of("chroma", query.chroma);
    interval_of("hue", query.hue);
    const bool bounded = query.lightness || query.chroma || query.hue;
    if (query.like.empty() && query.places.empty() && !bounded)
        fail(at, "a painted figure of no colour",
             "give a colour (like), a place in it (at), or bounds of lightness, chroma or hue");
    query.sharpest = flag_in(value, "edge") ||
                     (!query.places.empty() && query.like.empty() && !bounded && find_member(value, "tolerance") == nullptr);
    if (query.sharpest && query.places.empty()) fail(at, "a figure by its edge, but no place in it", "give a place in it (at)");
    query.tolerance = number_or(value, "tolerance", query.sharpest ? 60 : query.tolerance);
    query.smallest = length(number_or(value, "smallest", 0), frame);
    query.blur = static_cast<int>(number_or(value, "blur", query.blur));
    if (figures_.size() >= 8) figures_.clear();  // each holds a number per texel
    in_place(at, [&] {
        if (texels_ == nullptr) texels_ = std::make_shared<const TexelColours>(mesh_, *surroundings_.attributes, where_);
        figures_.emplace(at, PaintedFigure(texels_, query, where_ + ", at " + at));
    });
    return figures_.at(at);
}

ScalarMap ExpressionEvaluator::file_values(const std::string& name, const std::string& at) const {
    std::vector<std::string> names;
    if (surroundings_.attributes != nullptr)
        for (const bool on_faces : {false, true})
            for (const NamedValues& column :
                 on_faces ? surroundings_.attributes->face_values : surroundings_.attributes->vertex_values) {
                if (column.name == name) return {column.values, on_faces};
                names.push_back(column.name);
            }
    fail(at, "the mesh file has no values '" + printable(name, 60) + "'",
         names.empty() ? "it has none: give a PLY file with properties of vertices or faces" : "it has " + joined(names));
}

const ScalarMap& ExpressionEvaluator::thickness_map() const {
    if (!maps_.contains("thickness")) maps_["thickness"] = {thickness(mesh_), true};
    return maps_["thickness"];
}

void ExpressionEvaluator::in_place(const std::string& at, const std::function<void()>& work) const {
    try {
        work();
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input || error.where().starts_with(where_)) throw;
        fail(at, error.problem(), error.remedy().empty() ? "select by another tool" : error.remedy());
    }
}

ScalarRange ExpressionEvaluator::interval(const JsonValue& value, const ScalarMap& map, const std::string& at) const {
    if (whole_ != nullptr) return whole_->interval(value, uncut_, at);
    ScalarRange result;
    if (find_member(value, "above") == nullptr && find_member(value, "below") == nullptr)
        fail(at, "a threshold with neither above nor below", "give one of them, or both");
    const auto bound = [&](const char* name, double otherwise) {
        const double x = number_or(value, name, otherwise);
        if (find_member(value, name) == nullptr || !flag_in(value, "quantiles")) return x;
        if (x < 0 || x > 1) fail(at + '/' + name, "a quantile of " + to_string(x), "give a share of the area from 0 to 1");
        return quantile_of(mesh_, map, x, where_ + ", at " + at);
    };
    result.above = bound("above", result.above);
    result.below = bound("below", result.below);
    if (result.above > result.below) fail(at, "above exceeds below", "exchange the two");
    return result;
}

std::vector<bool> ExpressionEvaluator::segments(const JsonValue& value, PlaceFrame frame, const std::string& at) const {
    SegmentOptions options;
    options.clusters = static_cast<int>(number_or(value, "clusters", options.clusters));
    options.smoothing = number_or(value, "smoothing", options.smoothing);
    const JsonValue *seeds = find_member(value, "seeds"), *numbers = find_member(value, "numbers");
    if ((seeds == nullptr) == (numbers == nullptr))
        fail(at, seeds == nullptr ? "segments without seeds or numbers" : "segments by both seeds and numbers",
             "give one of the two");
    const std::string key = key_of("segments", options.clusters, options.smoothing);
    if (!segments_.contains(key)) in_place(at, [&] { segments_[key] = segment(mesh_, thickness_map().values, options); });
    const std::vector<Index>& number_of = segments_[key];
    const Index count = *std::max_element(number_of.begin(), number_of.end()) + 1;
    std::vector<bool> wanted(count, false);
    if (seeds != nullptr)
        for (rapidjson::SizeType i = 0; i < seeds->Size(); ++i)
            wanted[number_of[face((*seeds)[i], frame, at + "/seeds/" + to_string(i))]] = true;
    if (numbers != nullptr)
        for (rapidjson::SizeType i = 0; i < numbers->Size(); ++i) {
            const Index n = (*numbers)[i].GetUint();
            if (n >= count)
                fail(at + "/numbers/" + to_string(i), "segment " + to_string(n) + " of " + to_string(count),
                     "segments are numbered from 0, the largest");
            wanted[n] = true;
        }
    std::vector<bool> faces(mesh_.number_of_faces());
    for (std::size_t f = 0; f < faces.size(); ++f) faces[f] = wanted[number_of[f]];
    return faces;
}

std::vector<bool> ExpressionEvaluator::field_selected_faces(const std::string& kind, const JsonValue& value, PlaceFrame frame,
                                                            const std::string& at) const {
    if (kind == "brush" && whole_ != nullptr) {
        const double radius = length(value["radius"].GetDouble(), frame);
        const ScalarMap distance{
            cut_->vertex_values(whole_->mesh_, distances_within(whole_->mesh_, whole_->brush_centres(value, frame, at), radius)),
            false};
        return faces_between(mesh_, distance, {-std::numeric_limits<double>::infinity(), radius});
    }
    if (kind == "brush") return brushed_faces(mesh_, brush_centres(value, frame, at), length(value["radius"].GetDouble(), frame));
    if (kind == "threshold") {
        const ScalarMap map = scalar(value, frame, at);
        return faces_between(mesh_, map, interval(value, map, at));
    }
    if (kind == "segments") return segments(value, frame, at);
    const bool larger = kind == "grow";
    const std::vector<bool> part = faces(value["of"], frame, at + "/of");
    if (by_distance(value, at)) {
        const double distance = length(value["distance"].GetDouble(), frame);
        return larger ? grow_by(mesh_, part, distance) : shrink_by(mesh_, part, distance);
    }
    const int rings = value["rings"].GetInt();
    return larger ? grow(mesh_, part, rings) : shrink(mesh_, part, rings);
}

std::vector<Index> ExpressionEvaluator::field_selected_vertices(const std::string& kind, const JsonValue& value, PlaceFrame frame,
                                                                const std::string& at) const {
    if (kind == "brush")
        return brushed_vertices(mesh_, brush_centres(value, frame, at), length(value["radius"].GetDouble(), frame));
    if (kind == "threshold") {
        const ScalarMap map = scalar(value, frame, at);
        return vertices_between(mesh_, map, interval(value, map, at));
    }
    const std::vector<Index> part = vertices(value["of"], frame, at + "/of");
    if (by_distance(value, at)) fail(at + "/distance", "points grow by rings only", "give rings");
    const int rings = value["rings"].GetInt();
    return kind == "grow" ? grow_vertices(mesh_, part, rings) : shrink_vertices(mesh_, part, rings);
}

bool ExpressionEvaluator::by_distance(const JsonValue& value, const std::string& at) const {
    const bool rings = find_member(value, "rings") != nullptr, distance = find_member(value, "distance") != nullptr;
    if (rings == distance) fail(at, rings ? "both rings and a distance" : "neither rings nor a distance", "say one: how far");
    return distance;
}

}  // namespace ostraka

// Conversion of GLB with EXT_mesh_features and EXT_structural_metadata to annotations on a mesh.
#include "ostraka/interchange/feature_glb.h"

#include "interchange/feature_file.h"
#include "interchange/landmark_formats.h"
#include "interchange/placing.h"
#include "interchange/text.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/colouring.h"
#include "ostraka/core/error.h"
#include "ostraka/core/memory.h"
#include "ostraka/core/message_text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/json_build.h"
#include "ostraka/measure/measure.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <span>

namespace ostraka {

namespace {

using namespace interchange;

class FeatureReader {
public:
    FeatureReader(const std::string& bytes, const Mesh& mesh, const std::string& where, const PlaceOptions& options)
        : file_(bytes, where), where_(where), mesh_(mesh), options_(options), notes_(file_.notes) {
        native_.SetObject();
    }

    PlacedAnnotations read() {
        const JsonValue* ours = file_.extras();
        const JsonValue* source_mesh = ours == nullptr ? nullptr : find_member(*ours, "mesh");
        same_mesh_ = source_mesh != nullptr && file_.triangles() == mesh_.number_of_faces() &&
                     text_in(*source_mesh, "sha256") == mesh_checksum(mesh_);
        JsonValue entries(rapidjson::kArrayType);
        if (add_originals(ours, entries))
            return placed_annotations(native_, std::move(entries), ours, mesh_, where_, true, std::move(notes_),
                                      std::move(placements_));
        for (const auto& [id, feature] : file_.features) {
            JsonValue entry = annotation(id, feature);
            if (entry.IsObject()) entries.PushBack(entry, a());
        }
        return placed_annotations(native_, std::move(entries), ours, mesh_, where_, same_mesh_, std::move(notes_),
                                  std::move(placements_));
    }

private:
    JsonAllocator& a() { return native_.GetAllocator(); }

    /// Adds the original annotations stored in the file if they belong to this mesh and still agree with the table.
    bool add_originals(const JsonValue* ours, JsonValue& entries) {
        const JsonValue* original = ours == nullptr ? nullptr : find_member(*ours, "original");
        const JsonValue* source_mesh = original == nullptr ? nullptr : find_member(*original, "mesh");
        if (source_mesh == nullptr || !file_.ours || text_in(*source_mesh, "sha256") != mesh_checksum(mesh_)) return false;
        const auto original_entries = list_in(*original, "annotations");
        if (original_entries.Size() != file_.rows) return false;
        for (rapidjson::SizeType i = 0; i < original_entries.Size(); ++i) {
            const JsonValue* id = find_member(original_entries[i], "id");
            if (id == nullptr || !id->IsInt() || id->GetInt() != file_.ids[i] ||
                text_in(original_entries[i], "tag") != file_.tags[i])
                return false;
        }
        for (const JsonValue& entry : original_entries) {
            PlacedAnnotation& placement = placements_.emplace_back();
            placement.id = entry["id"].GetInt();
            placement.tag = text_in(entry, "tag");
            placement.how = "indices";
            entries.PushBack(JsonValue(entry, a()), a());
        }
        return true;
    }

    Placer& placer() {
        if (!placer_) placer_ = std::make_unique<Placer>(mesh_);
        return *placer_;
    }

    /// The triangle of the file nearest to each face's centroid; no_index if it is too far away.
    const std::vector<Index>& nearest_triangles() {
        if (!nearest_.empty()) return nearest_;
        require_memory(600.0 * static_cast<double>(file_.triangles()),
                       "to search the file's " + counted(file_.triangles(), "triangle"), "give a coarser one");
        TriangleSoup soup;  // separate triangles, since a mesh with duplicated vertices need not be manifold
        for (const Primitive& primitive : file_.primitives) {
            if (primitive.mode != glb::triangles_mode) continue;
            for (std::size_t c = 0; c < primitive.corners(); c += 3) {
                const auto first = static_cast<Index>(soup.points.size());
                for (std::size_t k = 0; k < 3; ++k) soup.points.push_back(primitive.position(primitive.corner(c + k)));
                soup.triangles.push_back({first, first + 1, first + 2});
            }
        }
        const Mesh surface = build_mesh(soup);
        const SurfaceSearch search(surface);
        const double limit = options_.tolerance * box_diagonal(mesh_);
        nearest_.assign(mesh_.number_of_faces(), no_index);
        std::vector<double> distance(nearest_.size());
        parallel_for(nearest_.size(), [&](std::size_t f) {
            const SurfaceHit hit = search.closest(centroid(mesh_, Face(static_cast<Index>(f))));
            distance[f] = hit.distance;
            if (hit.distance <= limit) nearest_[f] = hit.face;
        });
        const auto far_count = static_cast<std::size_t>(std::count(nearest_.begin(), nearest_.end(), no_index));
        if (2 * far_count > nearest_.size())
            fail_input(where_, fmt::format("most of the mesh lies farther than {} from the surface of the file", digits(limit)),
                       "give the mesh that the file shows, in the same unit and position, or raise --tolerance");
        if (far_count > 0)
            notes_.push_back(
                fmt::format("{} of the mesh farther than {} from the file's surface", counted(far_count, "face"), digits(limit)));
        to_surface_ = *std::max_element(distance.begin(), distance.end());
        return nearest_;
    }

    /// Faces of the mesh whose nearest triangle in the file is this one.
    std::span<const Index> faces_at(std::size_t triangle) {
        if (faces_begin_.empty()) {
            const std::vector<Index>& nearest = nearest_triangles();
            faces_begin_.assign(file_.triangles() + 1, 0);
            for (const Index t : nearest)
                if (t != no_index) ++faces_begin_[t + 1];
            std::partial_sum(faces_begin_.begin(), faces_begin_.end(), faces_begin_.begin());
            faces_.resize(faces_begin_.back());
            std::vector<Index> next = faces_begin_;
            for (Index f = 0; f < nearest.size(); ++f)
                if (nearest[f] != no_index) faces_[next[nearest[f]]++] = f;
        }
        return std::span(faces_).subspan(faces_begin_[triangle], faces_begin_[triangle + 1] - faces_begin_[triangle]);
    }

    /// The vertex of the mesh for a vertex of a primitive; no_index if it is too far away and far points may be skipped.
    Index vertex_of(const Primitive& primitive, std::size_t vertex, PlacedAnnotation& placement) {
        ++placement.points;
        if (same_mesh_ && primitive.origins) {
            const double origin = (*primitive.origins)[vertex];
            if (!(origin >= 0 && origin < static_cast<double>(mesh_.number_of_vertices())))
                file_.file.fail("/meshes/0/primitives", "a value of _VERTEX is not a vertex of the mesh");
            return static_cast<Index>(origin);
        }
        const auto position = primitive.position(vertex);
        const Placed placed = placer().place(Point(position[0], position[1], position[2]));
        const double limit = options_.tolerance * placer().diagonal();
        placement.to_surface = std::max(placement.to_surface, placed.to_surface);
        placement.to_vertex = std::max(placement.to_vertex, placed.to_vertex);
        if (placed.to_surface <= limit) return placed.vertex;
        if (!options_.skip_far)
            fail_input(where_,
                       fmt::format("a point of '{}' lies {} from the surface, farther than {}",
                                   one_line(placement.tag).substr(0, 40), digits(placed.to_surface), digits(limit)),
                       "give the mesh that the file shows, raise --tolerance, or skip such points with --skip-far");
        return no_index;
    }

    /// The vertices for corners of a primitive, without those too far away.
    std::vector<Index> vertices_of(std::size_t primitive, const std::vector<std::size_t>& selected, PlacedAnnotation& placement) {
        std::vector<Index> vertices;
        for (const std::size_t corner : selected)
            if (const Index vertex = vertex_of(file_.primitives[primitive], corner, placement); vertex != no_index)
                vertices.push_back(vertex);
        return vertices;
    }

    JsonValue annotation(std::size_t row, const Feature& feature) {
        PlacedAnnotation placement;
        placement.tag = row < file_.tags.size() ? file_.tags[row] : "feature " + std::to_string(row);
        placement.id = file_.ours ? file_.ids[row] : static_cast<int>(std::min<std::size_t>(row, 2147483647));
        placement.how = same_mesh_ ? "indices" : "places";
        if (!used_.insert(placement.id).second)
            fail_input(where_, "two features have the id " + std::to_string(placement.id), "correct the table");
        const std::array<int, 3> colour =
            file_.ours ? std::array<int, 3>{file_.colours[3 * row], file_.colours[3 * row + 1], file_.colours[3 * row + 2]}
                       : distinct_colour(row);
        JsonValue result = json_object(a(), "id", placement.id, "tag", placement.tag, "colour", colour);
        if (!select(row, feature, result, placement)) {
            notes_.push_back(fmt::format("'{}' could not be placed on this mesh and was left out", one_line(placement.tag)));
            return {};
        }
        if (row < file_.remarks.size()) add_nonempty_members(result, a(), "note", file_.remarks[row]);
        JsonValue attributes(rapidjson::kArrayType);
        if (row < file_.attributes.size()) {
            const Json parsed = parse_json(file_.attributes[row], fmt::format("{}, attributes of feature {}", where_, row));
            attributes.CopyFrom(parsed, a());
            if (!same_mesh_) without_pins(attributes);
        }
        add_member(result, "attributes", std::move(attributes), a());
        placements_.push_back(placement);
        return result;
    }

    bool select(std::size_t row, const Feature& feature, JsonValue& result, PlacedAnnotation& placement) {
        if (file_.ours && file_.kinds[row] == 3) {
            add_members(result, a(), "type", "region", "all", true);
        } else if (feature.faces) {
            std::vector<Index> faces;
            if (same_mesh_) {
                faces = *feature.faces;
                std::sort(faces.begin(), faces.end());
                faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
            } else {
                for (const std::uint32_t t : *feature.faces) {
                    const auto range = faces_at(t);
                    faces.insert(faces.end(), range.begin(), range.end());
                }
                std::sort(faces.begin(), faces.end());
                faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
                placement.to_surface = to_surface_;
            }
            if (faces.empty()) return false;
            add_members(result, a(), "type", "region", "faces", faces);
        } else if (!feature.polylines.empty()) {
            std::vector<std::vector<Index>> polylines;
            for (const auto& polyline : feature.polylines) {
                std::vector<Index> vertices = vertices_of(feature.line_primitive, polyline, placement);
                if (!same_mesh_ && !vertices.empty()) {
                    const bool closed = vertices.size() > 3 && vertices.front() == vertices.back();
                    vertices = placer().vertex_path(vertices, closed, fmt::format("{}, '{}'", where_, one_line(placement.tag)));
                }
                if (vertices.size() > 1) polylines.push_back(std::move(vertices));
            }
            if (polylines.empty()) return false;
            add_members(result, a(), "type", "line", "polylines", polylines);
        } else {
            const std::vector<Index> vertices = vertices_of(feature.point_primitive, feature.points, placement);
            if (vertices.empty()) return false;
            add_members(result, a(), "type", "point", "points", vertices);
        }
        return true;
    }

    /// Maps vertices of the file's mesh to this mesh; nullopt if one of them is not in the file.
    std::optional<std::vector<Index>> mapped_vertices(const JsonValue* points) {
        if (points == nullptr || !points->IsArray()) return {};
        std::vector<Index> vertices;
        for (const auto& point : points->GetArray()) {
            const auto position = point.IsUint() ? positions().find(point.GetUint()) : positions_.end();
            if (position == positions_.end()) return {};
            vertices.push_back(placer().place(position->second).vertex);
        }
        return vertices;
    }

    /// Pins are vertices of the file's mesh: they are mapped by _VERTEX, otherwise the measure becomes a number.
    void without_pins(JsonValue& attributes) {
        if (!attributes.IsArray()) return;
        for (auto& attribute : attributes.GetArray()) {
            if (!attribute.IsObject() || text_in(attribute, "type") != "measure" || !attribute.HasMember("measure") ||
                !attribute["measure"].IsObject())
                continue;
            JsonValue& measure = attribute["measure"];
            if (const auto vertices = mapped_vertices(find_member(measure, "points"))) {
                std::vector<std::vector<Index>> mapped_repeats;
                for (const auto& picked : list_in(measure, "repeats"))
                    if (const auto mapped = mapped_vertices(&picked)) mapped_repeats.push_back(*mapped);
                for (const char* name : {"points", "locations", "stale", "repeats"}) measure.RemoveMember(name);
                add_nonempty_members(measure, a(), "repeats", mapped_repeats);
                add_members(measure, a(), "points", *vertices, "stale", true);
                continue;
            }
            JsonValue number(rapidjson::kObjectType);
            copy_members(number, a(), attribute, {"id", "name"});
            add_members(number, a(), "type", "descriptor");
            copy_members(number, a(), measure, {"value", "unit"});
            add_members(number, a(), "stale", true);
            attribute = std::move(number);
        }
    }

    const std::map<Index, Point>& positions() {
        if (positions_.empty())
            for (const Primitive& primitive : file_.primitives)
                for (std::size_t i = 0; primitive.origins && i < primitive.origins->size(); ++i) {
                    const auto p = primitive.position(i);
                    if (const double origin = (*primitive.origins)[i]; origin >= 0 && origin < 16777217.0)
                        positions_.try_emplace(static_cast<Index>(origin), p[0], p[1], p[2]);
                }
        return positions_;
    }

    FeatureFile file_;
    const std::string& where_;
    const Mesh& mesh_;
    const PlaceOptions& options_;
    Json native_;
    bool same_mesh_ = false;
    std::vector<std::string> notes_;
    std::vector<Index> nearest_;
    std::vector<Index> faces_begin_, faces_;  ///< faces of the mesh, ordered by their nearest triangle
    double to_surface_ = 0;
    std::map<Index, Point> positions_;
    std::set<int> used_;
    std::unique_ptr<Placer> placer_;
    std::vector<PlacedAnnotation> placements_;
};

}  // namespace

PlacedAnnotations read_feature_glb(const std::string& bytes, const Mesh& mesh, const std::string& where,
                                   const PlaceOptions& options) {
    check_options(options, "feature GLB");
    return FeatureReader(bytes, mesh, where, options).read();
}

}  // namespace ostraka

// Conversion of annotations to GLB with EXT_mesh_features and EXT_structural_metadata.
#include "ostraka/algebra/dense.h"
#include "ostraka/interchange/feature_glb.h"

#include "interchange/landmark_formats.h"
#include "interchange/text.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/cut_extras.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/progress.h"
#include "ostraka/files/json_build.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/glb.h"
#include "ostraka/io/glb_materials.h"
#include "ostraka/io/surface_look.h"
#include "ostraka/mesh/limits.h"
#include "ostraka/vocabulary/text_match.h"

#include <fmt/core.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

namespace ostraka {

namespace {

using namespace interchange;
using glb::append;

constexpr std::size_t exact_in_float = std::size_t{1} << 24;
constexpr std::size_t check_every = 1 << 16;  ///< number of elements between two checks for cancellation

/// Vertices of a primitive: mesh vertices with one feature per set.
struct Corners {
    std::vector<Index> vertices;
    std::vector<std::array<int, 3>> colours;   ///< empty: the colours of the texture
    std::vector<TexturePoint> texture;         ///< empty: no texture
    int material = 0;                          ///< index of the glTF material
    std::vector<std::vector<Index>> features;  ///< one list per set
    std::vector<std::uint32_t> indices;
};

class FeatureWriter {
public:
    /// `originals`: the annotations on the original mesh if the primitives cannot represent all of them; otherwise null.
    /// `extras`: texture and colours of the surface.
    FeatureWriter(AnnotatedMeshView object, const std::string& mesh_file, const Provenance& provenance, const Json& originals,
                  const MeshExtras& extras, std::vector<std::string>& notes)
        : object_(object),
          where_(mesh_file.empty() ? "GLB" : mesh_file),
          native_(annotations_to_json(object, mesh_file, provenance)),
          originals_(originals),
          extras_(extras),
          notes_(notes) {}

    std::string write() {
        if (object_.mesh.number_of_faces() == 0)
            fail_work(where_, "glTF cannot store a mesh without triangles", "export another format");
        if (object_.annotations.annotations.size() >= exact_in_float)
            fail_work(where_, "has more annotations than distinct feature ids", "export fewer");
        JsonValue primitives(rapidjson::kArrayType);
        const std::vector<Corners> surfaces = surface();
        for (const Corners& part : surfaces) primitives.PushBack(primitive(part, glb::triangles_mode), a());
        const Corners drawn = lines(), marked = points();
        if (!drawn.vertices.empty()) primitives.PushBack(primitive(drawn, glb::lines_mode), a());
        if (!marked.vertices.empty()) primitives.PushBack(primitive(marked, glb::points_mode), a());
        if (!object_.annotations.annotations.empty()) add_table();

        JsonValue extras(rapidjson::kObjectType);
        // Triangle i is face i of the mesh only where there is one list of triangles.
        if (surfaces.size() == 1) copy_members(extras, a(), native_, {"mesh"});
        copy_members(extras, a(), native_, {"class", "unit", "up", "provenance"});
        if (originals_.IsObject()) {
            JsonValue original(rapidjson::kObjectType);
            copy_members(original, a(), originals_, {"mesh", "annotations"});
            add_members(extras, a(), "original", std::move(original));
        }
        JsonValue mesh =
            json_object(a(), "primitives", std::move(primitives), "extras", json_object(a(), "ostraka", std::move(extras)));
        JsonValue nodes = in_list(json_object(a(), "mesh", 0));
        const bool turned = add_display_node(nodes);
        Json& root = builder_.document();
        add_members(root, a(), "scene", 0, "scenes", in_list(json_object(a(), "nodes", std::array{turned ? 1 : 0})), "nodes",
                    std::move(nodes), "meshes", in_list(std::move(mesh)));
        const auto empty = std::count_if(
            object_.annotations.annotations.begin(), object_.annotations.annotations.end(), [](const Annotation& annotation) {
                return annotation.points.empty() && annotation.polylines.empty() && annotation.faces.empty();
            });
        if (empty > 0)
            notes_.push_back(counted(static_cast<std::size_t>(empty), "annotation") +
                             " without elements: present in the table, but not on the mesh");
        if (rounded_) notes_.emplace_back("GLB stores coordinates in single precision; they were rounded");
        return with_materials();
    }

private:
    /// Adds the materials, and the images as the last views, and completes the file.
    std::string with_materials() {
        std::vector<Index> used{no_index};  // of lines, points and faces without a material
        for (Index material = 0; textured_ && material < extras_.appearance.materials.size(); ++material)
            used.push_back(material);
        io::GlbMaterials materials(extras_.appearance, std::move(used), where_);
        materials.add_to(builder_, false);
        if (!object_.annotations.annotations.empty()) add_extensions_used({"EXT_mesh_features", "EXT_structural_metadata"});
        notes_.insert(notes_.end(), materials.notes().begin(), materials.notes().end());
        std::string file = builder_.finish(where_, "simplify the mesh");
        for (const SharedImage& image : materials.images()) {
            file += image->bytes;
            file.append((alignment - image->bytes.size() % alignment) % alignment, '\0');
        }
        return file;
    }
    JsonAllocator& a() { return builder_.allocator(); }
    void add_extensions_used(std::initializer_list<const char*> names) {
        Json& root = builder_.document();
        if (!root.HasMember("extensionsUsed")) add_members(root, a(), "extensionsUsed", JsonValue(rapidjson::kArrayType));
        for (const char* name : names) root["extensionsUsed"].PushBack(json_string(name, a()), a());
    }
    JsonValue in_list(JsonValue value) { return json_list_of(std::move(value), a()); }
    [[nodiscard]] Index none() const { return static_cast<Index>(object_.annotations.annotations.size()); }

    /// Smallest regions first, each in the first set in which it overlaps no other.
    std::vector<std::vector<Index>> layers() {
        std::vector<std::pair<double, Index>> regions;
        for (Index i = 0; i < none(); ++i) {
            const Annotation& annotation = object_.annotations.annotations[i];
            if (annotation.type != AnnotationType::region || annotation.faces.empty()) continue;
            check_cancelled();
            regions.emplace_back(area_of(object_.mesh, annotation.faces), i);
        }
        std::sort(regions.begin(), regions.end());
        std::vector<std::vector<Index>> result;
        for (const auto& [area, i] : regions) {
            const auto& faces = object_.annotations.annotations[i].faces;
            auto layer = std::find_if(result.begin(), result.end(), [&](const std::vector<Index>& features) {
                return std::none_of(faces.begin(), faces.end(), [&](Index face) { return features[face] != none(); });
            });
            if (layer == result.end())
                layer = result.insert(result.end(), std::vector<Index>(object_.mesh.number_of_faces(), none()));
            for (const Index face : faces) (*layer)[face] = i;
        }
        if (result.size() > 4)
            notes_.push_back(
                fmt::format("regions overlap in {} layers; viewers may read only the first feature id sets", result.size()));
        return result;
    }

    /// A vertex of a face: faces that agree in all of these share a copy of the vertex.
    struct Look {
        Index kind;            ///< number of the combination of features
        std::size_t part;      ///< number of the primitive
        TexturePoint texture;  ///< texture coordinates
        std::array<int, 3> colour;
        bool operator==(const Look&) const = default;
    };

    /// The primitive of a face: one per material, in the order of their first faces.
    std::size_t part_of(Face face, std::vector<Corners>& parts, std::map<Index, std::size_t>& numbers) const {
        const std::size_t materials = extras_.appearance.materials.size();
        Index material = no_index;
        if (textured_) material = extras_.face_materials[face.idx()];
        const auto [place, added] = numbers.try_emplace(material < materials ? material : no_index, parts.size());
        if (added) parts.emplace_back().material = material < materials ? static_cast<int>(material) + 1 : 0;
        return place->second;
    }

    /// Colour of a corner: that of the file if it has colours or a texture, else that of the smallest region; grey without any.
    [[nodiscard]] std::array<int, 3> colour_of(Face face, Vertex v, const std::vector<Index>& kind, bool has_material) const {
        const auto opaque = [](const Colour& colour) { return std::array<int, 3>{colour[0], colour[1], colour[2]}; };
        if (!extras_.face_colours.empty()) return opaque(extras_.face_colours[face.idx()]);
        if (!extras_.vertex_colours.empty()) return opaque(extras_.vertex_colours[v.idx()]);
        std::array<int, 3> colour{200, 200, 200};
        if (textured_) return has_material ? std::array<int, 3>{255, 255, 255} : colour;
        for (std::size_t s = kind.size(); s-- > 0;)
            if (kind[s] != none() && !object_.annotations.annotations[kind[s]].all)
                colour = object_.annotations.annotations[kind[s]].colour;
        return colour;
    }

    std::vector<Corners> surface() {
        const std::vector<std::vector<Index>> sets = layers();
        std::vector<Corners> parts;
        std::map<Index, std::size_t> part_numbers;
        std::map<std::vector<Index>, Index> kinds;
        std::vector<std::vector<std::pair<Look, std::uint32_t>>> copies(object_.mesh.number_of_vertices());
        std::vector<Index> kind(sets.size());
        for (const Face face : object_.mesh.faces()) {
            if (face.idx() % check_every == 0) check_cancelled();
            for (std::size_t s = 0; s < sets.size(); ++s) kind[s] = sets[s][face];
            Look look{};
            look.kind = kinds.emplace(kind, static_cast<Index>(kinds.size())).first->second;
            look.part = part_of(face, parts, part_numbers);
            Corners& part = parts[look.part];
            part.features.resize(sets.size());
            const bool has_places = part.material > 0 && !extras_.corner_texture.empty();
            std::size_t corner = 3 * std::size_t{face.idx()};
            for (const Vertex v : corners(object_.mesh, face)) {
                if (has_places) look.texture = extras_.corner_texture[corner++];
                look.colour = colour_of(face, v, kind, part.material > 0);
                auto& vertex_copies = copies[v];
                auto copy = std::find_if(vertex_copies.begin(), vertex_copies.end(),
                                         [&](const auto& entry) { return entry.first == look; });
                if (copy == vertex_copies.end()) {
                    copy = vertex_copies.insert(vertex_copies.end(), {look, static_cast<std::uint32_t>(part.vertices.size())});
                    part.vertices.push_back(v);
                    for (std::size_t s = sets.size(); s-- > 0;) part.features[s].push_back(kind[s]);
                    part.colours.push_back(look.colour);
                    if (has_places) part.texture.push_back(look.texture);
                }
                part.indices.push_back(copy->second);
            }
        }
        return parts;
    }

    Corners lines() {
        Corners result;
        result.features.resize(1);
        for (Index i = 0; i < none(); ++i)
            for (const auto& polyline : object_.annotations.annotations[i].polylines)
                for (std::size_t k = 0; k < polyline.size(); ++k) {
                    if (k > 0)
                        for (const std::size_t back : {1U, 0U})
                            result.indices.push_back(static_cast<std::uint32_t>(result.vertices.size() - back));
                    add(result, polyline[k], i);
                }
        return result;
    }

    /// In glTF, y points up and the unit is the metre: adds a parent node that transforms the mesh accordingly. Returns false
    /// if it already complies.
    bool add_display_node(JsonValue& nodes) {
        const auto metres = converted(1, object_.annotations.unit, "m");
        Vector3d up = Vector3d::UnitY();
        if (object_.annotations.up)
            up = eigen(unit_vector({(*object_.annotations.up)[0], (*object_.annotations.up)[1], (*object_.annotations.up)[2]}));
        const Eigen::Quaterniond rotation = rotation_between(up, Vector3d::UnitY());
        const bool rotates = (up - Vector3d::UnitY()).norm() > 1e-12, scales = metres && *metres != 1;
        if (!rotates && !scales) return false;
        JsonValue display_node = json_object(a(), "name", "as glTF wants it: y up, in metres", "children", std::array{0});
        if (rotates)
            add_members(display_node, a(), "rotation", std::array{rotation.x(), rotation.y(), rotation.z(), rotation.w()});
        if (scales) add_members(display_node, a(), "scale", std::array{*metres, *metres, *metres});
        add_members(display_node, a(), "extras", json_object(a(), glb::display_only, true));
        nodes.PushBack(display_node, a());
        return true;
    }

    Corners points() {
        Corners result;
        result.features.resize(1);
        for (Index i = 0; i < none(); ++i)
            for (const Index point : object_.annotations.annotations[i].points) add(result, point, i);
        return result;
    }

    void add(Corners& target, Index vertex, Index feature) {
        target.vertices.push_back(vertex);
        target.colours.push_back(object_.annotations.annotations[feature].colour);
        target.features.front().push_back(feature);
    }

    JsonValue primitive(const Corners& primitive_corners, int mode) {
        const std::size_t count = primitive_corners.vertices.size();
        JsonValue attributes(rapidjson::kObjectType);
        std::string positions, colours, origins, texture;
        std::array<float, 3> low, high;
        low.fill(std::numeric_limits<float>::max());
        high.fill(std::numeric_limits<float>::lowest());
        for (std::size_t i = 0; i < count; ++i) {
            if (i % check_every == 0) check_cancelled();
            const Point& p = object_.mesh.point(Vertex(primitive_corners.vertices[i]));
            for (int k = 0; k < 3; ++k) {
                if (std::fabs(p[k]) > static_cast<double>(std::numeric_limits<float>::max()))
                    fail_work(where_, "a coordinate does not fit the single precision of glTF", "rescale the mesh");
                const auto single = static_cast<float>(p[k]);
                rounded_ = rounded_ || static_cast<double>(single) != p[k];
                low[static_cast<std::size_t>(k)] = std::min(low[static_cast<std::size_t>(k)], single);
                high[static_cast<std::size_t>(k)] = std::max(high[static_cast<std::size_t>(k)], single);
                append(positions, single);
            }
            if (!primitive_corners.texture.empty()) {
                append(texture, primitive_corners.texture[i][0]);
                append(texture, 1 - primitive_corners.texture[i][1]);  // glTF counts from the top of the image
            }
            for (const int channel : primitive_corners.colours[i])
                append(colours, glb::linear_channel(static_cast<std::size_t>(channel)));
            append(colours, std::uint16_t{65535});
            append(origins, static_cast<float>(primitive_corners.vertices[i]));
        }
        JsonValue min = json_value(low, a()), max = json_value(high, a());
        const auto attribute = [&](const std::string& name, int accessor) { add_members(attributes, a(), name, accessor); };
        attribute("POSITION", builder_.add_accessor(positions, glb::array_buffer, 0, glb::single, count, "VEC3", &min, &max));
        const int colour = builder_.add_accessor(colours, glb::array_buffer, 0, glb::short_word, count, "VEC4");
        builder_.mark_normalised(colour);
        attribute("COLOR_0", colour);
        if (!texture.empty())
            attribute("TEXCOORD_0", builder_.add_accessor(texture, glb::array_buffer, 0, glb::single, count, "VEC2"));
        if (object_.mesh.number_of_vertices() <= exact_in_float)
            attribute("_VERTEX", builder_.add_accessor(origins, glb::array_buffer, 0, glb::single, count, "SCALAR"));
        JsonValue ids(rapidjson::kArrayType);
        for (std::size_t s = 0; s < primitive_corners.features.size(); ++s) {
            std::string bytes;
            const bool sixteen_bit = none() <= std::numeric_limits<std::uint16_t>::max();
            std::vector<Index> distinct = primitive_corners.features[s];
            for (const Index feature : primitive_corners.features[s]) {
                if (sixteen_bit) append(bytes, static_cast<std::uint16_t>(feature)), append(bytes, std::uint16_t{0});
                else append(bytes, static_cast<float>(feature));
            }
            std::sort(distinct.begin(), distinct.end());
            distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
            std::erase(distinct, none());
            if (distinct.empty()) continue;
            attribute(
                "_FEATURE_ID_" + std::to_string(s),
                builder_.add_accessor(bytes, glb::array_buffer, 4, sixteen_bit ? glb::short_word : glb::single, count, "SCALAR"));
            JsonValue id = json_object(a(), "featureCount", distinct.size(), "nullFeatureId", none(), "label",
                                       "annotations_" + std::to_string(s), "attribute", s, "propertyTable", 0);
            ids.PushBack(id, a());
        }
        JsonValue result = json_object(a(), "attributes", std::move(attributes));
        if (!primitive_corners.indices.empty()) {
            std::string bytes;
            for (const std::uint32_t index : primitive_corners.indices) append(bytes, index);
            add_members(result, a(), "indices",
                        builder_.add_accessor(bytes, glb::element_array_buffer, 0, glb::word, primitive_corners.indices.size(),
                                              "SCALAR"));
        }
        add_members(result, a(), "mode", mode, "material", primitive_corners.material);
        if (!ids.Empty())
            add_members(result, a(), "extensions",
                        json_object(a(), "EXT_mesh_features", json_object(a(), "featureIds", std::move(ids))));
        return result;
    }

    // The property table: one column per property.
    void column(const std::string& id, JsonValue described, JsonValue stored) {
        add_member(properties_, id, std::move(described), a());
        add_member(columns_, id, std::move(stored), a());
    }
    JsonValue described(const std::string& type, const std::string& component, const std::string& name, bool required) {
        JsonValue property(rapidjson::kObjectType);
        add_nonempty_members(property, a(), "name", name, "type", type, "componentType", component, "required", required);
        return property;
    }
    JsonValue stored(const std::string& bytes) { return json_object(a(), "values", builder_.add_view(bytes)); }
    JsonValue stored(const std::vector<std::string>& texts) {
        std::string bytes, offsets;
        append(offsets, std::uint32_t{0});
        for (const std::string& text : texts) {
            bytes += as_utf8(text);
            if (bytes.size() > std::numeric_limits<std::uint32_t>::max())
                fail_work(where_, "its texts exceed four gigabytes", "shorten them");
            append(offsets, static_cast<std::uint32_t>(bytes.size()));
        }
        JsonValue values = stored(bytes);
        add_members(values, a(), "stringOffsets", builder_.add_view(offsets), "stringOffsetType", "UINT32");
        return values;
    }

    void add_table() {
        std::string ids, colours, kinds;
        std::vector<std::string> tags, notes, attributes;
        const JsonValue& entries = native_["annotations"];
        for (rapidjson::SizeType i = 0; i < entries.Size(); ++i) {
            const Annotation& annotation = object_.annotations.annotations[i];
            append(ids, static_cast<std::int32_t>(annotation.id));
            for (const int channel : annotation.colour) append(colours, static_cast<std::uint8_t>(channel));
            append(kinds, static_cast<std::uint8_t>(annotation.all ? 3 : static_cast<int>(annotation.type)));
            tags.push_back(annotation.tag);
            notes.push_back(annotation.note);
            attributes.emplace_back(trimmed(to_text(entries[i]["attributes"])));
        }
        column("id", described("SCALAR", "INT32", "", true), stored(ids));
        column("tag", described("STRING", "", "", true), stored(tags));
        JsonValue kind = described("ENUM", "", "", true);
        add_member(kind, "enumType", "annotationKind", a());
        column("kind", std::move(kind), stored(kinds));
        column("colour", described("VEC3", "UINT8", "", true), stored(colours));
        column("note", described("STRING", "", "", true), stored(notes));
        column("attributes", described("STRING", "", "all attributes as JSON", true), stored(attributes));
        add_attribute_columns();

        int value = 0;
        JsonValue kind_names = json_list(std::array{"point", "line", "region", "whole"}, a(),
                                         [&](const char* name) { return json_object(a(), "name", name, "value", value++); });
        JsonValue kind_type = json_object(a(), "valueType", "UINT8", "values", std::move(kind_names));
        JsonValue type = json_object(a(), "name", "Annotation", "properties", std::move(properties_));
        JsonValue schema = json_object(a(), "id", "ostraka_annotations", "version", "1.0.0", "classes",
                                       json_object(a(), "annotation", std::move(type)), "enums",
                                       json_object(a(), "annotationKind", std::move(kind_type)));
        JsonValue table =
            json_object(a(), "name", "annotations", "class", "annotation", "count", none(), "properties", std::move(columns_));
        JsonValue metadata = json_object(a(), "schema", std::move(schema), "propertyTables", in_list(std::move(table)));
        add_members(builder_.document(), a(), "extensions", json_object(a(), "EXT_structural_metadata", std::move(metadata)));
    }

    /// For viewers: a column for each attribute name with a number or a text.
    void add_attribute_columns() {
        constexpr double missing = std::numeric_limits<double>::lowest();
        std::map<std::string, std::vector<double>> numbers;
        std::map<std::string, std::vector<std::string>> texts;
        for (Index i = 0; i < none(); ++i)
            for (const Attribute& attribute : object_.annotations.annotations[i].attributes) {
                if (const Note* note = attribute.note()) {
                    auto& values = texts[attribute.name];
                    values.resize(none());
                    values[i] += (values[i].empty() ? "" : "; ") + note->text;
                    continue;
                }
                const Figures figures = attribute_values(attribute);
                if (figures.values.size() != 1) continue;
                auto& values =
                    numbers[figures.unit.empty() ? attribute.name : fmt::format("{} ({})", attribute.name, figures.unit)];
                values.resize(none(), missing);
                values[i] = figures.values.front();
            }
        std::size_t number = 0;
        for (const auto& [name, values] : numbers) {
            std::string bytes;
            for (const double value : values) append(bytes, value);
            JsonValue property = described("SCALAR", "FLOAT64", name, false);
            add_members(property, a(), "noData", missing);
            column("number_" + std::to_string(number++), std::move(property), stored(bytes));
        }
        number = 0;
        for (const auto& [name, values] : texts) {
            JsonValue property = described("STRING", "", name, false);
            add_member(property, "noData", "", a());
            column("text_" + std::to_string(number++), std::move(property), stored(values));
        }
    }

    const AnnotatedMeshView object_;
    std::string where_;
    Json native_;
    const Json& originals_;
    const MeshExtras& extras_;
    bool textured_ = has_texture(extras_);
    std::vector<std::string>& notes_;
    static constexpr std::size_t alignment = 8;
    glb::Builder builder_{alignment, true};
    JsonValue properties_{rapidjson::kObjectType}, columns_{rapidjson::kObjectType};
    bool rounded_ = false;
};

}  // namespace

std::string feature_glb(AnnotatedMeshView object, const std::string& mesh_file, const Provenance& provenance,
                        std::vector<std::string>& notes, const MeshExtras& extras) {
    const EdgeAlignedAnnotations along_edges(object);
    if (along_edges.cut())
        notes.emplace_back("the mesh is cut along free outlines; the curves on the original mesh are stored as well");
    const bool informed = std::any_of(object.annotations.annotations.begin(), object.annotations.annotations.end(),
                                      [](const Annotation& annotation) { return !annotation.information.empty(); });
    const bool looks = has_texture(extras) || has_own_colours(extras);
    if (looks && !object.annotations.annotations.empty())
        notes.emplace_back(fmt::format("the surface has the {} in the file; the colours of the annotations are in their table",
                                       has_texture(extras) ? "texture" : "colours"));
    Json originals;
    const bool several_materials = has_texture(extras) && !extras.face_materials.empty() &&
                                   std::adjacent_find(extras.face_materials.begin(), extras.face_materials.end(),
                                                      std::not_equal_to<>()) != extras.face_materials.end();
    if (along_edges.cut() || informed || several_materials) originals = annotations_to_json(object, mesh_file, provenance);
    MeshExtras extras_of_cut;
    if (looks && along_edges.cut()) extras_of_cut = cut_extras(*along_edges.cut(), object.mesh, extras);
    return FeatureWriter(along_edges.object(), mesh_file, provenance, originals, along_edges.cut() ? extras_of_cut : extras,
                         notes)
        .write();
}

}  // namespace ostraka

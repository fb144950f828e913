#include "interchange/feature_file.h"

#include "interchange/text.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka::interchange {

namespace {
/// Charged for the features of a corner, including the cost of visiting it again.
constexpr double bytes_of_corner = 4;
/// Memory of an empty text in a list.
constexpr double bytes_of_text = sizeof(std::string);
}  // namespace

FeatureFile::FeatureFile(const std::string& bytes, const std::string& where) : file(bytes, where) {
    refuse_unsupported();
    read_primitives();
    read_table();
    for (std::size_t p = 0; p < primitives.size(); ++p) collect(primitives[p], p);
}

void FeatureFile::refuse_unsupported() const {
    constexpr std::array supported{"EXT_mesh_features", "EXT_structural_metadata", "EXT_texture_webp"};
    for (const auto& name : list_in(file.document(), "extensionsRequired"))
        if (!name.IsString() || std::find(supported.begin(), supported.end(), text_of(name)) == supported.end())
            file.fail("/extensionsRequired", "requires an unsupported extension");
    const auto nodes = list_in(file.document(), "nodes");
    for (rapidjson::SizeType i = 0; i < nodes.Size(); ++i) {
        const JsonValue* extras = find_member(nodes[i], "extras");
        if (extras != nullptr && find_member(*extras, glb::display_only) != nullptr) continue;
        for (const char* name : {"matrix", "translation", "rotation", "scale"})
            if (find_member(nodes[i], name) != nullptr)
                file.fail(fmt::format("/nodes/{}/{}", i, name), "transformations of nodes are not supported");
    }
}

const JsonValue* FeatureFile::extras() const {
    const auto meshes = list_in(file.document(), "meshes");
    const JsonValue* extras = meshes.Empty() ? nullptr : find_member(meshes[0], "extras");
    return extras == nullptr ? nullptr : find_member(*extras, "ostraka");
}

std::size_t FeatureFile::triangles() const {
    std::size_t count = 0;
    for (const Primitive& p : primitives)
        if (p.mode == glb::triangles_mode) count += p.corners() / 3;
    return count;
}

void FeatureFile::read_primitives() {
    const JsonValue* meshes = find_member(file.document(), "meshes");
    if (meshes == nullptr || !meshes->IsArray()) file.fail("/meshes", "the file contains no meshes");
    for (rapidjson::SizeType m = 0; m < meshes->Size(); ++m) {
        const JsonValue* entries = find_member((*meshes)[m], "primitives");
        const std::string pointer = fmt::format("/meshes/{}/primitives", m);
        if (entries == nullptr || !entries->IsArray()) file.fail(pointer, "is not a list");
        for (rapidjson::SizeType i = 0; i < entries->Size(); ++i) read_primitive((*entries)[i], fmt::format("{}/{}", pointer, i));
    }
    if (triangles() == 0) fail_input(file.where(), "contains no triangles", "give a file with a surface");
}

void FeatureFile::read_primitive(const JsonValue& object, const std::string& pointer) {
    Primitive primitive;
    const std::size_t mode = file.number(object, "mode", pointer, glb::triangles_mode);
    if (mode != glb::triangles_mode && mode != glb::lines_mode && mode != glb::points_mode) {
        notes.push_back(fmt::format("at {}: strips, fans and loops are not supported", pointer));
        return;
    }
    primitive.mode = static_cast<int>(mode);
    const JsonValue* accessors = find_member(object, "attributes");
    const std::size_t position =
        accessors == nullptr ? absent : file.number(*accessors, "POSITION", pointer + "/attributes", absent);
    if (position == absent) file.fail(pointer, "has no positions");
    primitive.positions = file.accessor(position, 3, pointer + "/attributes/POSITION");
    const std::size_t count = primitive.vertices();
    for (const double x : *primitive.positions)
        if (!std::isfinite(x)) file.fail(pointer + "/attributes/POSITION", "a coordinate is not finite");
    if (const std::size_t origin = file.number(*accessors, "_VERTEX", pointer, absent); origin != absent) {
        primitive.origins = file.accessor(origin, 1, pointer + "/attributes/_VERTEX");
        if (primitive.origins->size() != count)
            file.fail(pointer + "/attributes/_VERTEX", "has a different count from the positions");
    }
    if (const std::size_t indices = file.number(object, "indices", pointer, absent); indices != absent) {
        primitive.indices = file.accessor(indices, 1, pointer + "/indices");
        for (const double value : *primitive.indices)
            if (!(value >= 0 && value < static_cast<double>(count)) || value != std::floor(value))
                file.fail(pointer + "/indices", "an index is out of range");
    }
    if (primitive.corners() % (mode == glb::triangles_mode ? 3 : mode == glb::lines_mode ? 2 : 1) != 0)
        file.fail(pointer + "/indices", "do not form complete elements");
    file.charge(bytes_of_corner * static_cast<double>(primitive.corners()), pointer);
    const JsonValue* extensions = find_member(object, "extensions");
    const JsonValue* extension = extensions == nullptr ? nullptr : find_member(*extensions, "EXT_mesh_features");
    if (extension != nullptr) {
        const auto sets = list_in(*extension, "featureIds");
        for (rapidjson::SizeType i = 0; i < sets.Size(); ++i)
            read_ids(sets[i], *accessors, primitive, fmt::format("{}/extensions/EXT_mesh_features/featureIds/{}", pointer, i));
    }
    primitives.push_back(std::move(primitive));
}

void FeatureFile::read_ids(const JsonValue& set, const JsonValue& accessors, Primitive& primitive, const std::string& pointer) {
    const std::size_t number = file.number(set, "attribute", pointer, absent);
    if (number == absent) {
        notes.push_back(fmt::format("at {}: feature values in textures or without an attribute are not supported", pointer));
        return;
    }
    const std::string name = "_FEATURE_ID_" + std::to_string(number);
    const std::size_t accessor = file.number(accessors, name.c_str(), pointer, absent);
    if (accessor == absent)
        file.fail(pointer, fmt::format("refers to the attribute {}, which the primitive does not have", name));
    glb::Reader::Values values = file.accessor(accessor, 1, pointer);
    file.charge(bytes_of_corner * static_cast<double>(primitive.corners()), pointer);
    if (values->size() != primitive.vertices()) file.fail(pointer, "has a different count from the positions");
    for (const double id : *values)
        if (!(id >= 0 && id < 4294967296.0) || id != static_cast<double>(static_cast<std::uint32_t>(id)))
            file.fail(pointer, "a feature id is not a non-negative integer");
    primitive.features.push_back(std::move(values));
    primitive.nulls.push_back(file.number(set, "nullFeatureId", pointer, absent));
    const std::size_t table = file.number(set, "propertyTable", pointer, absent);
    if (table_ == absent) table_ = table;
    else if (table != absent && table != table_)
        file.fail(pointer + "/propertyTable", "features of several tables are not supported");
}

const JsonValue* FeatureFile::metadata(const char* member) const {
    const JsonValue* extensions = find_member(file.document(), "extensions");
    const JsonValue* structural_metadata = extensions == nullptr ? nullptr : find_member(*extensions, "EXT_structural_metadata");
    return structural_metadata == nullptr ? nullptr : find_member(*structural_metadata, member);
}

void FeatureFile::read_table() {
    if (table_ == absent) return;
    const JsonValue* tables = metadata("propertyTables");
    if (tables == nullptr || !tables->IsArray() || table_ >= tables->Size())
        file.fail("/extensions/EXT_structural_metadata/propertyTables", "does not have the table to which the features refer");
    const JsonValue& table = (*tables)[static_cast<rapidjson::SizeType>(table_)];
    const std::string pointer = "/extensions/EXT_structural_metadata/propertyTables/" + std::to_string(table_);
    rows = file.number(table, "count", pointer, 0);
    if (rows > (std::size_t{1} << 24)) file.fail(pointer + "/count", "exceeds the number of distinct feature ids");
    const JsonValue* properties = find_member(table, "properties");
    if (properties == nullptr || !properties->IsObject()) return;
    for (const char* name : {"tag", "name", "label"})
        if (tags.empty()) tags = texts(*properties, name, pointer);
    ours = text_in(table, "class") == "annotation" && find_member(*properties, "attributes") != nullptr;
    if (!ours) return;
    remarks = texts(*properties, "note", pointer);
    this->attributes = texts(*properties, "attributes", pointer);
    ids = numbers<std::int32_t>(*properties, "id", 1, pointer);
    kinds = numbers<std::uint8_t>(*properties, "kind", 1, pointer);
    colours = numbers<std::uint8_t>(*properties, "colour", 3, pointer);
}

template <class T>
std::vector<int> FeatureFile::numbers(const JsonValue& properties, const char* name, std::size_t width,
                                      const std::string& pointer) const {
    const JsonValue* property = find_member(properties, name);
    const std::string property_pointer = fmt::format("{}/properties/{}", pointer, name);
    if (property == nullptr) file.fail(property_pointer, "the property is missing");
    const std::string_view bytes = file.view(file.number(*property, "values", property_pointer, absent), property_pointer);
    if (bytes.size() < rows * width * sizeof(T)) file.fail(property_pointer, "has fewer values than the table has rows");
    file.charge(static_cast<double>(rows * width * sizeof(int)), property_pointer);
    std::vector<int> values;
    for (std::size_t i = 0; i < rows * width; ++i) {
        T value;
        std::copy_n(bytes.data() + i * sizeof(T), sizeof(T), reinterpret_cast<char*>(&value));
        values.push_back(value);
    }
    return values;
}

std::vector<std::string> FeatureFile::texts(const JsonValue& properties, const char* name, const std::string& pointer) const {
    std::vector<std::string> result;
    const JsonValue* property = find_member(properties, name);
    if (property == nullptr || find_member(*property, "stringOffsets") == nullptr) return result;
    const std::string property_pointer = fmt::format("{}/properties/{}", pointer, name);
    const std::string type = text_in(*property, "stringOffsetType");
    const std::size_t width = type == "UINT8" ? 1 : type == "UINT16" ? 2 : type == "UINT64" ? 8 : 4;
    const std::string_view bytes = file.view(file.number(*property, "values", property_pointer, absent), property_pointer);
    const std::string_view offsets =
        file.view(file.number(*property, "stringOffsets", property_pointer, absent), property_pointer);
    if (offsets.size() < (rows + 1) * width)
        file.fail(property_pointer + "/stringOffsets", "has fewer offsets than the table has rows");
    const auto offset = [&](std::size_t i) {
        std::uint64_t value = 0;
        for (std::size_t k = 0; k < width; ++k)
            value |= static_cast<std::uint64_t>(static_cast<unsigned char>(offsets[i * width + k])) << (8 * k);
        return value;
    };
    file.charge(bytes_of_text * static_cast<double>(rows) + static_cast<double>(bytes.size()), property_pointer);
    for (std::size_t i = 0; i < rows; ++i) {
        const std::uint64_t begin = offset(i), end = offset(i + 1);
        if (begin > end || end > bytes.size()) file.fail(property_pointer + "/stringOffsets", "exceed the texts");
        result.push_back(as_utf8(bytes.substr(begin, end - begin)));
    }
    return result;
}

/// Collects the elements selected by each feature in one primitive.
void FeatureFile::collect(const Primitive& primitive, std::size_t number) {
    for (std::size_t s = 0; s < primitive.features.size(); ++s) {
        const auto& set = primitive.features[s];
        const auto feature_of = [&](std::size_t corner) -> std::size_t {
            const auto id = static_cast<std::size_t>((*set)[primitive.corner(corner)]);
            if (id == primitive.nulls[s]) return absent;
            if (table_ != absent && id >= rows) file.fail("/extensions/EXT_structural_metadata", "has no row for a feature id");
            return id;
        };
        if (primitive.mode == glb::triangles_mode) {
            for (std::size_t t = 0; 3 * t < primitive.corners(); ++t) {
                const std::size_t x = feature_of(3 * t), y = feature_of(3 * t + 1), z = feature_of(3 * t + 2),
                                  id = y == z ? y : x;
                if (id == absent) continue;
                auto& faces = features[id].faces;
                if (!faces) faces.emplace();
                faces->push_back(static_cast<std::uint32_t>(t + offset_));
            }
        } else if (primitive.mode == glb::lines_mode) {
            for (std::size_t c = 0; c + 1 < primitive.corners(); c += 2) {
                const std::size_t id = feature_of(c), from = primitive.corner(c), to = primitive.corner(c + 1);
                if (id == absent) continue;
                Feature& feature = features[id];
                feature.line_primitive = number;
                if (feature.polylines.empty() || feature.polylines.back().back() != from) feature.polylines.push_back({from});
                feature.polylines.back().push_back(to);
            }
        } else {
            for (std::size_t c = 0; c < primitive.corners(); ++c) {
                const std::size_t id = feature_of(c);
                if (id == absent) continue;
                features[id].point_primitive = number;
                features[id].points.push_back(primitive.corner(c));
            }
        }
    }
    if (primitive.mode == glb::triangles_mode) offset_ += primitive.corners() / 3;
}

}  // namespace ostraka::interchange

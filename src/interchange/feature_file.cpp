#include "feature_file.h"

#include "text.h"

#include "ostraka/core/error.h"

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
    refuse_what_is_not_read();
    read_primitives();
    read_table();
    for (std::size_t p = 0; p < primitives.size(); ++p) collect(primitives[p], p);
}

void FeatureFile::refuse_what_is_not_read() const {
    for (const auto& name : list_in(file.document(), "extensionsRequired"))
        if (!name.IsString() || (text_of(name) != "EXT_mesh_features" && text_of(name) != "EXT_structural_metadata"))
            file.fail("/extensionsRequired", "asks for an extension that is not known here");
    const auto nodes = list_in(file.document(), "nodes");
    for (rapidjson::SizeType i = 0; i < nodes.Size(); ++i) {
        const JsonValue* extras = find_member(nodes[i], "extras");
        if (extras != nullptr && find_member(*extras, glb::display_only) != nullptr) continue;
        for (const char* name : {"matrix", "translation", "rotation", "scale"})
            if (find_member(nodes[i], name) != nullptr)
                file.fail("/nodes/" + std::to_string(i) + "/" + name, "transformations of nodes are not read");
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
    if (meshes == nullptr || !meshes->IsArray()) file.fail("/meshes", "the file holds no meshes");
    for (rapidjson::SizeType m = 0; m < meshes->Size(); ++m) {
        const JsonValue* list = find_member((*meshes)[m], "primitives");
        const std::string at = "/meshes/" + std::to_string(m) + "/primitives";
        if (list == nullptr || !list->IsArray()) file.fail(at, "is not a list");
        for (rapidjson::SizeType i = 0; i < list->Size(); ++i) read_primitive((*list)[i], at + "/" + std::to_string(i));
    }
    if (triangles() == 0) fail_input(file.where(), "holds no triangles", "give a file with a surface");
}

void FeatureFile::read_primitive(const JsonValue& object, const std::string& at) {
    Primitive primitive;
    const std::size_t mode = file.number(object, "mode", at, glb::triangles_mode);
    if (mode != glb::triangles_mode && mode != glb::lines_mode && mode != glb::points_mode) {
        notes.push_back("at " + at + ": strips, fans and loops are not read");
        return;
    }
    primitive.mode = static_cast<int>(mode);
    const JsonValue* accessors = find_member(object, "attributes");
    const std::size_t position = accessors == nullptr ? absent : file.number(*accessors, "POSITION", at + "/attributes", absent);
    if (position == absent) file.fail(at, "has no positions");
    primitive.positions = file.accessor(position, 3, at + "/attributes/POSITION");
    const std::size_t count = primitive.vertices();
    for (const double x : *primitive.positions)
        if (!std::isfinite(x)) file.fail(at + "/attributes/POSITION", "a coordinate is not finite");
    if (const std::size_t origin = file.number(*accessors, "_VERTEX", at, absent); origin != absent) {
        primitive.origins = file.accessor(origin, 1, at + "/attributes/_VERTEX");
        if (primitive.origins->size() != count) file.fail(at + "/attributes/_VERTEX", "has another count than the positions");
    }
    if (const std::size_t indices = file.number(object, "indices", at, absent); indices != absent) {
        primitive.indices = file.accessor(indices, 1, at + "/indices");
        for (const double value : *primitive.indices)
            if (!(value >= 0 && value < static_cast<double>(count)) || value != std::floor(value))
                file.fail(at + "/indices", "an index is out of range");
    }
    if (primitive.corners() % (mode == glb::triangles_mode ? 3 : mode == glb::lines_mode ? 2 : 1) != 0)
        file.fail(at + "/indices", "do not come out even");
    file.charge(bytes_of_corner * static_cast<double>(primitive.corners()), at);
    const JsonValue* extensions = find_member(object, "extensions");
    const JsonValue* extension = extensions == nullptr ? nullptr : find_member(*extensions, "EXT_mesh_features");
    if (extension != nullptr) {
        const auto sets = list_in(*extension, "featureIds");
        for (rapidjson::SizeType i = 0; i < sets.Size(); ++i)
            read_ids(sets[i], *accessors, primitive, at + "/extensions/EXT_mesh_features/featureIds/" + std::to_string(i));
    }
    primitives.push_back(std::move(primitive));
}

void FeatureFile::read_ids(const JsonValue& set, const JsonValue& accessors, Primitive& primitive, const std::string& at) {
    const std::size_t number = file.number(set, "attribute", at, absent);
    if (number == absent) {
        notes.push_back("at " + at + ": feature values in textures or without an attribute are not read");
        return;
    }
    const std::string name = "_FEATURE_ID_" + std::to_string(number);
    const std::size_t accessor = file.number(accessors, name.c_str(), at, absent);
    if (accessor == absent) file.fail(at, "names the attribute " + name + ", which the primitive does not have");
    glb::Reader::Values values = file.accessor(accessor, 1, at);
    file.charge(bytes_of_corner * static_cast<double>(primitive.corners()), at);
    if (values->size() != primitive.vertices()) file.fail(at, "has another count than the positions");
    for (const double id : *values)
        if (!(id >= 0 && id < 4294967296.0) || id != static_cast<double>(static_cast<std::uint32_t>(id)))
            file.fail(at, "a feature id is not a whole number from 0");
    primitive.features.push_back(std::move(values));
    primitive.nulls.push_back(file.number(set, "nullFeatureId", at, absent));
    const std::size_t table = file.number(set, "propertyTable", at, absent);
    if (table_ == absent) table_ = table;
    else if (table != absent && table != table_) file.fail(at + "/propertyTable", "features of several tables are not read");
}

const JsonValue* FeatureFile::metadata(const char* member) const {
    const JsonValue* extensions = find_member(file.document(), "extensions");
    const JsonValue* found = extensions == nullptr ? nullptr : find_member(*extensions, "EXT_structural_metadata");
    return found == nullptr ? nullptr : find_member(*found, member);
}

void FeatureFile::read_table() {
    if (table_ == absent) return;
    const JsonValue* tables = metadata("propertyTables");
    if (tables == nullptr || !tables->IsArray() || table_ >= tables->Size())
        file.fail("/extensions/EXT_structural_metadata/propertyTables", "does not have the table that the features name");
    const JsonValue& table = (*tables)[static_cast<rapidjson::SizeType>(table_)];
    const std::string at = "/extensions/EXT_structural_metadata/propertyTables/" + std::to_string(table_);
    rows = file.number(table, "count", at, 0);
    if (rows > (std::size_t{1} << 24)) file.fail(at + "/count", "is more than feature ids can tell apart");
    const JsonValue* properties = find_member(table, "properties");
    if (properties == nullptr || !properties->IsObject()) return;
    for (const char* name : {"tag", "name", "label"})
        if (tags.empty()) tags = texts(*properties, name, at);
    ours = text_in(table, "class") == "annotation" && find_member(*properties, "attributes") != nullptr;
    if (!ours) return;
    remarks = texts(*properties, "note", at);
    this->attributes = texts(*properties, "attributes", at);
    ids = numbers<std::int32_t>(*properties, "id", 1, at);
    kinds = numbers<std::uint8_t>(*properties, "kind", 1, at);
    colours = numbers<std::uint8_t>(*properties, "colour", 3, at);
}

template <class T>
std::vector<int> FeatureFile::numbers(const JsonValue& properties, const char* name, std::size_t width,
                                      const std::string& at) const {
    const JsonValue* property = find_member(properties, name);
    const std::string here = at + "/properties/" + name;
    if (property == nullptr) file.fail(here, "the property is missing");
    const std::string_view bytes = file.view(file.number(*property, "values", here, absent), here);
    if (bytes.size() < rows * width * sizeof(T)) file.fail(here, "has fewer values than the table has rows");
    file.charge(static_cast<double>(rows * width * sizeof(int)), here);
    std::vector<int> values;
    for (std::size_t i = 0; i < rows * width; ++i) {
        T value;
        std::copy_n(bytes.data() + i * sizeof(T), sizeof(T), reinterpret_cast<char*>(&value));
        values.push_back(value);
    }
    return values;
}

std::vector<std::string> FeatureFile::texts(const JsonValue& properties, const char* name, const std::string& at) const {
    std::vector<std::string> list;
    const JsonValue* property = find_member(properties, name);
    if (property == nullptr || find_member(*property, "stringOffsets") == nullptr) return list;
    const std::string here = at + "/properties/" + name;
    const std::string type = text_in(*property, "stringOffsetType");
    const std::size_t width = type == "UINT8" ? 1 : type == "UINT16" ? 2 : type == "UINT64" ? 8 : 4;
    const std::string_view bytes = file.view(file.number(*property, "values", here, absent), here);
    const std::string_view offsets = file.view(file.number(*property, "stringOffsets", here, absent), here);
    if (offsets.size() < (rows + 1) * width) file.fail(here + "/stringOffsets", "has fewer offsets than the table has rows");
    const auto offset = [&](std::size_t i) {
        std::uint64_t value = 0;
        for (std::size_t k = 0; k < width; ++k)
            value |= static_cast<std::uint64_t>(static_cast<unsigned char>(offsets[i * width + k])) << (8 * k);
        return value;
    };
    file.charge(bytes_of_text * static_cast<double>(rows) + static_cast<double>(bytes.size()), here);
    for (std::size_t i = 0; i < rows; ++i) {
        const std::uint64_t begin = offset(i), end = offset(i + 1);
        if (begin > end || end > bytes.size()) file.fail(here + "/stringOffsets", "point beyond the texts");
        list.push_back(as_utf8(bytes.substr(begin, end - begin)));
    }
    return list;
}

/// Collects the elements selected by each feature in one primitive.
void FeatureFile::collect(const Primitive& primitive, std::size_t number) {
    for (std::size_t s = 0; s < primitive.features.size(); ++s) {
        const auto& set = primitive.features[s];
        const auto of = [&](std::size_t corner) -> std::size_t {
            const auto id = static_cast<std::size_t>((*set)[primitive.corner(corner)]);
            if (id == primitive.nulls[s]) return absent;
            if (table_ != absent && id >= rows) file.fail("/extensions/EXT_structural_metadata", "has no row for a feature id");
            return id;
        };
        if (primitive.mode == glb::triangles_mode) {
            for (std::size_t t = 0; 3 * t < primitive.corners(); ++t) {
                const std::size_t x = of(3 * t), y = of(3 * t + 1), z = of(3 * t + 2), id = y == z ? y : x;
                if (id == absent) continue;
                auto& faces = features[id].faces;
                if (!faces) faces.emplace();
                faces->push_back(static_cast<std::uint32_t>(t + offset_));
            }
        } else if (primitive.mode == glb::lines_mode) {
            for (std::size_t c = 0; c + 1 < primitive.corners(); c += 2) {
                const std::size_t id = of(c), from = primitive.corner(c), to = primitive.corner(c + 1);
                if (id == absent) continue;
                Feature& feature = features[id];
                feature.line_primitive = number;
                if (feature.polylines.empty() || feature.polylines.back().back() != from) feature.polylines.push_back({from});
                feature.polylines.back().push_back(to);
            }
        } else {
            for (std::size_t c = 0; c < primitive.corners(); ++c) {
                const std::size_t id = of(c);
                if (id == absent) continue;
                features[id].point_primitive = number;
                features[id].points.push_back(primitive.corner(c));
            }
        }
    }
    if (primitive.mode == glb::triangles_mode) offset_ += primitive.corners() / 3;
}

}  // namespace ostraka::interchange

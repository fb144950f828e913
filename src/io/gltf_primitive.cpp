#include "io/gltf_primitive.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka::io {

namespace {

constexpr std::size_t no_number = static_cast<std::size_t>(-1);
constexpr const char* draco_extension = "KHR_draco_mesh_compression";

/// The corners of triangles from those of a strip or fan (glTF 2.0, section 3.7.2.1).
std::vector<std::uint32_t> unrolled(const std::vector<std::uint32_t>& corners, bool fan) {
    std::vector<std::uint32_t> triangles;
    if (corners.size() < 3) return triangles;
    triangles.reserve(3 * (corners.size() - 2));
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
        const std::uint32_t a = corners[i], b = corners[i + 1], c = corners[i + 2];
        if (fan) triangles.insert(triangles.end(), {b, c, corners[0]});
        else if (i % 2 == 0) triangles.insert(triangles.end(), {a, b, c});
        else triangles.insert(triangles.end(), {a, c, b});
    }
    return triangles;
}

}  // namespace

GltfPrimitive::GltfPrimitive(const glb::Reader& reader, const JsonValue& primitive, std::string pointer, DracoCache& draco)
    : reader_(reader), primitive_(primitive), pointer_(std::move(pointer)) {
    const std::size_t mode = reader.number(primitive, "mode", pointer_, glb::triangles_mode);
    if (mode > glb::fan_mode) reader.fail(pointer_ + "/mode", "is not a mode from 0 to 6");
    mode_ = static_cast<int>(mode);
    attributes_ = find_member(primitive, "attributes");
    if (attributes_ == nullptr || !attributes_->IsObject()) reader.fail(pointer_ + "/attributes", "is missing");
    const JsonValue* extensions = find_member(primitive, "extensions");
    const JsonValue* extension = extensions == nullptr ? nullptr : find_member(*extensions, draco_extension);
    if (extension == nullptr || mode_ < glb::triangles_mode) return;
    const std::string place = fmt::format("{}/extensions/{}", pointer_, draco_extension);
    draco_attributes_ = find_member(*extension, "attributes");
    draco_view_ = reader.number(*extension, "bufferView", place, no_number);
    std::unique_ptr<DracoPrimitive>& decoded = draco[draco_view_];
    if (!decoded) decoded = std::make_unique<DracoPrimitive>(reader, reader.view(draco_view_, place), place);
    draco_ = decoded.get();
}

std::optional<std::size_t> GltfPrimitive::accessor(const std::string& attribute) const {
    const std::size_t index = reader_.number(*attributes_, attribute.c_str(), pointer_ + "/attributes", no_number);
    return index == no_number ? std::nullopt : std::optional(index);
}

glb::Reader::Shape GltfPrimitive::shape(const std::string& attribute) const {
    return reader_.shape(*accessor(attribute), fmt::format("{}/attributes/{}", pointer_, attribute));
}

std::optional<std::size_t> GltfPrimitive::draco_id(const std::string& attribute) const {
    if (draco_attributes_ == nullptr) return std::nullopt;
    const std::string place = fmt::format("{}/extensions/{}/attributes", pointer_, draco_extension);
    const std::size_t id = reader_.number(*draco_attributes_, attribute.c_str(), place, no_number);
    return id == no_number ? std::nullopt : std::optional(id);
}

glb::Reader::Values GltfPrimitive::values(const std::string& attribute, std::size_t width, std::size_t count) const {
    const std::string place = fmt::format("{}/attributes/{}", pointer_, attribute);
    glb::Reader::Values values;
    if (const auto id = draco_id(attribute); id) {
        glb::Reader::Shape expected = shape(attribute);
        if (expected.width != width) reader_.fail(place, "is not of the expected type");
        values = draco_->values(*id, expected, place);
    } else {
        values = reader_.accessor(*accessor(attribute), width, place);
    }
    if (values->size() != width * count) reader_.fail(place, "has a different count from the positions");
    return values;
}

std::optional<glb::Reader::Floats> GltfPrimitive::floats(const std::string& attribute, std::size_t width,
                                                         std::size_t count) const {
    if (draco_id(attribute)) return std::nullopt;
    const std::string place = fmt::format("{}/attributes/{}", pointer_, attribute);
    const auto list = reader_.floats(*accessor(attribute), width, place);
    if (list && list->count != count) reader_.fail(place, "has a different count from the positions");
    return list;
}

std::size_t GltfPrimitive::vertices() const { return draco_ != nullptr ? draco_->vertices() : shape("POSITION").count; }

std::size_t GltfPrimitive::corners() const {
    if (draco_ != nullptr) return draco_->indices().size();
    const std::size_t index = reader_.number(primitive_, "indices", pointer_, no_number);
    return index == no_number ? vertices() : reader_.shape(index, pointer_ + "/indices").count;
}

std::vector<std::uint32_t> GltfPrimitive::triangles() const {
    std::vector<std::uint32_t> list;
    const std::size_t count = vertices(), index = reader_.number(primitive_, "indices", pointer_, no_number);
    if (draco_ != nullptr) {
        reader_.charge(4.0 * static_cast<double>(draco_->indices().size()), pointer_);
        return draco_->indices();  // always triangles, whatever the mode
    }
    if (index != no_number) {
        list = reader_.integers(index, pointer_ + "/indices");
    } else {
        reader_.charge(4.0 * static_cast<double>(count), pointer_);
        list.resize(count);
        for (std::size_t i = 0; i < count; ++i) list[i] = static_cast<std::uint32_t>(i);
    }
    std::uint32_t largest = 0;
    for (const std::uint32_t v : list) largest = std::max(largest, v);
    for (std::size_t i = 0; i < list.size() && largest >= count; ++i)
        if (list[i] >= count)
            reader_.fail(pointer_ + "/indices",
                         fmt::format("index {} (number {}) is out of range: there are {} vertices", list[i], i, count));
    if (mode_ != glb::triangles_mode) {
        reader_.charge(12.0 * static_cast<double>(list.size()), pointer_);
        return unrolled(list, mode_ == glb::fan_mode);
    }
    list.resize(list.size() / 3 * 3);
    return list;
}

std::array<std::size_t, 3> GltfPrimitive::key() const {
    return {draco_ != nullptr ? draco_view_ : no_number, accessor("POSITION").value_or(no_number),
            accessor("COLOR_0").value_or(no_number)};
}

}  // namespace ostraka::io

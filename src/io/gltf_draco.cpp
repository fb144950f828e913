#include "io/gltf_draco.h"

#include <draco/compression/config/decoder_options.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/decoder_buffer.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <type_traits>

namespace ostraka::io {

namespace {

/// What the beginning of a Draco bitstream states (Draco bitstream specification 2.2, sections 4 to 8).
struct DracoStart {
    bool edgebreaker = false;
    std::uint32_t faces = 0, vertices = 0;
    std::uint8_t attribute_tables = 0;  ///< edgebreaker: connectivities of attributes with seams
};

DracoStart read_start(const glb::Reader& reader, std::string_view bytes, const std::string& pointer) {
    if (bytes.size() < 11 || bytes.substr(0, 5) != "DRACO") reader.fail(pointer, "the data are not compressed with Draco");
    const auto byte_at = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(bytes[i])); };
    if (byte_at(5) != 2 || byte_at(6) != 2)
        reader.fail(pointer, fmt::format("has version {}.{} of Draco; glTF uses version 2.2", byte_at(5), byte_at(6)));
    if (byte_at(7) != 1) reader.fail(pointer, "is a Draco point cloud, not a mesh");
    if (byte_at(8) > 1) reader.fail(pointer, "has an unknown method of Draco");
    if ((byte_at(10) & 0x80U) != 0) reader.fail(pointer, "has Draco metadata, which glTF does not use");
    DracoStart start;
    start.edgebreaker = byte_at(8) == 1;
    draco::DecoderBuffer buffer;
    const std::size_t head = start.edgebreaker ? 12 : 11;  // edgebreaker: one byte for the kind of traversal
    buffer.Init(bytes.data(), bytes.size(), DRACO_BITSTREAM_VERSION(2, 2));
    buffer.Advance(static_cast<std::int64_t>(head));
    std::uint32_t first = 0, second = 0;
    if (bytes.size() <= head || !draco::DecodeVarint(&first, &buffer) || !draco::DecodeVarint(&second, &buffer))
        reader.fail(pointer, "the Draco data are truncated");
    start.faces = start.edgebreaker ? second : first;
    start.vertices = start.edgebreaker ? first : second;
    if (start.edgebreaker && !buffer.Decode(&start.attribute_tables)) reader.fail(pointer, "the Draco data are truncated");
    return start;
}

/// Accounts for the memory of the attributes before they are decoded.
template <class Decoder>
class BoundedDecoder : public Decoder {
public:
    BoundedDecoder(const glb::Reader& reader, const std::string& pointer) : reader_(reader), pointer_(pointer) {}

    /// Throws what was thrown while decoding: no exception passes through the library.
    void rethrow() const {
        if (failure_) std::rethrow_exception(failure_);
    }

protected:
    bool DecodeAllAttributes() override {
        try {
            charge_attributes();
        } catch (...) {
            failure_ = std::current_exception();
            return false;
        }
        return Decoder::DecodeAllAttributes();
    }

private:
    void charge_attributes() {
        const draco::PointCloud& cloud = *this->point_cloud();
        double bytes_per_point = 0;
        for (std::int32_t i = 0; i < cloud.num_attributes(); ++i) {
            const draco::PointAttribute& attribute = *cloud.attribute(i);
            // The values as they are, as integers, their entropy code and the map from points to values.
            bytes_per_point += static_cast<double>(attribute.byte_stride()) + 12.0 * attribute.num_components() + 4;
        }
        reader_.charge(bytes_per_point * static_cast<double>(cloud.num_points()), pointer_);
    }

    const glb::Reader& reader_;
    const std::string& pointer_;
    std::exception_ptr failure_;
};

template <class Decoder>
draco::Status decode_with(const glb::Reader& reader, draco::DecoderBuffer& buffer, draco::Mesh& mesh,
                          const std::string& pointer) {
    BoundedDecoder<Decoder> decoder(reader, pointer);
    draco::Status status = decoder.Decode(draco::DecoderOptions(), &buffer, &mesh);
    decoder.rethrow();
    return status;
}

/// Reads one value of an attribute as numbers.
template <class Component>
void read_components(const draco::PointAttribute& attribute, draco::AttributeValueIndex value, std::size_t width, bool normalised,
                     double* numbers) {
    Component component{};
    for (std::size_t k = 0; k < width; ++k) {
        std::memcpy(&component, attribute.GetAddress(value) + k * sizeof component, sizeof component);
        numbers[k] = static_cast<double>(component);
        if constexpr (std::is_integral_v<Component>)
            if (normalised) numbers[k] = std::max(numbers[k] / static_cast<double>(std::numeric_limits<Component>::max()), -1.0);
    }
}

using ReadComponents = void (*)(const draco::PointAttribute&, draco::AttributeValueIndex, std::size_t, bool, double*);
ReadComponents reader_of(draco::DataType type) {
    switch (type) {
        case draco::DT_INT8:
            return read_components<std::int8_t>;
        case draco::DT_UINT8:
            return read_components<std::uint8_t>;
        case draco::DT_INT16:
            return read_components<std::int16_t>;
        case draco::DT_UINT16:
            return read_components<std::uint16_t>;
        case draco::DT_INT32:
            return read_components<std::int32_t>;
        case draco::DT_UINT32:
            return read_components<std::uint32_t>;
        case draco::DT_FLOAT32:
            return read_components<float>;
        case draco::DT_FLOAT64:
            return read_components<double>;
        default:
            return nullptr;
    }
}

}  // namespace

struct DracoPrimitive::Decoded {
    draco::Mesh mesh;
};

DracoPrimitive::DracoPrimitive(const glb::Reader& reader, std::string_view bytes, const std::string& pointer)
    : reader_(reader), decoded_(std::make_unique<Decoded>()) {
    const DracoStart start = read_start(reader, bytes, pointer);
    // The corner table of edgebreaker (and one for each attribute with seams), or lists of indices; then the faces.
    const double bytes_per_face = start.edgebreaker ? 72 + 32.0 * start.attribute_tables : 40;
    reader.charge(bytes_per_face * start.faces + 16.0 * start.vertices, pointer);
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Mesh& mesh = decoded_->mesh;
    const draco::Status status = start.edgebreaker ? decode_with<draco::MeshEdgebreakerDecoder>(reader, buffer, mesh, pointer)
                                                   : decode_with<draco::MeshSequentialDecoder>(reader, buffer, mesh, pointer);
    if (!status.ok()) reader.fail(pointer, "the Draco data are damaged");
    indices_.reserve(3 * static_cast<std::size_t>(mesh.num_faces()));
    for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
        for (const draco::PointIndex& point : mesh.face(f)) {
            if (point.value() >= mesh.num_points()) reader.fail(pointer, "the Draco data have an index out of range");
            indices_.push_back(point.value());
        }
}

DracoPrimitive::~DracoPrimitive() = default;

std::size_t DracoPrimitive::vertices() const { return decoded_->mesh.num_points(); }

glb::Reader::Values DracoPrimitive::values(std::size_t unique_id, const glb::Reader::Shape& shape,
                                           const std::string& pointer) const {
    glb::Reader::Values& known = read_[{unique_id, shape.width}];
    if (known) return known;
    const draco::PointAttribute* attribute =
        decoded_->mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(std::min<std::size_t>(unique_id, 0xFFFFFFFFU)));
    if (attribute == nullptr) reader_.fail(pointer, "the Draco data have no attribute of this id");
    const ReadComponents read = reader_of(attribute->data_type());
    if (read == nullptr || static_cast<std::size_t>(attribute->num_components()) != shape.width)
        reader_.fail(pointer, "the attribute in the Draco data is of another type");
    reader_.charge(8.0 * static_cast<double>(vertices() * shape.width), pointer);
    std::vector<double> numbers(vertices() * shape.width);
    for (draco::PointIndex point(0); point < decoded_->mesh.num_points(); ++point) {
        const draco::AttributeValueIndex value = attribute->mapped_index(point);
        if (value.value() >= attribute->size()) reader_.fail(pointer, "the Draco data have a value out of range");
        read(*attribute, value, shape.width, shape.normalised, numbers.data() + point.value() * shape.width);
    }
    return known = std::make_shared<const std::vector<double>>(std::move(numbers));
}

}  // namespace ostraka::io

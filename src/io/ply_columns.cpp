#include "ostraka/io/ply_columns.h"

#include "io/ply_rows.h"
#include "ostraka/core/progress.h"

#include <fmt/core.h>

namespace ostraka {

namespace io {

namespace {

template <class Rows>
class PlyVertexReader {
public:
    PlyVertexReader(Rows rows, const PlyHeader& header) : rows_(std::move(rows)), header_(header) {}

    PlyVertexProperties read() {
        for (const PlyElement& element : header_.elements) {
            const std::size_t minimum = element.min_bytes(header_.format);
            if (minimum > 0 && element.count > rows_.remaining() / minimum)
                rows_.fail(fmt::format("the header promises {} elements '{}' of at least {} bytes, but only {} bytes follow",
                                       element.count, element.name, minimum, rows_.remaining()),
                           "the file is cut off or its header is wrong");
            const bool is_vertex = element.name == "vertex";
            if (!element.properties.empty()) rows_of(element, is_vertex);
            if (!is_vertex && element.count > 0) result_.notes.push_back("element not kept: " + element.name);
        }
        return std::move(result_);
    }

private:
    void rows_of(const PlyElement& element, bool keep) {
        if (keep) {
            result_.vertices = element.count;
            for (const PlyProperty& property : element.properties) {
                if (property.is_list) continue;
                result_.columns.push_back({property.name, is_real(property.type), size_of(property.type), {}});
                result_.columns.back().values.reserve(element.count);
            }
        }
        CancelCheck check;
        for (std::size_t row = 0; row < element.count; ++row) {
            check();
            rows_.begin(element, row);
            std::size_t column = 0;
            for (const PlyProperty& property : element.properties) {
                if (property.is_list) skip_list(property);
                else if (keep) result_.columns[column++].values.push_back(rows_.value(property.type));
                else rows_.skip(property.type, 1);
            }
            rows_.end(element, row);
        }
    }

    void skip_list(const PlyProperty& property) {
        const double length = rows_.value(property.count_type);
        if (!(length >= 0) || Rows::minimum(property.type, 1) * length > static_cast<double>(rows_.remaining()))
            rows_.fail(fmt::format("a list '{}' claims {} entries", property.name, static_cast<std::int64_t>(length)),
                       "the file is cut off or damaged");
        rows_.skip(property.type, static_cast<std::size_t>(length));
    }

    Rows rows_;
    const PlyHeader& header_;
    PlyVertexProperties result_;
};

}  // namespace

}  // namespace io

PlyVertexProperties read_ply_vertex_properties(const std::string& bytes, const std::string& file) {
    const io::PlyHeader header = io::read_ply_header(bytes, file);
    for (const char* faces : {"face", "tristrips"})
        if (const io::PlyElement* element = header.find(faces); element != nullptr && element->count > 0) {
            PlyVertexProperties result;
            result.has_faces = true;
            return result;
        }
    const auto read = [&](auto rows) { return io::PlyVertexReader(std::move(rows), header).read(); };
    constexpr bool little = std::endian::native == std::endian::little;
    if (header.format == io::PlyFormat::ascii) return read(io::AsciiRows(bytes, header.size, file));
    if ((header.format == io::PlyFormat::little_endian) == little) return read(io::BinaryRows<false>(bytes, header.size, file));
    return read(io::BinaryRows<true>(bytes, header.size, file));
}

}  // namespace ostraka

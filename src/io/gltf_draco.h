// Primitives of glTF that are compressed with Draco (KHR_draco_mesh_compression).
#pragma once

#include "ostraka/io/glb.h"

#include <map>
#include <memory>

namespace ostraka::io {

/// A decoded Draco mesh.
class DracoPrimitive {
public:
    /// Decodes the bytes of a buffer view. Throws Error (input), naming the JSON pointer, for damaged data, and before memory is
    /// allocated for data that would expand too strongly.
    DracoPrimitive(const glb::Reader& reader, std::string_view bytes, const std::string& pointer);
    ~DracoPrimitive();
    DracoPrimitive(const DracoPrimitive&) = delete;
    DracoPrimitive& operator=(const DracoPrimitive&) = delete;

    [[nodiscard]] std::size_t vertices() const;                                           ///< number of vertices
    [[nodiscard]] const std::vector<std::uint32_t>& indices() const { return indices_; }  ///< three vertices per triangle
    /// Values of the attribute with this unique id: as many numbers per vertex as `shape` has; normalised as `shape` says.
    [[nodiscard]] glb::Reader::Values values(std::size_t unique_id, const glb::Reader::Shape& shape,
                                             const std::string& pointer) const;

private:
    struct Decoded;
    const glb::Reader& reader_;
    std::unique_ptr<Decoded> decoded_;
    std::vector<std::uint32_t> indices_;
    mutable std::map<std::pair<std::size_t, std::size_t>, glb::Reader::Values> read_;
};

}  // namespace ostraka::io

// The data of one primitive of a glTF mesh, compressed with Draco or not.
#pragma once

#include "io/gltf_draco.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ostraka::io {

/// Decoded Draco data by the index of their buffer view: several primitives and nodes may share them.
using DracoCache = std::map<std::size_t, std::unique_ptr<DracoPrimitive>>;

/// A primitive whose attributes are looked up by name.
class GltfPrimitive {
public:
    GltfPrimitive(const glb::Reader& reader, const JsonValue& primitive, std::string pointer, DracoCache& draco);

    [[nodiscard]] int mode() const { return mode_; }                       ///< glTF mode, 0 to 6
    [[nodiscard]] const std::string& pointer() const { return pointer_; }  ///< JSON pointer of the primitive
    [[nodiscard]] const JsonValue& attributes() const { return *attributes_; }
    /// Index of the accessor of an attribute; nullopt: the primitive does not have it.
    [[nodiscard]] std::optional<std::size_t> accessor(const std::string& attribute) const;
    /// Shape of the accessor of an attribute that the primitive has.
    [[nodiscard]] glb::Reader::Shape shape(const std::string& attribute) const;
    /// Numbers of an attribute that the primitive has. Throws Error (input) unless there are `count` elements of `width`.
    [[nodiscard]] glb::Reader::Values values(const std::string& attribute, std::size_t width, std::size_t count) const;
    /// The numbers of an attribute where they lie in the file (Reader::floats); nothing if they must be converted or decoded.
    [[nodiscard]] std::optional<glb::Reader::Floats> floats(const std::string& attribute, std::size_t width,
                                                            std::size_t count) const;
    [[nodiscard]] std::size_t vertices() const;  ///< number of positions
    [[nodiscard]] std::size_t corners() const;   ///< number of indices, or of vertices without indices
    /// The vertices of three corners per triangle, from triangles, strips or fans; corners that complete no triangle are left
    /// out. Throws Error (input) for an index out of range.
    [[nodiscard]] std::vector<std::uint32_t> triangles() const;
    /// Distinguishes vertices: primitives with equal keys have the same positions and colours.
    [[nodiscard]] std::array<std::size_t, 3> key() const;

private:
    [[nodiscard]] std::optional<std::size_t> draco_id(const std::string& attribute) const;

    const glb::Reader& reader_;
    const JsonValue& primitive_;
    std::string pointer_;
    int mode_ = glb::triangles_mode;
    const JsonValue* attributes_ = nullptr;
    const JsonValue* draco_attributes_ = nullptr;
    const DracoPrimitive* draco_ = nullptr;
    std::size_t draco_view_ = 0;
};

}  // namespace ostraka::io

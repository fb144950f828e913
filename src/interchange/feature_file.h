// Features in a GLB file: the elements that each feature selects, and the rows of the property table.
#pragma once

#include "ostraka/io/glb.h"

#include <array>
#include <map>
#include <optional>

namespace ostraka::interchange {

inline constexpr std::size_t absent = static_cast<std::size_t>(-1);  ///< index of nothing

/// The elements of primitives that one feature selects.
struct Feature {
    /// Indices of triangles, counted over all primitives; none: the feature selects no triangles.
    std::optional<std::vector<std::uint32_t>> faces;
    /// For each poly-line: indices of corners of the line primitive.
    std::vector<std::vector<std::size_t>> polylines;
    std::vector<std::size_t> points;  ///< indices of corners of the point primitive
    /// Index of the primitive with the feature's lines; with its points.
    std::size_t line_primitive = absent, point_primitive = absent;
};

/// A primitive (triangles, lines or points) of the mesh. Primitives that refer to the same accessors share the values.
struct Primitive {
    glb::Reader::Values positions;              ///< coordinates, three per vertex
    glb::Reader::Values origins;                ///< attribute _VERTEX: index of each vertex in the original mesh; null if absent
    glb::Reader::Values indices;                ///< index of the vertex of each corner; null: corner i is vertex i ...
    std::vector<glb::Reader::Values> features;  ///< for each feature id set: feature id of each vertex
    std::vector<std::size_t> nulls;             ///< for each feature id set: the id that means "no feature"
    int mode = glb::triangles_mode;             ///< glTF mode: triangles, lines or points

    [[nodiscard]] std::size_t vertices() const { return positions->size() / 3; }  ///< number of vertices
    /// Number of corners.
    [[nodiscard]] std::size_t corners() const { return indices ? indices->size() : vertices(); }
    /// Index of the vertex at a corner.
    [[nodiscard]] std::size_t corner(std::size_t c) const { return indices ? static_cast<std::size_t>((*indices)[c]) : c; }
    [[nodiscard]] std::array<double, 3> position(std::size_t vertex) const {
        return {(*positions)[3 * vertex], (*positions)[3 * vertex + 1], (*positions)[3 * vertex + 2]};
    }
};

/// A parsed and checked GLB file with features, not yet placed on a mesh. The constructor throws Error (input) with file and JSON
/// pointer.
class FeatureFile {
public:
    FeatureFile(const std::string& bytes, const std::string& where);

    glb::Reader file;
    std::vector<Primitive> primitives;        ///< triangles, lines and points of the mesh
    std::map<std::size_t, Feature> features;  ///< row of the property table -> elements of the feature
    std::size_t rows = 0;                     ///< number of rows of the property table
    /// True: the table was written by this toolkit, and ids, kinds, colours, notes and attributes are available.
    bool ours = false;
    std::vector<std::string> tags, remarks, attributes;  ///< per row: tag, note, and attributes as JSON
    std::vector<int> ids, kinds, colours;                ///< per row: id, kind, and three colour channels
    std::vector<std::string> notes;                      ///< messages about content of the file that was not read

    /// The toolkit's data in the extras of the glTF mesh; null if there are none.
    [[nodiscard]] const JsonValue* extras() const;
    [[nodiscard]] std::size_t triangles() const;  ///< number of triangles of all primitives

private:
    void refuse_unsupported() const;
    void read_primitives();
    void read_primitive(const JsonValue& object, const std::string& pointer);
    void read_ids(const JsonValue& set, const JsonValue& attributes, Primitive& primitive, const std::string& pointer);
    [[nodiscard]] const JsonValue* metadata(const char* member) const;
    void read_table();
    template <class T>
    std::vector<int> numbers(const JsonValue& properties, const char* name, std::size_t width, const std::string& pointer) const;
    [[nodiscard]] std::vector<std::string> texts(const JsonValue& properties, const char* name, const std::string& pointer) const;
    void collect(const Primitive& primitive, std::size_t number);

    std::size_t table_ = absent, offset_ = 0;
};

}  // namespace ostraka::interchange

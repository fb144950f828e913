// Features in a GLB file: the elements of its primitives that they select, and the rows of their table.
#pragma once

#include "ostraka/io/glb.h"

#include <array>
#include <map>
#include <optional>

namespace ostraka::interchange {

inline constexpr std::size_t absent = static_cast<std::size_t>(-1);

/// The elements that one feature selects.
struct Feature {
    std::optional<std::vector<std::uint32_t>> faces;  ///< triangles, counted over all primitives
    std::vector<std::vector<std::size_t>> polylines;  ///< corners of the line primitive
    std::vector<std::size_t> points;                  ///< corners of the point primitive
    std::size_t line_primitive = absent, point_primitive = absent;
};

/// Primitives that refer to the same accessors share their values.
struct Primitive {
    glb::Reader::Values positions;              ///< three per vertex
    glb::Reader::Values origins;                ///< _VERTEX, or null
    glb::Reader::Values indices;                ///< null: 0, 1, 2 ...
    std::vector<glb::Reader::Values> features;  ///< per feature id set, one value per vertex
    std::vector<std::size_t> nulls;
    int mode = glb::triangles_mode;

    [[nodiscard]] std::size_t vertices() const { return positions->size() / 3; }
    [[nodiscard]] std::size_t corners() const { return indices ? indices->size() : vertices(); }
    [[nodiscard]] std::size_t corner(std::size_t c) const { return indices ? static_cast<std::size_t>((*indices)[c]) : c; }
    [[nodiscard]] std::array<double, 3> position(std::size_t vertex) const {
        return {(*positions)[3 * vertex], (*positions)[3 * vertex + 1], (*positions)[3 * vertex + 2]};
    }
};

/// A parsed and checked file, independent of the mesh. The constructor throws Error (input) with file and JSON pointer.
class FeatureFile {
public:
    FeatureFile(const std::string& bytes, const std::string& where);

    glb::Reader file;
    std::vector<Primitive> primitives;
    std::map<std::size_t, Feature> features;  ///< by row of the table
    std::size_t rows = 0;
    bool ours = false;  ///< the table has our class: ids, kinds, colours, notes and attributes are available
    std::vector<std::string> tags, remarks, attributes;
    std::vector<int> ids, kinds, colours;
    std::vector<std::string> notes;  ///< messages about content that was not read

    /// Our data in the extras of the mesh, or nullptr.
    [[nodiscard]] const JsonValue* extras() const;
    [[nodiscard]] std::size_t triangles() const;

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

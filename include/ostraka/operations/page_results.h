// Converts results of other operations into the contents of a page: slices, constraints, tables of reports, maps of PLY files.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/files/json_build.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/page/page.h"

#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace ostraka {

/// Reads the document of a slices file (slices.schema.json); `where` names the file in errors. Throws Error (input).
PageSlices page_slices(const JsonValue& document, const std::string& where);

/// Verdicts on an object, read from `result`, the report of 'relation check'. Violated rules come first, then relationships in
/// the order of the graph. `set`: annotations of the object.
std::vector<PageVerdict> page_conformance(const JsonValue& result, const AnnotationSet& set);

/// Constraints, read from `result`, the report of a deformation; the report refers to annotations by tags, which are looked up
/// in `set`.
std::vector<PageConstraint> page_constraints(const JsonValue& result, const AnnotationSet& set);
/// Messages on conflicting constraints from the report of a deformation.
std::vector<std::string> page_conflicts(const JsonValue& result);

/// Tables made from the result of a report, or from a file of the same structure: one table for each list of records, and one
/// table for all single values. Lists of numbers and deeper structures are omitted. `title`: prefix of the tables' titles;
/// `omitted`: members of `result` to omit.
std::vector<PageTable> record_tables(const JsonValue& result, const std::string& title,
                                     const std::set<std::string>& omitted = {});

/// True if the file name has the extension of a mesh file.
bool is_mesh_name(const std::string& name);

/// Links rows of tables to objects and annotations of the page, by names and tags in the cells.
class PageNames {
public:
    /// Adds the next object of the page. `set`: annotations of the object to which rows may be linked; null: none.
    void add(const std::string& object, const AnnotationSet* set);
    /// Links each row of a table to an object. The object is the first one whose name or file name is a text in the row.
    /// Without such a text, it is the object that has an annotation whose tag is a text in the row, if no other object has an
    /// annotation with this tag.
    void link(PageTable& table) const;

private:
    [[nodiscard]] int object(const std::string& text) const;  ///< index of the object with this name or file name; -1: none

    int count_ = 0;                                 ///< number of objects added
    std::unordered_map<std::string, int> objects_;  ///< from the name of an object to its index in the page
    /// From a tag to the indices of its object and annotation.
    std::unordered_map<std::string, std::pair<int, int>> annotations_;
};

/// Table cell that holds a text or a number.
Json cell_of(const auto& value) {
    Json cell;
    static_cast<JsonValue&>(cell) = json_value(value, cell.GetAllocator());
    return cell;
}

/// Reads a CSV file whose first row holds the column titles; `name` is used for the table's title and in errors. Throws Error
/// (input).
PageTable csv_table(const Path& file, const std::string& name);

/// Scalar maps of an object, made from the values of its vertices and faces (MeshExtras::vertex_values, face_values); for a
/// completed object also the map of observed, interpolated and hypothetical surface.
std::vector<PageMap> value_maps(const MeshFile& mesh);
/// Transfers a map to a simplified mesh. `new_index`: for each vertex of the original mesh, its index in the simplified mesh
/// (`no_index` if removed); `vertices`: number of vertices of the simplified mesh.
PageMap simplified_map(const PageMap& map, const std::vector<Index>& new_index, std::size_t vertices);
/// True if one of the maps classifies the surface of a completed object as observed, interpolated or hypothetical.
bool is_completed(const std::vector<PageMap>& maps);

/// Vertex values from face values: for each vertex, the mean of the finite values of its adjacent faces; NaN if there are none.
std::vector<double> vertex_means(const Mesh& mesh, const std::vector<double>& face_values);

/// True if no two regions of the set share a vertex; such regions can be moved apart in the viewer.
bool are_apart(AnnotatedMeshView object);

}  // namespace ostraka

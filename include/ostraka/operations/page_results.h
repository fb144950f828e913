// Converts results of other operations for a page: slices, constraints, tables of reports, maps of PLY files.
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

/// Reads the document of a slices file (slices.schema.json). Throws Error (input).
PageSlices page_slices(const JsonValue& document, const std::string& where);

/// Verdicts on an object from the report of 'relation check': violated rules first, then relationships in the order of the
/// graph.
std::vector<PageVerdict> page_conformance(const JsonValue& result, const AnnotationSet& set);

/// Constraints and conflicts from the report of a deformation; their parts are named by the tags in the object's annotations.
std::vector<PageConstraint> page_constraints(const JsonValue& result, const AnnotationSet& set);
std::vector<std::string> page_conflicts(const JsonValue& result);

/// Tables from a report's result, or from a file of the same form: one per list of records, and one for the single values.
/// Lists of numbers and deeper structures are omitted. `title`: prefix of the titles; `omitted`: members to omit.
std::vector<PageTable> record_tables(const JsonValue& result, const std::string& title,
                                     const std::set<std::string>& omitted = {});

/// Whether the name is that of a mesh file.
bool is_mesh_name(const std::string& name);

/// Links rows of tables to objects and annotations of the page.
class PageNames {
public:
    /// Adds the next object of the page, with its annotations if rows may refer to them.
    void add(const std::string& object, const AnnotationSet* set);
    /// Links each row to the object whose name or file name is the first found among the row's texts; if there is none, to the
    /// object whose annotation a text names, provided that its tag is unique.
    void link(PageTable& table) const;

private:
    [[nodiscard]] int object(const std::string& text) const;

    int count_ = 0;
    std::unordered_map<std::string, int> objects_;
    std::unordered_map<std::string, std::pair<int, int>> annotations_;
};

/// A text or a number as a cell of a table.
Json cell_of(const auto& value) {
    Json cell;
    static_cast<JsonValue&>(cell) = json_value(value, cell.GetAllocator());
    return cell;
}

/// Reads a CSV file whose first row holds the column titles. Throws Error (input).
PageTable csv_table(const Path& file, const std::string& name);

/// Maps of the vertices from the additional numeric properties of a PLY file; for a completed object also the map of observed,
/// interpolated and hypothetical surface.
std::vector<PageMap> ply_maps(const Path& file, const MeshFile& mesh);
/// The map on a simplified mesh; `new_index`: of each vertex, `no_index` if removed.
PageMap simplified_map(const PageMap& map, const std::vector<Index>& new_index, std::size_t vertices);
/// Whether the face labels state the origin of the surface of a completed object, instead of parts.
bool is_completed(const std::vector<PageMap>& maps);

/// One number per vertex from one per face: the mean of the finite values of its faces, NaN if there are none.
std::vector<double> vertex_means(const Mesh& mesh, const std::vector<double>& face_values);

/// Whether no vertex belongs to faces of two of these regions, so that the regions can be moved apart.
bool are_apart(AnnotatedMeshView object);

}  // namespace ostraka

// What results of other operations give a page: slices, constraints, tables of reports, maps of PLY files.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/json_build.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/page/page.h"

#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace ostraka {

/// Of a slices file (slices.schema.json). Throws Error (input).
PageSlices page_slices(const JsonValue& document, const std::string& where);

/// What 'relation check' says of an object, from its report: broken rules first, then relationships in the order of the graph.
std::vector<PageVerdict> page_conformance(const JsonValue& result, const AnnotationSet& set);

/// The constraints and conflicts in the report of a deformation, by the tags of their parts in the object's annotations.
std::vector<PageConstraint> page_constraints(const JsonValue& result, const AnnotationSet& set);
std::vector<std::string> page_conflicts(const JsonValue& result);

/// Lists of records become tables, single values one more: of a report's result, or of a file that has its form. Lists of
/// numbers and what is nested deeper are left out. `title`: before the names of the lists; `but`: members that are left out.
std::vector<PageTable> record_tables(const JsonValue& result, const std::string& title, const std::set<std::string>& but = {});

/// Whether the name is that of a mesh file.
bool is_mesh_name(const std::string& name);

/// Where rows of tables find what they are of.
class PageNames {
public:
    /// The next object of the page, and its annotations, if rows may name them.
    void add(const std::string& object, const AnnotationSet* set);
    /// Rows show the object that the first of their texts to name one names, by its name or that of its file; else the annotation
    /// that only one object has.
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

/// The rows under its first row. Throws Error (input).
PageTable csv_table(const Path& file, const std::string& name);

/// The real properties that a PLY file has beside a mesh, as maps of its vertices, and of a completed object what is observed,
/// interpolated and hypothesis.
std::vector<PageMap> ply_maps(const Path& file, const MeshFile& mesh);
/// The map on a simplified mesh; `to`: what became of each vertex, `no_index` where nothing.
PageMap simplified_map(const PageMap& map, const std::vector<Index>& to, std::size_t vertices);
/// Whether the labels of its faces say that, and are no parts.
bool is_completed(const std::vector<PageMap>& maps);

/// A number for each vertex from one for each face: the mean of its faces' finite ones, NaN without any.
std::vector<double> vertex_means(const Mesh& mesh, const std::vector<double>& of_faces);

/// Whether no vertex has faces of two of these regions, so that they can be moved apart.
bool are_apart(const Mesh& mesh, const AnnotationSet& regions);

}  // namespace ostraka

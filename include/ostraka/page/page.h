// A self-contained HTML page that shows objects in 3D with their annotations and measures, with tables and drawings.
#pragma once

#include "ostraka/io/mesh_file.h"
#include "ostraka/io/textured_vertices.h"
#include "ostraka/relation/check.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// A scalar map: one number for each vertex of an object; a number that is not finite means no value.
struct PageMap {
    std::string name;            ///< name of the map
    std::string label;           ///< name of the quantity, with its unit
    std::vector<double> values;  ///< value of each vertex
    struct Category {
        std::string text;             ///< name of the category
        std::array<int, 3> colour{};  ///< red, green, blue, 0 to 255
    };
    std::vector<Category> categories = {};  ///< if not empty, the values of the map are indices into this list
};

/// Slices of an object, by ascending height.
struct PageSlices {
    /// A descriptor of the slices: a column of the table beside the drawing.
    struct Column {
        std::string name, title, unit;  ///< name of the descriptor, column title, and unit
    };
    /// A closed or open contour of a slice.
    struct Contour {
        bool closed = true, hole = false;           ///< hole: the contour bounds a hole of the cross-section
        std::vector<std::array<double, 2>> points;  ///< coordinates along the axes `u` and `v` of the slice
    };
    /// One slice: its plane and contours.
    struct Level {
        double height = 0;                          ///< height of the slicing plane
        std::array<double, 3> origin{}, u{}, v{};   ///< point of the slicing plane, and unit vectors of its axes
        std::vector<std::optional<double>> values;  ///< descriptor values, one per column; empty: no value
        std::vector<Contour> contours;              ///< contours in the plane, outer contours and holes
    };
    std::string unit;  ///< unit of lengths
    std::vector<Column> columns;
    std::vector<Level> levels;
    /// Lowest and highest height between which the object is tubular; empty: not tubular.
    std::optional<std::array<double, 2>> tube;
};

/// State of a constraint before and after a deformation.
struct PageConstraint {
    struct Deviation {
        std::string quantity;  ///< name of the quantity
        /// Value before and after the deformation, and max value that satisfies the constraint; empty: unknown.
        std::optional<double> before, value, tolerance;
        std::string unit;
    };
    std::string type;                   ///< type of the constraint
    std::vector<std::size_t> members;   ///< indices of the constrained annotations in the annotation set
    double weight = 1;                  ///< weight of a soft constraint
    bool hard = false;                  ///< true: the constraint is satisfied exactly, not by weight
    std::string before, verdict;        ///< state before, and verdict after the deformation, as text
    std::optional<bool> holds;          ///< whether the constraint is satisfied after the deformation; empty: undetermined
    std::string text;                   ///< explanation
    std::vector<Deviation> deviations;  ///< deviations of the constraint's quantities
    std::optional<std::array<double, 2>> residual;  ///< mean and maximum residual after the deformation
};

/// Result of 'relation check' for one rule, relation, constraint or canon (a constraint that prescribes a proportion).
struct PageVerdict {
    std::string kind;                  ///< "rule", "relation", "constraint" or "canon"
    std::string name;                  ///< name of the rule, or type of the relation, constraint or canon
    std::vector<std::size_t> members;  ///< indices of the annotations concerned in the annotation set
    std::optional<bool> holds;         ///< whether the rule or relation holds; empty: undetermined
    std::string text;                  ///< measured value and allowed range, or how the rule is violated
};

/// Contents of one object of a page. The mesh and all other data that this struct refers to must live until the object is added.
struct PageObject {
    std::string name;                            ///< name of the object
    const Mesh* mesh = nullptr;                  ///< the shown mesh
    const AnnotationSet* annotations = nullptr;  ///< null: no annotations
    const RelationGraph* graph = nullptr;        ///< null: no relationships
    /// Checks of the graph's relationships, in the order of the graph; empty: not checked.
    std::vector<RelationCheck> checks = {};
    const Mesh* cage = nullptr;                    ///< null: no cage
    std::vector<PageMap> maps = {};                ///< scalar maps that can be shown
    const PageSlices* slices = nullptr;            ///< null: no slices
    std::vector<PageVerdict> conformance = {};     ///< results of 'relation check'; empty: not checked
    std::vector<PageConstraint> constraints = {};  ///< states of the constraints after a deformation
    std::vector<std::string> conflicts = {};       ///< messages on conflicting constraints
    /// Indices of the regions that can be moved apart in the viewer, since they share no vertex.
    std::vector<std::size_t> parts = {};
    const MeshExtras* extras = nullptr;  ///< colours and texture of the mesh; null: none
    /// Colours that the page initially shows: texture, own (colours of vertices or faces), annotations, values (the first map)
    /// or clay (one neutral colour). auto: annotations if there are any, otherwise the texture, otherwise the colours of
    /// vertices or faces.
    std::string colouring = "auto";
    std::string unit = {};                 ///< unit of the mesh; empty: unit of the annotations
    std::array<double, 3> up = {0, 0, 1};  ///< upward direction, used if the annotations state none
    /// Size of the original object, if it has more vertices than the shown mesh.
    struct Whole {
        std::size_t vertices = 0, faces = 0;  ///< numbers of vertices and faces of the original object
        double deviation = 0;                 ///< max distance of the original vertices from the shown mesh
    };
    /// Empty if the shown mesh is the original object.
    std::optional<Whole> whole = {};
    /// Request for exact geometry instead of packed (quantised) geometry: coordinates are stored in single precision relative
    /// to the bounding box, with a key that identifies the shape.
    struct Exact {
        std::string key;          ///< identifies the shape
        bool sends_shape = true;  ///< false: only the key is sent, since the viewer already has the shape
    };
    /// Empty: packed geometry.
    std::optional<Exact> exact = {};
};

/// A table whose cells are texts, numbers, or empty.
struct PageTable {
    struct Row {
        std::vector<Json> cells;  ///< one cell per column
        /// The object and annotation that the row describes: index of the object in the page, and index of the annotation in
        /// the object's set; -1: none.
        int object = -1, annotation = -1;
    };
    std::string title, note;           ///< note: text below the table
    std::vector<std::string> columns;  ///< titles of the columns
    std::vector<Row> rows;
};

/// An object of a collection whose data are stored in a file beside the page.
struct PageEntry {
    std::string name;             ///< name of the object
    std::string file, thumbnail;  ///< file names relative to the page: the output of `Page::script`, and a PNG
    std::size_t vertices = 0, faces = 0;
    std::vector<std::string> tags;  ///< tags of the object's annotations
};

/// Limits for the images of an object on a page: max length of a side in pixels, and max total number of bytes. Larger images
/// are reduced.
inline constexpr int page_image_side = 4096;
inline constexpr std::size_t page_image_bytes = 2'000'000;

class Page {
public:
    explicit Page(std::string title);

    /// Adds an object that the page loads on demand from a separate file, instead of an object embedded in the page.
    void add(const PageEntry& entry);

    /// Adds an object and returns its index in the page. Objects with the same triangles as an earlier object can be morphed
    /// into each other in the viewer. Positions are quantised to 1/131,070 of the largest side of the box, values of maps to
    /// 1/131,068 of their range, texture coordinates to 1/131,070 of their range; the order of vertices and triangles is kept.
    /// The images of an object are reduced to page_image_bytes in total, and a note of the page reports the reduction. Throws
    /// Error (input) for a mesh without triangles, a map, colours or texture coordinates of a different length, or a damaged
    /// image.
    std::size_t add(const PageObject& object);
    void add(PageTable table);  ///< Adds a table to the page.
    /// Adds a drawing; `svg` is the text of an SVG file.
    void add_drawing(const std::string& title, const std::string& svg);
    /// Adds a remark that the page shows.
    void note(const std::string& text);

    /// The text of the HTML file: the viewer, with the data embedded as JSON and deflated bytes. The same page gives the same
    /// bytes. The HTML file loads no other files, and texts of annotations are escaped. `provenance_text`: provenance, shown on
    /// the page.
    [[nodiscard]] std::string html(const std::string& provenance_text) const;
    /// The content of this page as a script that the page of a collection loads; `file`: name of the script, as in
    /// PageEntry::file.
    [[nodiscard]] std::string script(const std::string& file, const std::string& provenance_text) const;
    /// The content of a page for a viewer that is already open.
    struct Content {
        std::string data, bytes;  ///< the page's data as JSON, and the binary data that the JSON refers to
    };
    /// Content of this page without the viewer; `provenance_text`: provenance, shown on the page.
    [[nodiscard]] Content content(const std::string& provenance_text) const;

private:
    /// Adds own colours, materials and images to the data of an object; `exact`: the texture coordinates too, which are otherwise
    /// in the geometry.
    void add_look(JsonValue& entry, const MeshExtras& extras, const std::optional<io::TexturedVertices>& textured, bool exact,
                  const std::string& name);
    std::size_t add_bytes(std::string_view bytes);                             ///< returns the offset of the bytes in `bytes_`
    [[nodiscard]] std::string data(const std::string& provenance_text) const;  ///< JSON text of the page's data

    Json document_;  ///< data of the page, as it is written
    JsonValue objects_{rapidjson::kArrayType}, tables_{rapidjson::kArrayType}, drawings_{rapidjson::kArrayType},
        notes_{rapidjson::kArrayType}, places_{rapidjson::kArrayType}, entries_{rapidjson::kArrayType};
    std::string bytes_;  ///< binary data to which the JSON refers
    /// Checksum of each object's triangles, to detect objects that can be morphed into each other.
    std::vector<std::string> triangles_;
};

/// Table of the measures and sizes of the annotations of an object. `object`: index of the object in the page; `name`: its name.
PageTable annotation_table(AnnotatedMeshView annotated, int object, const std::string& name);

}  // namespace ostraka

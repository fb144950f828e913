// A self-contained HTML page that shows objects in 3D with their annotations and measures, with tables and drawings.
#pragma once

#include "ostraka/relation/check.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// A number for each vertex of an object; none if it is not finite.
struct PageMap {
    std::string name;
    std::string label;  ///< name of the quantity, with its unit
    std::vector<double> values;
    struct Category {
        std::string text;
        std::array<int, 3> colour{};  ///< red, green, blue, 0 to 255
    };
    std::vector<Category> categories = {};  ///< if not empty, the values are indices into this list
};

/// Slices of an object, by ascending height.
struct PageSlices {
    struct Column {
        std::string name, title, unit;
    };
    struct Contour {
        bool closed = true, hole = false;
        std::vector<std::array<double, 2>> points;  ///< coordinates along u and v
    };
    struct Level {
        double height = 0;
        std::array<double, 3> origin{}, u{}, v{};
        std::vector<std::optional<double>> values;  ///< one per column
        std::vector<Contour> contours;
    };
    std::string unit;
    std::vector<Column> columns;
    std::vector<Level> levels;
    std::optional<std::array<double, 2>> tube;  ///< height range in which the object is tubular
};

/// State of a constraint after a deformation.
struct PageConstraint {
    struct Deviation {
        std::string quantity;
        std::optional<double> before, value, tolerance;
        std::string unit;
    };
    std::string type;
    std::vector<std::size_t> members;  ///< indices into the annotation set
    double weight = 1;
    bool hard = false;
    std::string before, verdict;  ///< descriptions
    std::optional<bool> holds;    ///< none: undetermined
    std::string text;
    std::vector<Deviation> deviations;
    std::optional<std::array<double, 2>> residual;  ///< mean and maximum
};

/// Result of 'relation check' for one rule, relation, constraint or canon (a proportion that is a constraint).
struct PageVerdict {
    std::string kind;                  ///< "rule", "relation", "constraint" or "canon"
    std::string name;                  ///< name of the rule, or the type
    std::vector<std::size_t> members;  ///< indices into the annotation set
    std::optional<bool> holds;         ///< none: undetermined
    std::string text;                  ///< the measured value and the allowed range; the violation of a rule
};

/// Contents of one object of a page. The mesh and all other referenced data must live until the object is added.
struct PageObject {
    std::string name;
    const Mesh* mesh = nullptr;
    const AnnotationSet* annotations = nullptr;  ///< null: none
    const RelationGraph* graph = nullptr;        ///< null: none
    std::vector<RelationCheck> checks = {};      ///< checks of the graph's relationships, or empty
    const Mesh* cage = nullptr;                  ///< null: none
    std::vector<PageMap> maps = {};
    const PageSlices* slices = nullptr;         ///< null: none
    std::vector<PageVerdict> conformance = {};  ///< results of 'relation check', or empty
    std::vector<PageConstraint> constraints = {};
    std::vector<std::string> conflicts = {};  ///< messages on conflicting constraints
    std::vector<std::size_t> parts = {};      ///< indices of regions that can be moved separately: they share no vertex
    std::string unit = {};                    ///< empty: unit of the annotations
    std::array<double, 3> up = {0, 0, 1};     ///< used if the annotations give no up direction
    /// The original object, if it has more vertices than the shown mesh.
    struct Whole {
        std::size_t vertices = 0, faces = 0;
        double deviation = 0;  ///< maximum distance of its vertices from the shown mesh
    };
    std::optional<Whole> whole = {};
    /// Exact instead of packed geometry: single precision relative to the box, with a key that identifies the shape. If
    /// `sends_shape` is false only the key is included: the reader already has the shape.
    struct Exact {
        std::string key;
        bool sends_shape = true;
    };
    std::optional<Exact> exact = {};
};

/// A table whose cells are texts, numbers, or empty.
struct PageTable {
    struct Row {
        std::vector<Json> cells;
        /// Object and annotation that the row describes: indices into the page and into the object's set.
        int object = -1, annotation = -1;
    };
    std::string title, note;
    std::vector<std::string> columns;
    std::vector<Row> rows;
};

/// An object of a collection, stored in a file beside the page.
struct PageEntry {
    std::string name;
    std::string file, thumbnail;  ///< relative to the page: the output of `Page::script`, and a PNG
    std::size_t vertices = 0, faces = 0;
    std::vector<std::string> tags;
};

class Page {
public:
    explicit Page(std::string title);

    /// Adds an entry to an index of objects that are loaded on demand, instead of objects embedded in the page.
    void add(const PageEntry& entry);

    /// Adds an object and returns its index in the page. Objects with the same triangles as an earlier object can be morphed
    /// into each other in the viewer. Positions are quantised to 1/131,070 of the largest side of the box, values of maps to
    /// 1/131,068 of their range; the order of vertices and triangles is kept. Throws Error (input) for a mesh without triangles
    /// or a map of a different length.
    std::size_t add(const PageObject& object);
    void add(PageTable table);
    /// `svg` is the text of an SVG file.
    void add_drawing(const std::string& title, const std::string& svg);
    void note(const std::string& text);

    /// The whole file: the viewer, with the data embedded as JSON and deflated bytes. The same page gives the same bytes. It
    /// loads nothing from elsewhere, and texts of annotations are escaped.
    [[nodiscard]] std::string html(const std::string& made_how) const;
    /// The same content as a script that the page of a collection loads from `file`, as named in an entry.
    [[nodiscard]] std::string script(const std::string& file, const std::string& made_how) const;
    /// The content alone, for a viewer that is already open: the page's data (JSON), and the bytes they refer to.
    struct Content {
        std::string data, bytes;
    };
    [[nodiscard]] Content content(const std::string& made_how) const;

private:
    std::size_t add_bytes(std::string_view bytes);
    [[nodiscard]] std::string data(const std::string& made_how) const;

    Json document_;
    JsonValue objects_{rapidjson::kArrayType}, tables_{rapidjson::kArrayType}, drawings_{rapidjson::kArrayType},
        notes_{rapidjson::kArrayType}, places_{rapidjson::kArrayType}, entries_{rapidjson::kArrayType};
    std::string bytes_;
    std::vector<std::string> triangles_;  ///< checksums of the objects' triangles
};

/// Table of the measures and sizes of the annotations of an object of the page.
PageTable annotation_table(AnnotatedMeshView annotated, int object, const std::string& name);

}  // namespace ostraka

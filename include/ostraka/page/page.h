// One HTML page that shows objects in 3D with what is said of them, and tables and drawings beside; it needs nothing else.
#pragma once

#include "ostraka/relation/check.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// A number for each vertex of an object; none where it is not finite.
struct PageMap {
    std::string name;
    std::string label;  ///< what the numbers are, with their unit
    std::vector<double> values;
    struct Category {
        std::string text;
        std::array<int, 3> colour{};  ///< red, green, blue, 0 to 255
    };
    std::vector<Category> categories = {};  ///< not empty: the values are places in it
};

/// What planes cut out of an object, by ascending height.
struct PageSlices {
    struct Column {
        std::string name, title, unit;
    };
    struct Contour {
        bool closed = true, hole = false;
        std::vector<std::array<double, 2>> points;  ///< along u and v
    };
    struct Level {
        double height = 0;
        std::array<double, 3> origin{}, u{}, v{};
        std::vector<std::optional<double>> values;  ///< in the order of the columns
        std::vector<Contour> contours;
    };
    std::string unit;
    std::vector<Column> columns;
    std::vector<Level> levels;
    std::optional<std::array<double, 2>> tube;  ///< heights between which the object is tubular
};

/// What became of a constraint in a deformation.
struct PageConstraint {
    struct Deviation {
        std::string quantity;
        std::optional<double> before, value, tolerance;
        std::string unit;
    };
    std::string type;
    std::vector<std::size_t> members;  ///< places in the set of annotations
    double weight = 1;
    bool hard = false;
    std::string before, verdict;  ///< in words
    std::optional<bool> holds;    ///< none: it cannot be told
    std::string text;
    std::vector<Deviation> deviations;
    std::optional<std::array<double, 2>> residual;  ///< mean and largest
};

/// What 'relation check' says of one rule, relation, constraint or canon (a proportion that is a constraint).
struct PageVerdict {
    std::string kind;                  ///< "rule", "relation", "constraint" or "canon"
    std::string name;                  ///< the rule's, or the type
    std::vector<std::size_t> members;  ///< places in the set of annotations
    std::optional<bool> holds;         ///< none: it cannot be told
    std::string text;                  ///< what is measured, against what is allowed; what breaks the rule
};

/// What is shown of one object. The mesh and what is said of it must live until the object is added.
struct PageObject {
    std::string name;
    const Mesh* mesh = nullptr;
    const AnnotationSet* annotations = nullptr;  ///< null: none
    const RelationGraph* graph = nullptr;        ///< null: none
    std::vector<RelationCheck> checks = {};      ///< of the graph's relationships; or empty
    const Mesh* cage = nullptr;                  ///< null: none
    std::vector<PageMap> maps = {};
    const PageSlices* slices = nullptr;         ///< null: none
    std::vector<PageVerdict> conformance = {};  ///< what 'relation check' says; or empty
    std::vector<PageConstraint> constraints = {};
    std::vector<std::string> conflicts = {};  ///< of constraints, in words
    std::vector<std::size_t> parts = {};      ///< places of regions that can be moved apart: they share no vertex
    std::string unit = {};                    ///< empty: that of the annotations
    std::array<double, 3> up = {0, 0, 1};     ///< of objects whose annotations tell none
    /// The object that the mesh stands for, if that has more vertices.
    struct Whole {
        std::size_t vertices = 0, faces = 0;
        double deviation = 0;  ///< the largest distance of its vertices from what is shown
    };
    std::optional<Whole> whole = {};
    /// Instead of packed geometry: the shape as it is, in single precision relative to the box, and a key that says which shape
    /// it is. Without `sends_shape` only the key is there: the reader has that shape.
    struct Exact {
        std::string key;
        bool sends_shape = true;
    };
    std::optional<Exact> exact = {};
};

/// A cell is a text, a number, or nothing.
struct PageTable {
    struct Row {
        std::vector<Json> cells;
        int object = -1, annotation = -1;  ///< what the row is of: by the places in the page and in the object's set
    };
    std::string title, note;
    std::vector<std::string> columns;
    std::vector<Row> rows;
};

/// An object of a collection, which a file beside the page holds.
struct PageEntry {
    std::string name;
    std::string file, thumbnail;  ///< relative to the page: what `Page::script` gives, and a PNG
    std::size_t vertices = 0, faces = 0;
    std::vector<std::string> tags;
};

class Page {
public:
    explicit Page(std::string title);

    /// An index of objects that are read when they are asked for, instead of objects in the page.
    void add(const PageEntry& entry);

    /// Returns the object's place in the page. Objects of the same triangles as one before can be turned into each other there.
    /// Positions are kept to a 131,070th of the largest side of the box, numbers of maps to a 131,068th of their range; the
    /// order of vertices and triangles stays. Throws Error (input) for a mesh without triangles or a map of another length.
    std::size_t add(const PageObject& object);
    void add(PageTable table);
    /// An SVG file.
    void add_drawing(const std::string& title, const std::string& svg);
    void note(const std::string& text);

    /// The whole file: the viewer, and the data as JSON and deflated bytes within it. The same page has the same bytes. Nothing
    /// of it is fetched from anywhere, and texts of annotations stay texts.
    [[nodiscard]] std::string html(const std::string& made_how) const;
    /// The same content as a script that a page of a collection reads as `file`, which an entry names.
    [[nodiscard]] std::string script(const std::string& file, const std::string& made_how) const;
    /// The content alone, for a viewer that is open already: the page's data (JSON), and the bytes that they refer to.
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

/// The measures and sizes of the annotations of an object of the page.
PageTable annotation_table(const Mesh& mesh, const AnnotationSet& set, int object, const std::string& name);

}  // namespace ostraka

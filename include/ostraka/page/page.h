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
    std::string unit = {};                 ///< empty: that of the annotations
    std::array<double, 3> up = {0, 0, 1};  ///< of objects whose annotations tell none
    /// The object that the mesh stands for, if that has more vertices.
    struct Whole {
        std::size_t vertices = 0, faces = 0;
        double deviation = 0;  ///< the largest distance of its vertices from what is shown
    };
    std::optional<Whole> whole = {};
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

class Page {
public:
    explicit Page(std::string title);

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

private:
    std::size_t add_bytes(std::string_view bytes);

    Json document_;
    JsonValue objects_{rapidjson::kArrayType}, tables_{rapidjson::kArrayType}, drawings_{rapidjson::kArrayType},
        notes_{rapidjson::kArrayType}, places_{rapidjson::kArrayType};
    std::string bytes_;
    std::vector<std::string> triangles_;  ///< checksums of the objects' triangles
};

/// The measures and sizes of the annotations of an object of the page.
PageTable annotation_table(const Mesh& mesh, const AnnotationSet& set, int object, const std::string& name);

}  // namespace ostraka

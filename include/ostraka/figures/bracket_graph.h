// A tree of annotations with brackets for their relationships.
#pragma once

#include "ostraka/files/file.h"
#include "ostraka/render/picture.h"

#include <string>
#include <vector>

namespace ostraka {

/// A drawing with one row per annotation and one bracket per relationship.
struct BracketGraph {
    std::string title;  ///< title of the drawing
    struct Row {
        std::string name;  ///< name of the annotation
        int depth = 0;     ///< depth in the tree; 0 for a root
        Rgb colour;        ///< colour of the annotation
    };
    struct Bracket {
        std::string type;               ///< name of the relationship
        std::vector<std::size_t> rows;  ///< indices of the rows that the bracket joins
        int lane = 0;                   ///< column in which the bracket is drawn; 0 is closest to the rows
        bool strong = false;            ///< true: the relationship is a constraint
        bool directed = false;          ///< true: the relationship is directed, from the first of `rows`
    };
    std::vector<Row> rows;          ///< in preorder: each row comes after the row that contains it
    std::vector<Bracket> brackets;  ///< one per relationship
};

/// Writes the graph as .svg, .pdf or .png, atomically, creating folders. Throws Error (usage) for any other extension.
void write_plot(const Path& file, const BracketGraph& graph);

}  // namespace ostraka

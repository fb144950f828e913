// A tree of annotations with brackets for their relationships.
#pragma once

#include "ostraka/files/file.h"
#include "ostraka/render/picture.h"

#include <string>
#include <vector>

namespace ostraka {

struct BracketGraph {
    std::string title;
    struct Row {
        std::string name;
        int depth = 0;
        Rgb colour;
    };
    struct Bracket {
        std::string type;
        std::vector<std::size_t> rows;  ///< indices of the joined rows
        int lane = 0;                   ///< counted outwards, 0 is the innermost
        bool strong = false;            ///< whether it is a constraint
        bool directed = false;          ///< whether it is directed, from its first row
    };
    std::vector<Row> rows;  ///< in preorder: each row comes after the row that contains it
    std::vector<Bracket> brackets;
};

/// Writes the graph as .svg, .pdf or .png, atomically, creating folders. Throws Error (usage) for any other extension.
void write_plot(const Path& file, const BracketGraph& graph);

}  // namespace ostraka

// A tree with brackets beside it: annotations and their relationships.
#pragma once

#include "ostraka/core/file.h"
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
        std::vector<std::size_t> rows;  ///< what it joins
        int lane = 0;                   ///< from inside
        bool strong = false;            ///< a constraint
        bool directed = false;          ///< from the first of its rows
    };
    std::vector<Row> rows;  ///< each below what contains it
    std::vector<Bracket> brackets;
};

/// Writes it as .svg, .pdf or .png, atomically, folders and all. Throws Error (usage) for another ending.
void write_plot(const Path& file, const BracketGraph& graph);

}  // namespace ostraka

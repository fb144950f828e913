// Trees of clusters.
#pragma once

#include "ostraka/core/file.h"
#include "ostraka/stats/clustering.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct Dendrogram {
    std::string title;
    Linkage tree;
    std::vector<std::string> names;         ///< of the samples
    std::string label = "distance";         ///< of the axis
    std::optional<double> cut = {};         ///< a dashed line at this height
    std::string cut_label = {};             ///< words at that line
    std::vector<int> groups = {};           ///< of the samples, from 0; empty: those of the cut, or one a sample; numbered from 1
    std::vector<std::string> classes = {};  ///< known answers, a coloured mark beside each name; empty, or one a sample
};

/// Writes it as an SVG, or as a PNG of twice the size where the file's name ends in .png, atomically, folders and all: a row a
/// sample, merges to the right. Branches within a group are strong, and its number stands at each; they have colours of their own
/// where no classes are shown, whose colours would be mistaken for theirs. Throws Error (input) for a tree without samples or
/// whose merges are none, Error (usage) where names, classes or groups are not one a sample.
void write_plot(const Path& file, const Dendrogram& dendrogram);

}  // namespace ostraka

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
    std::optional<double> cut = {};         ///< a dashed line at this height; merges below it have the colours of their clusters
    std::vector<std::string> classes = {};  ///< known answers, a coloured mark beside each name; empty, or one a sample
};

/// The tree as an SVG file's bytes: a row a sample, merges to the right. Throws Error (input) for a tree without samples or whose
/// merges are none, Error (usage) where names or classes are not one a sample.
std::string svg_bytes(const Dendrogram& dendrogram);
/// Writes it atomically, folders and all; a PNG of twice the size where the file's name ends in .png.
void write_plot(const Path& file, const Dendrogram& dendrogram);

}  // namespace ostraka

// Dendrograms: plots of trees of clusters.
#pragma once

#include "ostraka/files/file.h"
#include "ostraka/stats/clustering.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct Dendrogram {
    std::string title;
    Linkage tree;
    std::vector<std::string> names;  ///< one per sample
    std::string label = "distance";  ///< label of the axis
    std::optional<double> cut = {};  ///< draws a dashed line at this height
    std::string cut_label = {};      ///< text at that line
    /// One per sample, from 0; empty: the groups of the cut, or one group per sample; displayed from 1.
    std::vector<int> groups = {};
    std::vector<std::string> classes = {};  ///< known labels, shown as a coloured mark beside each name; empty, or one per sample
};

/// Writes the dendrogram as an SVG, or as a PNG of twice the size if the file name ends in .png, atomically, creating folders:
/// one row per sample, merges to the right. Branches within a group are bold, with the group number at each group. Groups have
/// their own colours unless class colours, which could be confused with them, are shown. Throws Error (input) for a tree
/// without samples or with invalid merges, Error (usage) unless names, classes and groups have one entry per sample.
void write_plot(const Path& file, const Dendrogram& dendrogram);

}  // namespace ostraka

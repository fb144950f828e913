// Dendrograms: plots of trees of clusters.
#pragma once

#include "ostraka/files/file.h"
#include "ostraka/stats/clustering.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// A plot of a tree of clusters.
struct Dendrogram {
    std::string title;               ///< title of the plot
    Linkage tree;                    ///< merges of the samples
    std::vector<std::string> names;  ///< names of the samples
    std::string label = "distance";  ///< label of the distance axis
    std::optional<double> cut = {};  ///< distance at which a dashed line is drawn; none: no line
    std::string cut_label = {};      ///< text at the dashed line of `cut`
    /// For each sample: index of its group, from 0 (displayed from 1). Empty: the groups that result from cutting the tree at
    /// `cut`, or one group per sample if there is no `cut`.
    std::vector<int> groups = {};
    /// For each sample: its known class, shown as a coloured mark beside the name; empty: no classes.
    std::vector<std::string> classes = {};
};

/// Writes the dendrogram as an SVG, or as a PNG of twice the size if the file name ends in .png, atomically, creating folders:
/// one row per sample, merges to the right. Branches within a group are bold, and each group has its number. Groups have their
/// own colours unless class colours, which could be confused with group colours, are shown. Throws Error (input) for a tree
/// without samples or with invalid merges, Error (usage) unless names, classes and groups have one entry per sample.
void write_plot(const Path& file, const Dendrogram& dendrogram);

}  // namespace ostraka

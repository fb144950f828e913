#include "ostraka/figures/dendrogram.h"

#include "figures/sheet.h"
#include "ostraka/core/error.h"
#include "ostraka/render/colour_scale.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace ostraka {

namespace {

using namespace figures;

constexpr double row_height = 17, tree_width = 460, leaf_size = 12, largest_leaf = 220, number_size = 10.5;
constexpr Rgb between{130, 130, 130}, cut_colour{200, 30, 30};

void check(const Dendrogram& d) {
    if (d.tree.samples < 1) fail_input("dendrogram", "the tree has no samples", "give at least one sample");
    const auto n = static_cast<std::size_t>(d.tree.samples);
    if (d.tree.merges.size() != n - 1)
        fail_input("dendrogram", fmt::format("the tree of {} samples has {} merges", n, d.tree.merges.size()),
                   "give one merge fewer than samples");
    std::vector<bool> merged(2 * n);
    for (std::size_t m = 0; m < d.tree.merges.size(); ++m)
        for (const int child : {d.tree.merges[m].first, d.tree.merges[m].second}) {
            if (child < 0 || static_cast<std::size_t>(child) >= n + m || merged[static_cast<std::size_t>(child)])
                fail_input("dendrogram", fmt::format("merge {} refers to cluster {}", m, child),
                           "merge each cluster once, after it was created");
            merged[static_cast<std::size_t>(child)] = true;
        }
    if (d.names.size() != n || (!d.classes.empty() && d.classes.size() != n) || (!d.groups.empty() && d.groups.size() != n))
        fail_usage(fmt::format("the names, classes or groups of a dendrogram do not match its {} samples", n),
                   "give one per sample");
}

std::string draw(const Dendrogram& d, Sheet::Format format) {
    check(d);
    const auto n = static_cast<std::size_t>(d.tree.samples);
    std::map<std::string, std::size_t> classes;
    for (const std::string& name : d.classes) classes.try_emplace(name, 0);
    std::size_t number = 0;
    for (auto& [name, index] : classes) index = number++;
    double names = 0, legend = 0;
    {
        Sheet measure(10, 10);
        for (const std::string& name : d.names)
            names = std::max(names, std::min(largest_leaf, measure.width_of(name, leaf_size)));
        for (const auto& [name, index] : classes)
            legend = std::max({legend, 34 + measure.width_of(name), measure.width_of("known answers")});
        legend = std::max(legend, measure.width_of(d.title) - names - tree_width);
    }
    const double mark_width = classes.empty() ? 0 : 16, left = margin + names + 8 + mark_width, right = left + tree_width;
    const double top = margin + (d.cut_label.empty() ? 2 : 3) * text_size, bottom = top + static_cast<double>(n) * row_height;
    const double height =
        std::max(bottom + 3.4 * text_size, top + (static_cast<double>(classes.size()) + 2) * 1.6 * text_size) + margin;
    Sheet sheet(right + 2 * margin + legend, height, format);
    sheet.text(d.title, margin, margin + 0.8 * text_size, 0);

    double highest = d.cut.value_or(0);
    for (const Merge& merge : d.tree.merges) highest = std::max(highest, merge.height);
    if (!(highest > 0)) highest = 1;
    highest *= 1.04;
    const auto x = [&](double value) { return left + value / highest * tree_width; };
    const ColourScale range{0, highest, false, ""};
    const std::vector<double> steps = ticks(range, 6);
    for (const double value : steps) {
        sheet.line(x(value), top, x(value), bottom, pale, 1);
        sheet.text(tick_text(value, steps.size() > 1 ? steps[1] - steps[0] : value), x(value), bottom + 1.4 * text_size, 0.5);
    }
    sheet.line(left, bottom, right, bottom, ink, 1);
    sheet.text(d.label, (left + right) / 2, bottom + 2.9 * text_size, 0.5);

    const std::vector<int> leaves = leaf_order(d.tree);
    const std::vector<int> clusters = !d.groups.empty() ? d.groups : d.cut ? cut_at(d.tree, *d.cut) : std::vector<int>(n, -1);
    std::vector<double> place(2 * n), at(2 * n, 0.0);
    std::vector<int> cluster(2 * n, -1);
    for (std::size_t r = 0; r < leaves.size(); ++r) {
        const auto leaf = static_cast<std::size_t>(leaves[r]);
        place[leaf] = top + (static_cast<double>(r) + 0.5) * row_height;
        cluster[leaf] = clusters[leaf];
        sheet.text(sheet.fitted(d.names[leaf], largest_leaf, leaf_size), margin + names, place[leaf] + 0.35 * leaf_size, 1,
                   leaf_size);
        if (!classes.empty()) {
            const std::size_t class_index = classes.at(d.classes[leaf]);
            sheet.mark(left - 10, place[leaf], class_index, series_colour(class_index));
        }
    }
    const auto draw_branch = [&](int cluster_number, double x1, double y1, double x2, double y2) {
        const Rgb colour = cluster_number < 0 ? between
                           : classes.empty()  ? category_colour(static_cast<std::size_t>(cluster_number))
                                              : ink;
        sheet.line(x1, y1, x2, y2, colour, cluster_number < 0 ? 1.2 : 2);
    };
    // The number of a group is at the branch that leaves it.
    std::vector<std::tuple<double, double, int>> numbers;
    for (std::size_t m = 0; m < d.tree.merges.size(); ++m) {
        const Merge& merge = d.tree.merges[m];
        const auto a = static_cast<std::size_t>(merge.first), b = static_cast<std::size_t>(merge.second);
        const double merge_x = x(merge.height);
        cluster[n + m] = cluster[a] == cluster[b] ? cluster[a] : -1;
        for (const std::size_t child : {a, b}) {
            draw_branch(cluster[n + m], x(at[child]), place[child], merge_x, place[child]);
            if (cluster[child] >= 0 && cluster[n + m] < 0) numbers.emplace_back(x(at[child]), place[child], cluster[child]);
        }
        draw_branch(cluster[n + m], merge_x, place[a], merge_x, place[b]);
        place[n + m] = (place[a] + place[b]) / 2;
        at[n + m] = merge.height;
    }
    if (cluster[2 * n - 2] >= 0) numbers.emplace_back(x(at[2 * n - 2]), place[2 * n - 2], cluster[2 * n - 2]);
    for (const auto& [px, py, cluster_number] : numbers) {
        const std::string words = "group " + std::to_string(cluster_number + 1);
        const double begin = std::min(px + 4, right - sheet.width_of(words, number_size) - 2);
        sheet.rectangle({begin - 2, py - number_size / 2, begin + sheet.width_of(words, number_size) + 2, py + number_size / 2},
                        paper);
        sheet.text(words, begin, py + 0.35 * number_size, 0, number_size);
    }
    if (d.cut) {
        sheet.line(x(*d.cut), top - 4, x(*d.cut), bottom, cut_colour, 1.2, true);
        const double half = sheet.width_of(d.cut_label, number_size) / 2;
        sheet.text(d.cut_label, std::clamp(x(*d.cut), left + half, std::max(left + half, right - half)), top - 6, 0.5,
                   number_size, cut_colour);
    }
    double row = top + 0.8 * text_size;
    if (!classes.empty()) sheet.text("known answers", right + margin, row + 0.35 * text_size, 0), row += 1.6 * text_size;
    for (const auto& [name, index] : classes) {
        sheet.mark(right + margin + 13, row, index, series_colour(index));
        sheet.text(name.empty() ? "unknown" : name, right + margin + 26, row + 0.35 * text_size, 0);
        row += 1.6 * text_size;
    }
    return sheet.finish();
}

}  // namespace

void write_plot(const Path& file, const Dendrogram& dendrogram) {
    figures::write_sheet(file, [&](figures::Sheet::Format format) { return draw(dendrogram, format); });
}

}  // namespace ostraka

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

/// The drawing of a dendrogram: names on the left, the tree, the legend of classes on the right.
class DendrogramDrawing {
public:
    DendrogramDrawing(const Dendrogram& dendrogram, Sheet::Format format)
        : d_(dendrogram), count_(static_cast<std::size_t>(dendrogram.tree.samples)), format_(format) {
        for (const std::string& name : d_.classes) classes_.try_emplace(name, 0);
        std::size_t number = 0;
        for (auto& [name, index] : classes_) index = number++;
        double legend = 0;
        Sheet measure(10, 10);
        for (const std::string& name : d_.names)
            names_ = std::max(names_, std::min(largest_leaf, measure.width_of(name, leaf_size)));
        for (const auto& [name, index] : classes_)
            legend = std::max({legend, 34 + measure.width_of(name), measure.width_of("known answers")});
        legend = std::max(legend, measure.width_of(d_.title) - names_ - tree_width);
        left_ = margin + names_ + 8 + (classes_.empty() ? 0 : 16);
        right_ = left_ + tree_width;
        top_ = margin + (d_.cut_label.empty() ? 2 : 3) * text_size;
        bottom_ = top_ + static_cast<double>(count_) * row_height;
        width_ = right_ + 2 * margin + legend;
        height_ =
            std::max(bottom_ + 3.4 * text_size, top_ + (static_cast<double>(classes_.size()) + 2) * 1.6 * text_size) + margin;
        highest_ = d_.cut.value_or(0);
        for (const Merge& merge : d_.tree.merges) highest_ = std::max(highest_, merge.height);
        if (!(highest_ > 0)) highest_ = 1;
        highest_ *= 1.04;
    }

    std::string draw() {
        Sheet sheet(width_, height_, format_);
        sheet.text(d_.title, margin, margin + 0.8 * text_size, 0);
        draw_axis(sheet);
        draw_tree(sheet);
        if (d_.cut) {
            sheet.line(x(*d_.cut), top_ - 4, x(*d_.cut), bottom_, cut_colour, 1.2, true);
            const double half = sheet.width_of(d_.cut_label, number_size) / 2;
            sheet.text(d_.cut_label, std::clamp(x(*d_.cut), left_ + half, std::max(left_ + half, right_ - half)), top_ - 6, 0.5,
                       number_size, cut_colour);
        }
        draw_legend(sheet);
        return sheet.finish();
    }

private:
    [[nodiscard]] double x(double height) const { return left_ + height / highest_ * tree_width; }

    void draw_axis(Sheet& sheet) const {
        const std::vector<double> steps = ticks({0, highest_, false, ""}, 6);
        for (const double value : steps) {
            sheet.line(x(value), top_, x(value), bottom_, pale, 1);
            sheet.text(tick_text(value, steps.size() > 1 ? steps[1] - steps[0] : value), x(value), bottom_ + 1.4 * text_size,
                       0.5);
        }
        sheet.line(left_, bottom_, right_, bottom_, ink, 1);
        sheet.text(d_.label, (left_ + right_) / 2, bottom_ + 2.9 * text_size, 0.5);
    }

    void draw_branch(Sheet& sheet, int cluster, double x1, double y1, double x2, double y2) const {
        const Rgb colour = cluster < 0 ? between : classes_.empty() ? category_colour(static_cast<std::size_t>(cluster)) : ink;
        sheet.line(x1, y1, x2, y2, colour, cluster < 0 ? 1.2 : 2);
    }

    void draw_tree(Sheet& sheet) const {
        const std::size_t n = count_;
        const std::vector<int> leaves = leaf_order(d_.tree);
        const std::vector<int> groups = !d_.groups.empty() ? d_.groups
                                        : d_.cut           ? cut_at(d_.tree, *d_.cut)
                                                           : std::vector<int>(n, -1);
        std::vector<double> y(2 * n), heights(2 * n, 0.0);  // of leaves and merges
        std::vector<int> cluster(2 * n, -1);
        for (std::size_t r = 0; r < leaves.size(); ++r) {
            const auto leaf = static_cast<std::size_t>(leaves[r]);
            y[leaf] = top_ + (static_cast<double>(r) + 0.5) * row_height;
            cluster[leaf] = groups[leaf];
            sheet.text(sheet.fitted(d_.names[leaf], largest_leaf, leaf_size), margin + names_, y[leaf] + 0.35 * leaf_size, 1,
                       leaf_size);
            if (classes_.empty()) continue;
            const std::size_t class_index = classes_.at(d_.classes[leaf]);
            sheet.mark(left_ - 10, y[leaf], class_index, series_colour(class_index));
        }
        // The number of a group is at the branch that leaves it.
        std::vector<std::tuple<double, double, int>> numbers;
        for (std::size_t m = 0; m < d_.tree.merges.size(); ++m) {
            const Merge& merge = d_.tree.merges[m];
            const auto a = static_cast<std::size_t>(merge.first), b = static_cast<std::size_t>(merge.second);
            const double merge_x = x(merge.height);
            cluster[n + m] = cluster[a] == cluster[b] ? cluster[a] : -1;
            for (const std::size_t child : {a, b}) {
                draw_branch(sheet, cluster[n + m], x(heights[child]), y[child], merge_x, y[child]);
                if (cluster[child] >= 0 && cluster[n + m] < 0) numbers.emplace_back(x(heights[child]), y[child], cluster[child]);
            }
            draw_branch(sheet, cluster[n + m], merge_x, y[a], merge_x, y[b]);
            y[n + m] = (y[a] + y[b]) / 2;
            heights[n + m] = merge.height;
        }
        if (cluster[2 * n - 2] >= 0) numbers.emplace_back(x(heights[2 * n - 2]), y[2 * n - 2], cluster[2 * n - 2]);
        for (const auto& [px, py, number] : numbers) {
            const std::string words = "group " + std::to_string(number + 1);
            const double begin = std::min(px + 4, right_ - sheet.width_of(words, number_size) - 2);
            sheet.rectangle(
                {begin - 2, py - number_size / 2, begin + sheet.width_of(words, number_size) + 2, py + number_size / 2}, paper);
            sheet.text(words, begin, py + 0.35 * number_size, 0, number_size);
        }
    }

    void draw_legend(Sheet& sheet) const {
        double row = top_ + 0.8 * text_size;
        if (!classes_.empty()) sheet.text("known answers", right_ + margin, row + 0.35 * text_size, 0), row += 1.6 * text_size;
        for (const auto& [name, index] : classes_) {
            sheet.mark(right_ + margin + 13, row, index, series_colour(index));
            sheet.text(name.empty() ? "unknown" : name, right_ + margin + 26, row + 0.35 * text_size, 0);
            row += 1.6 * text_size;
        }
    }

    const Dendrogram& d_;
    std::size_t count_;  ///< number of leaves
    Sheet::Format format_;
    std::map<std::string, std::size_t> classes_;  ///< in alphabetical order, with their numbers
    double names_ = 0;                            ///< width of the column of names
    double left_ = 0, right_ = 0, top_ = 0, bottom_ = 0, width_ = 0, height_ = 0;
    double highest_ = 0;  ///< height at the right end of the axis
};

}  // namespace

void write_plot(const Path& file, const Dendrogram& dendrogram) {
    figures::write_sheet(file, [&](figures::Sheet::Format format) {
        check(dendrogram);
        return DendrogramDrawing(dendrogram, format).draw();
    });
}

}  // namespace ostraka

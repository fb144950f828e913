#include "render/labels.h"

#include "ostraka/execution/parallel.h"

#include <algorithm>
#include <cmath>

namespace ostraka::detail {

namespace {

constexpr double font = 14;   // nominal pixels
constexpr double row = 1.45;  // line height, relative to the font
constexpr double gap = 14;    // between names and the pane: space for the first segment of the lines
constexpr int cell = 4;       // pixels
constexpr int no_label = -1;

using Place = Canvas::Place;

/// Label of the surface in each cell of a pane; of overlapping regions, the smallest.
class Grid {
public:
    Grid(const Scene& scene, const Surface& surface, const Camera& camera, const PixelBox& pane) : pane_(pane) {
        columns_ = std::max(1, static_cast<int>(pane.width / cell));
        rows_ = std::max(1, static_cast<int>(pane.height / cell));
        std::vector<int> label_of_face(scene.mesh.triangles.size(), no_label);
        std::vector<std::size_t> order;
        for (std::size_t i = 0; i < scene.labels.size(); ++i) order.push_back(i);
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return scene.labels[a].faces.size() > scene.labels[b].faces.size();
        });
        for (const std::size_t i : order)
            for (const Index face : scene.labels[i].faces) label_of_face[face] = static_cast<int>(i);
        label_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), no_label);
        parallel_for(static_cast<std::size_t>(rows_), [&](std::size_t y) {
            for (int x = 0; x < columns_; ++x) {
                const Place centre = middle(x, static_cast<int>(y));
                const Camera::Ray ray = camera.ray(centre.x, centre.y);
                Surface::Hit hit;
                if (surface.first_hit(ray.origin, ray.direction, hit))
                    label_[index_of(x, static_cast<int>(y))] = label_of_face[hit.triangle];
            }
        });
    }

    /// The centre of the cell farthest from cells without the label (chessboard distance); ties: the first.
    [[nodiscard]] std::optional<Place> deepest(int label) const {
        std::vector<int> depth(label_.size(), 0);
        const auto depth_at = [&](int x, int y) {
            return x < 0 || y < 0 || x >= columns_ || y >= rows_ ? 0 : depth[index_of(x, y)];
        };
        for (int y = 0; y < rows_; ++y)
            for (int x = 0; x < columns_; ++x)
                if (label_[index_of(x, y)] == label)
                    depth[index_of(x, y)] =
                        1 + std::min({depth_at(x - 1, y), depth_at(x, y - 1), depth_at(x - 1, y - 1), depth_at(x + 1, y - 1)});
        int max_depth = 0;
        std::optional<Place> deepest_cell;
        for (int y = rows_ - 1; y >= 0; --y)
            for (int x = columns_ - 1; x >= 0; --x) {
                if (label_[index_of(x, y)] != label) continue;
                int& cell_depth = depth[index_of(x, y)];
                cell_depth = std::min(cell_depth, 1 + std::min({depth_at(x + 1, y), depth_at(x, y + 1), depth_at(x + 1, y + 1),
                                                                depth_at(x - 1, y + 1)}));
                if (cell_depth >= max_depth) max_depth = cell_depth, deepest_cell = middle(x, y);
            }
        return deepest_cell;
    }

private:
    [[nodiscard]] std::size_t index_of(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
    }
    [[nodiscard]] Place middle(int x, int y) const { return {pane_.left + (x + 0.5) * cell, pane_.top + (y + 0.5) * cell}; }

    PixelBox pane_;
    int columns_ = 1, rows_ = 1;
    std::vector<int> label_;
};

bool within(const PixelBox& pane, const Place& point) {
    return point.x >= pane.left && point.x < pane.left + pane.width && point.y >= pane.top && point.y < pane.top + pane.height;
}

/// The middle of the longest visible interval.
std::optional<Place> middle_in_sight(const SceneLabel& label, const Surface& surface, const Camera& camera,
                                     const PixelBox& pane) {
    struct VisibleSample {
        Place pixel;
        double arc_length;  // from the first point
    };
    std::vector<VisibleSample> stretch, longest;
    const auto length = [](const std::vector<VisibleSample>& samples) {
        return samples.empty() ? -1 : samples.back().arc_length - samples.front().arc_length;
    };
    double arc_length = 0;
    const auto add = [&](const Eigen::Vector3d& point) {
        Place pixel{};
        const bool visible = camera.project(point, pixel.x, pixel.y) && within(pane, pixel) &&
                             (label.through || is_visible(surface, camera, point));
        if (visible) stretch.push_back({pixel, arc_length});
        if (!visible || length(stretch) > length(longest)) {
            if (length(stretch) > length(longest)) longest = stretch;
            if (!visible) stretch.clear();
        }
    };
    for (std::size_t i = 0; i < label.points.size(); ++i) {
        const Eigen::Vector3d to = surface.to_local(label.points[i]);
        if (i > 0) {
            const Eigen::Vector3d from = surface.to_local(label.points[i - 1]);
            constexpr int steps = 24;
            const double segment = (to - from).norm();
            for (int k = 1; k <= steps; ++k) {
                arc_length += segment / steps;
                add(from + k * (to - from) / steps);
            }
        } else {
            add(to);
        }
    }
    if (longest.empty()) return std::nullopt;
    const double half = (longest.front().arc_length + longest.back().arc_length) / 2;
    return std::min_element(longest.begin(), longest.end(),
                            [&](const VisibleSample& a, const VisibleSample& b) {
                                return std::abs(a.arc_length - half) < std::abs(b.arc_length - half);
                            })
        ->pixel;
}

/// Moves labels to ascending positions as close as possible to the wanted ones (least squares), at least a row apart and within
/// the pane: overlapping labels are merged into blocks placed at the mean of their wanted positions.
void spread(std::vector<PaneLabel*>& labels, double top, double bottom) {
    struct Block {
        double sum;  // sum of the wanted positions of the block's first row
        std::size_t count;
        double height;
        [[nodiscard]] double begin() const { return sum / static_cast<double>(count); }
    };
    std::vector<Block> blocks;
    for (const PaneLabel* label : labels) {
        blocks.push_back({label->place_y - label->height / 2, 1, label->height});
        while (blocks.size() > 1 &&
               blocks[blocks.size() - 2].begin() + blocks[blocks.size() - 2].height > blocks.back().begin()) {
            const Block last = blocks.back();
            blocks.pop_back();
            Block& joined = blocks.back();
            joined.sum += last.sum - static_cast<double>(last.count) * joined.height;
            joined.count += last.count;
            joined.height += last.height;
        }
    }
    std::size_t next = 0;
    double free = top;
    for (const Block& block : blocks) {
        double y = std::max(block.begin(), free);
        for (std::size_t i = 0; i < block.count; ++i) labels[next++]->top = y, y += labels[next - 1]->height;
        free = y;
    }
    double limit = bottom;  // from below: moves up labels that are too low
    for (std::size_t i = labels.size(); i-- > 0;) {
        labels[i]->top = std::min(labels[i]->top, limit - labels[i]->height);
        limit = labels[i]->top;
    }
}

/// Start point of the line of a label.
Place begin_of(const PaneLabel& label, double size) {
    const bool left = label.left < label.place_x;
    return {left ? label.left + label.width + gap / 3 * size : label.left - gap / 3 * size, label.top + label.height / 2};
}

bool cross(const Place& a, const Place& b, const Place& c, const Place& d) {
    const auto side = [](const Place& p, const Place& q, const Place& r) {
        return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    };
    return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

}  // namespace

double label_column(Canvas& canvas, const Scene& scene, double pane_width, const Style& style) {
    double width = 0;
    for (const SceneLabel& label : scene.labels)
        width = std::max(width, canvas.text_width(clean_text(label.text), font * style.size));
    return width > 0 ? std::min(width + (gap + 8) * style.size, 0.27 * pane_width) : 0;
}

std::vector<PaneLabel> place_labels(Canvas& canvas, const Scene& scene, const Surface& surface, const Camera& camera,
                                    const PixelBox& pane, double column, const Style& style) {
    const Grid grid(scene, surface, camera, pane);
    const double height = row * font * style.size, room = column - (gap + 8) * style.size;
    std::vector<PaneLabel> labels;
    for (std::size_t i = 0; i < scene.labels.size(); ++i) {
        const SceneLabel& scene_label = scene.labels[i];
        const auto anchor =
            scene_label.faces.empty() ? middle_in_sight(scene_label, surface, camera, pane) : grid.deepest(static_cast<int>(i));
        if (!anchor) continue;
        PaneLabel& label = labels.emplace_back();
        label.text = canvas.elide(clean_text(scene_label.text), font * style.size, room);
        label.colour = scene_label.colour;
        label.width = canvas.text_width(label.text, font * style.size);
        label.height = height;
        label.place_x = anchor->x;
        label.place_y = anchor->y;
    }
    // Labels in the left half go to the left, as long as there are free rows.
    std::stable_sort(labels.begin(), labels.end(), [](const PaneLabel& a, const PaneLabel& b) { return a.place_x < b.place_x; });
    const auto rows = static_cast<std::size_t>(std::max(1.0, pane.height / height));
    if (labels.size() > 2 * rows) labels.resize(2 * rows);
    std::size_t to_left = 0;
    while (to_left < labels.size() && labels[to_left].place_x < pane.left + pane.width / 2) ++to_left;
    to_left = std::clamp(to_left, labels.size() - std::min(labels.size(), rows), std::min(labels.size(), rows));
    std::vector<PaneLabel*> sides[2];
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const bool left = i < to_left;
        labels[i].left = left ? pane.left - gap * style.size - labels[i].width : pane.left + pane.width + gap * style.size;
        sides[left ? 0 : 1].push_back(&labels[i]);
    }
    for (auto& side : sides) {
        std::stable_sort(side.begin(), side.end(),
                         [](const PaneLabel* a, const PaneLabel* b) { return a->place_y < b->place_y; });
        spread(side, pane.top, pane.top + pane.height);
        // Each exchange shortens the lines, so that the loop ends; the bound is a safeguard against rounding.
        bool crossing = true;
        for (std::size_t round = 0; crossing && round < side.size() * side.size() + 1; ++round) {
            crossing = false;
            for (std::size_t a = 0; a < side.size(); ++a)
                for (std::size_t b = a + 1; b < side.size(); ++b)
                    if (cross(begin_of(*side[a], style.size), {side[a]->place_x, side[a]->place_y},
                              begin_of(*side[b], style.size), {side[b]->place_x, side[b]->place_y})) {
                        std::swap(side[a]->top, side[b]->top);
                        std::swap(side[a], side[b]);
                        crossing = true;
                    }
        }
    }
    return labels;
}

void draw_labels(Canvas& canvas, const std::vector<PaneLabel>& labels, const Style& style) {
    const double size = style.size;
    for (const bool rim : {true, false})
        for (const PaneLabel& label : labels) {
            const Place begin = begin_of(label, size), end{label.place_x, label.place_y};
            canvas.polyline({begin, end}, rim ? style.background : style.ink, (rim ? 3.0 : 1.1) * size);
            canvas.disc(end, (rim ? 4.2 : 3.2) * size, rim ? style.background : style.ink);
            if (!rim) canvas.disc(end, 2 * size, label.colour);
        }
    for (const PaneLabel& label : labels)
        canvas.text(label.text, label.left, label.top + label.height / 2 + 0.36 * font * size, font * size, style.ink,
                    Canvas::Align::left, &style.background);
}

}  // namespace ostraka::detail

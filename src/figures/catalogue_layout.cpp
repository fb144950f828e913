#include "figures/catalogue_layout.h"

#include "figures/drawing_elements.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/render/colour_scale.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka::figures {

namespace {

constexpr double page_margin = 15 * points_per_mm, header_height = 30, text_points = 8, leading = 10.5, column_gap = 18;

/// Scales from the largest to the smallest; enlargements are for objects below 25 mm only.
constexpr std::array<double, 20> scales{10,       5,        4,        3,         2,          1,          1 / 2.0,
                                        1 / 3.0,  1 / 4.0,  1 / 5.0,  1 / 6.0,   1 / 8.0,    1 / 10.0,   1 / 15.0,
                                        1 / 20.0, 1 / 25.0, 1 / 50.0, 1 / 100.0, 1 / 1000.0, 1 / 10000.0};

/// The largest scale at which `fits(scale)`; the requested one if it fits. 0: none fits.
template <class Fits>
double choose_scale(const std::string& requested, double object_size, const Fits& fits) {
    if (requested != "auto" && fits(catalogue_scale(requested))) return catalogue_scale(requested);
    constexpr double small_object = 25;
    for (const double scale : scales)
        if ((scale <= 1 || object_size < small_object) && fits(scale)) return scale;
    return 0;
}

/// Scale bar of a round length with the name of the scale, its left end at x.
void scale_with_bar(Sheet& sheet, double x, double y, double scale, double room) {
    scale_bar(sheet, x, y, points_per_mm * scale, std::min(room, 120.0), "mm");
    const double bar = points_per_mm * scale * round_length(std::min(room, 120.0) / (points_per_mm * scale));
    sheet.text(scale_text(scale), x + bar + 34, y + 5, 0, 9);
}

/// A printed line: a label with its value, or a heading.
struct TextLine {
    std::string label, text;
    bool heading = false;
};

std::string number_text(double value, int digits_shown, const char* unit) {
    return significant(value, digits_shown) + " " + unit;
}

void add_measures(std::vector<TextLine>& lines, const CatalogueEntry& entry) {
    const auto add = [&](const char* label, const std::string& text) { lines.push_back({label, text, false}); };
    const CatalogueDiameter& diameter = entry.diameter;
    if (!diameter.name.empty()) {
        std::string text = diameter_text(diameter);
        if (diameter.known && text.find('(') != std::string::npos)
            text += diameter.is_range ? ", range over all directions" : ", 95 % interval";
        add(diameter.name.c_str(), text);
        add(entry.kind == CatalogueKind::vessel || entry.kind == CatalogueKind::rim ? "rim preserved" : "circle preserved",
            share_text(diameter.share) + fmt::format(" ({}\u00B0)", fixed(360 * diameter.share, 0)));
    }
    if (std::isfinite(entry.height))
        add(entry.kind == CatalogueKind::rim || entry.kind == CatalogueKind::wall || entry.kind == CatalogueKind::base
                ? "preserved height"
                : "height",
            millimetres_text(entry.height));
    if (std::isfinite(entry.width)) add("width, depth", millimetres_text(entry.width) + ", " + millimetres_text(entry.depth));
    if (std::isfinite(entry.thickness))
        add("wall thickness", fmt::format("median {} ({} to {})", number_text(entry.thickness, 3, "mm"),
                                          significant(entry.thickness_low, 2), significant(entry.thickness_high, 2)));
    if (std::isfinite(entry.capacity))
        add("capacity to the rim",
            number_text(entry.capacity, 3, "litres") +
                (std::isfinite(entry.capacity_error) ? fmt::format(" \u00B1 {}", significant(entry.capacity_error, 1)) : ""));
    if (std::isfinite(entry.volume)) add("volume of the body", number_text(entry.volume, 3, "cm\u00B3"));
    if (std::isfinite(entry.weight)) add("weight", number_text(entry.weight, 3, "g"));
    for (const std::string& clause : entry.unknown) add("not known", clause);
    add("scan", fmt::format("{} vertices, {} faces, in {}{}", entry.vertices, entry.faces, entry.unit,
                            entry.unit_assumed ? " (assumed)" : ""));
}

void add_texts(std::vector<TextLine>& lines, const char* heading, const std::vector<std::pair<std::string, std::string>>& texts) {
    if (texts.empty()) return;
    lines.push_back({heading, "", true});
    for (const auto& [label, text] : texts) lines.push_back({label, text, false});
}

std::vector<TextLine> left_column(const CatalogueEntry& entry) {
    std::vector<TextLine> lines;
    if (!entry.problem.empty()) return lines;  // nothing is known of it
    lines.push_back({"Measures", "", true});
    add_measures(lines, entry);
    if (!entry.landmarks.empty()) {
        lines.push_back({"Landmarks", "", true});
        std::string names;
        bool numbered = true;  // the names are the numbers
        for (std::size_t i = 0; i < entry.landmarks.size(); ++i) {
            numbered = numbered && entry.landmarks[i] == std::to_string(i + 1);
            names += fmt::format("{}{} {}", i > 0 ? ", " : "", i + 1, printable(entry.landmarks[i], 60));
        }
        if (numbered) names = fmt::format("1 to {}, as in the file", entry.landmarks.size());
        lines.push_back({"", names, false});
    }
    return lines;
}

std::vector<TextLine> right_column(const CatalogueEntry& entry) {
    std::vector<TextLine> lines;
    add_texts(lines, "State", entry.state);
    add_texts(lines, "Provenance", entry.provenance);
    add_texts(lines, "Annotations", entry.annotations);
    if (!entry.notes.empty()) lines.push_back({"Notes", "", true});
    for (const std::string& note : entry.notes) lines.push_back({"", note, false});
    return lines;
}

/// A line as it is printed: label at the left, text beside it.
struct PrintedLine {
    std::string label, text;
    bool heading = false;
};

constexpr double label_width = 88;

std::vector<PrintedLine> printed(Sheet& sheet, const std::vector<TextLine>& lines, double width) {
    std::vector<PrintedLine> result;
    for (const TextLine& line : lines) {
        if (line.heading) {
            if (!result.empty()) result.push_back({});
            result.push_back({line.label, "", true});
            continue;
        }
        const double indent = line.label.empty() ? 0 : label_width;
        const auto parts = wrapped(sheet, line.text, width - indent, text_points);
        for (std::size_t i = 0; i < parts.size(); ++i)
            result.push_back({i == 0 ? sheet.fitted(line.label, label_width - 6, text_points) : "", parts[i], false});
        if (!line.label.empty())
            for (std::size_t i = result.size() - parts.size() + 1; i < result.size(); ++i) result[i].label = " ";
    }
    return result;
}

void draw_column(Sheet& sheet, const std::vector<PrintedLine>& lines, std::size_t begin, std::size_t end, double x, double y) {
    for (std::size_t i = begin; i < std::min(end, lines.size()); ++i, y += leading) {
        const PrintedLine& line = lines[i];
        if (line.heading) {
            sheet.text(line.label, x, y, 0, text_points + 1);
            continue;
        }
        if (!line.label.empty()) sheet.text(line.label, x, y, 0, text_points, {110, 110, 110});
        sheet.text(line.text, x + (line.label.empty() ? 0 : label_width), y, 0, text_points);
    }
}

void draw_header(Sheet& sheet, const PageSize& page, const std::string& left, const std::string& right) {
    const double width = page.points_wide() - 2 * page_margin, y = page_margin + 8;
    const double right_width = sheet.width_of(right, 10);
    sheet.text(sheet.fitted(left, width - right_width - 12, 14), page_margin, y, 0, 14);
    sheet.text(right, page.points_wide() - page_margin, y, 1, 10);
    sheet.line(page_margin, y + 6, page.points_wide() - page_margin, y + 6, ink, 0.5);
}

/// Views in a row at one scale, with captions below.
struct ViewRow {
    double scale = 0;
    double height = 0;  ///< with captions and scale bar
};
constexpr double caption_height = 12, view_gap = 14, bar_height = 26;

ViewRow plan_row(const std::vector<CatalogueView>& views, double width, double max_height) {
    double sum = 0, highest = 0;
    for (const CatalogueView& view : views)
        sum += view.object_right - view.object_left, highest = std::max(highest, view.object_high - view.object_low);
    if (views.empty() || !(sum > 0)) return {};
    const double room = width - view_gap * double(views.size() - 1);
    const double scale = choose_scale("auto", highest, [&](double s) {
        return points_per_mm * s * sum <= room && points_per_mm * s * highest <= max_height - caption_height - bar_height;
    });
    return {scale, points_per_mm * scale * highest + caption_height + bar_height};
}

/// Draws views side by side, their lower edges at `y`; returns nothing if there is no scale.
void draw_row(Sheet& sheet, const std::vector<const CatalogueView*>& views, double scale, double x, double y, double width) {
    double used = 0;
    const double points = points_per_mm * scale;
    for (const CatalogueView* view : views) used += points * (view->object_right - view->object_left);
    const double gap = views.size() > 1 ? std::min(40.0, (width - used) / double(views.size() - 1)) : 0;
    double left = x + std::max(0.0, (width - used - gap * double(views.size() - 1)) / 2);
    for (const CatalogueView* view : views) {
        const double extent = points * (view->object_right - view->object_left);
        draw_view(sheet, *view, points, left, y);
        sheet.text(view->name, left + extent / 2, y + caption_height, 0.5, 7, {110, 110, 110});
        left += extent + gap;
    }
}

/// One object with its texts: plans sizes, then draws.
class ObjectPage {
public:
    ObjectPage(const CatalogueEntry& entry, const CatalogueStyle& style) : entry_(entry), style_(style) {
        Sheet measuring(page_.points_wide(), page_.points_high());
        left_ = printed(measuring, left_column(entry), column_width());
        right_ = printed(measuring, right_column(entry), column_width());
        plan();
    }

    [[nodiscard]] double scale() const { return scale_; }
    [[nodiscard]] std::size_t pages() const {
        const std::size_t total = std::max(left_.size(), right_.size());
        const std::size_t further = total > lines_ ? total - lines_ : 0, per_page = lines_per_page();
        return 1 + (further + per_page - 1) / per_page;
    }

    void draw(Sheet& sheet, std::size_t page, std::size_t number) const {
        const std::string name = printable(entry_.name, 200) + (page > 0 ? " (continued)" : "");
        draw_header(sheet, page_, fmt::format("{}  {}", number, name), to_string(entry_.kind));
        const std::size_t begin = page == 0 ? 0 : lines_ + (page - 1) * lines_per_page();
        const std::size_t end = page == 0 ? lines_ : begin + lines_per_page();
        const double y = page == 0 ? text_top_ : page_margin + header_height;
        draw_column(sheet, left_, begin, end, page_margin, y + text_points);
        draw_column(sheet, right_, begin, end, page_margin + column_width() + column_gap, y + text_points);
        if (page > 0) return;
        if (!entry_.problem.empty()) return draw_problem(sheet);
        if (entry_.has_axis()) draw_pottery(sheet);
        else draw_six(sheet);
    }

private:
    [[nodiscard]] double width() const { return page_.points_wide() - 2 * page_margin; }
    [[nodiscard]] double column_width() const { return (width() - column_gap) / 2; }
    [[nodiscard]] double bottom() const { return page_.points_high() - page_margin - 14; }
    [[nodiscard]] double top() const { return page_margin + header_height; }
    [[nodiscard]] std::size_t lines_per_page() const { return static_cast<std::size_t>((bottom() - top()) / leading); }

    void plan() {
        const double max_text = 0.36 * page_.points_high();
        const std::size_t total = std::max(left_.size(), right_.size());
        lines_ = std::min(total, static_cast<std::size_t>(max_text / leading));
        text_top_ = bottom() - leading * double(lines_);
        const double room = text_top_ - 12 - top();
        if (!entry_.problem.empty()) return;
        if (!entry_.has_axis()) return plan_six(room);
        row_ = plan_row(entry_.views, width(), 0.42 * room);
        const double height = room - row_.height - 10 - above_drawing - below_drawing;
        const auto fits = [&](double scale) {
            const PlateExtent extent = PotteryPlate(entry_, style_, scale).extent();
            return extent.width() + 2 * beside_drawing <= width() && extent.height() <= height;
        };
        const CatalogueDrawing& drawing = entry_.drawing;
        scale_ = choose_scale(style_.scale, std::max(drawing.high, 2 * drawing.section_reach), fits);
    }

    /// Two rows: the four sides, then the views from above and below.
    void plan_six(double room) {
        const auto& views = entry_.views;
        if (views.size() < 6) return;
        const auto fits = [&](double scale) {
            const double points = points_per_mm * scale;
            double sides = 0, ends = 0, first = 0, second = 0;
            for (std::size_t i = 0; i < 6; ++i) {
                const double w = points * (views[i].object_right - views[i].object_left);
                const double h = points * (views[i].object_high - views[i].object_low);
                (i < 4 ? sides : ends) += w;
                double& row = i < 4 ? first : second;
                row = std::max(row, h);
            }
            return sides + 3 * view_gap <= width() && ends + view_gap <= width() &&
                   first + second + 2 * caption_height + view_gap + bar_height <= room;
        };
        scale_ = choose_scale(style_.scale, std::max(entry_.height, entry_.width), fits);
    }

    void draw_problem(Sheet& sheet) const {
        double y = top() + 24;
        sheet.text("This object could not be read:", page_margin, y, 0, 10);
        for (const std::string& line : wrapped(sheet, printable(entry_.problem, 2000), width(), 10))
            sheet.text(line, page_margin, y += 15, 0, 10);
    }

    void draw_pottery(Sheet& sheet) const {
        if (!(scale_ > 0)) return;
        const PotteryPlate plate(entry_, style_, scale_);
        const PlateExtent extent = plate.extent();
        const double room = text_top_ - 12 - top() - row_.height - 10;
        const double base = top() + (room + extent.height() + above_drawing - below_drawing) / 2;
        plate.draw(sheet, page_margin + (width() - extent.width()) / 2 + extent.left, base, false);
        scale_with_bar(sheet, page_margin + 6, std::min(base + 34, top() + room - 6), scale_, width() / 3);
        if (!(row_.scale > 0)) return;
        std::vector<const CatalogueView*> views;
        for (const CatalogueView& view : entry_.views) views.push_back(&view);
        const double row_base = text_top_ - 12 - bar_height - caption_height;
        draw_row(sheet, views, row_.scale, page_margin, row_base, width());
        scale_with_bar(sheet, page_margin + 6, text_top_ - 20, row_.scale, width() / 3);
    }

    void draw_six(Sheet& sheet) const {
        if (!(scale_ > 0)) return;
        std::vector<const CatalogueView*> sides, ends;
        double first = 0, second = 0;
        for (std::size_t i = 0; i < 6; ++i) {
            const CatalogueView& view = entry_.views[i];
            (i < 4 ? sides : ends).push_back(&view);
            double& row = i < 4 ? first : second;
            row = std::max(row, points_per_mm * scale_ * (view.object_high - view.object_low));
        }
        const double spare = std::max(0.0, text_top_ - 12 - top() - first - second - 2 * caption_height - view_gap - bar_height);
        double y = top() + spare / 3 + first;
        draw_row(sheet, sides, scale_, page_margin, y, width());
        y += caption_height + view_gap + spare / 3 + second;
        draw_row(sheet, ends, scale_, page_margin, y, width());
        scale_with_bar(sheet, page_margin + 6, text_top_ - 20, scale_, width() / 3);
    }

    const CatalogueEntry& entry_;
    const CatalogueStyle& style_;
    PageSize page_ = page_size(style_.paper);
    std::vector<PrintedLine> left_, right_;
    std::size_t lines_ = 0;  ///< number of lines on the first page
    double text_top_ = 0, scale_ = 0;
    ViewRow row_;
};

}  // namespace

PageSize page_size(CatalogueStyle::Paper format) {
    switch (format) {
        case CatalogueStyle::Paper::a3:
            return {297, 420};
        case CatalogueStyle::Paper::letter:
            return {215.9, 279.4};
        default:
            return {210, 297};
    }
}

std::vector<std::string> wrapped(Sheet& sheet, const std::string& text, double width, double size) {
    std::vector<std::string> lines{""};
    std::size_t begin = 0;
    while (begin < text.size()) {
        const std::size_t end = std::min(text.find(' ', begin), text.size());
        const std::string word = text.substr(begin, end - begin);
        const std::string joined_line = lines.back().empty() ? word : lines.back() + " " + word;
        if (lines.back().empty() || sheet.width_of(joined_line, size) <= width) lines.back() = joined_line;
        else lines.push_back(word);
        begin = end + 1;
    }
    for (std::string& line : lines) line = sheet.fitted(line, width, size);
    return lines;
}

void add_object_pages(Layout& layout, const std::vector<CatalogueEntry>& entries, const CatalogueStyle& style) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const auto page = std::make_shared<ObjectPage>(entries[i], style);
        layout.places.emplace_back(layout.pages.size() + 1, page->scale() > 0 ? scale_text(page->scale()) : "");
        for (std::size_t k = 0; k < page->pages(); ++k)
            layout.pages.emplace_back([page, k, i](Sheet& sheet) { page->draw(sheet, k, i + 1); });
    }
}

}  // namespace ostraka::figures

namespace ostraka {

void write_pottery_drawing(const Path& file, const CatalogueEntry& entry, const CatalogueStyle& style) {
    using namespace figures;
    if (!entry.has_axis())
        fail_usage(fmt::format("{} has no axis to be drawn about", entry.name), "draw its views (ostraka render)");
    constexpr double head = 24, room_x = 400, room_y = 560, room_limit = 1150;
    const auto extent_at = [&](double scale) { return PotteryPlate(entry, style, scale).extent(); };
    const bool is_fixed = style.scale != "auto";
    const double scale = choose_scale(style.scale, 2 * entry.drawing.section_reach, [&](double s) {
        const PlateExtent extent = extent_at(s);
        return extent.width() <= (is_fixed ? room_limit : room_x) && extent.height() <= (is_fixed ? room_limit : room_y);
    });
    if (!(scale > 0) || (is_fixed && scale != catalogue_scale(style.scale)))
        fail_usage(fmt::format("at the scale {} the drawing is larger than a sheet", style.scale),
                   "use a smaller scale, or auto");
    const PlateExtent extent = extent_at(scale);
    const double width = std::max(extent.width() + 2 * (beside_drawing + margin), 260.0);
    const double height = head + above_drawing + extent.height() + below_drawing + 2 * margin;
    write_sheet(file, [&](Sheet::Format format) {
        Sheet sheet(width, height, format);
        const std::string title = style.title.empty() ? entry.name : style.title;
        sheet.text(sheet.fitted(title, width - 2 * margin, 12), margin, margin + 8, 0, 12);
        const PotteryPlate plate(entry, style, scale);
        plate.draw(sheet, (width - extent.width()) / 2 + extent.left, margin + head + above_drawing + extent.height(), false);
        scale_with_bar(sheet, margin + 6, height - margin - 6, scale, width / 3);
        return sheet.finish();
    });
}

}  // namespace ostraka

namespace ostraka::figures {

namespace {

/// A drawing in its place on a sheet of many.
struct Cell {
    std::size_t entry = 0;
    double width = 0, height = 0;
    double x = 0, y = 0;  ///< upper left corner
};
constexpr double cell_gap = 16, cell_caption = 32;

Cell cell_of(const std::vector<CatalogueEntry>& entries, std::size_t index, const CatalogueStyle& style, double scale) {
    const CatalogueEntry& entry = entries[index];
    Cell cell{index};
    if (entry.has_axis()) {
        const PlateExtent extent = PotteryPlate(entry, style, scale).extent();
        cell.width = extent.width(), cell.height = extent.height();
    } else if (!entry.views.empty()) {
        for (std::size_t k = 0; k < 2 && k < entry.views.size(); ++k) {
            const CatalogueView& view = entry.views[k];
            cell.width += points_per_mm * scale * (view.object_right - view.object_left) + (k > 0 ? view_gap : 0);
            cell.height = std::max(cell.height, points_per_mm * scale * (view.object_high - view.object_low));
        }
    }
    cell.width = std::max(cell.width, 90.0);
    return cell;
}

void draw_cell(Sheet& sheet, const CatalogueEntry& entry, const Cell& cell, const CatalogueStyle& style, double scale) {
    const double base = cell.y + cell.height;
    if (entry.has_axis()) {
        const PotteryPlate plate(entry, style, scale);
        const PlateExtent extent = plate.extent();
        plate.draw(sheet, cell.x + (cell.width - extent.width()) / 2 + extent.left, base, true);
    } else {
        double x = cell.x;
        for (std::size_t k = 0; k < 2 && k < entry.views.size(); ++k) {
            const CatalogueView& view = entry.views[k];
            draw_view(sheet, view, points_per_mm * scale, x, base);
            x += points_per_mm * scale * (view.object_right - view.object_left) + view_gap;
        }
    }
    const double middle = cell.x + cell.width / 2;
    sheet.text(sheet.fitted(fmt::format("{}  {}", cell.entry + 1, printable(entry.name, 80)), cell.width + cell_gap / 2, 7),
               middle, base + 14, 0.5, 7);
    std::string words = to_string(entry.kind);
    if (!entry.problem.empty()) words = "could not be read";
    if (!entry.diameter.name.empty())
        words =
            "\u2300 " + (entry.diameter.known ? millimetres_text(entry.diameter.value) + ", " + share_text(entry.diameter.share)
                                              : std::string("cannot be told"));
    sheet.text(sheet.fitted(words, cell.width + cell_gap / 2, 7), middle, base + 23, 0.5, 7, {110, 110, 110});
}

/// Places cells in rows on pages; the pages with their cells.
std::vector<std::vector<Cell>> pages_of_cells(std::vector<Cell> cells, double width, double height) {
    std::vector<std::vector<Cell>> pages(1);
    double x = 0, y = 0, row_height = 0;
    std::size_t row_begin = 0;
    const auto end_row = [&] {  // drawings of a row stand on one line, and are spread over its width
        auto& page = pages.back();
        double used = 0;
        for (std::size_t k = row_begin; k < page.size(); ++k) used += page[k].width;
        const auto count = double(page.size() - row_begin);
        const double gap = std::min((width - used) / std::max(1.0, count + 1), 60.0);
        double left = std::max(0.0, (width - used - gap * (count - 1)) / 2);
        for (std::size_t k = row_begin; k < page.size(); ++k) {
            page[k].y += row_height - page[k].height, page[k].x = left;
            left += page[k].width + gap;
        }
        y += row_height + cell_caption + cell_gap;
        x = row_height = 0;
        row_begin = page.size();
    };
    for (Cell& cell : cells) {
        if (x > 0 && x + cell.width > width) end_row();
        if (y > 0 && y + std::max(row_height, cell.height) + cell_caption > height) {
            // The unfinished row moves to the next page.
            std::vector<Cell> row(pages.back().begin() + static_cast<long>(row_begin), pages.back().end());
            pages.back().resize(row_begin);
            pages.emplace_back();
            row_begin = 0, y = 0;
            for (Cell& moved : row) moved.y = 0, pages.back().push_back(moved);
        }
        cell.x = x, cell.y = y;
        x += cell.width + cell_gap;
        row_height = std::max(row_height, cell.height);
        pages.back().push_back(cell);
    }
    end_row();
    return pages;
}

}  // namespace

void add_sheets(Layout& layout, const std::vector<CatalogueEntry>& entries, const CatalogueStyle& style) {
    const PageSize page = page_size(style.paper);
    const double width = page.points_wide() - 2 * page_margin;
    const double height = page.points_high() - 2 * page_margin - header_height - 40;
    const double scale = choose_scale(style.scale, 1e9, [&](double s) {
        for (std::size_t i = 0; i < entries.size(); ++i)
            if (const Cell cell = cell_of(entries, i, style, s); cell.width > width || cell.height + cell_caption > height)
                return false;
        return true;
    });
    if (!(scale > 0)) fail_input("catalogue", "an object is too large for a sheet", "leave out --several-per-page");
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < entries.size(); ++i) cells.push_back(cell_of(entries, i, style, scale));
    layout.places.resize(entries.size());
    for (const auto& on_page : pages_of_cells(std::move(cells), width, height)) {
        for (const Cell& cell : on_page) layout.places[cell.entry] = {layout.pages.size() + 1, scale_text(scale)};
        layout.pages.emplace_back([&entries, &style, on_page, page, scale](Sheet& sheet) {
            draw_header(sheet, page, style.title.empty() ? "Catalogue" : style.title, scale_text(scale));
            for (Cell cell : on_page) {
                cell.x += page_margin, cell.y += page_margin + header_height;
                draw_cell(sheet, entries[cell.entry], cell, style, scale);
            }
            scale_with_bar(sheet, page_margin + 6, page.points_high() - page_margin - 22, scale, 150);
        });
    }
}

void add_table_pages(Layout& layout, const TextTable& table, const CatalogueStyle& style) {
    const PageSize page = page_size(style.paper);
    constexpr double size = 6.5, row_height = 9.5, padding = 5;
    Sheet measuring(page.points_wide(), page.points_high());
    const std::size_t columns = table.columns().size();
    std::vector<double> widths(columns, 0);
    for (std::size_t c = 0; c < columns; ++c) {
        widths[c] = measuring.width_of(table.columns()[c], size);
        for (const auto& row : table.rows()) widths[c] = std::max(widths[c], measuring.width_of(row[c], size));
        widths[c] = std::min(widths[c] + padding, 100.0);
    }
    // The last column takes what the others leave, but at least a fifth of the page; its text may be cut off.
    const double room = page.points_wide() - 2 * page_margin;
    double others = 0;
    for (std::size_t c = 0; c + 1 < columns; ++c) others += widths[c];
    const double shrink = std::min(1.0, 0.8 * room / std::max(1.0, others));
    for (double& width : widths) width *= shrink;
    if (columns > 0) widths.back() = room - shrink * others;
    const auto per_page = static_cast<std::size_t>((page.points_high() - 2 * page_margin - header_height - 40) / row_height);
    for (std::size_t begin = 0; begin == 0 || begin < table.size(); begin += per_page)
        layout.pages.emplace_back([=, rows = table.rows(), names = table.columns()](Sheet& sheet) {
            draw_header(sheet, page, "Table of all objects", "");
            double y = page_margin + header_height + 10;
            const auto draw = [&](const std::vector<std::string>& cells) {
                double x = page_margin;
                for (std::size_t c = 0; c < cells.size(); ++c) {
                    sheet.text(sheet.fitted(cells[c], widths[c] - 2, size), x, y, 0, size);
                    x += widths[c];
                }
                y += row_height;
            };
            draw(names);
            sheet.line(page_margin, y - 6, page.points_wide() - page_margin, y - 6, ink, 0.4);
            y += 3;
            for (std::size_t r = begin; r < std::min(begin + per_page, rows.size()); ++r) draw(rows[r]);
        });
}

}  // namespace ostraka::figures

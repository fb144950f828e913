#include "ostraka/figures/catalogue.h"

#include "figures/catalogue_layout.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/render/render.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ostraka {

using namespace figures;

namespace {

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : printable(text, 5000)) {
        if (c == '<') result += "&lt;";
        else if (c == '>') result += "&gt;";
        else if (c == '&') result += "&amp;";
        else if (c == '"') result += "&quot;";
        else result += c;
    }
    return result;
}

/// The SVG with its size in millimetres.
std::string in_millimetres(std::string svg, const PageSize& page) {
    const std::size_t width = svg.find(" width=\""), end = svg.find(" viewBox=");
    if (width == std::string::npos || end == std::string::npos || width > end) return svg;
    return svg.replace(width, end - width, fmt::format(" width=\"{}mm\" height=\"{}mm\"", page.width, page.height));
}

/// The SVG with names of its elements that no other page has, without the XML declaration.
std::string for_page(const std::string& svg, std::size_t page) {
    const std::string prefix = fmt::format("p{}-", page);
    constexpr std::array<std::string_view, 3> marks{" id=\"", "href=\"#", "url(#"};
    std::size_t at = std::min(svg.find("<svg"), svg.size());
    std::array<std::size_t, 3> next{};
    for (std::size_t k = 0; k < 3; ++k) next[k] = svg.find(marks[k], at);
    std::string result;
    result.reserve(svg.size() + svg.size() / 16);
    for (;;) {
        const std::size_t k = static_cast<std::size_t>(std::min_element(next.begin(), next.end()) - next.begin());
        if (next[k] == std::string::npos) break;
        const std::size_t end = next[k] + marks[k].size();
        result.append(svg, at, end - at);
        result += prefix;
        at = end;
        next[k] = svg.find(marks[k], at);
    }
    return result.append(svg, at);
}

constexpr const char* page_style =
    "body{font:14px/1.4 sans-serif;margin:2em auto;max-width:230mm;color:#1e1e1e;background:#fff}"
    "section{margin:1em 0;box-shadow:0 0 6px #bbb}section svg{display:block;max-width:100%;height:auto}"
    "table{border-collapse:collapse;font-size:12px}td,th{padding:2px 8px;text-align:left;border-bottom:1px solid #ddd;"
    "vertical-align:top}@media print{body{margin:0;max-width:none}section{box-shadow:none;margin:0;break-after:page}"
    "section svg{max-width:none;height:revert-layer}}";

std::string range_csv(double value) { return std::isfinite(value) ? digits(value, 12) : ""; }

TableCell measured(double value, double low, double high, int digits_shown) {
    if (!std::isfinite(value)) return {"-", {"", "", ""}};
    const std::string text = std::isfinite(low) && std::isfinite(high)
                                 ? fmt::format("{} ({} to {})", significant(value, digits_shown), significant(low, digits_shown),
                                               significant(high, digits_shown))
                                 : significant(value, digits_shown);
    return {text, {range_csv(value), range_csv(low), range_csv(high)}};
}

/// The diameter: a value only if it is known; the interval in any case.
TableCell diameter_cell(const CatalogueDiameter& d) {
    if (d.name.empty()) return {"-", {"", "", ""}};
    if (d.known) return measured(d.value, d.low, d.high, 3);
    const std::string bound = std::isfinite(d.high)
                                  ? fmt::format("between {} and {}", significant(d.low, 3), significant(d.high, 3))
                                  : fmt::format("more than {}", significant(d.low, 3));
    return {"cannot be told: " + bound, {"", range_csv(d.low), range_csv(d.high)}};
}

}  // namespace

double catalogue_scale(const std::string& text) { return parse_print_scale(text); }

bool CatalogueStyle::section_right() const {
    return section == Section::right || (section == Section::automatic && convention == Convention::american);
}

void CatalogueStyle::declare_options(OptionList& list) {
    list("scale", scale,
         "scale of the drawings, such as 1:2; auto: the largest of 1:1, 1:2 and 1:3, or else a smaller one, that fits the page",
         Words{{"auto"}, "a scale such as 1:2", [](const std::string& word) {
                   if (word != "auto" && !(catalogue_scale(word) > 0))
                       fail_usage(fmt::format("--scale is '{}'", printable(word, 40)), "give a scale such as 1:2, or auto");
               }});
    list(
        "convention", convention,
        "drawing of vessels. english: section on the left, filled; continental: section on the left, in outline, open at breaks; "
        "american: section on the right, filled",
        Choices{"english", "continental", "american"});
    list("section", section, "side of the section; auto: by the convention", Choices{"auto", "left", "right"});
    list("paper", paper, "size of the pages", Choices{"a4", "a3", "letter"});
    list("several-per-page", several_per_page,
         "draw several objects on a page, all at one scale, instead of one page for each object");
    list("title", title, "title of the catalogue");
}

struct Catalogue::Content {
    std::vector<CatalogueEntry> entries;
    CatalogueStyle style;
    std::string source;
    Layout layout;
    std::size_t table_page = 0;  ///< index of the first page of the table

    void draw(Sheet& sheet, std::size_t index) const {
        layout.pages[index](sheet);
        const PageSize page = page_size(style.paper);
        const double margin_points = 15 * points_per_mm, y = page.points_high() - margin_points + 8;
        const std::string number = fmt::format("{} / {}", index + 1, layout.pages.size());
        sheet.text(number, page.points_wide() - margin_points, y, 1, 7, {110, 110, 110});
        const double room = page.points_wide() - 2 * margin_points - sheet.width_of(number, 7) - 12;
        sheet.text(sheet.fitted(style.title.empty() || style.several_per_page ? source : style.title + "; " + source, room, 6),
                   margin_points, y, 0, 6, {140, 140, 140});
    }

    [[nodiscard]] std::string svg(std::size_t index) const {
        const PageSize page = page_size(style.paper);
        Sheet sheet(page.points_wide(), page.points_high(), Sheet::Format::svg);
        draw(sheet, index);
        return in_millimetres(sheet.finish(), page);
    }
};

Catalogue::Catalogue(const std::vector<CatalogueEntry>& entries, const CatalogueStyle& style, std::string source)
    : content_(std::make_unique<Content>()) {
    content_->entries = entries;
    content_->style = style;
    content_->source = std::move(source);
    Layout& layout = content_->layout;
    if (style.several_per_page) add_sheets(layout, content_->entries, content_->style);
    else add_object_pages(layout, content_->entries, content_->style);
    content_->table_page = layout.pages.size();
    add_table_pages(layout, catalogue_table(content_->entries, layout.places), content_->style);
}
Catalogue::~Catalogue() = default;

std::size_t Catalogue::pages() const { return content_->layout.pages.size(); }
const std::vector<std::pair<std::size_t, std::string>>& Catalogue::places() const { return content_->layout.places; }

std::string Catalogue::pdf() const {
    const PageSize page = page_size(content_->style.paper);
    Sheet sheet(page.points_wide(), page.points_high(), Sheet::Format::pdf);
    for (std::size_t i = 0; i < pages(); ++i) {
        if (i > 0) sheet.next_page();
        content_->draw(sheet, i);
    }
    return sheet.finish();
}

std::string Catalogue::svg(std::size_t page) const {
    if (page < 1 || page > pages()) fail_usage(fmt::format("there is no page {}", page), "pages count from 1");
    return content_->svg(page - 1);
}

std::string Catalogue::html() const {
    const std::string title = content_->style.title.empty() ? "Catalogue" : content_->style.title;
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-Policy\" "
        "content=\"default-src 'none'; style-src 'unsafe-inline'; img-src data:\">\n<title>{0}</title>\n<style>{1}</style>\n"
        "</head>\n<body>\n<h1>{0}</h1>\n",
        escaped(title), page_style);
    const TextTable table = catalogue_table(content_->entries, places());
    std::string rows;
    for (const std::string& name : table.columns()) rows += "<th>" + escaped(name) + "</th>";
    rows = "<table id=\"table\">\n<tr>" + rows + "</tr>\n";
    for (std::size_t r = 0; r < table.size(); ++r) {
        rows += "<tr>";
        for (std::size_t c = 0; c < table.columns().size(); ++c) {
            const std::string text = escaped(table.rows()[r][c]);
            constexpr std::size_t name_column = 1;
            rows += "<td>" + (c == name_column ? fmt::format("<a href=\"#page-{}\">{}</a>", places()[r].first, text) : text) +
                    "</td>";
        }
        rows += "</tr>\n";
    }
    html += "<p><a href=\"#table\">Table of all objects</a></p>\n";
    // The pages of the table are in the PDF; here the table itself follows.
    for (std::size_t i = 0; i < content_->table_page; ++i)
        html += fmt::format("<section id=\"page-{}\">\n{}</section>\n", i + 1, for_page(content_->svg(i), i + 1));
    html += "<h2>Table of all objects</h2>\n" + rows + "</table>\n";
    return html + "<p>" + escaped(content_->source) + "</p>\n</body>\n</html>\n";
}

TextTable catalogue_table(const std::vector<CatalogueEntry>& entries,
                          const std::vector<std::pair<std::size_t, std::string>>& places) {
    const auto interval = [](const char* title, const std::string& name) {
        return TableColumn(title, {name, name + "_low", name + "_high"});
    };
    TextTable table({"no.",
                     "name",
                     "kind",
                     {"diameter of", {"diameter_of"}},
                     interval("diameter (mm)", "diameter_mm"),
                     TableColumn("preserved", {"preserved_share"}),
                     TableColumn("height (mm)", {"height_mm"}),
                     interval("wall (mm)", "wall_mm"),
                     TableColumn("capacity (l)", {"capacity_l"}),
                     TableColumn("weight (g)", {"weight_g"}),
                     "scale",
                     "page",
                     TableColumn("not known", {"not_known"})});
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const CatalogueEntry& entry = entries[i];
        const CatalogueDiameter& diameter = entry.diameter;
        const auto one = [](double value, int digits_shown) -> TableCell {
            return std::isfinite(value) ? TableCell(significant(value, digits_shown), {range_csv(value)}) : TableCell("-", {""});
        };
        std::string of = diameter.name.substr(0, diameter.name.find(" diameter"));
        const bool has_place = i < places.size() && places[i].first > 0;
        table.add(
            {std::to_string(i + 1), printable(entry.name, 200), to_string(entry.kind), of, diameter_cell(diameter),
             diameter.name.empty() ? TableCell("-", {""}) : TableCell(share_text(diameter.share), {range_csv(diameter.share)}),
             one(entry.height, 4), measured(entry.thickness, entry.thickness_low, entry.thickness_high, 2),
             one(entry.capacity, 3), one(entry.weight, 3), has_place ? places[i].second : "",
             has_place ? std::to_string(places[i].first) : "",
             entry.problem.empty() ? joined(entry.unknown, "; ") : printable(entry.problem, 300)});
    }
    return table;
}

}  // namespace ostraka

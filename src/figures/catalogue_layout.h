// Layout of the pages of a catalogue.
#pragma once

#include "figures/catalogue_drawing.h"

#include <functional>
#include <memory>

namespace ostraka::figures {

/// Size of a page in millimetres.
struct PageSize {
    double width = 210, height = 297;
    [[nodiscard]] double points_wide() const { return points_per_mm * width; }
    [[nodiscard]] double points_high() const { return points_per_mm * height; }
};
PageSize page_size(CatalogueStyle::Paper format);

/// A page: a function that draws it.
using PageDrawing = std::function<void(Sheet&)>;

/// Pages, and where each entry begins.
struct Layout {
    std::vector<PageDrawing> pages;
    std::vector<std::pair<std::size_t, std::string>> places;  ///< for each entry: first page, from 1; scale of its drawing
};

/// Adds a page for each entry (more if its texts need them). The entries and the style must outlive the layout.
void add_object_pages(Layout& layout, const std::vector<CatalogueEntry>& entries, const CatalogueStyle& style);
/// Adds pages with several drawings each, all at one scale.
void add_sheets(Layout& layout, const std::vector<CatalogueEntry>& entries, const CatalogueStyle& style);
/// Adds pages with the table of all entries.
void add_table_pages(Layout& layout, const TextTable& table, const CatalogueStyle& style);

/// The lines of a text, broken at blanks to fit a width.
std::vector<std::string> wrapped(Sheet& sheet, const std::string& text, double width, double size);

}  // namespace ostraka::figures

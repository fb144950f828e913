// Printed catalogues of objects: pages with drawings at a scale, and tables, as PDF, HTML or SVG.
#pragma once

#include "ostraka/catalogue/entry.h"
#include "ostraka/core/options.h"
#include "ostraka/figures/table.h"
#include "ostraka/files/file.h"

#include <memory>
#include <string>
#include <vector>

namespace ostraka {

/// How a catalogue is printed.
struct CatalogueStyle {
    /// Scale of the drawings, such as "1:2"; auto: the largest of 1:1, 1:2, 1:3, then smaller ones, that fits the page.
    std::string scale = "auto";
    /// Convention of the drawings of vessels. english: section on the left, filled; continental: section on the left, in outline,
    /// open at breaks; american: section on the right, filled.
    enum class Convention { english, continental, american } convention = Convention::english;
    enum class Section {
        automatic,
        left,
        right
    } section = Section::automatic;                         ///< side of the section; automatic: by convention
    enum class Paper { a4, a3, letter } paper = Paper::a4;  ///< size of the pages, upright
    bool several_per_page = false;  ///< several objects a page, all at one scale, instead of one page for each
    std::string title;              ///< title of the catalogue

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
    /// True if drawings have the section on the right.
    [[nodiscard]] bool section_right() const;
};

/// Paper lengths per length of the object: "1:2" is 0.5. Throws Error (usage) unless the text is two positive numbers separated
/// by a colon.
double catalogue_scale(const std::string& text);

/// A catalogue as files in memory. Pages have their exact size; lengths on the page are those of the object times the scale
/// printed beside each drawing.
class Catalogue {
public:
    /// `source`: a line on the origin of the catalogue (its provenance), printed at the foot of the pages.
    Catalogue(const std::vector<CatalogueEntry>& entries, const CatalogueStyle& style, std::string source);
    ~Catalogue();
    Catalogue(const Catalogue&) = delete;
    Catalogue& operator=(const Catalogue&) = delete;

    [[nodiscard]] std::size_t pages() const;  ///< number of pages
    /// For each entry: the page on which it begins, from 1; and its scale ("1:2"; empty: nothing is drawn).
    [[nodiscard]] const std::vector<std::pair<std::size_t, std::string>>& places() const;
    [[nodiscard]] std::string pdf() const;                  ///< all pages as one PDF document
    [[nodiscard]] std::string html() const;                 ///< one self-contained HTML file with the pages as SVG, and the table
    [[nodiscard]] std::string svg(std::size_t page) const;  ///< one page as SVG, in millimetres; pages count from 1

private:
    struct Content;
    std::unique_ptr<Content> content_;
};

/// Writes the drawing of a vessel or sherd alone as SVG, PDF or PNG (by the extension of the file), with its dimensions and a
/// scale bar; a sheet in SVG or PDF has the stated scale. Throws Error (usage) for an entry without a drawing about an axis, or a
/// scale at which the drawing is larger than a sheet of A3.
void write_pottery_drawing(const Path& file, const CatalogueEntry& entry, const CatalogueStyle& style);

/// Table of all entries, one row each: measures with their intervals, and what is unknown. `places`: as `Catalogue::places`.
TextTable catalogue_table(const std::vector<CatalogueEntry>& entries,
                          const std::vector<std::pair<std::size_t, std::string>>& places);

}  // namespace ostraka

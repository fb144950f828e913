// Remarks that `ostraka slice` adds to its tables.
#include "operations/slice_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// "3 of 50 slices, at height 1.5 to 1.7, 3, ": the slices for which `holds` is true; empty if there are none.
template <class Holds>
std::string slices_where(const std::vector<Slice>& slices, const Holds& holds) {
    std::size_t count = 0, runs = 0;
    std::string heights_text;
    for (std::size_t i = 0; i < slices.size(); ++i) {
        if (!holds(slices[i])) continue;
        const std::size_t first = i;
        while (i + 1 < slices.size() && holds(slices[i + 1])) ++i;
        count += i - first + 1;
        if (++runs > 3) continue;
        heights_text += fmt::format("{}{}{}", heights_text.empty() ? "" : ", ", number(slices[first].height),
                                    i > first ? " to " + number(slices[i].height) : "");
    }
    if (count == 0) return {};
    if (runs > 3) heights_text += " and others";
    return fmt::format("{} of {} slices, at height {}, ", count, slices.size(), heights_text);
}

bool slice_has_holes_only(const Slice& slice) {
    return !slice.contours.empty() && slice.contours[0].hole &&
           std::all_of(slice.contours.begin(), slice.contours.end(),
                       [](const Contour& c) { return !c.closed || (c.hole && c.parent < 0); });
}

void add_slice_soundness(std::vector<std::string>& remarks, const SlicedObject& cut) {
    const auto add = [&](const auto& holds, const char* problem) {
        if (const std::string affected = slices_where(cut.slices, holds); !affected.empty())
            remarks.push_back(affected + problem);
    };
    add([](const Slice& s) { return !s.completeness.has_areas(); },
        "have contours that cross: parts of the mesh pass through each other there, so that areas and values derived from them "
        "are left empty (ostraka mesh repair --wrap makes one surface of them)");
    add([](const Slice& s) { return s.completeness.crossing > 0 && s.completeness.has_areas(); },
        "have contours that cross by less than a thousandth of their area: their descriptors are reported");
    add([](const Slice& s) { return s.completeness.reversed_contours > 0; },
        "have contours whose orientation contradicts their nesting, such as a wrongly oriented cavity or part: their nesting is "
        "used");
    add(slice_has_holes_only, "have holes only, without an outer contour: the mesh is inside out, or its outside is missing");
    if (cut.reversed) remarks.emplace_back("the mesh is inside out: contours were reversed (ostraka mesh repair corrects it)");
}

}  // namespace

std::vector<std::string> slice_remarks(const SlicedObject& cut, bool one_plane) {
    std::size_t met = 0, closed = 0, open = 0;
    for (const auto& slice : cut.slices) {
        met += slice.contours.empty() ? 0 : 1;
        closed += !slice.contours.empty() && slice.contours[0].closed ? 1 : 0;
        open += slice.completeness.complete() ? 0 : 1;
    }
    std::vector<std::string> remarks;
    const std::size_t total = cut.slices.size();
    const std::string range = fmt::format(" go from {} to {}", number(cut.lowest), number(cut.highest));
    if (met == 0 && one_plane) remarks.push_back("the plane misses the mesh, whose heights above it" + range);
    else if (met == 0 && !(cut.lowest < cut.highest))
        remarks.emplace_back("no plane meets the mesh: it is flat across this direction; give another --direction");
    else if (met == 0) remarks.push_back("no plane meets the mesh: its heights" + range);
    else if (met < cut.slices.size())
        remarks.push_back(fmt::format("{} of {} planes miss the mesh, whose heights{}", cut.slices.size() - met, total, range));
    if (met > 0 && closed == 0)
        remarks.emplace_back(
            "no slice has a closed contour: areas, and values derived from them, are absent (is the mesh an open scan?)");
    else if (open > 0)
        remarks.push_back(
            fmt::format("{} of {} slices have open contours; their descriptors describe the closed ones only", open, total));
    std::size_t undetermined = 0, arcs = 0;
    for (const auto& slice : cut.slices) {
        if (slice.completeness.complete()) continue;
        (std::isfinite(slice.completeness.share) ? arcs : undetermined) += 1;
    }
    if (arcs > 0)
        remarks.push_back(
            fmt::format("{} of {} slices are open arcs of a circle: complete % is the part of the circle that they show (95 % "
                        "interval), if the missing part is round as well",
                        arcs, total));
    if (undetermined > 0)
        remarks.push_back(
            fmt::format("{} of {} slices have open contours that are not arcs of one circle: how much of their outline is "
                        "missing cannot be determined (complete % is an upper bound)",
                        undetermined, total));
    add_slice_soundness(remarks, cut);
    return remarks;
}

}  // namespace ostraka

// Remarks that `ostraka slice` adds to its tables.
#include "slice_report.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// "3 of 50 slices, at height 1.5 to 1.7, 3, ": the slices for which `holds` is true; empty if there are none.
template <class Holds>
std::string slices_where(const std::vector<Slice>& slices, const Holds& holds) {
    std::size_t count = 0, runs = 0;
    std::string places;
    for (std::size_t i = 0; i < slices.size(); ++i) {
        if (!holds(slices[i])) continue;
        const std::size_t first = i;
        while (i + 1 < slices.size() && holds(slices[i + 1])) ++i;
        count += i - first + 1;
        if (++runs > 3) continue;
        places +=
            (places.empty() ? "" : ", ") + number(slices[first].height) + (i > first ? " to " + number(slices[i].height) : "");
    }
    if (count == 0) return {};
    if (runs > 3) places += " and others";
    return std::to_string(count) + " of " + std::to_string(slices.size()) + " slices, at height " + places + ", ";
}

bool slice_has_holes_only(const Slice& slice) {
    return !slice.contours.empty() && slice.contours[0].hole &&
           std::all_of(slice.contours.begin(), slice.contours.end(),
                       [](const Contour& c) { return !c.closed || (c.hole && c.parent < 0); });
}

void add_slice_soundness(std::vector<std::string>& list, const CutObject& cut) {
    const auto add = [&](const auto& holds, const char* what) {
        if (const std::string which = slices_where(cut.slices, holds); !which.empty()) list.push_back(which + what);
    };
    add([](const Slice& s) { return !s.completeness.has_areas(); },
        "have contours that cross: parts of the mesh pass through each other there, so that areas and what is made of them are "
        "left empty (ostraka mesh repair --wrap makes one surface of them)");
    add([](const Slice& s) { return s.completeness.crossing > 0 && s.completeness.has_areas(); },
        "have contours that cross by less than a thousandth of their area: their descriptors stand");
    add([](const Slice& s) { return s.completeness.turned > 0; },
        "have contours that ran against their nesting, as a cavity or a part does that is oriented wrongly: they are read by "
        "their nesting");
    add(slice_has_holes_only, "have holes only, without an outer contour: the mesh is inside out, or its outside is missing");
    if (cut.reversed) list.emplace_back("the mesh is inside out: contours were turned around (ostraka mesh repair mends it)");
}

}  // namespace

std::vector<std::string> slice_remarks(const CutObject& cut, bool one_plane) {
    std::size_t met = 0, closed = 0, open = 0;
    for (const auto& slice : cut.slices) {
        met += slice.contours.empty() ? 0 : 1;
        closed += !slice.contours.empty() && slice.contours[0].closed ? 1 : 0;
        open += slice.completeness.complete() ? 0 : 1;
    }
    std::vector<std::string> list;
    const std::string all = std::to_string(cut.slices.size());
    const std::string range = " go from " + number(cut.lowest) + " to " + number(cut.highest);
    if (met == 0 && one_plane) list.push_back("the plane misses the mesh, whose heights over it" + range);
    else if (met == 0 && !(cut.lowest < cut.highest))
        list.emplace_back("no plane meets the mesh: it is flat across this direction; give another --direction");
    else if (met == 0) list.push_back("no plane meets the mesh: its heights" + range);
    else if (met < cut.slices.size())
        list.push_back(std::to_string(cut.slices.size() - met) + " of " + all + " planes miss the mesh, whose heights" + range);
    if (met > 0 && closed == 0)
        list.emplace_back(
            "no slice has a closed contour: areas, and what is made of them, are absent (is the mesh an open scan?)");
    else if (open > 0)
        list.push_back(std::to_string(open) + " of " + all +
                       " slices have open contours; their descriptors are of the closed ones only");
    std::size_t untold = 0, arcs = 0;
    for (const auto& slice : cut.slices) {
        if (slice.completeness.complete()) continue;
        (std::isfinite(slice.completeness.share) ? arcs : untold) += 1;
    }
    if (arcs > 0)
        list.push_back(std::to_string(arcs) + " of " + all +
                       " slices are open arcs of a circle: complete % is what they show of its turn (95 % interval), if what is "
                       "not there is round as well");
    if (untold > 0)
        list.push_back(std::to_string(untold) + " of " + all +
                       " slices have open contours that are no arcs of one circle: how much of their outline is missing cannot "
                       "be told (complete %: at most as said)");
    add_slice_soundness(list, cut);
    return list;
}

}  // namespace ostraka

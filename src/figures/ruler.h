// An axis of a plot: its range, ticks, and positions on the sheet.
#pragma once

#include "ostraka/figures/plot.h"

#include <string>
#include <vector>

namespace ostraka::figures {

struct Tick {
    double value;
    std::string text;
};

/// Whether a value can be shown on the axis.
bool has_place(const PlotAxis& axis, double value);

/// One axis with its range, along the sheet from `low` to `high`.
class Ruler {
public:
    /// coordinate 0: x; 1: y. Throws Error (input) if no point can be shown.
    Ruler(const Plot& plot, std::size_t coordinate);

    void stretch_over(double low, double high) { low_ = low, high_ = high; }
    [[nodiscard]] double pixel(double value) const {
        return low_ + (place(value) - minimum_) / (maximum_ - minimum_) * (high_ - low_);
    }
    [[nodiscard]] std::vector<Tick> ticks() const;
    [[nodiscard]] bool inside(double value) const { return place(value) >= minimum_ && place(value) <= maximum_; }
    /// Value at the lower end.
    [[nodiscard]] double lowest() const;
    [[nodiscard]] double extent() const { return maximum_ - minimum_; }
    /// Sets the width of the range to `extent`, keeping its midpoint.
    void widen(double extent);

private:
    [[nodiscard]] double place(double value) const;
    void include(double value);
    [[nodiscard]] std::vector<Tick> even_ticks() const;

    const PlotAxis* axis_;
    bool logarithmic_;
    double minimum_, maximum_;  ///< on the scale of the axis: values, or their logarithms
    double low_ = 0, high_ = 1;
};

}  // namespace ostraka::figures

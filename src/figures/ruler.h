// An axis of a plot: range, ticks, and positions on the sheet.
#pragma once

#include "ostraka/figures/plot.h"

#include <string>
#include <vector>

namespace ostraka::figures {

/// A tick of an axis.
struct Tick {
    double value;      ///< value at the tick
    std::string text;  ///< label of the tick
};

/// True if a value can be shown on the axis (finite, and positive on a logarithmic axis).
bool has_place(const PlotAxis& axis, double value);

/// One axis of a plot: maps values to positions on the sheet between `low` and `high`.
class Ruler {
public:
    /// Finds the range of an axis; `coordinate`: 0 for x, 1 for y. Throws Error (input) if no point can be shown.
    Ruler(const Plot& plot, std::size_t coordinate);

    /// Sets the positions on the sheet of the two ends of the range.
    void stretch_over(double low, double high) { low_ = low, high_ = high; }
    /// Position of a value on the sheet.
    [[nodiscard]] double pixel(double value) const {
        return low_ + (place(value) - minimum_) / (maximum_ - minimum_) * (high_ - low_);
    }
    [[nodiscard]] std::vector<Tick> ticks() const;  ///< ticks at round values in the range
    /// True if the value lies in the range.
    [[nodiscard]] bool inside(double value) const { return place(value) >= minimum_ && place(value) <= maximum_; }
    /// Value at the lower end of the range.
    [[nodiscard]] double lowest() const;
    /// Length of the range; for a logarithmic axis, of logarithms.
    [[nodiscard]] double extent() const { return maximum_ - minimum_; }
    /// Sets the width of the range to `extent`, keeping its midpoint.
    void widen(double extent);

private:
    [[nodiscard]] double place(double value) const;
    void include(double value);
    [[nodiscard]] std::vector<Tick> even_ticks() const;

    const PlotAxis* axis_;
    bool logarithmic_;
    double minimum_, maximum_;  ///< ends of the range: values, or logarithms of values for a logarithmic axis
    double low_ = 0, high_ = 1;
};

}  // namespace ostraka::figures

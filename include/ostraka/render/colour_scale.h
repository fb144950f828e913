// Colours for numbers.
#pragma once

#include "ostraka/render/picture.h"

#include <string>
#include <vector>

namespace ostraka {

/// Maps [minimum, maximum] to colours whose lightness grows evenly (blue to yellow), or, if diverging, whose lightness falls
/// to both sides of the middle (blue, white, red). Values beyond the ends take the end's colour.
struct ColourScale {
    double minimum = 0, maximum = 1;
    bool diverging = false;
    std::string label;  ///< what the numbers are, with their unit
};

/// A scale over the finite ones of the values; values of both signs give a diverging one, symmetric about zero.
/// Throws Error (input) naming `where` if no value is finite.
ColourScale scale_of(const std::vector<const std::vector<double>*>& values, const std::string& where);

/// The colour of a value; a neutral grey for values that are not numbers.
Rgb colour_of(const ColourScale& scale, double value);

/// Colours for things without an order. The first `category_hues` are Paul Tol's muted scheme with a lighter indigo, which
/// colour-blind readers can tell apart, in an order that puts the most different ones first; then come lighter and darker ones of
/// the same hues in turn, and after `category_count` all again.
Rgb category_colour(std::size_t index);
inline constexpr std::size_t category_hues = 9, category_count = 63;

/// The largest of 1, 2 and 5 times a power of ten that is not above `length`; 0 unless length is positive and finite.
double round_length(double length);

/// Multiples of a round step within the scale, at most `count` or so, ascending.
std::vector<double> ticks(const ColourScale& scale, int count);

/// A number for a label: as few digits as tell it from its neighbours a step away.
std::string tick_text(double value, double step);

}  // namespace ostraka

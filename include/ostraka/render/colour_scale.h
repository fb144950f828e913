// Colour scales for numbers.
#pragma once

#include "ostraka/render/picture.h"

#include <string>
#include <vector>

namespace ostraka {

/// Maps [minimum, maximum] to colours of uniformly increasing lightness (blue to yellow) or, if diverging, of lightness that
/// decreases to both sides of the middle (blue, white, red). Values outside the range take the colour of the nearest end.
struct ColourScale {
    double minimum = 0, maximum = 1;
    bool diverging = false;
    std::string label;  ///< name of the quantity, with its unit
};

/// A scale over the finite values; values of both signs give a diverging scale, symmetric about zero. Throws Error (input)
/// naming `where` if no value is finite.
ColourScale scale_of(const std::vector<const std::vector<double>*>& values, const std::string& where);

/// The colour of a value; a neutral grey for NaN.
Rgb colour_of(const ColourScale& scale, double value);

/// Colours for categories. The first `category_hues` are Paul Tol's muted scheme with a lighter indigo, distinguishable for
/// colour-blind readers, ordered so that the most different colours come first. Lighter and darker shades of the same hues
/// follow in turn; after `category_count` the colours repeat.
Rgb category_colour(std::size_t index);
inline constexpr std::size_t category_hues = 9, category_count = 63;

/// The largest number of the form 1, 2 or 5 times a power of ten that is at most `length`; 0 unless length is positive and
/// finite.
double round_length(double length);

/// Multiples of a round step within the scale, about `count` at most, ascending.
std::vector<double> ticks(const ColourScale& scale, int count);

/// Text of a tick label, with the minimum number of digits that distinguishes it from its neighbours a step away.
std::string tick_text(double value, double step);

}  // namespace ostraka

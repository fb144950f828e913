// Colour scales for numbers.
#pragma once

#include "ostraka/render/picture.h"

#include <string>
#include <vector>

namespace ostraka {

/// Maps values in [minimum, maximum] to colours of uniformly increasing lightness (blue to yellow) or, if diverging, of lightness
/// that decreases from the middle to both ends (blue, white, red). Values outside the range take the colour of the nearest end.
struct ColourScale {
    double minimum = 0, maximum = 1;  ///< values at the ends of the scale
    bool diverging = false;           ///< true: two hues diverge from a light colour at the middle of the scale
    std::string label;                ///< name of the quantity, with its unit
};

/// A colour scale over the range of the finite values; if there are negative and positive values, the scale is diverging and
/// symmetric about zero. Throws Error (input) naming `where` if no value is finite.
ColourScale scale_of(const std::vector<const std::vector<double>*>& values, const std::string& where);

/// The colour of a value on the scale; a neutral grey for NaN.
Rgb colour_of(const ColourScale& scale, double value);

/// Colour of a category. The first `category_hues` colours are Paul Tol's muted scheme with a lighter indigo, distinguishable for
/// colour-blind readers, ordered so that the most different colours come first. Lighter and darker shades of the same hues follow
/// in turn; after `category_count` categories the colours repeat.
Rgb category_colour(std::size_t index);
/// Number of different hues, and number of different colours.
inline constexpr std::size_t category_hues = 9, category_count = 63;

/// The largest number of the form 1, 2 or 5 times a power of ten that is at most `length`; 0 unless `length` is positive and
/// finite.
double round_length(double length);

/// Positions of ticks on the scale: multiples of a round step, at most about `count`, ascending.
std::vector<double> ticks(const ColourScale& scale, int count);

/// Text of a tick label, with the smallest number of digits that distinguishes it from the neighbouring labels (`step`:
/// distance of the ticks).
std::string tick_text(double value, double step);

}  // namespace ostraka

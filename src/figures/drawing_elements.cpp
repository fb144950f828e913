#include "figures/drawing_elements.h"

#include "ostraka/figures/table.h"
#include "ostraka/render/colour_scale.h"

namespace ostraka::figures {

std::vector<std::array<double, 2>> Placing::operator()(const std::vector<Eigen::Vector2d>& points, bool closed) const {
    std::vector<std::array<double, 2>> places;
    for (const auto& p : points) places.push_back((*this)(p));
    if (closed && !places.empty()) places.push_back(places.front());
    return places;
}

std::string length_text(double value, const std::string& unit) {
    return significant(value, 4) + (unit.empty() ? "" : " " + unit);
}

void scale_bar(Sheet& sheet, double x, double y, double scale, double maximum, const std::string& unit) {
    const double length = round_length(maximum / scale);
    if (!(length > 0)) return;
    const std::string digits = significant(length, 3);
    const int parts = digits.find('2') != std::string::npos ? 4 : 5;
    for (int k = 0; k < parts; ++k) {
        const double left = x + scale * length * k / parts, right = x + scale * length * (k + 1) / parts;
        if (k % 2 == 0) sheet.rectangle({left, y, right, y + 4}, ink);
    }
    sheet.frame({x, y, x + scale * length, y + 4}, ink, 0.6);
    sheet.text("0", x, y - 4, 0.5, 9);
    sheet.text(digits + (unit.empty() ? (digits == "1" ? " unit" : " units") : " " + unit), x + scale * length, y - 4, 0.5, 9);
}

void open_contours(Sheet& sheet, const Slice& slice, const Placing& placing) {
    for (const auto& contour : slice.contours) {
        if (contour.closed) continue;
        sheet.polyline(placing(contour.points, false), torn, false, 1.2);
        for (const auto* end : {&contour.points.front(), &contour.points.back()}) {
            const auto [x, y] = placing(*end);
            sheet.dot(x, y, torn, 1.8);
        }
    }
}

}  // namespace ostraka::figures

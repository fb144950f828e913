#include "figures/sheet.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/render/colour_scale.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <cmath>
#include <cstring>

namespace ostraka::figures {

namespace {

constexpr double png_scale = 2;

constexpr std::array<Rgb, 7> colours{
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {86, 180, 233}, {230, 159, 0}, {60, 60, 60}}};

cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
    static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
}

/// Makes text drawable: damaged characters become U+FFFD, control characters become blanks.
std::string drawable(const std::string& words) {
    std::string result;
    for (std::size_t at = 0; at < words.size();) {
        const Character character = character_at(words, at);
        if (is_control(character.code)) result += ' ';
        else if (character.code == 0xfffd) result += "\xef\xbf\xbd";
        else result.append(words, at, character.length);
        at += character.length;
    }
    return result;
}

}  // namespace

Rgb series_colour(std::size_t index) { return index < colours.size() ? colours[index] : category_colour(index); }

Rgb lighter(const Rgb& colour, double fraction) {
    const auto mix = [&](std::uint8_t part) { return static_cast<std::uint8_t>(std::lround(part + fraction * (255 - part))); };
    return {mix(colour.red), mix(colour.green), mix(colour.blue)};
}

Sheet::Sheet(double width, double height, Format format)
    : format_(format),
      width_(width),
      height_(height),
      surface_(format == Format::svg ? cairo_svg_surface_create_for_stream(&append, &bytes_, width, height)
               : format == Format::pdf
                   ? cairo_pdf_surface_create_for_stream(&append, &bytes_, width, height)
                   : cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::ceil(png_scale * width)),
                                                static_cast<int>(std::ceil(png_scale * height))),
               &cairo_surface_destroy),
      context_(cairo_create(surface_.get()), &cairo_destroy) {
    if (format == Format::pdf) cairo_pdf_surface_set_metadata(surface_.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
    if (format == Format::png) cairo_scale(context_.get(), png_scale, png_scale);
    cairo_select_font_face(context_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_font_options_t* font = cairo_font_options_create();
    cairo_font_options_set_antialias(font, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(font, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(font, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(context_.get(), font);
    cairo_font_options_destroy(font);
    cairo_set_line_join(context_.get(), CAIRO_LINE_JOIN_ROUND);
    set(paper);
    cairo_paint(context_.get());
}

Sheet::~Sheet() = default;

void Sheet::set(const Rgb& colour) {
    cairo_set_source_rgb(context_.get(), colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0);
}

void Sheet::stroke(const Rgb& colour, double width, bool dashed) {
    const double dash[] = {7, 4};
    cairo_set_dash(context_.get(), dash, dashed ? 2 : 0, 0);
    set(colour);
    cairo_set_line_width(context_.get(), width);
    cairo_stroke(context_.get());
}

void Sheet::line(double x1, double y1, double x2, double y2, const Rgb& colour, double width, bool dashed) {
    cairo_move_to(context_.get(), x1, y1);
    cairo_line_to(context_.get(), x2, y2);
    stroke(colour, width, dashed);
}

void Sheet::polyline(const std::vector<std::array<double, 2>>& places, const Rgb& colour, bool dashed, double width) {
    for (std::size_t i = 0; i < places.size(); ++i)
        (i == 0 ? cairo_move_to : cairo_line_to)(context_.get(), places[i][0], places[i][1]);
    stroke(colour, width, dashed);
}

void Sheet::fill(const std::vector<std::vector<std::array<double, 2>>>& curves, const Rgb& colour) {
    for (const auto& curve : curves) {
        for (std::size_t i = 0; i < curve.size(); ++i)
            (i == 0 ? cairo_move_to : cairo_line_to)(context_.get(), curve[i][0], curve[i][1]);
        cairo_close_path(context_.get());
    }
    cairo_set_fill_rule(context_.get(), CAIRO_FILL_RULE_EVEN_ODD);
    set(colour);
    cairo_fill(context_.get());
}

void Sheet::rectangle(const Box& box, const Rgb& colour) {
    cairo_rectangle(context_.get(), box.left, box.top, box.right - box.left, box.bottom - box.top);
    set(colour);
    cairo_fill(context_.get());
}

void Sheet::frame(const Box& box, const Rgb& colour, double width) {
    cairo_rectangle(context_.get(), box.left, box.top, box.right - box.left, box.bottom - box.top);
    stroke(colour, width, false);
}

void Sheet::image(const Picture& picture, const Box& box) {
    if (picture.width < 1 || picture.height < 1) return;
    const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> pixels(
        cairo_image_surface_create(CAIRO_FORMAT_ARGB32, picture.width, picture.height), &cairo_surface_destroy);
    unsigned char* rows = cairo_image_surface_get_data(pixels.get());
    if (rows == nullptr) throw Error(ErrorKind::failure, "plot", "there is no memory for a picture");
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(pixels.get()));
    const auto columns = static_cast<std::size_t>(picture.width);
    for (std::size_t row = 0; row < static_cast<std::size_t>(picture.height); ++row)
        std::memcpy(rows + row * stride, picture.argb.data() + row * columns, 4 * columns);
    cairo_surface_mark_dirty(pixels.get());
    cairo_save(context_.get());
    cairo_translate(context_.get(), box.left, box.top);
    cairo_scale(context_.get(), (box.right - box.left) / picture.width, (box.bottom - box.top) / picture.height);
    cairo_set_source_surface(context_.get(), pixels.get(), 0, 0);
    cairo_paint(context_.get());
    cairo_restore(context_.get());
}

void Sheet::dot(double x, double y, const Rgb& colour, double radius) {
    cairo_new_path(context_.get());
    cairo_arc(context_.get(), x, y, radius, 0, 2 * pi);
    set(colour);
    cairo_fill(context_.get());
}

void Sheet::mark(double x, double y, std::size_t form, const Rgb& colour) {
    switch (form % 6) {
        case 0:
            dot(x, y, colour, 3.6);
            break;
        case 1:
            rectangle({x - 3.2, y - 3.2, x + 3.2, y + 3.2}, colour);
            break;
        case 2:
            fill({{{x, y - 4.4}, {x + 4.2, y + 3}, {x - 4.2, y + 3}}}, colour);
            break;
        case 3:
            fill({{{x, y - 4.6}, {x + 4.6, y}, {x, y + 4.6}, {x - 4.6, y}}}, colour);
            break;
        case 4:
            line(x - 3.2, y - 3.2, x + 3.2, y + 3.2, colour, 2);
            line(x - 3.2, y + 3.2, x + 3.2, y - 3.2, colour, 2);
            break;
        default:
            cairo_new_path(context_.get());
            cairo_arc(context_.get(), x, y, 3.2, 0, 2 * pi);
            stroke(colour, 1.8, false);
    }
}

double Sheet::width_of(const std::string& words, double size) {
    cairo_text_extents_t extents;
    cairo_set_font_size(context_.get(), size);
    cairo_text_extents(context_.get(), drawable(words).c_str(), &extents);
    return extents.x_advance;
}

void Sheet::text(const std::string& words, double x, double y, double anchor, double size, const Rgb& colour) {
    const double left = x - anchor * width_of(words, size);
    cairo_move_to(context_.get(), left, y);
    set(colour);
    cairo_show_text(context_.get(), drawable(words).c_str());
}

void Sheet::upward_text(const std::string& words, double x, double y, double anchor, double size) {
    cairo_save(context_.get());
    cairo_translate(context_.get(), x, y);
    cairo_rotate(context_.get(), -pi / 2);
    text(words, 0, 0, anchor, size);
    cairo_restore(context_.get());
}

std::string Sheet::fitted(const std::string& words, double width, double size) {
    std::string remaining = drawable(words);
    if (width_of(remaining, size) <= width) return remaining;
    while (!remaining.empty()) {
        std::size_t last = remaining.size() - 1;
        while (last > 0 && (static_cast<unsigned char>(remaining[last]) & 0xc0) == 0x80) --last;
        remaining.resize(last);
        if (width_of(remaining + "\u2026", size) <= width) break;
    }
    return remaining + "\u2026";
}

void Sheet::clip(const Box& box) {
    cairo_save(context_.get());
    cairo_rectangle(context_.get(), box.left, box.top, box.right - box.left, box.bottom - box.top);
    cairo_clip(context_.get());
}

void Sheet::unclip() { cairo_restore(context_.get()); }

std::string Sheet::finish() {
    const cairo_status_t drawn = cairo_status(context_.get());
    cairo_status_t written = CAIRO_STATUS_SUCCESS;
    if (format_ == Format::png) written = cairo_surface_write_to_png_stream(surface_.get(), &append, &bytes_);
    cairo_surface_finish(surface_.get());
    for (const cairo_status_t status : {drawn, written, cairo_surface_status(surface_.get())})
        if (status != CAIRO_STATUS_SUCCESS && status != CAIRO_STATUS_SURFACE_FINISHED)
            throw Error(ErrorKind::failure, "plot", std::string("drawing failed: ") + cairo_status_to_string(status));
    return format_ == Format::svg ? stable_svg(bytes_) : std::move(bytes_);
}

void write_sheet(const Path& file, const std::function<std::string(Sheet::Format)>& draw) {
    const std::string ending = extension(file);
    if (ending != ".svg" && ending != ".png" && ending != ".pdf")
        throw Error(ErrorKind::usage, file.string(), "drawings are written as SVG, PDF or PNG",
                    "use a file name that ends in .svg, .pdf or .png");
    make_folder(file.parent_path());
    write_file(file, draw(ending == ".png" ? Sheet::Format::png : ending == ".pdf" ? Sheet::Format::pdf : Sheet::Format::svg));
}

}  // namespace ostraka::figures

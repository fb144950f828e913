#include "render/canvas.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <cstring>

#if defined(__SANITIZE_ADDRESS__)
// Fontconfig keeps some hundred bytes of settings allocated until exit; this is not our leak.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig\n"; }
extern "C" const char* __lsan_default_options();
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
#endif

namespace ostraka::detail {

namespace {
bool invisible(char32_t code) {
    return code < 0x20 || (code >= 0x7F && code < 0xA0) || (code >= 0x200B && code <= 0x200F) ||
           (code >= 0x2028 && code <= 0x202E) || (code >= 0x2060 && code <= 0x206F) || code == 0xFEFF;
}
}  // namespace

std::string clean_text(const std::string& text) {
    std::string clean;
    for (std::size_t i = 0; i < text.size();) {
        const Character character = character_at(text, i);
        if (character.code == 0xFFFD) clean += "\xEF\xBF\xBD";
        else if (character.code == '\t' || character.code == '\n') clean += ' ';
        else if (!invisible(character.code)) clean.append(text, i, character.length);
        i += character.length;
    }
    return clean;
}

cairo_status_t append_bytes(void* bytes, const unsigned char* data, unsigned int length) {
    try {
        static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
    } catch (const std::bad_alloc&) {
        return CAIRO_STATUS_NO_MEMORY;
    }
    return CAIRO_STATUS_SUCCESS;
}

namespace {

cairo_surface_t* surface_of(PictureKind kind, int width, int height, std::string* bytes, double dpi) {
    const double points = 72.0 / dpi;
    if (kind == PictureKind::svg) {
        if (dpi == css_dpi) {
            cairo_surface_t* surface = cairo_svg_surface_create_for_stream(&append_bytes, bytes, width, height);
            cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PX);
            return surface;
        }
        cairo_surface_t* surface = cairo_svg_surface_create_for_stream(&append_bytes, bytes, points * width, points * height);
        cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PT);
        cairo_surface_set_device_scale(surface, points, points);
        return surface;
    }
    if (kind == PictureKind::pdf) {
        cairo_surface_t* surface = cairo_pdf_surface_create_for_stream(&append_bytes, bytes, points * width, points * height);
        cairo_surface_set_device_scale(surface, points, points);
        cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "");  // makes the output reproducible
        return surface;
    }
    return cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height);
}

}  // namespace

Canvas::Canvas(int width, int height, PictureKind kind, double dpi)
    : kind_(kind),
      bytes_(std::make_unique<std::string>()),
      surface_(surface_of(kind, width, height, bytes_.get(), dpi), &cairo_surface_destroy),
      context_(cairo_create(surface_.get()), &cairo_destroy) {
    check();
    cairo_t* context = context_.get();
    cairo_select_font_face(context, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_font_options_t* font = cairo_font_options_create();
    cairo_font_options_set_antialias(font, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(font, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(font, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(context, font);
    cairo_font_options_destroy(font);
    cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(context, CAIRO_LINE_CAP_ROUND);
}

void Canvas::check() const {
    auto status = cairo_surface_status(surface_.get());
    if (status == CAIRO_STATUS_SUCCESS) status = cairo_status(context_.get());
    if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
    if (status != CAIRO_STATUS_SUCCESS)
        throw Error(ErrorKind::failure, "picture", std::string("drawing failed: ") + cairo_status_to_string(status));
}

void Canvas::colour(const Rgb& value) {
    cairo_set_source_rgb(context_.get(), value.red / 255.0, value.green / 255.0, value.blue / 255.0);
}

void Canvas::fill(const Rgb& value) {
    colour(value);
    cairo_paint(context_.get());
}

void Canvas::paint(const std::vector<std::uint32_t>& pixels, int columns, int rows, int left, int top, int width, int height) {
    const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> image(
        cairo_image_surface_create(CAIRO_FORMAT_ARGB32, columns, rows), &cairo_surface_destroy);
    if (cairo_surface_status(image.get()) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
    unsigned char* data = cairo_image_surface_get_data(image.get());
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(image.get()));
    const auto length = static_cast<std::size_t>(columns);
    for (std::size_t row = 0; row < static_cast<std::size_t>(rows); ++row)
        std::memcpy(data + row * stride, pixels.data() + row * length, length * sizeof(std::uint32_t));
    cairo_surface_mark_dirty(image.get());
    cairo_save(context_.get());
    cairo_translate(context_.get(), left, top);
    if (columns != width || rows != height) cairo_scale(context_.get(), double(width) / columns, double(height) / rows);
    cairo_set_source_surface(context_.get(), image.get(), 0, 0);
    cairo_paint(context_.get());
    cairo_restore(context_.get());
}

void Canvas::clip(double left, double top, double width, double height) {
    cairo_save(context_.get());
    cairo_rectangle(context_.get(), left, top, width, height);
    cairo_clip(context_.get());
}

void Canvas::unclip() { cairo_restore(context_.get()); }

void Canvas::trace(const std::vector<Place>& places) {
    cairo_new_path(context_.get());
    cairo_move_to(context_.get(), places.front().x, places.front().y);
    for (const Place& place : places) cairo_line_to(context_.get(), place.x, place.y);
}

void Canvas::polyline(const std::vector<Place>& places, const Rgb& value, double width) {
    if (places.empty()) return;
    trace(places);
    colour(value);
    cairo_set_line_width(context_.get(), width);
    cairo_stroke(context_.get());
}

void Canvas::dashed(const std::vector<Place>& places, const Rgb& value, double width) {
    const double dashes[] = {3 * width, 3 * width};
    cairo_set_dash(context_.get(), dashes, 2, 0);
    polyline(places, value, width);
    cairo_set_dash(context_.get(), nullptr, 0, 0);
}

void Canvas::polygon(const std::vector<Place>& places, const Rgb& value) {
    if (places.empty()) return;
    trace(places);
    colour(value);
    cairo_fill(context_.get());
}

void Canvas::disc(Place centre, double radius, const Rgb& value) {
    cairo_new_path(context_.get());
    cairo_arc(context_.get(), centre.x, centre.y, radius, 0, 2 * pi);
    colour(value);
    cairo_fill(context_.get());
}

void Canvas::rectangle(double left, double top, double width, double height, const Rgb& value) {
    cairo_rectangle(context_.get(), left, top, width, height);
    colour(value);
    cairo_fill(context_.get());
}

double Canvas::text_width(const std::string& words, double size) {
    cairo_text_extents_t extents;
    cairo_set_font_size(context_.get(), size);
    cairo_text_extents(context_.get(), words.c_str(), &extents);
    return extents.x_advance;
}

void Canvas::text(const std::string& words, double x, double y, double size, const Rgb& value, Align align, const Rgb* halo) {
    const double width = text_width(words, size);
    const double start = align == Align::left ? x : align == Align::centre ? x - width / 2 : x - width;
    if (halo != nullptr) {
        cairo_move_to(context_.get(), start, y);
        cairo_text_path(context_.get(), words.c_str());
        colour(*halo);
        cairo_set_line_width(context_.get(), size / 4);
        cairo_stroke(context_.get());
    }
    cairo_move_to(context_.get(), start, y);
    colour(value);
    cairo_show_text(context_.get(), words.c_str());
}

void Canvas::upward_text(const std::string& words, double x, double y, double size, const Rgb& value) {
    cairo_save(context_.get());
    cairo_translate(context_.get(), x, y);
    cairo_rotate(context_.get(), -pi / 2);
    text(words, 0, 0, size, value, Align::centre);
    cairo_restore(context_.get());
}

std::string Canvas::elide(const std::string& words, double size, double width) {
    // Bounded, so that a text of megabytes costs no more than a single line.
    std::vector<std::size_t> ends;
    for (std::size_t i = 0; i < words.size() && ends.size() < 500;) {
        ++i;
        while (i < words.size() && (static_cast<unsigned char>(words[i]) & 0xC0U) == 0x80) ++i;
        ends.push_back(i);
    }
    if (ends.empty() || (ends.back() == words.size() && text_width(words, size) <= width)) return words;
    std::size_t low = 0, high = ends.size();  // number of characters kept
    const auto shortened = [&](std::size_t count) { return words.substr(0, count == 0 ? 0 : ends[count - 1]) + "\xE2\x80\xA6"; };
    while (low + 1 < high) {
        const std::size_t middle = (low + high) / 2;
        (text_width(shortened(middle), size) <= width ? low : high) = middle;
    }
    return shortened(low);
}

Picture Canvas::picture() {
    check();
    cairo_surface_flush(surface_.get());
    Picture result;
    result.width = cairo_image_surface_get_width(surface_.get());
    result.height = cairo_image_surface_get_height(surface_.get());
    const auto columns = static_cast<std::size_t>(result.width), rows = static_cast<std::size_t>(result.height);
    result.argb.resize(columns * rows);
    const unsigned char* data = cairo_image_surface_get_data(surface_.get());
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface_.get()));
    for (std::size_t row = 0; row < rows; ++row)
        std::memcpy(result.argb.data() + row * columns, data + row * stride, columns * sizeof(std::uint32_t));
    return result;
}

std::string Canvas::document() {
    cairo_surface_finish(surface_.get());
    check();
    return kind_ == PictureKind::svg ? stable_svg(*bytes_) : *bytes_;
}

}  // namespace ostraka::detail

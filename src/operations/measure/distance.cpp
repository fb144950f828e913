// measure distance: signed distances between two scans, with their significance.
#include "operations/annotated_scene.h"
#include "operations/operations.h"

#include "ostraka/core/text.h"
#include "ostraka/fields/detection_level.h"
#include "ostraka/fields/scan_noise.h"
#include "ostraka/fields/surface_distance.h"
#include "ostraka/figures/map_figure.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/render/render.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

namespace {

/// The distances of one surface from the other, and their levels of detection.
struct Direction {
    Direction(std::string direction_name, const NoisySurface& from_surface, const NoisySurface& to_surface)
        : name(std::move(direction_name)), from(from_surface), to(to_surface) {}
    std::string name;
    NoisySurface from, to;
    std::vector<PlaceDistance> vertices, places;  ///< of the vertices; of evenly spread places
    std::vector<double> levels;                   ///< of `places`
};

std::vector<double> coordinates_of(const Point& p) { return {p.x(), p.y(), p.z()}; }

std::string area_share(double share) { return number(100 * share, 4) + " %"; }

struct MeasureDistance final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh whose distance is measured, such as the later scan of an object");
        p.input("reference", Kind::mesh, reference,
                "mesh to which the distance is measured, such as the earlier scan, registered with the mesh ('mesh register')");
        declare_files(p);
        p.options("samples", samples, "number of places, spread evenly over each surface, from which the statistics are computed",
                  Range{100, 1e8});
        p.options(
            "border", border,
            "places whose nearest place lies on the border of the other surface, so that the surface ends there: keep them, "
            "with distances without sign, or leave them out",
            Choices{"keep", "leave-out"});
        p.options("tolerance", tolerances, "tolerances such as 0.1,0.5: shares of the area within, above and below",
                  Range{0, std::numeric_limits<double>::max()}, "length");
        p.options("noise-radius", noise_radius,
                  "radius within which the noise of each surface is estimated; 0: three times its mean edge length", Range{0, 1},
                  "share of its diagonal");
        p.options("registration-error", registration_error,
                  "standard deviation of the registration of the two meshes, part of the level of detection",
                  Range{0, std::numeric_limits<double>::max()}, "length");
        p.options("unit", unit, "unit of the coordinates (any text, such as mm), if the annotations do not state a unit");
        p.options("range", range,
                  "picture: distance at the ends of the colour scale; 0: the distance that 99 % of the area do not exceed",
                  Range{0, std::numeric_limits<double>::max()}, "length");
        p.options("views", render_options.views, "picture: views of the mesh, as of 'render --views'");
        p.options("size", render_options.size, "picture: width and height of the drawn mesh in pixels, such as 1600x900");
        declare_report(p);
    }

    void declare_files(Parameters& p) {
        p.output_option("output", Kind::values, output,
                        "map to write: the signed distance of each vertex of the mesh (.npy, or text)");
        p.output_option("back", Kind::values, back,
                        "map to write: the signed distance of each vertex of the reference from the mesh (.npy, or text)");
        p.output_option("level", Kind::values, level,
                        "map to write: the level of detection at each vertex of the mesh (.npy, or text)");
        p.output_option("picture", Kind::picture, picture,
                        "picture to write: the map on the mesh with its histogram (.svg, .pdf or .png)");
        p.input_option("annotations", Kind::annotations, annotations,
                       "annotations of the mesh (.ant.json): statistics of each region");
    }

    static void declare_report(Parameters& p) {
        p.report.values(text("unit"), number("hausdorff", "Hausdorff distance", "length"), number("hausdorffBound", "", "length"),
                        boolean("overlap"));
        p.report.table("directions", text("direction", "from, to"), integer("places"), number("area", "", "length^2"),
                       number("mean", "mean", "length"), number("deviation", "deviation", "length"),
                       number("meanAbsolute", "mean absolute", "length"), number("rms", "rms", "length"),
                       number("lowest", "lowest", "length"), number("highest", "highest", "length"),
                       number("beyond", "beyond border", "fraction of the area"), number("maximum", "maximum", "length"),
                       number("maximumBound", "", "length"), number("volumeAbove", "", "length^3"),
                       number("volumeBelow", "", "length^3"));
        p.report.table("quantiles", text("direction", "from, to"), number("share", "share of the area"),
                       number("distance", "absolute distance", "length"), number("signed", "signed", "length"),
                       numbers("place", "at", "length"), numbers("nearest", "", "length"), boolean("beyond"));
        p.report.table("tolerances", text("direction", "from, to"), number("tolerance", "tolerance", "length"),
                       number("within", "within"), number("above", "above"), number("below", "below"),
                       number("beyond", "beyond border"));
        p.report.table("significance", text("direction", "from, to"), number("noise", "noise", "length"),
                       number("noiseRadius", "within", "length"), number("correlation", "correlation"),
                       number("level", "level of detection", "length"), number("assessed", "assessed"),
                       number("significant", "significant"), number("above", "above"), number("below", "below"));
        p.report.table("parts", integer("id", "id"), text("tag", "tag"), number("area", "area", "length^2"),
                       number("mean", "mean", "length"), number("meanAbsolute", "mean absolute", "length"),
                       number("rms", "rms", "length"), number("lowest", "lowest", "length"),
                       number("highest", "highest", "length"), number("above", "significantly above"),
                       number("below", "significantly below"), number("volumeAbove", "volume above", "length^3"),
                       number("volumeBelow", "volume below", "length^3"), number("beyond", "beyond border"));
    }

    void check() const override {
        check_render_options(render_options);
        if (!picture.file().empty()) static_cast<void>(picture_kind(picture.file()));
    }

    void run(Context&, Report& report) override {
        const AnnotationSet* set = annotations ? &annotations.on(mesh->mesh) : nullptr;
        length_unit = set != nullptr && !set->unit.empty() ? set->unit : unit;
        report.set_unit(length_unit);
        const SignedDistance to_mesh = in_file(mesh.file(), [&] { return SignedDistance(mesh->mesh); });
        const SignedDistance to_reference = in_file(reference.file(), [&] { return SignedDistance(reference->mesh); });
        const ScanNoise mesh_noise = scan_noise(mesh->mesh, noise_radius * to_mesh.diagonal());
        const ScanNoise reference_noise = scan_noise(reference->mesh, noise_radius * to_reference.diagonal());
        const NoisySurface a(mesh->mesh, mesh_noise), b(reference->mesh, reference_noise);
        Direction forth("mesh, reference", a, b), backwards("reference, mesh", b, a);
        measure(forth, to_reference);
        measure(backwards, to_mesh);
        warn_unregistered(to_mesh, to_reference, forth, report);
        report("unit", length_unit.empty() ? std::optional<std::string>() : std::optional(length_unit));
        report_distances(forth, to_reference, backwards, to_mesh, report);
        report_significance(forth, backwards, report);
        if (set != nullptr) report_parts(*set, to_reference, forth, report);
        write_maps(forth, backwards, set);
    }

private:
    enum class Border { keep, leave_out };
    [[nodiscard]] bool keeps_beyond() const { return border == Border::keep; }

    void measure(Direction& direction, const SignedDistance& to) const {
        direction.vertices = vertex_distances(direction.from.mesh, to);
        direction.places = distances_of(evenly_spread_places(direction.from.mesh, {}, samples), to);
        direction.levels = detection_levels(direction.places, direction.from, direction.to, registration_error);
    }

    /// Notes about meshes that are plainly not registered, or not oriented alike.
    void warn_unregistered(const SignedDistance& to_mesh, const SignedDistance& to_reference, const Direction& forth,
                           Report& report) const {
        const bool overlap = CGAL::do_overlap(bounding_box(mesh->mesh), bounding_box(reference->mesh));
        const double ratio = to_mesh.diagonal() / to_reference.diagonal();
        report("overlap", overlap);
        constexpr const char* remedy = "register the mesh first: ostraka mesh register MESH REFERENCE OUTPUT";
        if (!overlap) {
            report.note(fmt::format("the bounding boxes of the two meshes do not overlap: they are not registered; {}", remedy));
        } else if (ratio > 3 || ratio < 1.0 / 3) {
            report.note(
                fmt::format("the mesh is {} times as large as the reference: they may be in different units, or one may be "
                            "a part of the other; {}",
                            number(ratio, 3), remedy));
        } else {
            const double median = std::abs(quantile_places(forth.places, {0.5}, true, mesh.file()).front().distance);
            if (median > 0.05 * to_reference.diagonal())
                report.note(
                    fmt::format("half of the mesh is farther than {} from the reference, {} of its diagonal: the meshes "
                                "may not be registered; {}",
                                number(median, 3), area_share(median / to_reference.diagonal()), remedy));
        }
        std::size_t opposed = 0;
        for (const PlaceDistance& place : forth.places)
            if (area_vector(mesh->mesh, Face(place.face)) * area_vector(reference->mesh, Face(place.nearest.face)) < 0) ++opposed;
        if (2 * opposed > forth.places.size() && overlap)
            report.note(
                "the two surfaces face opposite ways: one of the meshes may be inside out, so that signs are reversed "
                "(ostraka mesh repair)");
    }

    /// The place of the largest distance, and a bound of it.
    [[nodiscard]] FarthestPlace farthest(const Direction& direction, const SignedDistance& to) const {
        FarthestPlace result;
        if (keeps_beyond()) {
            result = farthest_place(direction.from.mesh, direction.vertices, to);
        } else {
            result.bound = std::numeric_limits<double>::quiet_NaN();  // parts of faces beyond the border cannot be left out
            for (const PlaceDistance& place : direction.vertices)
                if (std::isfinite(place.distance) && !place.beyond &&
                    (result.place.face == no_index || std::abs(place.distance) > std::abs(result.place.distance)))
                    result.place = place;
        }
        for (const PlaceDistance& place : direction.places)
            if ((keeps_beyond() || !place.beyond) &&
                (result.place.face == no_index || std::abs(place.distance) > std::abs(result.place.distance)))
                result.place = place;
        return result;
    }

    void report_distances(const Direction& forth, const SignedDistance& to_reference, const Direction& backwards,
                          const SignedDistance& to_mesh, Report& report) const {
        double largest = 0, bound = 0;
        for (const char* table : {"directions", "quantiles", "tolerances"}) report.empty_table(table, false);
        for (const auto& [direction, to] : {std::pair{&forth, &to_reference}, std::pair{&backwards, &to_mesh}}) {
            const FarthestPlace far = farthest(*direction, *to);
            largest = std::max(largest, std::abs(far.place.distance));
            bound = std::isnan(far.bound) ? far.bound : std::max(bound, far.bound);
            report_direction(*direction, far, report);
        }
        report("hausdorff", largest,
               std::isnan(bound) ? number(largest) : fmt::format("{} (at most {})", number(largest), number(bound)))(
            "hausdorffBound", bound);
    }

    void report_direction(const Direction& direction, const FarthestPlace& far, Report& report) const {
        const std::string& file = &direction.from.mesh == &mesh->mesh ? mesh.file() : reference.file();
        const DistanceSummary s = summary_of(direction.places, keeps_beyond(), file);
        const double area =
            surface_area(direction.from.mesh) * static_cast<double>(s.places) / static_cast<double>(direction.places.size());
        report.row("directions")("direction", direction.name)("places", s.places)("area", area)("mean", s.mean)(
            "deviation", s.deviation)("meanAbsolute", s.mean_absolute)("rms", s.rms)("lowest", s.lowest)("highest", s.highest)(
            "beyond", static_cast<double>(s.beyond) / static_cast<double>(s.places))("maximum", std::abs(far.place.distance))(
            "maximumBound", far.bound)("volumeAbove", area * s.raised)("volumeBelow", area * s.lowered);
        const std::vector<double> shares(distance_quantiles.begin(), distance_quantiles.end());
        std::vector<PlaceDistance> quantiles = quantile_places(direction.places, shares, keeps_beyond(), file);
        quantiles.push_back(far.place);
        for (std::size_t i = 0; i < quantiles.size(); ++i) {
            const PlaceDistance& at = quantiles[i];
            report.row("quantiles")("direction", direction.name)("share", i < shares.size() ? shares[i] : 1.0)(
                "distance", std::abs(at.distance))("signed", at.beyond ? std::nullopt : std::optional(at.distance))(
                "place", coordinates_of(at.place))("nearest", coordinates_of(at.nearest.point))("beyond", at.beyond);
        }
        for (const double tolerance : tolerances) {
            const ToleranceShares t = tolerance_shares(direction.places, tolerance, keeps_beyond());
            report.row("tolerances")("direction", direction.name)("tolerance", tolerance)(
                "within", t.within, area_share(t.within))("above", t.above, area_share(t.above))(
                "below", t.below, area_share(t.below))("beyond", t.beyond, area_share(t.beyond));
        }
    }

    void report_significance(const Direction& forth, const Direction& backwards, Report& report) const {
        report.empty_table("significance", false);
        for (const Direction* direction : {&forth, &backwards}) {
            const SignificantShares shares = significant_shares(direction->places, direction->levels);
            const ScanNoise& noise = direction->from.noise;
            auto row = report.row("significance");
            row("direction", direction->name)("noise", noise.median)("noiseRadius", noise.radius)(
                "correlation", noise.correlation)("assessed", shares.assessed, area_share(shares.assessed));
            if (shares.assessed > 0)
                row("level", shares.level)("significant", shares.above + shares.below, area_share(shares.above + shares.below))(
                    "above", shares.above, area_share(shares.above))("below", shares.below, area_share(shares.below));
            if (direction == &forth) report.notes(doubts_about(shares, forth.from, forth.to, registration_error));
        }
    }

    void report_parts(const AnnotationSet& set, const SignedDistance& to, const Direction& forth, Report& report) const {
        constexpr double min_places = 1000;
        const double total = surface_area(mesh->mesh);
        std::size_t others = 0;
        report.empty_table("parts", false);
        for (const Annotation& annotation : set.annotations) {
            if (annotation.type != AnnotationType::region) {
                ++others;
                continue;
            }
            const double area = area_of(mesh->mesh, annotation.faces);
            auto row = report.row("parts");
            row("id", annotation.id)("tag", annotation.tag)("area", area);
            if (!(area > 0)) continue;
            const double share = static_cast<double>(samples) * area / total;
            const auto count = static_cast<std::size_t>(std::max(min_places, std::ceil(share)));
            const auto places = distances_of(evenly_spread_places(mesh->mesh, annotation.faces, count), to);
            report_part(places, area, forth, row);
        }
        if (others > 0)
            report.note(fmt::format("{} not regions: they have no area and no statistics",
                                    others == 1 ? "1 annotation is" : std::to_string(others) + " annotations are"));
    }

    void report_part(const std::vector<PlaceDistance>& places, double area, const Direction& forth, Report::Row& row) const {
        if (!keeps_beyond() && std::all_of(places.begin(), places.end(), [](const PlaceDistance& at) { return at.beyond; })) {
            row("beyond", 1.0);
            return;
        }
        const DistanceSummary s = summary_of(places, keeps_beyond(), mesh.file());
        const double measured = area * static_cast<double>(s.places) / static_cast<double>(places.size());
        const auto beyond = std::count_if(places.begin(), places.end(), [](const PlaceDistance& at) { return at.beyond; });
        row("mean", s.mean)("meanAbsolute", s.mean_absolute)("rms", s.rms)("lowest", s.lowest)("highest", s.highest)(
            "volumeAbove", measured * s.raised)("volumeBelow", measured * s.lowered)(
            "beyond", static_cast<double>(beyond) / static_cast<double>(places.size()),
            area_share(static_cast<double>(beyond) / static_cast<double>(places.size())));
        const SignificantShares shares =
            significant_shares(places, detection_levels(places, forth.from, forth.to, registration_error));
        if (shares.assessed > 0)
            row("above", shares.above, area_share(shares.above))("below", shares.below, area_share(shares.below));
    }

    /// Distances of vertices, NaN where they are left out.
    [[nodiscard]] std::vector<double> map_of(const std::vector<PlaceDistance>& vertices) const {
        std::vector<double> values;
        for (const PlaceDistance& at : vertices)
            values.push_back(at.beyond && !keeps_beyond() ? std::numeric_limits<double>::quiet_NaN() : at.distance);
        return values;
    }

    void write_maps(const Direction& forth, const Direction& backwards, const AnnotationSet* set) const {
        if (output) output.write(map_of(forth.vertices));
        if (back) back.write(map_of(backwards.vertices));
        if (level) level.write(detection_levels(forth.vertices, forth.from, forth.to, registration_error));
        if (picture) write_picture(forth, set);
    }

    void write_picture(const Direction& forth, const AnnotationSet* set) const {
        MapFigure figure;
        const double quantile =
            std::abs(quantile_places(forth.places, {distance_quantiles.back()}, keeps_beyond(), mesh.file()).front().distance);
        const double end = range > 0 ? range : std::max(quantile, 1e-12 * box_diagonal(mesh->mesh));
        figure.scale = {-end, end, true, length_unit.empty() ? "distance" : fmt::format("distance ({})", length_unit)};
        Scene scene;
        scene.mesh = to_soup(mesh->mesh);
        scene.vertex_values = map_of(forth.vertices);
        scene.unit = length_unit;
        RenderOptions drawing = render_options;
        drawing.scale = figure.scale;
        drawing.no_legend = true;
        if (set != nullptr && set->up) drawing.up = up_words(*set);
        figure.picture = render({scene}, drawing).picture;
        figure.title = fmt::format("Distance of {} from {}", mesh.file_name(), reference.file_name());
        for (const PlaceDistance& at : forth.places)
            if (keeps_beyond() || !at.beyond) figure.values.push_back(at.distance);
        for (const double tolerance : tolerances) figure.lines.insert(figure.lines.end(), {-tolerance, tolerance});
        figure.facts = facts_about(forth);
        write_plot(picture.path(), figure);
    }

    [[nodiscard]] std::vector<std::string> facts_about(const Direction& forth) const {
        const DistanceSummary s = summary_of(forth.places, keeps_beyond(), mesh.file());
        const std::string suffix = length_unit.empty() ? "" : " " + length_unit;
        std::vector<std::string> facts{fmt::format("mean {}{}, mean absolute {}{}, rms {}{}", number(s.mean, 3), suffix,
                                                   number(s.mean_absolute, 3), suffix, number(s.rms, 3), suffix)};
        const SignificantShares shares = significant_shares(forth.places, forth.levels);
        if (shares.assessed > 0)
            facts.push_back(fmt::format("significant at 95 %: {} of the area above, {} below (level of detection {}{})",
                                        area_share(shares.above), area_share(shares.below), number(shares.level, 3), suffix));
        for (const double tolerance : tolerances)
            facts.push_back(fmt::format("within {}{}: {}", number(tolerance), suffix,
                                        area_share(tolerance_shares(forth.places, tolerance, keeps_beyond()).within)));
        return facts;
    }

    MeshInput mesh, reference;
    ValuesOutput output, back, level;
    FileOutput picture{".png"};
    AnnotationsInput annotations;
    std::uint64_t samples = 100000;
    Border border = Border::keep;
    std::vector<double> tolerances;
    double noise_radius = 0, registration_error = 0, range = 0;
    std::string unit, length_unit;  ///< requested unit, or that of the annotations
    RenderOptions render_options = [] {
        RenderOptions options;
        options.size = "1600x900";
        options.views = "30,20;210,20";
        return options;
    }();
};

}  // namespace

std::unique_ptr<Operation> make_measure_distance() { return make<MeasureDistance>(); }

}  // namespace ostraka

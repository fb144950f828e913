// measure capacity: the liquid that a vessel holds.
#include "operations/operations.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/axis/axis.h"
#include "ostraka/core/text.h"
#include "ostraka/files/csv.h"
#include "ostraka/slicing/capacity.h"
#include "ostraka/vocabulary/text_match.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

namespace {

/// A profile from a table with a column of radii and one of heights, as `template revolve` writes it.
std::vector<Eigen::Vector2d> read_profile_table(const Path& file) {
    const std::string name = file.string(), bytes = read_file(file);
    const std::vector<CsvRow> rows = csv_rows(bytes, csv_separator(bytes), name);
    const auto column = [&](std::initializer_list<const char*> names) {
        for (std::size_t i = 0; !rows.empty() && i < rows[0].cells.size(); ++i)
            for (const char* title : names)
                if (lower_case(rows[0].cells[i]) == title) return i;
        fail_input(name, "has no columns 'radius' and 'height' in its first line",
                   "give the profile.csv of 'template revolve': one point of the section per line, in order");
    };
    const std::size_t radius = column({"radius", "r", "x"}), height = column({"height", "h", "y", "z"});
    std::vector<Eigen::Vector2d> profile;
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const auto cell = [&](std::size_t k) {
            const auto value = k < rows[i].cells.size() ? number_of(rows[i].cells[k]) : std::nullopt;
            if (!value)
                fail_input(fmt::format("{}, line {}", name, rows[i].line), "has no radius or no height", "give two numbers");
            return *value;
        };
        profile.emplace_back(cell(radius), cell(height));
    }
    // A section drawn at the left of the axis.
    if (!profile.empty() && std::all_of(profile.begin(), profile.end(), [](const auto& p) { return p.x() <= 0; }))
        for (auto& p : profile) p.x() = -p.x();
    return profile;
}

struct MeasureCapacity final : Operation {
    void declare(Parameters& p) override {
        p.input(
            "vessel", Kind::mesh, vessel,
            "mesh of a vessel: a closed scan, or the inner wall alone; or its profile (.csv with the columns radius and height)");
        p.input("annotations", Kind::annotations, annotations,
                "annotations of the mesh (.ant.json): unit, upward direction, places of levels")
            .optional();
        p.options("up", up,
                  "upward direction; 'axis': the vessel's axis of revolution; 'auto': the axis of revolution or else a principal "
                  "axis, with the mouth upwards; by default the upward direction of the annotations, or 0,0,1",
                  direction_words("--up", {"auto", "axis"}));
        p.options("level", levels,
                  "level of the liquid: its height above --from, or the id or tag of a point annotation at the level; repeatable")
            .words();
        p.options("from", from,
                  "zero of the heights of --level: id or tag of a point annotation; by default the lowest point of the cavity");
        p.options("fill", shares,
                  "level of the liquid as a share of the height from the lowest point of the cavity to its overflow; repeatable",
                  Range{0, 1});
        p.options("unit", unit, "unit of the coordinates, such as mm; by default the unit of the annotations");
        options.declare_options(p.options);
        up_error = p.options.find("up-error");
        declare_report(p.report);
    }

    static void declare_report(ReportLayout& layout) {
        layout.values(boolean("known"), text("reason"), number("capacity", "capacity", "length^3"),
                      number("litres", "capacity", "litres"), number("uncertainty", "standard deviation", "length^3"),
                      number("uncertaintyOfNoise", "", "length^3"), number("uncertaintyOfWall", "", "length^3"),
                      number("uncertaintyOfDirection", "", "length^3"), number("height", "height of the liquid", "length"),
                      number("level", "", "length"), number("surface", "area of its surface", "length^2"),
                      numbers("lowest", "lowest point of the cavity"), numbers("overflow", "overflows at"),
                      text("over", "overflows over"), number("noise", "", "length"), number("upError", "", "degrees"),
                      numbers("up", "upward direction"), boolean("overturned"), text("unit"));
        layout.table("levels", text("request", "level"), number("height", "height", "length"),
                     number("volume", "volume", "length^3"), number("litres", "litres"),
                     number("uncertainty", "standard deviation", "length^3"), number("surface", "surface", "length^2"),
                     text("reason", ""));
        layout.table("cavities", number("volume"), number("height"), number("surface"), text("over"), boolean("openWall"),
                     numbers("lowest"));
    }

    void check() const override {
        if (is_profile()) {
            if (annotations) fail_usage("annotations belong to a mesh, but the vessel is a profile", "leave out the annotations");
            if (up == "auto" || up == "axis") fail_usage("--up " + up + " with a profile", "the axis of a profile is z");
        }
        if (annotations) return;
        for (const std::string& level : levels)
            if (!number_of(level))
                fail_usage(fmt::format("--level '{}' is not a number, and there are no annotations", printable(level, 60)),
                           "give a height, or the annotation file with the point");
        if (!from.empty()) fail_usage("--from names a point annotation, but there are no annotations", "add the annotation file");
    }

    void run(Context& context, Report& report) override {
        const Mesh* surface = nullptr;
        std::shared_ptr<const void> revolved;
        if (is_profile()) {
            revolved = context.load(vessel, 0, typeid(Mesh), "profile", [](const Path& path) {
                return std::make_shared<const Mesh>(revolve_profile(read_profile_table(path), 720));
            });
            surface = static_cast<const Mesh*>(revolved.get());
        } else surface = &vessel->mesh;
        length_unit = unit;
        std::optional<std::array<double, 3>> known_up;
        if (annotations) {
            const AnnotationSet& set = annotations.on(*surface);
            if (unit.empty()) length_unit = set.unit;
            known_up = set.up;
        }
        report.set_unit(length_unit);
        const std::vector<FillRequest> requests = requests_on(*surface);
        std::string no_axis;
        const std::optional<Vector> direction = upward(*surface, known_up, no_axis);
        if (!direction) {
            report("known", false)("reason", no_axis);
            report.line("the capacity cannot be told: " + no_axis);
            return report.answer_no();
        }
        const Capacity capacity = in_file(vessel.file(), [&] { return find_capacity(*surface, *direction, requests, options); });
        report_result(report, *surface, capacity);
    }

    [[nodiscard]] bool is_profile() const {
        return vessel.size() > 0 && !vessel.sources.front().object && extension(vessel.sources.front().file) == ".csv";
    }

    [[nodiscard]] Point place_of(const Mesh& surface, const std::string& name) const {
        const Annotation& annotation = find_annotation(annotations.on(surface), name, annotations.file());
        const std::vector<Index> points = touched_vertices(surface, annotation);
        if (annotation.type != AnnotationType::point || points.empty())
            fail_input(annotations.file(), fmt::format("'{}' is not a point annotation", printable(name, 60)),
                       "name a point that marks the level");
        if (!annotation.curves.empty() && !annotation.curves.front().empty())
            return position(surface, annotation.curves.front().front());
        return surface.point(Vertex(points.front()));
    }

    [[nodiscard]] std::vector<FillRequest> requests_on(const Mesh& surface) const {
        std::vector<FillRequest> requests;
        for (const std::string& level : levels) {
            FillRequest& request = requests.emplace_back();
            if (const auto height = number_of(level)) {
                request.value = *height;
                if (!from.empty()) request.from = place_of(surface, from);
            } else request.from = place_of(surface, level);
        }
        for (const double share : shares) requests.push_back({FillRequest::Kind::share, share, {}});
        return requests;
    }

    /// The upward direction; none, with the reason, if the vessel has no axis.
    std::optional<Vector> upward(const Mesh& surface, const std::optional<std::array<double, 3>>& known_up, std::string& reason) {
        if (up != "auto" && up != "axis") {
            const std::array<double, 3> d =
                !up.empty() ? direction_of(up, "--up") : known_up.value_or(std::array<double, 3>{0, 0, 1});
            return Vector(d[0], d[1], d[2]);
        }
        std::vector<Index> faces(surface.number_of_faces());
        std::iota(faces.begin(), faces.end(), Index{0});
        std::vector<Vector> axes;
        const Axis axis = in_file(vessel.file(), [&] { return find_axis(surface, faces); });
        if (axis.found) {
            axes.push_back(axis.direction);
            if (const AxisFigure* error = axis.figure("direction error"); error != nullptr && !up_error->given)
                options.up_error = std::clamp(error->value, 0.01, 30.0);
        } else if (up == "axis") {
            reason = "the vessel has no axis of revolution: " + axis.reason;
            return std::nullopt;
        } else {
            const AreaMoments moments = area_moments(surface, faces);
            axes.assign(moments.directions.begin(), moments.directions.end());
        }
        double most = -1;
        Vector best = axes.front();
        for (const Vector& candidate : axes)
            for (const double sign : {1.0, -1.0})
                if (const double amount = held(surface, sign * candidate); amount > most) most = amount, best = sign * candidate;
        return best;
    }

    /// Volume of the largest cavity that can be filled; 0: none.
    static double held(const Mesh& surface, const Vector& direction) {
        for (const Cavity& cavity : find_cavities(surface, direction))
            if (cavity.over != Overflow::sealed && !cavity.open_wall) return cavity.full.volume;
        return 0;
    }

    /// Whether a vessel stands on its mouth: turned over, it holds at least three times as much.
    [[nodiscard]] double held_overturned(const Mesh& surface, const Capacity& capacity) const {
        if (up == "auto" || up == "axis") return 0;
        const double upright = capacity.main ? capacity.full.volume : 0;
        if (upright > 0.1 * capacity.box) return 0;
        const double turned = held(surface, -capacity.up);
        return turned > std::max(3 * upright, min_cavity_share * capacity.box) ? turned : 0;
    }

    void report_result(Report& report, const Mesh& surface, const Capacity& capacity) const {
        const auto triple = [](const auto& v) { return std::vector<double>{v.x(), v.y(), v.z()}; };
        const double overturned = held_overturned(surface, capacity);
        std::string reason = capacity.reason;
        if (overturned > 0)
            reason = fmt::format("the vessel stands upside down; turned over it holds {} (--up auto, or --up={},{},{})",
                                 volume(overturned), number(0 - capacity.up.x()), number(0 - capacity.up.y()),
                                 number(0 - capacity.up.z()));
        report("known", reason.empty())("reason", reason)("up", triple(capacity.up))("overturned", overturned > 0)("unit",
                                                                                                                   length_unit);
        report("noise", capacity.noise)("upError", options.up_error);
        if (capacity.main) {
            const Cavity& cavity = capacity.cavities[*capacity.main];
            const LiquidVolume& full = capacity.full;
            report("capacity", full.volume, number(full.volume, 8))("litres", litres(full.volume))(
                "uncertainty", full.uncertainty())("uncertaintyOfNoise", full.by_noise)("uncertaintyOfWall", full.by_wall)(
                "uncertaintyOfDirection", full.by_direction)("height", full.height)("level", full.level)("surface", full.surface)(
                "lowest", triple(cavity.lowest))("overflow", triple(cavity.overflow))("over", over(cavity.over));
        }
        report_levels(report, capacity);
        report.empty_table("cavities", false);
        for (const Cavity& cavity : capacity.cavities)
            report.row("cavities")("volume", cavity.full.volume)("height", cavity.full.height)("surface", cavity.full.surface)(
                "over", over(cavity.over))("openWall", cavity.open_wall)("lowest", triple(cavity.lowest));
        if (!reason.empty()) {
            report.line("the capacity cannot be told: " + reason);
            return report.answer_no();
        }
        report.line(fmt::format("holds {} before it overflows, standard deviation {}", volume(capacity.full.volume),
                                volume(capacity.full.uncertainty())));
        add_notes(report, capacity);
    }

    void report_levels(Report& report, const Capacity& capacity) const {
        report.empty_table("levels", false);
        for (std::size_t i = 0; i < capacity.levels.size(); ++i) {
            const LiquidVolume& level = capacity.levels[i];
            const std::string request =
                i < levels.size() ? printable(levels[i], 60) : fmt::format("{} of the height", number(shares[i - levels.size()]));
            auto row = report.row("levels");
            row("request", request);
            if (level.reason.empty())
                row("height", level.height)("volume", level.volume, number(level.volume, 8))("litres", litres(level.volume))(
                    "uncertainty", level.uncertainty())("surface", level.surface);
            else {
                row("reason", level.reason);
                if (capacity.main) report.note(fmt::format("level {}: cannot be told, {}", request, level.reason));
                report.answer_no();
            }
        }
    }

    void add_notes(Report& report, const Capacity& capacity) const {
        const Cavity& cavity = capacity.cavities[*capacity.main];
        const auto place = [](const Point& p) {
            return fmt::format("({}, {}, {})", number(p.x()), number(p.y()), number(p.z()));
        };
        if (cavity.over == Overflow::hole)
            report.note(
                fmt::format("liquid leaves through a hole of the mesh at {}: if the vessel has no hole there, close it with "
                            "'ostraka mesh repair'",
                            place(cavity.overflow)));
        if (length_unit.empty()) report.note("the unit is unknown, so that there are no litres: give --unit mm");
        else if (!litres(1)) report.note(fmt::format("'{}' cannot be converted to litres", printable(length_unit, 30)));
        if (capacity.crossing > 0)
            report.note(
                "parts of the mesh pass through each other where it overflows, so that the volume is approximate: "
                "'ostraka mesh repair --wrap' makes one surface of them");
        const std::size_t others = capacity.cavities.size() - 1;
        if (others > 0)
            report.note(fmt::format("{} smaller {} not counted, the largest {}", others,
                                    others == 1 ? "cavity is" : "cavities are",
                                    volume(capacity.cavities[*capacity.main == 0 ? 1 : 0].full.volume)));
    }

    static std::string over(Overflow overflow) {
        return overflow == Overflow::rim ? "the rim" : overflow == Overflow::hole ? "a hole of the mesh" : "nowhere: closed";
    }

    [[nodiscard]] std::optional<double> litres(double value) const {
        const auto decimetres = converted(1, length_unit, "dm");
        return decimetres ? std::optional(value * std::pow(*decimetres, 3)) : std::nullopt;
    }

    /// "12345678 mm^3 (12.346 litres)".
    [[nodiscard]] std::string volume(double value) const {
        std::string text = number(value, 8) + (length_unit.empty() ? "" : " " + length_unit + "^3");
        if (const auto in_litres = litres(value)) text += fmt::format(" ({} litres)", number(*in_litres, 5));
        return text;
    }

    MeshInput vessel;
    AnnotationsInput annotations;
    std::string up, from, unit, length_unit;
    std::vector<std::string> levels;
    std::vector<double> shares;
    CapacityOptions options;
    const Option* up_error = nullptr;
};

}  // namespace

std::unique_ptr<Operation> make_measure_capacity() { return make<MeasureCapacity>(); }

}  // namespace ostraka

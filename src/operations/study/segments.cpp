// study segments
#include "operations/operations.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/figures/plot.h"
#include "ostraka/measure/examine.h"
#include "ostraka/select/slice_segments.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

struct StudySegments final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.output("output", Kind::annotations, output, "annotations to write (.ant.json)");
        p.output_option("curve", Kind::picture, curve,
                        "plot to write: the criterion over the number of clusters (.svg, .pdf, .png)");
        p.input_option("compare", Kind::annotations, compare,
                       "annotations of the true parts (.ant.json), with which the result is compared; by default the labels of "
                       "the mesh file, if any");
        up.declare(p, "upward direction; by default the upward direction of --compare, or 0,0,1");
        p.options("unit", unit, "unit of the mesh's coordinates; by default the unit of --compare");
        options.declare_options(p.options);
        p.report.values(text("unit"), integer("clusters"), integer("proposed"), text("criterion"));
        p.report.table("curve", integer("clusters", "clusters"), number("cost", "cost"), number("silhouette", "silhouette"),
                       number("gap", "gap"), number("gapError", "gap error"));
        p.report.table("segments", text("tag", "segment"), integer("cluster", "cluster"), number("low", "from", "length"),
                       number("high", "to", "length"), integer("slices", "slices"), integer("faces"),
                       number("area", "area", "length^2"));
        p.report.values(number("adjustedRandIndex"));
    }

    void run(Context&, Report& report) override {
        const Mesh& surface = mesh->mesh;
        const AnnotationSet* parts = compare ? &compare.on(surface) : nullptr;
        std::optional<std::array<double, 3>> direction = parts != nullptr ? parts->up : std::nullopt;
        if (up) direction = up.value();
        if (!direction) report.note("no upward direction is known, so z is used; otherwise give --up");
        const Vector upward = direction ? Vector((*direction)[0], (*direction)[1], (*direction)[2]) : Vector(0, 0, 1);
        const SliceSegments segments = in_file(mesh.file(), [&] { return segment_by_slices(surface, upward, options); });
        AnnotationSet set = annotate_segments(surface, segments);
        set.up = {upward.x(), upward.y(), upward.z()};
        set.unit = unit.empty() && parts != nullptr ? parts->unit : unit;
        const auto agreement =
            segment_agreement(segments, parts != nullptr ? labels_of({surface, *parts}) : mesh->extras.face_labels);

        report.set_unit(set.unit);
        if (!set.unit.empty()) report("unit", set.unit);
        report("clusters", segments.clusters)("proposed", segments.count.proposed)("criterion",
                                                                                   option_text(options.count, "criterion"));
        report.empty_table("curve");
        for (const ClusterCount::Row& row : segments.count.rows)
            report.row("curve")("clusters", row.clusters)("cost", row.cost)("silhouette", row.silhouette)("gap", row.gap)(
                "gapError", row.gap_error);
        report.line(fmt::format("{} clusters proposed by {}, {} used\n", segments.count.proposed,
                                option_text(options.count, "criterion"), segments.clusters));
        for (std::size_t i = 0; i < segments.segments.size(); ++i) {
            const SliceRun& slice_segment = segments.segments[i];
            const Annotation* region = set.find(static_cast<int>(i));
            const AnnotationSummary summary = region != nullptr ? summarise(surface, *region) : AnnotationSummary{};
            report.row("segments")("tag", "segment " + std::to_string(i + 1))("cluster", slice_segment.cluster)(
                "low", slice_segment.low)("high", slice_segment.high)("slices", slice_segment.slices)("faces", summary.elements)(
                "area", summary.area);
        }
        report_clusters(report, segments);
        if (agreement) {
            report("adjustedRandIndex", *agreement);
            report.line("adjusted Rand index against the known parts, over the faces: " + number(*agreement, 3));
        }
        if (curve && segments.count.rows.size() > 2) draw(segments);
        else if (curve) report.note("no curve is drawn for fewer than three numbers of clusters (--max-clusters)");
        output.write(std::move(set), surface, mesh.file());
    }

    /// Reports clusters without a segment, and clusters with several.
    void report_clusters(Report& report, const SliceSegments& segments) const {
        std::string empty_clusters, split_clusters;
        std::size_t count = 0;
        for (int cluster = 0; cluster < segments.clusters; ++cluster) {
            std::vector<std::string> segment_numbers;
            for (std::size_t i = 0; i < segments.segments.size(); ++i)
                if (segments.segments[i].cluster == cluster) segment_numbers.push_back(std::to_string(i + 1));
            if (segment_numbers.empty()) {
                const auto slices = std::count(segments.raw.begin(), segments.raw.end(), cluster);
                empty_clusters +=
                    fmt::format("{}{} ({} {})", count++ == 0 ? "" : ", ", cluster, slices, slices == 1 ? "slice" : "slices");
            }
            if (segment_numbers.size() > 1) split_clusters += split_clusters.empty() ? "" : "; ";
            for (std::size_t k = 0; k < segment_numbers.size() && segment_numbers.size() > 1; ++k)
                split_clusters += (k == 0 ? "" : k + 1 < segment_numbers.size() ? ", " : " and ") + segment_numbers[k];
        }
        if (count > 0)
            report.line(fmt::format(
                "{} of the {} clusters {} no segment: {} in runs of fewer than {}, which joined their neighbours (--min-run)",
                count, segments.clusters, count == 1 ? "has" : "have", empty_clusters, options.min_run));
        if (!split_clusters.empty()) report.line("of one cluster, and therefore of one colour: segments " + split_clusters);
    }

    void draw(const SliceSegments& segments) const {
        const bool gap = options.count.criterion == ClusterCountOptions::Criterion::gap;
        Plot plot{fmt::format("Number of clusters: {} proposed", segments.count.proposed),
                  {"clusters"},
                  {gap ? "gap statistic" : "mean silhouette"},
                  {}};
        PlotSeries series;
        for (const ClusterCount::Row& row : segments.count.rows) {
            if (!gap && row.clusters < 2) continue;
            series.points.push_back({static_cast<double>(row.clusters), gap ? row.gap : row.silhouette});
            if (gap) series.intervals.emplace_back(std::array<double, 2>{row.gap - row.gap_error, row.gap + row.gap_error});
        }
        plot.series.push_back(std::move(series));
        plot.lines.push_back({static_cast<double>(segments.count.proposed), true, ""});
        write_plot(curve.path(), plot);
    }

    MeshInput mesh;
    AnnotationsInput compare;
    AnnotationsOutput output;
    FileOutput curve{".svg"};
    DirectionOption up;
    std::string unit;
    SliceSegmentOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_study_segments() { return make<StudySegments>(); }

}  // namespace ostraka

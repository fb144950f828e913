// ostraka study segments: an object in segments along its height, by clusters of its slices.
#include "command.h"
#include "number_lists.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/examine.h"
#include "ostraka/report/plot.h"
#include "ostraka/select/slice_segments.h"
#include "ostraka/stats/scores.h"

#include <algorithm>
#include <iostream>
#include <map>
#include <memory>

namespace ostraka::app {

namespace {

struct StudySegments {
    std::string mesh, output, up, curve, compare, unit;
    SliceSegmentOptions options;

    /// Upward direction and unit, of the options, else of the annotations compared with.
    struct Known {
        Vector up{0, 0, 1};
        std::string unit;
    };
    [[nodiscard]] Known known(const Session& session, const Mesh& surface) const {
        Known result;
        result.unit = unit;
        std::optional<std::array<double, 3>> way;
        if (!compare.empty()) {
            const AnnotationSet set = read_annotations(compare, surface);
            way = set.up;
            if (unit.empty()) result.unit = set.unit;
        }
        if (!up.empty()) way = direction_of(up, "--up");
        if (way) result.up = {(*way)[0], (*way)[1], (*way)[2]};
        else session.note("note: no upward direction is known, z is taken; else give --up");
        return result;
    }

    /// Clusters without a segment, and those with several.
    [[nodiscard]] std::string about_clusters(const SliceSegments& segments) const {
        std::map<int, std::vector<std::string>> of;
        for (std::size_t i = 0; i < segments.segments.size(); ++i)
            of[segments.segments[i].cluster].push_back(std::to_string(i + 1));
        std::string gone, again;
        std::size_t count = 0;
        for (int cluster = 0; cluster < segments.clusters; ++cluster) {
            if (of.contains(cluster)) continue;
            ++count;
            const auto slices = std::count(segments.raw.begin(), segments.raw.end(), cluster);
            gone += (gone.empty() ? "" : ", ") + std::to_string(cluster) + " (" + std::to_string(slices) +
                    (slices == 1 ? " slice)" : " slices)");
        }
        for (const auto& [cluster, list] : of) {
            if (list.size() < 2) continue;
            again += again.empty() ? "" : "; ";
            for (std::size_t k = 0; k < list.size(); ++k) again += (k == 0 ? "" : k + 1 < list.size() ? ", " : " and ") + list[k];
        }
        std::string text;
        if (count > 0)
            text += std::to_string(count) + " of the " + std::to_string(segments.clusters) + " clusters " +
                    (count == 1 ? "has" : "have") + " no segment: " + gone + " in runs of fewer than " +
                    std::to_string(options.least_run) + ", which joined their neighbours (--least-run)\n";
        if (!again.empty()) text += "one cluster, and so one colour: segments " + again + "\n";
        return text;
    }

    /// Adjusted Rand index of segments and known parts over the faces: those of an annotation file, or the mesh file's labels.
    [[nodiscard]] std::optional<double> agreement(const MeshFile& file, const SliceSegments& segments) const {
        std::vector<std::int32_t> known = file.extras.face_labels;
        if (!compare.empty()) known = labels_of(file.mesh, read_annotations(compare, file.mesh));
        if (known.empty()) return std::nullopt;
        std::vector<int> found, truth;
        for (std::size_t f = 0; f < known.size(); ++f) {
            if (known[f] < 0) continue;
            found.push_back(segments.face_segments[f]);
            truth.push_back(known[f]);
        }
        if (found.empty()) return std::nullopt;
        return adjusted_rand_index(found, truth);
    }

    void draw(const SliceSegments& segments) const {
        Plot plot;
        const bool gap = options.count.criterion == "gap";
        plot.title = "Number of clusters: " + std::to_string(segments.count.proposed) + " proposed";
        plot.x = {"clusters"};
        plot.y = {gap ? "gap statistic" : "mean silhouette"};
        PlotSeries series;
        for (const ClusterCount::Row& row : segments.count.rows) {
            if (!gap && row.clusters < 2) continue;
            series.points.push_back({static_cast<double>(row.clusters), gap ? row.gap : row.silhouette});
            if (gap) series.intervals.emplace_back(std::array<double, 2>{row.gap - row.gap_error, row.gap + row.gap_error});
        }
        plot.series.push_back(std::move(series));
        plot.lines.push_back({static_cast<double>(segments.count.proposed), true, ""});
        write_plot(curve, plot);
    }

    int run(const Session& session) const {
        check_outputs({mesh, compare}, {output, curve});
        Provenance provenance{"study segments", list_options(options), {}};
        provenance.options.emplace_back("up", up.empty() ? "auto" : up);
        if (!unit.empty()) provenance.options.emplace_back("unit", unit);
        provenance.add_input(mesh);
        if (!compare.empty()) provenance.add_input(compare);
        const MeshFile file = read_mesh(mesh);
        for (const auto& note : file.notes) session.note("note: " + note);
        const Known frame = known(session, file.mesh);
        const SliceSegments segments = in_file(mesh, [&] { return segment_by_slices(file.mesh, frame.up, options); });
        AnnotationSet set = annotate_segments(file.mesh, segments);
        set.up = {frame.up.x(), frame.up.y(), frame.up.z()};
        set.unit = frame.unit;
        const std::optional<double> ari = agreement(file, segments);
        OutputTransaction transaction;
        write_annotations(output, set, file.mesh, mesh, provenance);
        if (!curve.empty() && segments.count.rows.size() > 2) draw(segments);
        transaction.commit();

        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType), rows(rapidjson::kArrayType);
        std::vector<std::vector<std::string>> cells, counts;
        for (std::size_t i = 0; i < segments.segments.size(); ++i) {
            const SliceSegment& each = segments.segments[i];
            const Annotation* region = set.find(static_cast<int>(i));
            const AnnotationSummary summary = region != nullptr ? summarise(file.mesh, *region) : AnnotationSummary{};
            JsonValue entry(rapidjson::kObjectType);
            add_member(entry, "tag", "segment " + std::to_string(i + 1), allocator);
            add_member(entry, "cluster", JsonValue(each.cluster), allocator);
            add_member(entry, "low", JsonValue(each.low), allocator);
            add_member(entry, "high", JsonValue(each.high), allocator);
            add_member(entry, "slices", JsonValue(static_cast<std::uint64_t>(each.slices)), allocator);
            add_member(entry, "faces", JsonValue(static_cast<std::uint64_t>(summary.elements)), allocator);
            add_member(entry, "area", JsonValue(summary.area), allocator);
            list.PushBack(entry, allocator);
            cells.push_back({"segment " + std::to_string(i + 1), std::to_string(each.cluster), number(each.low),
                             number(each.high), std::to_string(each.slices), number(summary.area)});
        }
        for (const ClusterCount::Row& row : segments.count.rows) {
            JsonValue entry(rapidjson::kObjectType);
            add_member(entry, "clusters", JsonValue(row.clusters), allocator);
            add_member(entry, "cost", JsonValue(row.cost), allocator);
            add_member(entry, "silhouette", JsonValue(row.silhouette), allocator);
            add_member(entry, "gap", JsonValue(row.gap), allocator);
            add_member(entry, "gapError", JsonValue(row.gap_error), allocator);
            rows.PushBack(entry, allocator);
            counts.push_back(
                {std::to_string(row.clusters), number(row.cost), number(row.silhouette), number(row.gap), number(row.gap_error)});
        }
        if (!frame.unit.empty()) add_member(result, "unit", frame.unit, allocator);
        add_member(result, "clusters", JsonValue(segments.clusters), allocator);
        add_member(result, "proposed", JsonValue(segments.count.proposed), allocator);
        add_member(result, "criterion", options.count.criterion, allocator);
        add_member(result, "curve", std::move(rows), allocator);
        add_member(result, "segments", std::move(list), allocator);
        if (ari) add_member(result, "adjustedRandIndex", JsonValue(*ari), allocator);
        if (session.json) {
            session.print_report(provenance, document, result);
            return done;
        }
        const std::string length = frame.unit.empty() ? "" : " " + printable(frame.unit, 20);
        std::cout << table({"clusters", "cost", "silhouette", "gap", "gap error"}, counts) << segments.count.proposed
                  << " clusters proposed by " << options.count.criterion << ", " << segments.clusters << " used\n\n"
                  << table({"segment", "cluster", "from" + length, "to" + length, "slices",
                            "area" + (length.empty() ? "" : length + "^2")},
                           cells)
                  << about_clusters(segments);
        if (ari) std::cout << "adjusted Rand index against the known parts, over the faces: " << number(*ari, 3) << "\n";
        return done;
    }
};

}  // namespace

void add_study_segments(CLI::App& study, Session& session) {
    const auto work = std::make_shared<StudySegments>();
    CLI::App* command = session.add(study, "segments", "an object in segments along its height, by clusters of its slices",
                                    [&session, work] { return work->run(session); });
    command->add_option("mesh", work->mesh, "mesh file")->required();
    command->add_option("output", work->output, "annotations to write (.ant.json)")->required();
    command->add_option(
        "--up", work->up,
        "x, y, z, -x, -y, -z or three numbers: upward direction; else as the annotations of --compare say, else 0,0,1");
    command->add_option("--unit", work->unit, "unit of the mesh; else as the annotations of --compare say");
    command->add_option("--curve", work->curve, "plot of the criterion over the number of clusters (.svg, .png)");
    command->add_option("--compare", work->compare,
                        "annotations with the known parts; else the mesh file's labels, if it has any");
    add_flags(command, work->options);
}

}  // namespace ostraka::app

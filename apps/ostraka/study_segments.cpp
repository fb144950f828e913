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

#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct StudySegments {
    std::string mesh, output, up, curve, compare;
    SliceSegmentOptions options;

    [[nodiscard]] Vector upward(const Mesh& surface) const {
        std::array<double, 3> way{0, 0, 1};
        if (!up.empty()) way = direction_of(up, "--up");
        else if (!compare.empty()) way = read_annotations(compare, surface).up.value_or(way);
        return {way[0], way[1], way[2]};
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
        provenance.add_input(mesh);
        if (!compare.empty()) provenance.add_input(compare);
        const MeshFile file = read_mesh(mesh);
        for (const auto& note : file.notes) session.note("note: " + note);
        const SliceSegments segments = in_file(mesh, [&] { return segment_by_slices(file.mesh, upward(file.mesh), options); });
        AnnotationSet set = annotate_segments(file.mesh, segments);
        const Vector way = upward(file.mesh);
        set.up = {way.x(), way.y(), way.z()};
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
        std::cout << table({"clusters", "cost", "silhouette", "gap", "gap error"}, counts) << segments.count.proposed
                  << " clusters proposed by " << options.count.criterion << ", " << segments.clusters << " used\n\n"
                  << table({"segment", "cluster", "from", "to", "slices", "area"}, cells);
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
    command->add_option("--up", work->up, "x,y,z: upward direction; else as the annotations of --compare say, else 0,0,1");
    command->add_option("--curve", work->curve, "plot of the criterion over the number of clusters (.svg, .png)");
    command->add_option("--compare", work->compare,
                        "annotations with the known parts; else the mesh file's labels, if it has any");
    add_flags(command, work->options);
}

}  // namespace ostraka::app

// ostraka annotation segment: a mesh cut into parts of like thickness, each an annotation.
#include "command.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/fields/thickness.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/examine.h"
#include "ostraka/select/scalars.h"

#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct Segment {
    std::string mesh, output, labels_out;
    SegmentOptions options;
    ThicknessOptions thickness_options;

    int run(const Session& session) const {
        check_outputs({mesh}, {output, labels_out});
        Provenance provenance{"annotation segment", list_options(options), {}};
        for (const auto& option : list_options(thickness_options)) provenance.options.push_back(option);
        provenance.add_input(mesh);
        const MeshFile file = read_mesh(mesh);
        for (const auto& note : file.notes) session.note("note: " + note);
        const AnnotationSet set = in_file(mesh, [&] {
            const std::vector<Index> number = segment(file.mesh, thickness(file.mesh, thickness_options), options);
            const std::vector<std::int32_t> labels(number.begin(), number.end());
            if (!labels_out.empty()) write_labels(labels_out, labels);
            std::map<std::int32_t, std::string> names;
            for (const std::int32_t label : labels)
                if (!names.contains(label)) names[label] = "segment " + std::to_string(label);
            return regions_from_labels(file.mesh, labels, names);
        });
        write_annotations(output, set, file.mesh, mesh, provenance);
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType);
        std::vector<std::vector<std::string>> rows;
        for (const Annotation& annotation : set.annotations) {
            const AnnotationSummary summary = summarise(file.mesh, annotation);
            JsonValue entry(rapidjson::kObjectType);
            add_member(entry, "id", JsonValue(annotation.id), allocator);
            add_member(entry, "tag", annotation.tag, allocator);
            add_member(entry, "faces", JsonValue(static_cast<std::uint64_t>(summary.elements)), allocator);
            add_member(entry, "area", JsonValue(summary.area), allocator);
            list.PushBack(entry, allocator);
            rows.push_back(
                {std::to_string(annotation.id), annotation.tag, std::to_string(summary.elements), number(summary.area)});
        }
        add_member(result, "segments", std::move(list), allocator);
        if (session.json) session.print_report(provenance, document, result);
        else std::cout << table({"id", "tag", "faces", "area"}, rows);
        return done;
    }
};

}  // namespace

void add_annotation_segment(CLI::App& annotation, Session& session) {
    const auto work = std::make_shared<Segment>();
    CLI::App* command = session.add(annotation, "segment", "cut a mesh into parts of like thickness, each an annotation",
                                    [&session, work] { return work->run(session); });
    command->add_option("mesh", work->mesh, "mesh file, closed")->required();
    command->add_option("output", work->output, "annotations to write (.ant.json)")->required();
    command->add_option("--labels-out", work->labels_out, "write the number of each face's segment, one a line");
    add_flags(command, work->options);
    add_flags(command, work->thickness_options);
}

}  // namespace ostraka::app

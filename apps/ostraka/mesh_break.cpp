// ostraka mesh break: a fragment whose pose and place on the whole are known.
#include "command.h"
#include "number_lists.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/remap.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/shapes/fragments.h"

#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct Break {
    std::string input, output, annotations, annotations_out, at, pose_out;
    BreakOptions options;

    int run(const Session& session) const {
        check_options(options, "mesh break");
        if (annotations.empty() && !annotations_out.empty())
            fail_usage("--annotations-out is given without --annotations", "give those of the whole too");
        std::vector<Path> inputs{input}, outputs{output};
        if (!annotations.empty()) inputs.emplace_back(annotations);
        if (!annotations_out.empty()) outputs.emplace_back(annotations_out);
        if (!pose_out.empty()) outputs.emplace_back(pose_out);
        check_outputs(inputs, outputs);
        Provenance provenance{"mesh break", list_options(options), {}};
        provenance.options.emplace_back("at", at);
        for (const Path& file : inputs) provenance.add_input(file);
        const MeshFile whole = read_mesh(input);
        std::optional<AnnotationSet> set;
        if (!annotations.empty()) set.emplace(read_annotations(annotations, whole.mesh));
        const BrokenPiece piece =
            in_file(input, [&] { return break_off(whole.mesh, place(whole.mesh, set ? &*set : nullptr), options); });

        OutputTransaction transaction;
        MeshExtras extras;
        const auto take = [](const auto& from, const std::vector<Index>& kept, auto& to) {
            if (!from.empty())
                for (const Index i : kept) to.push_back(from[i]);
        };
        take(whole.extras.vertex_colours, piece.vertices, extras.vertex_colours);
        take(whole.extras.vertex_labels, piece.vertices, extras.vertex_labels);
        take(whole.extras.face_colours, piece.faces, extras.face_colours);
        take(whole.extras.face_labels, piece.faces, extras.face_labels);
        write_mesh(output, piece.mesh, extras);
        if (!annotations_out.empty()) {
            const auto inverse = [](const std::vector<Index>& kept, std::size_t count) {
                std::vector<Index> map(count, no_index);
                for (std::size_t i = 0; i < kept.size(); ++i) map[kept[i]] = static_cast<Index>(i);
                return map;
            };
            AnnotationSet rest =
                remap_annotations(whole.mesh, *set, piece.mesh, inverse(piece.vertices, whole.mesh.number_of_vertices()),
                                  inverse(piece.faces, whole.mesh.number_of_faces()));
            // What became a line or a point since its region is gone is not there any more.
            std::erase_if(rest.annotations, [&](const Annotation& one) {
                const Annotation* before = set->find(one.id);
                return before == nullptr || before->type != one.type ||
                       (one.type == AnnotationType::point && one.points.size() != before->points.size());
            });
            rest.up.reset();
            write_annotations(annotations_out, rest, piece.mesh, Path(output).filename().string(), provenance);
        }
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue rows(rapidjson::kArrayType);
        for (int i = 0; i < 4; ++i) {
            JsonValue row(rapidjson::kArrayType);
            for (int j = 0; j < 4; ++j)
                row.PushBack(i == 3 ? (j == 3 ? 1.0 : 0.0) : (j == 3 ? piece.pose.shift[i] : piece.pose.turn(i, j)), allocator);
            rows.PushBack(row, allocator);
        }
        JsonValue result(rapidjson::kObjectType);
        add_member(result, "vertices", JsonValue(static_cast<std::uint64_t>(piece.vertices.size())), allocator);
        add_member(result, "faces", JsonValue(static_cast<std::uint64_t>(piece.faces.size())), allocator);
        add_member(result, "pose", std::move(rows), allocator);
        if (!pose_out.empty()) write_json(pose_out, result["pose"]);
        transaction.commit();
        if (session.json) session.print_report(provenance, document, result);
        else std::cout << printable(output) << ": " << piece.vertices.size() << " vertices, " << piece.faces.size() << " faces\n";
        return done;
    }

private:
    [[nodiscard]] Point place(const Mesh& mesh, const AnnotationSet* set) const {
        if (set != nullptr)
            for (const Annotation& one : set->annotations) {
                if (one.tag != at) continue;
                const auto vertices = touched_vertices(mesh, one);
                Eigen::Vector3d sum = Eigen::Vector3d::Zero();
                for (const Index v : vertices) sum += eigen(mesh.point(Vertex(v)));
                if (!vertices.empty()) return point_of(sum / static_cast<double>(vertices.size()));
            }
        std::vector<double> numbers;
        try {
            numbers = numbers_of<double>(at, "--at");
        } catch (const Error&) {
            numbers.clear();  // said below, with what else it may be
        }
        if (numbers.size() != 3)
            fail_usage("--at is '" + printable(at, 60) + (set != nullptr ? "', and no annotation has this tag" : "'"),
                       set != nullptr ? "give the tag of an annotation, or three numbers like 0,0,10"
                                      : "give three numbers like 0,0,10, or --annotations that have this tag");
        if (set != nullptr && annotations_out.empty())
            fail_usage("--annotations are neither needed for --at nor written", "give --annotations-out, or leave them away");
        for (const double x : numbers)
            if (!std::isfinite(x)) fail_usage("--at is not finite", "give a place on the object");
        return {numbers[0], numbers[1], numbers[2]};
    }
};

}  // namespace

void add_mesh_break(CLI::App& mesh, Session& session) {
    const auto work = std::make_shared<Break>();
    CLI::App* command = session.add(mesh, "break", "break a piece off an object: a fragment whose pose on the whole is known",
                                    [&session, work] { return work->run(session); });
    command->add_option("input", work->input, "mesh file")->required();
    command->add_option("output", work->output, "mesh file of the fragment to write")->required();
    command->add_option("--at", work->at, "middle of the fragment: a place x,y,z, or the tag of an annotation")->required();
    command->add_option("--annotations", work->annotations, "annotations of the whole (.ant.json)");
    command->add_option("--annotations-out", work->annotations_out, "those of the fragment to write");
    command->add_option("--pose-out", work->pose_out,
                        "4 x 4 matrix (JSON) that carries the fragment back to its place on the whole");
    add_flags(command, work->options);
}

}  // namespace ostraka::app

#include "study.h"

#include "ostraka/core/parallel.h"
#include "ostraka/core/progress.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/shapes/head_casts.h"

#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct MakeHeads {
    std::string folder, format = "ply";
    MouldPopulationOptions population;
    CastOptions cast;
};

int make(const MakeHeads& input, const Session& session) {
    const std::vector<PlannedHead> plan = plan_heads(input.population, input.cast);
    const Path folder(input.folder);
    make_collection_folder(input.folder);

    Provenance provenance;
    provenance.command = "study make moulds";
    for (const auto& list : {list_options(input.population), list_options(input.cast)})
        provenance.options.insert(provenance.options.end(), list.begin(), list.end());

    std::vector<HeadCast> casts(plan.size());
    Progress progress("heads", plan.size());
    parallel_for(
        plan.size(),
        [&](std::size_t i) {
            HeadCast cast = cast_head(plan[i].shape, plan[i].cast);
            MeshExtras extras;
            extras.face_labels = cast.face_labels;
            WriteOptions options;
            options.comment = provenance.to_line();
            write_mesh(folder / (plan[i].name + ".ply"), cast.mesh, extras, options);
            cast.mesh.clear();
            casts[i] = std::move(cast);
            progress.advance();
        },
        1);

    std::string table = "name,label,hair,beard,missing piece,wear,shrinkage,seed\n";
    const auto yes = [](bool value) { return value ? "yes" : "no"; };
    for (std::size_t i = 0; i < plan.size(); ++i) {
        const char* hair = plan[i].shape.hat != HeadShape::Hat::none ? "hat" : plan[i].shape.long_hair ? "long" : "short";
        table += plan[i].name + "," + plan[i].mould + "," + hair + "," + yes(casts[i].beard) + "," + yes(casts[i].chunk) + "," +
                 number(casts[i].wear, 4) + "," + number(casts[i].shrinkage, 4) + "," + std::to_string(plan[i].cast.seed) + "\n";
    }
    write_file(folder / "truth.csv", table);

    if (session.json) {
        Json document;
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), parts(rapidjson::kArrayType);
        add_member(result, "objects", JsonValue(static_cast<std::uint64_t>(plan.size())), allocator);
        for (const auto& part : head_part_names()) parts.PushBack(json_string(part, allocator), allocator);
        add_member(result, "parts", std::move(parts), allocator);
        session.print_report(provenance, document, result);
        return done;
    }
    std::cout << plan.size() << " heads in " << input.folder << ", their moulds in truth.csv\n";
    std::vector<std::vector<std::string>> rows;
    const auto names = head_part_names();
    for (std::size_t part = 0; part < names.size(); ++part) rows.push_back({std::to_string(part), names[part]});
    std::cout << app::table({"label", "part"}, rows);
    return done;
}

}  // namespace

void add_study_make_moulds(CLI::App& made, Session& session) {
    auto input = std::make_shared<MakeHeads>();
    CLI::App* command =
        session.add(made, "moulds", "heads of figurines cast from a few moulds, each worn, pressed and scanned on its own",
                    [input, &session] { return make(*input, session); });
    command->add_option("folder", input->folder, "folder to write to: a PLY mesh with labelled faces each, and truth.csv")
        ->required();
    add_flags(command, input->population);
    add_flags(command, input->cast);
}

}  // namespace ostraka::app

#include "commands.h"

#include "ostraka/core/parallel.h"
#include "ostraka/core/progress.h"

#include <csignal>
#include <iostream>
#include <new>

// NOLINTNEXTLINE(bugprone-exception-escape): what stands outside the try and in the catches throws only without any memory left
int main(int argc, char** argv) {
    using namespace ostraka;
    // A closed pipe or a full disk shall be an error with words, not a signal.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    app::Session session;
    CLI::App tool("Semantics-aware modelling of 3D shapes", "ostraka");
    tool.set_version_flag("--version", version());
    tool.require_subcommand(1);
    CLI::App* mesh = tool.add_subcommand("mesh", "examine, repair, convert, resize and make meshes");
    mesh->require_subcommand(1);
    CLI::App* annotation = tool.add_subcommand("annotation", "annotate meshes and carry annotations between them");
    annotation->require_subcommand(1);
    CLI::App* relation = tool.add_subcommand("relation", "relationships among annotations");
    relation->require_subcommand(1);
    CLI::App* measure = tool.add_subcommand("measure", "take measures, describe annotations, compute maps");
    measure->require_subcommand(1);
    CLI::App* vocabulary = tool.add_subcommand("vocabulary", "the words that tags and attributes are taken from");
    vocabulary->require_subcommand(1);
    CLI::App* bundle = tool.add_subcommand("template", "the files of a template, as one");
    bundle->require_subcommand(1);
    CLI::App* cage = tool.add_subcommand("cage", "cages around meshes, and coordinates in them");
    cage->require_subcommand(1);
    CLI::App* study = tool.add_subcommand("study", "questions to a whole collection of objects");
    study->require_subcommand(1);
    CLI::App* made = study->add_subcommand("make", "collections whose answers are known, to try a study on");
    made->require_subcommand(1);
    app::add_mesh_info(*mesh, session);
    app::add_mesh_convert(*mesh, session);
    app::add_mesh_repair(*mesh, session);
    app::add_mesh_resize(*mesh, session);
    app::add_mesh_break(*mesh, session);
    app::add_mesh_make(*mesh, session);
    app::add_annotation(*annotation, session);
    app::add_annotation_select(*annotation, session);
    app::add_annotation_creases(*annotation, session);
    app::add_annotation_facets(*annotation, session);
    app::add_annotation_segment(*annotation, session);
    app::add_annotation_transfer(*annotation, session);
    app::add_annotation_survival(*annotation, session);
    app::add_axis(tool, session);
    app::add_slice(tool, session);
    app::add_relation(*relation, session);
    app::add_annotation_exchange(*annotation, session);
    app::add_annotation_edit(*annotation, session);
    app::add_annotation_merge(*annotation, session);
    app::add_measure(*measure, session);
    app::add_measure_map(*measure, session);
    app::add_measure_clay(*measure, session);
    app::add_annotation_infer(*annotation, session);
    app::add_template(*bundle, session);
    app::add_template_learn(*bundle, session);
    app::add_template_sample(*bundle, session);
    app::add_template_turn(*bundle, session);
    app::add_vocabulary(*vocabulary, session);
    app::add_cage_make(*cage, session);
    app::add_cage(*cage, session);
    app::add_deform(tool, session);
    app::add_fit(tool, session);
    app::add_pair(tool, session);
    app::add_render(tool, session);
    app::add_study_make_proportions(*made, session);
    app::add_study_landmarks(*study, session);
    app::add_study_proportions(*study, session);
    app::add_study_moulds(*study, session);
    app::add_study_make_moulds(*made, session);
    app::add_study_make_technique(*made, session);
    app::add_study_technique(*study, session);
    app::add_study_segments(*study, session);
    try {
        tool.parse(argc, argv);
        set_threads(session.threads);
        if (session.quiet) Progress::switch_off();
        return session.action ? session.action() : app::done;
    } catch (const CLI::ParseError& error) {
        if (tool.exit(error) != 0) return app::wrong_usage;
        std::cout.flush();
        return std::cout ? app::done : app::failed;
    } catch (const Error& error) {
        std::cerr << "ostraka: " << app::printable(error.what()) << '\n';
        return error.kind() == ErrorKind::usage ? app::wrong_usage : app::failed;
    } catch (const std::bad_alloc&) {
        std::cerr << "ostraka: out of memory (close other programs or use a smaller mesh)\n";
        return app::failed;
    } catch (const std::exception& error) {
        std::cerr << "ostraka: internal error: " << error.what() << " (please report it with the command that caused it)\n";
        return app::failed;
    }
}

// Experiments: how faithful transfer is, how sound cages are, what semantic constraints keep. Each prints Markdown tables and
// writes the raw rows as CSV.
#include "breaks.h"
#include "classes.h"
#include "experiments.h"

#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"

#include <CLI/CLI.hpp>

#include <iostream>

int main(int argc, char** argv) {
    using namespace ostraka;
    CLI::App tool("Experiments on annotation transfer, cages and semantic constraints", "ostraka_experiments");
    tool.require_subcommand(1);
    int threads = 0;
    tool.add_option("--threads", threads, "number of threads, 0 for all cores")->check(CLI::Range(0, 1024));

    experiments::TableOptions table;
    CLI::App* table_command =
        tool.add_subcommand("table", "distortions per metric, size and pair of resolutions (thesis, Table 2.1)");
    table_command->add_option("--made", table.made, "made objects to use, or none")->delimiter(',');
    table_command
        ->add_option("--scan", table.scans, "mesh files of scans to use; they are subdivided smoothly to the full resolution")
        ->delimiter(',');
    table_command->add_option("--full", table.full, "vertices of the full resolution")->capture_default_str();
    table_command->add_option("--rungs", table.rungs, "other resolutions, the first is the one annotated")->delimiter(',');
    table_command->add_option("--metric", table.metric, "only the rows whose metric contains this");
    table_command->add_option("--csv", table.csv, "raw rows");
    table_command->add_flag("--truth-only", table.truth_only, "only the overlap with the parts of the made objects");
    table_command->add_flag("--no-independent", table.no_independent, "leave out independently meshed resolutions");

    experiments::Table41Options table_4_1;
    CLI::App* table_4_1_command =
        tool.add_subcommand("table-4-1", "a region made plane, over the mesh and through a cage: time and memory");
    table_4_1_command->add_option("--made", table_4_1.made, "made object")->capture_default_str();
    table_4_1_command->add_option("--scan", table_4_1.scan,
                                  "mesh file instead; refined and simplified to each number of vertices");
    table_4_1_command->add_option("--sizes", table_4_1.sizes, "numbers of vertices")->delimiter(',');
    table_4_1_command->add_option("--direction", table_4_1.direction, "the region is around the vertex farthest along it")
        ->delimiter(',');
    table_4_1_command->add_option("--share", table_4_1.share, "of the surface, of the region")->capture_default_str();
    table_4_1_command->add_option("--cage-vertices", table_4_1.cage_vertices, "of the cage")->capture_default_str();
    table_4_1_command->add_option("--iterations", table_4_1.iterations, "plain iterations that are timed")->capture_default_str();
    table_4_1_command->add_option("--output", table_4_1.output, "folder to write to")->capture_default_str();

    experiments::Figure46Options figure_4_6;
    CLI::App* figure_4_6_command =
        tool.add_subcommand("figure-4-6", "a region made plane, over the mesh and through a cage: what else moves");
    figure_4_6_command->add_option("mesh", figure_4_6.mesh, "mesh file")->required();
    figure_4_6_command->add_option("annotations", figure_4_6.annotations, "its annotations")->required();
    figure_4_6_command->add_option("cage", figure_4_6.cage, "its cage")->required();
    figure_4_6_command->add_option("region", figure_4_6.region, "tag of the region that is to become plane")->required();
    figure_4_6_command->add_option("--output", figure_4_6.output, "folder to write to")->capture_default_str();

    experiments::ControlPointOptions control;
    CLI::App* control_command =
        tool.add_subcommand("control-points", "control points of annotations, level by level (figure 5.11)");
    control_command->add_option("mesh", control.mesh, "mesh file")->required();
    control_command->add_option("annotations", control.annotations, "its annotations")->required();
    control_command->add_option("cage", control.cage, "its cage")->required();
    control_command->add_option("weights", control.weights, "weights of 'ostraka cage weights'")->required();
    control_command->add_option("--threshold", control.threshold, "of influence")->capture_default_str();
    control_command->add_option("--output", control.output, "folder to write to")->capture_default_str();

    experiments::MovedOptions moved;
    CLI::App* moved_command = tool.add_subcommand("moved", "how far each annotation moves from one shape of a mesh to others");
    moved_command->add_option("mesh", moved.mesh, "the shape at rest")->required();
    moved_command->add_option("annotations", moved.annotations, "its annotations")->required();
    moved_command->add_option("shapes", moved.shapes, "mesh files with the same vertices")->required();
    moved_command->add_option("--output", moved.output, "folder to write to")->required();

    experiments::CageReachOptions reach;
    CLI::App* reach_command =
        tool.add_subcommand("cage-reach", "how near cages come to what constraints ask for (figures 6.1, 6.2)");
    reach_command->add_option("mesh", reach.mesh, "mesh file")->required();
    reach_command->add_option("annotations", reach.annotations, "its annotations")->required();
    reach_command->add_option("graph", reach.graph, "relationships, some of them constraints")->required();
    reach_command->add_option("--edit", reach.edits, "NAME=FILE of an edit")->required();
    reach_command->add_option("--cage", reach.cages, "NAME=FILE of a cage")->required();
    reach_command->add_option("--iterations", reach.iterations, "at most")->capture_default_str();
    reach_command->add_option("--output", reach.output, "folder to write to")->capture_default_str();

    experiments::LabelOptions labels;
    CLI::App* label_command = tool.add_subcommand("labels", "part labels carried to a remeshed version and back");
    label_command->add_option("models", labels.models, "folder with <class>/<number>.off")->required();
    label_command->add_option("labels", labels.labels, "folder with <number>/<number>_<k>.seg")->required();
    label_command->add_option("--csv", labels.csv, "raw rows");
    label_command->add_option("--limit", labels.limit, "use only the first models");

    experiments::CageTableOptions cages;
    CLI::App* cage_command = tool.add_subcommand("cages", "cages of many meshes: how many are sound, and how long they take");
    cage_command->add_option("meshes", cages.meshes, "closed meshes; open ones are left out")->required();
    cage_command->add_option("--vertices", cages.vertices, "wanted numbers of vertices")->delimiter(',');
    cage_command->add_option("--csv", cages.csv, "raw rows");

    experiments::FixedProportionsOptions fixed;
    CLI::App* fixed_command = tool.add_subcommand("proportions", "planted proportions found in made populations, and false ones");
    fixed_command->add_option("output", fixed.output, "folder for table and plot")->capture_default_str();
    fixed_command->add_option("--seeds", fixed.seeds, "populations of each kind")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();

    experiments::PoseSearchExperiment poses;
    CLI::App* pose_command = tool.add_subcommand("pose-search", "pieces broken off objects, and where a search lays them");
    pose_command->add_option("--whole", poses.wholes, "mesh files, or made:NAME")->delimiter(',');
    pose_command->add_option("--member", poses.members, "TEMPLATE=MEMBER: pieces of another member of the class")->delimiter(',');
    pose_command->add_option("--stranger", poses.strangers, "TEMPLATE=OTHER: pieces of no such object")->delimiter(',');
    pose_command->add_option("--shares", poses.shares, "of the surface")->delimiter(',');
    pose_command->add_option("--noises", poses.noises, "shares of the diagonal")->delimiter(',');
    pose_command->add_option("--erosion", poses.erosion, "share of the diagonal")->capture_default_str();
    pose_command->add_option("--pieces", poses.pieces, "of each kind")->capture_default_str();
    pose_command->add_option("--vertices", poses.vertices, "of made objects")->capture_default_str();
    pose_command->add_option("--least-scale", poses.search.least_scale, "of the template")->capture_default_str();
    pose_command->add_option("--most-scale", poses.search.most_scale, "of the template")->capture_default_str();
    pose_command->add_option("--csv", poses.csv, "raw rows");

    experiments::BreakExperiment breaks;
    const auto add_breaks = [&](const char* name, const char* text) {
        CLI::App* command = tool.add_subcommand(name, text);
        command->add_option("output", breaks.output, "folder for tables and meshes")->capture_default_str();
        command->add_option("--data", breaks.data, "folder with the scanned fragments")->capture_default_str();
        command->add_option("--motions", breaks.motions, "random ones of all sherds")
            ->check(CLI::Range(1, 1000))
            ->capture_default_str();
        command->add_option("--pots", breaks.pots, "made vessels of each kind")
            ->check(CLI::Range(1, 1000))
            ->capture_default_str();
        return command;
    };
    CLI::App* break_pairs_command = add_breaks("break-pairs", "two halves of a bottle, and neighbours among scanned sherds");
    CLI::App* sherd_turns_command = add_breaks("sherd-turns", "scanned sherds on the template turned from them, turns by breaks");
    CLI::App* broken_pots_command = add_breaks("broken-pots", "made vessels, broken: turns by breaks");

    experiments::MouldExperimentOptions heads;
    CLI::App* mould_command = tool.add_subcommand("moulds", "moulds of made heads and of mixes of faces, found again");
    mould_command->add_option("output", heads.output, "folder for tables and plots")->capture_default_str();
    mould_command->add_option("--part", heads.parts, "choices, wear, runs, scans; all if not given")
        ->delimiter(',')
        ->check(CLI::IsMember({"choices", "wear", "runs", "scans"}));
    mould_command->add_option("--face", heads.faces, "mesh files of faces with the same vertices, for scans");
    mould_command->add_option("--objects", heads.objects, "casts of four moulds")
        ->check(CLI::Range(8, 10000))
        ->capture_default_str();
    mould_command->add_option("--seeds", heads.seeds, "populations")->check(CLI::Range(1, 1000))->capture_default_str();
    mould_command->add_option("--vertices", heads.vertices, "of a whole head")
        ->check(CLI::Range(1500, 1000000))
        ->capture_default_str();

    experiments::FragmentExperiment broken;
    CLI::App* fragment_command = tool.add_subcommand("fragments", "fragments of deformed copies of a template, fitted");
    fragment_command->add_option("output", broken.output, "folder for the table")->capture_default_str();
    fragment_command->add_option("--seeds", broken.seeds, "fragments of each kind")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    fragment_command->add_option("--shares", broken.shares, "of the surface that fragments have")->delimiter(',');
    fragment_command->add_option("--vertices", broken.vertices, "of the template")
        ->check(CLI::Range(4000, 1000000))
        ->capture_default_str();
    fragment_command->add_option("--space", broken.space, "of the fit; with another than mesh no class is asked")
        ->check(CLI::IsMember({"mesh", "cage", "both"}))
        ->capture_default_str();

    CLI::App* verdict_command = tool.add_subcommand("verdicts", "pairs of fragments that belong together, or do not");
    verdict_command->add_option("output", broken.output, "folder for the table")->capture_default_str();
    verdict_command->add_option("--pairs", broken.pairs, "half of them of one object")
        ->check(CLI::Range(4, 100000))
        ->capture_default_str();
    verdict_command->add_option("--vertices", broken.vertices, "of the template")->check(CLI::Range(4000, 1000000));
    verdict_command->add_option("--seed", broken.seed, "of members and breaks");

    experiments::ClassMembershipOptions classes;
    CLI::App* class_command = tool.add_subcommand("classes", "which class an object belongs to, leave one out");
    class_command->add_option("models", classes.models, "folder with <class>/<number>.off")->required();
    class_command->add_option("--output", classes.output, "folder for tables")->capture_default_str();
    class_command->add_option("--labels", classes.labels, "folder with <class>/<number>/*.seg");
    class_command->add_option("--members", classes.members, "of each class, at most");
    class_command->add_option("--vertices", classes.template_vertices, "of the templates")->capture_default_str();
    class_command->add_option("--object-vertices", classes.object_vertices, "of the objects, at most")->capture_default_str();
    class_command->add_option("--tries", classes.tries, "placements that are fitted")->check(CLI::Range(1, 5));
    class_command->add_option("--reach", classes.reach, "farthest match in the first level, as a share of the diagonal")
        ->capture_default_str();

    experiments::ClassCorrespondenceOptions known;
    CLI::App* known_command = tool.add_subcommand("class-correspondence", "modes and fits of faces and bodies in correspondence");
    known_command->add_option("--face", known.faces, "mesh files of faces with the same vertices, the neutral one first")
        ->required();
    known_command->add_option("--landmarks", known.landmarks, "vertices of a face, an index a line")->required();
    known_command->add_option("--body", known.body, "mesh file of a body");
    known_command->add_option("--target", known.targets, "what moves the body's vertices: 'vertex dx dy dz' a line");
    known_command->add_option("--made", known.made, "faces made for the modes")
        ->check(CLI::Range(2, 10000))
        ->capture_default_str();

    experiments::SemanticOptions semantic;
    std::vector<std::pair<CLI::App*, void (*)(const experiments::SemanticOptions&)>> semantic_commands;
    const struct {
        const char *name, *text;
        void (*run)(const experiments::SemanticOptions&);
    } semantic_list[] = {
        {"same-level", "flowers of a stretched teapot (thesis, figures 5.3 and 5.4)", experiments::same_level},
        {"structural-continuity", "a chair's longer arm and its support (figure 5.7)", experiments::structural_continuity},
        {"face-proportions", "nose and eyes of a face (figure 5.17)", experiments::face_proportions},
        {"before-and-after", "a patch's axis, a finger's stretch (figures 5.18 and 5.19)", experiments::before_and_after}};
    for (const auto& [name, text, run] : semantic_list) {
        CLI::App* command = tool.add_subcommand(name, text);
        command->add_option("output", semantic.output, "folder for tables, plots and meshes")->required();
        command->add_option("--vertices", semantic.vertices, "of made objects; 0: as in the thesis");
        command->add_option("--iterations", semantic.iterations, "of the comparison of plain and accelerated iterations")
            ->check(CLI::Range(1, 100000));
        if (run == experiments::face_proportions) {
            command->add_option("--mesh", semantic.mesh, "the face")->required();
            command->add_option("--recipe", semantic.recipe, "with its eyes and nose")->required();
        }
        semantic_commands.emplace_back(command, run);
    }

    experiments::TechniqueExperiment technique;
    CLI::App* technique_command = tool.add_subcommand(
        "technique", "wheel-made or hand-made: F1 on generated statuettes by level of difficulty (section 3.2.1)");
    technique_command->add_option("output", technique.output, "folder for tables and plots")->required();
    technique_command->add_option("--objects", technique.objects, "statuettes of a population")->check(CLI::Range(10, 100000));
    technique_command->add_option("--seeds", technique.seeds, "populations of a level")->check(CLI::Range(1, 1000));
    technique_command->add_option("--vertices", technique.vertices, "of each mesh")->capture_default_str();
    technique_command->add_flag("--variants", technique.variants, "also scan noise, missing interior and holes, at level 3");

    try {
        tool.parse(argc, argv);
        set_threads(threads);
        if (table_command->parsed()) experiments::transfer_table(table);
        if (table_4_1_command->parsed()) experiments::table_4_1(table_4_1);
        if (figure_4_6_command->parsed()) experiments::figure_4_6(figure_4_6);
        if (control_command->parsed()) experiments::control_points(control);
        if (moved_command->parsed()) experiments::moved(moved);
        if (reach_command->parsed()) experiments::cage_reach(reach);
        if (cage_command->parsed()) experiments::cages(cages);
        if (label_command->parsed()) experiments::label_transfer(labels);
        if (fixed_command->parsed()) experiments::fixed_proportions(fixed);
        if (technique_command->parsed()) experiments::technique(technique);
        if (fragment_command->parsed()) experiments::fragments(broken);
        if (verdict_command->parsed()) experiments::verdicts(broken);
        if (known_command->parsed()) experiments::class_correspondence(known);
        if (class_command->parsed()) experiments::class_membership(classes);
        if (mould_command->parsed()) experiments::moulds(heads);
        if (pose_command->parsed()) experiments::pose_search(poses);
        if (break_pairs_command->parsed()) experiments::break_pairs(breaks);
        if (sherd_turns_command->parsed()) experiments::sherd_turns(breaks);
        if (broken_pots_command->parsed()) experiments::broken_pots(breaks);
        for (const auto& [command, run] : semantic_commands)
            if (command->parsed()) run(semantic);
        return 0;
    } catch (const CLI::ParseError& error) {
        return tool.exit(error) == 0 ? 0 : 2;
    } catch (const Error& error) {
        std::cerr << "ostraka_experiments: " << error.what() << '\n';
        return error.kind() == ErrorKind::usage ? 2 : 1;
    }
}

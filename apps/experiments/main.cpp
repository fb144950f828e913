// Experiments: accuracy of annotation transfer, validity of cages, effect of semantic constraints. Each prints Markdown tables
// and writes the raw rows as CSV.
#include "breaks.h"
#include "classes.h"
#include "experiments.h"

#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"

#include <CLI/CLI.hpp>

#include <functional>
#include <iostream>
#include <memory>

namespace ostraka::experiments {
namespace {

template <class Number>
void ranged(CLI::App& command, const char* name, Number& value, const char* text, int minimum, int maximum) {
    command.add_option(name, value, text)->check(CLI::Range(minimum, maximum))->capture_default_str();
}

void declare_transfer_table(CLI::App& command, TableOptions& options) {
    command.add_option("--made", options.made, "made objects to use, or none")->delimiter(',');
    command
        .add_option("--scan", options.scans, "mesh files of scans to use; they are subdivided smoothly to the full resolution")
        ->delimiter(',');
    command.add_option("--full", options.full, "vertices of the full resolution")->capture_default_str();
    command.add_option("--rungs", options.rungs, "other resolutions, the first is the one annotated")->delimiter(',');
    command.add_option("--metric", options.metric, "only the rows whose metric contains this");
    command.add_option("--csv", options.csv, "raw rows");
    command.add_flag("--truth-only", options.truth_only, "only the overlap with the parts of the made objects");
    command.add_flag("--no-independent", options.no_independent, "leave out independently meshed resolutions");
}

void declare_free_outlines(CLI::App& command, FreeOutlineOptions& options) {
    command.add_option("--objects", options.objects, "made:NAME or mesh files")->delimiter(',');
    command.add_option("--sizes", options.sizes, "numbers of vertices, ascending")->delimiter(',');
    command.add_option("--shares", options.shares, "of the surface, of the regions")->delimiter(',');
    command.add_option("--discs", options.discs, "regions of each share")->capture_default_str();
    command.add_option("--csv", options.csv, "raw rows");
}

void declare_table_4_1(CLI::App& command, Table41Options& options) {
    command.add_option("--made", options.made, "made object")->capture_default_str();
    command.add_option("--scan", options.scan, "mesh file instead; refined and simplified to each number of vertices");
    command.add_option("--sizes", options.sizes, "numbers of vertices")->delimiter(',');
    command.add_option("--direction", options.direction, "the region is around the vertex farthest along it")->delimiter(',');
    command.add_option("--share", options.share, "of the surface, of the region")->capture_default_str();
    command.add_option("--cage-vertices", options.cage_vertices, "of the cage")->capture_default_str();
    command.add_option("--iterations", options.iterations, "plain iterations that are timed")->capture_default_str();
    ranged(command, "--convergence", options.convergence,
           "iterations, plain and accelerated, that are compared at the first resolution; 0: none", 0, 100000);
    command.add_option("--output", options.output, "folder to write to")->capture_default_str();
}

void declare_figure_4_6(CLI::App& command, Figure46Options& options) {
    command.add_option("mesh", options.mesh, "mesh file")->required();
    command.add_option("annotations", options.annotations, "its annotations")->required();
    command.add_option("cage", options.cage, "its cage")->required();
    command.add_option("region", options.region, "tag of the region that is to become plane")->required();
    command.add_option("--kind", options.kinds, "coordinates of the cage, once for each")->capture_default_str();
    command.add_option("--nodes", options.nodes, "of the tetrahedra inside the cage")->capture_default_str();
    command.add_option("--output", options.output, "folder to write to")->capture_default_str();
}

void declare_control_points(CLI::App& command, ControlPointOptions& options) {
    command.add_option("mesh", options.mesh, "mesh file")->required();
    command.add_option("annotations", options.annotations, "its annotations")->required();
    command.add_option("cage", options.cage, "its cage")->required();
    command.add_option("weights", options.weights, "weights of 'ostraka cage weights'")->required();
    command.add_option("--threshold", options.threshold, "of influence")->capture_default_str();
    command.add_option("--output", options.output, "folder to write to")->capture_default_str();
}

void declare_counterparts(CLI::App& command, CounterpartExperiment& options) {
    command.add_option("--objects", options.objects, "made objects")->delimiter(',');
    command.add_option("--pairs", options.pairs, "TEMPLATE=MEMBER: mesh files in correspondence")->delimiter(',');
    command.add_option("--cases", options.cases, "by name or number, from 1; all without")->delimiter(',');
    command.add_option("--ways", options.ways, "nearest, or words of 'ostraka fit --counterparts'")->delimiter(',');
    command.add_option("--vertices", options.vertices, "of the template, if it can be held by so few")->capture_default_str();
    command.add_option("--seed", options.seed, "of the other member and its fragments")->capture_default_str();
    command.add_option("--strength", options.strength, "deviation of the logarithm of the size of parts")->capture_default_str();
    command.add_option("--output", options.output, "folder to write to")->capture_default_str();
}

void declare_moved(CLI::App& command, MovedOptions& options) {
    command.add_option("mesh", options.mesh, "the shape at rest")->required();
    command.add_option("annotations", options.annotations, "its annotations")->required();
    auto* shapes = command.add_option("shapes", options.shapes, "mesh files with the same vertices");
    auto* fit = command.add_option("--fit", options.fit,
                                   "folder of 'ostraka fit --no-join': its completed.ply is the shape, and the shape at rest, in "
                                   "the frame of the fragment, goes where the fragment was laid");
    shapes->excludes(fit);
    command.add_option("--pose", options.pose, "of 'ostraka mesh break --pose-out', if the fragment was moved")->needs(fit);
    command.add_option("--fragment", options.fragment, "mesh file of the fragment: laid.ply shows where it was laid")->needs(fit);
    command.add_option("--output", options.output, "folder to write to")->required();
}

void declare_cluster_picture(CLI::App& command, ClusterPictureOptions& options) {
    command.add_option("output", options.output, "folder for the plot and its table")->required();
}

void declare_cage_reach(CLI::App& command, CageReachOptions& options) {
    command.add_option("mesh", options.mesh, "mesh file")->required();
    command.add_option("annotations", options.annotations, "its annotations")->required();
    command.add_option("graph", options.graph, "relationships, some of them constraints")->required();
    command.add_option("--edit", options.edits, "file of an edit, NAME.edit.json")->required();
    command.add_option("--cage", options.cages, "file of a cage, NAME.ply")->required();
    command.add_option("--iterations", options.iterations, "at most")->capture_default_str();
    command.add_option("--output", options.output, "folder to write to")->capture_default_str();
}

void declare_label_transfer(CLI::App& command, LabelOptions& options) {
    command.add_option("models", options.models, "folder with <class>/<number>.off")->required();
    command.add_option("labels", options.labels, "folder with <number>/<number>_<k>.seg")->required();
    command.add_option("--csv", options.csv, "raw rows");
    command.add_option("--limit", options.limit, "use only the first models");
}

void declare_cages(CLI::App& command, CageTableOptions& options) {
    command.add_option("meshes", options.meshes, "closed meshes; open ones are left out")->required();
    command.add_option("--vertices", options.vertices, "wanted numbers of vertices")->delimiter(',');
    command.add_option("--csv", options.csv, "raw rows");
}

void declare_repairs(CLI::App& command, RepairExperiment& options) {
    command.add_option("meshes", options.meshes, "closed meshes; others are left out")->required();
    ranged(command, "--combinations", options.combinations, "of defects, a mesh", 1, 100000);
    command.add_option("--seed", options.seed, "of the defects");
    command.add_option("--csv", options.csv, "raw rows");
}

void declare_fixed_proportions(CLI::App& command, FixedProportionsOptions& options) {
    command.add_option("output", options.output, "folder for table and plot")->capture_default_str();
    ranged(command, "--seeds", options.seeds, "populations of each kind", 1, 100000);
}

void declare_pose_search(CLI::App& command, PoseSearchExperiment& options) {
    command.add_option("--whole", options.wholes, "mesh files, or made:NAME")->delimiter(',');
    command.add_option("--member", options.members, "TEMPLATE=MEMBER: pieces of another member of the class")->delimiter(',');
    command.add_option("--stranger", options.strangers, "TEMPLATE=OTHER: pieces of no such object")->delimiter(',');
    command.add_option("--shares", options.shares, "of the surface")->delimiter(',');
    command.add_option("--noises", options.noises, "shares of the diagonal")->delimiter(',');
    command.add_option("--erosion", options.erosion, "share of the diagonal")->capture_default_str();
    command.add_option("--pieces", options.pieces, "of each kind")->capture_default_str();
    command.add_option("--vertices", options.vertices, "of made objects")->capture_default_str();
    command.add_option("--least-scale", options.search.min_scale, "of the template")->capture_default_str();
    command.add_option("--most-scale", options.search.max_scale, "of the template")->capture_default_str();
    command.add_option("--csv", options.csv, "raw rows");
}

void declare_breaks(CLI::App& command, BreakExperiment& options) {
    command.add_option("output", options.output, "folder for tables and meshes")->capture_default_str();
    command.add_option("--data", options.data, "folder with the scanned fragments")->capture_default_str();
    ranged(command, "--motions", options.motions, "random ones of all sherds", 1, 1000);
    ranged(command, "--pots", options.pots, "made vessels of each kind", 1, 1000);
    ranged(command, "--first", options.first, "vessels left out before the first one", 0, 100000);
    command.add_flag("--write", options.write, "write the sherds, too");
}

template <class Options>
void declare_boxes(CLI::App& command, Options& options) {
    command
        .add_option("--boxes", options.boxes,
                    "pot:SHAPE, plate:SHAPE, stone:SHAPE, made:NAME or a mesh file, to be broken; or a folder of fragments in "
                    "assembled layout")
        ->delimiter(',');
    command.add_option("--output", options.output, "folder for tables")->capture_default_str();
    ranged(command, "--pieces", options.pieces, "that an object is broken into", 2, 100);
    command.add_option("--seed", options.seed, "of breaks, noise and wear");
}

void declare_joins(CLI::App& command, JoinExperiment& options) {
    declare_boxes(command, options);
    command.add_option("--rows", options.rows, "joins.csv of earlier runs, to learn from")->delimiter(',');
    command.add_option("--model", options.model, "model to train and write (data/joins.model.json)");
    command.add_option("--recipe", options.recipe, "how the model is made, in words: written into it")->needs("--model");
    command.add_option("--facets", options.facets, "as they are known, as the library finds them, or so for each second box")
        ->check(CLI::IsMember({"known", "found", "both"}))
        ->capture_default_str();
    command.add_flag("--adjacent-only", options.adjacent_only, "only pairs that touch");
}

void declare_assemblies(CLI::App& command, AssemblyExperiment& options) {
    declare_boxes(command, options);
    ranged(command, "--strangers", options.strangers, "in each box, of the others", 0, 100);
    command.add_flag("--found", options.found, "facets as the library finds them, not as they are known");
}

void declare_facets(CLI::App& command, FacetExperiment& options) {
    ranged(command, "--objects", options.objects, "of each kind that the model is made from", 4, 1000);
    command.add_option("--seed", options.seed, "of objects and breaks");
    ranged(command, "--trees", options.boosting.trees, "of the model", 1, 10000);
    ranged(command, "--depth", options.boosting.depth, "of its trees", 1, 16);
    command.add_option("--model", options.model,
                       "model to make and write (data/facets.model.json); else the built-in one judges");
    command.add_option("--meshes", options.meshes, "folders of meshes of whole objects that are broken for it, too")
        ->delimiter(',');
    command.add_option("--scanned", options.scanned, "folders of fragments in assembled layout that it is made from, too")
        ->delimiter(',');
    command
        .add_option("--judge", options.judged,
                    "pot:SEED, stone:SEED, made:NAME:SEED, mesh:FILE:SEED or a folder of fragments in assembled layout")
        ->delimiter(',');
    command.add_option("--pictures", options.pictures, "folder for coloured meshes of what is judged");
    command.add_flag("--each", options.each, "a row a fragment");
}

void declare_moulds(CLI::App& command, MouldExperimentOptions& options) {
    command.add_option("output", options.output, "folder for tables and plots")->capture_default_str();
    command.add_option("--part", options.parts, "choices, wear, runs, scans; all if not given")
        ->delimiter(',')
        ->check(CLI::IsMember({"choices", "wear", "runs", "scans"}));
    command.add_option("--face", options.faces, "mesh files of faces with the same vertices, for scans");
    ranged(command, "--objects", options.objects, "casts of four moulds", 8, 10000);
    ranged(command, "--casts", options.casts, "in the thesis's runs: casts; heads formed by hand are 60 to 43 of them", 8, 10000);
    ranged(command, "--seeds", options.seeds, "populations", 1, 1000);
    ranged(command, "--vertices", options.vertices, "of a whole head", 1500, 1000000);
}

void declare_fragments(CLI::App& command, FragmentExperiment& options) {
    command.add_option("output", options.output, "folder for the table")->capture_default_str();
    ranged(command, "--seeds", options.seeds, "fragments of each kind", 1, 1000);
    command.add_option("--shares", options.shares, "of the surface that fragments have")->delimiter(',');
    ranged(command, "--vertices", options.vertices, "of the template", 4000, 1000000);
    command.add_option("--space", options.space, "of the fit; with another than mesh no class is asked")
        ->check(CLI::IsMember({"mesh", "cage", "both"}))
        ->capture_default_str();
}

void declare_verdicts(CLI::App& command, FragmentExperiment& options) {
    command.add_option("output", options.output, "folder for the table")->capture_default_str();
    ranged(command, "--pairs", options.pairs, "half of them of one object", 4, 100000);
    command.add_option("--vertices", options.vertices, "of the template")->check(CLI::Range(4000, 1000000));
    command.add_option("--seed", options.seed, "of members and breaks");
}

void declare_class_membership(CLI::App& command, ClassMembershipOptions& options) {
    command.add_option("models", options.models, "folder with <class>/<number>.off")->required();
    command.add_option("--output", options.output, "folder for tables")->capture_default_str();
    command.add_option("--labels", options.labels, "folder with <class>/<number>/*.seg");
    command.add_option("--members", options.members, "of each class, at most");
    command.add_option("--vertices", options.template_vertices, "of the templates")->capture_default_str();
    command.add_option("--object-vertices", options.object_vertices, "of the objects, at most")->capture_default_str();
    command.add_option("--tries", options.tries, "placements that are fitted")->check(CLI::Range(1, 5));
    command.add_option("--reach", options.search_radius, "farthest match in the first level, as a share of the diagonal")
        ->capture_default_str();
}

void declare_class_size(CLI::App& command, ClassSizeOptions& options) {
    command.add_option("--output", options.output, "folder for tables")->capture_default_str();
    command.add_option("--vertices", options.vertices, "of each object")->capture_default_str();
    command.add_option("--seed", options.seed, "of what objects vary in")->capture_default_str();
}

void declare_class_correspondence(CLI::App& command, ClassCorrespondenceOptions& options) {
    command.add_option("--face", options.faces, "mesh files of faces with the same vertices, the neutral one first")->required();
    command.add_option("--landmarks", options.landmarks, "vertices of a face, an index a line")->required();
    command.add_option("--body", options.body, "mesh file of a body");
    command.add_option("--target", options.targets, "what moves the body's vertices: 'vertex dx dy dz' a line");
    ranged(command, "--made", options.made, "faces made for the modes", 2, 10000);
}

void declare_semantic(CLI::App& command, SemanticOptions& options) {
    command.add_option("output", options.output, "folder for tables, plots and meshes")->required();
    command.add_option("--vertices", options.vertices, "of made objects; 0: as in the thesis");
    command.add_option("--convergence", options.convergence, "iterations, plain and accelerated, that are compared; 0: none")
        ->check(CLI::Range(0, 100000));
}

void declare_annotated(CLI::App& command, SemanticOptions& options) {
    declare_semantic(command, options);
    command.add_option("--data", options.data, "folder of the project's recipes, such as teapot.recipe.json")->required();
}

void declare_face(CLI::App& command, SemanticOptions& options) {
    declare_semantic(command, options);
    command.add_option("--mesh", options.mesh, "the face; else one is made");
    command.add_option("--recipe", options.recipe, "with its eyes and nose")->required();
}

void declare_technique(CLI::App& command, TechniqueExperiment& options) {
    command.add_option("output", options.output, "folder for tables and plots")->required();
    command.add_option("--objects", options.objects, "statuettes of a population")->check(CLI::Range(10, 100000));
    command.add_option("--seeds", options.seeds, "populations of a level")->check(CLI::Range(1, 1000));
    command.add_option("--vertices", options.vertices, "of each mesh")->capture_default_str();
    command.add_flag("--variants", options.variants, "also scan noise, missing interior and holes, at level 3");
}

using Run = std::function<void()>;

/// Declares the options of a command, and returns the function that runs it.
template <auto declare, auto run>
Run declared(CLI::App& command) {
    return [&]<class Options>(void (*)(const Options&)) {
        const auto options = std::make_shared<Options>();
        declare(command, *options);
        return Run([options] { run(*options); });
    }(run);
}

struct Experiment {
    const char *name, *text;
    Run (*declare)(CLI::App& command);
};
constexpr Experiment list[] = {
    {"table", "distortions per metric, size and pair of resolutions (thesis, Table 2.1)",
     declared<declare_transfer_table, transfer_table>},
    {"free-outlines", "free outlines carried to other meshes and back, against the same curves laid there place by place",
     declared<declare_free_outlines, free_outlines>},
    {"table-4-1", "a region made plane, over the mesh and through a cage: time and memory",
     declared<declare_table_4_1, table_4_1>},
    {"figure-4-6", "a region made plane, over the mesh and through a cage: what else moves",
     declared<declare_figure_4_6, figure_4_6>},
    {"control-points", "control points of annotations, level by level (figure 5.11)",
     declared<declare_control_points, control_points>},
    {"counterparts", "templates fitted to other members: how far vertices end from their true places",
     declared<declare_counterparts, counterparts>},
    {"moved", "how far each annotation moves from one shape of a mesh to others", declared<declare_moved, moved>},
    {"dbscan", "points of several forms and the clusters found among them (figure 3.7)",
     declared<declare_cluster_picture, cluster_picture>},
    {"cage-reach", "how near cages come to what constraints ask for (figures 6.1, 6.2)",
     declared<declare_cage_reach, cage_reach>},
    {"labels", "part labels carried to a remeshed version and back", declared<declare_label_transfer, label_transfer>},
    {"cages", "cages of many meshes: how many are sound, and how long they take", declared<declare_cages, cages>},
    {"repairs", "combinations of defects on closed meshes, and how many are repaired", declared<declare_repairs, repairs>},
    {"proportions", "planted proportions found in made populations, and false ones",
     declared<declare_fixed_proportions, fixed_proportions>},
    {"pose-search", "pieces broken off objects, and where a search lays them", declared<declare_pose_search, pose_search>},
    {"break-pairs", "two halves of a bottle, and neighbours among scanned sherds", declared<declare_breaks, break_pairs>},
    {"joins", "pairs of fragments of broken objects: right poses and calibration", declared<declare_joins, joins>},
    {"assemblies", "fragments of one object among strangers put together", declared<declare_assemblies, assemblies>},
    {"facets", "breaks told from intact surface: the model made, judged on objects left out and on scans",
     declared<declare_facets, facets>},
    {"sherd-turns", "scanned sherds on the template turned from them, turns by breaks",
     declared<declare_breaks, sherd_rotations>},
    {"broken-pots", "made vessels, broken: turns by breaks", declared<declare_breaks, broken_pots>},
    {"turned-sherds", "made vessels, broken: templates turned from sherds, some of no use",
     declared<declare_breaks, turned_sherds>},
    {"moulds", "moulds of made heads and of mixes of faces, found again", declared<declare_moulds, moulds>},
    {"fragments", "fragments of deformed copies of a template, fitted", declared<declare_fragments, fragments>},
    {"verdicts", "pairs of fragments that belong together, or do not", declared<declare_verdicts, verdicts>},
    {"classes", "which class an object belongs to, leave one out", declared<declare_class_membership, class_membership>},
    {"class-size", "how many members a class needs, of made ones", declared<declare_class_size, class_size>},
    {"class-correspondence", "modes and fits of faces and bodies in correspondence",
     declared<declare_class_correspondence, class_correspondence>},
    {"same-level", "flowers of a stretched teapot (thesis, figures 5.3 and 5.4)", declared<declare_annotated, same_level>},
    {"structural-continuity", "a chair's longer arm and its support (figure 5.7)",
     declared<declare_annotated, structural_continuity>},
    {"face-proportions", "nose and eyes of a face (figure 5.17)", declared<declare_face, face_proportions>},
    {"before-and-after", "a patch's axis, a finger's stretch (figures 5.18 and 5.19)",
     declared<declare_annotated, before_and_after>},
    {"technique", "wheel-made or hand-made: F1 on generated statuettes by level of difficulty (section 3.2.1)",
     declared<declare_technique, technique>}};

}  // namespace
}  // namespace ostraka::experiments

int main(int argc, char** argv) {
    using namespace ostraka;
    CLI::App tool("Experiments on annotation transfer, cages and semantic constraints", "ostraka_experiments");
    tool.require_subcommand(1);
    int threads = 0;
    tool.add_option("--threads", threads, "number of threads, 0 for all cores")->check(CLI::Range(0, 1024));
    std::vector<std::pair<CLI::App*, experiments::Run>> commands;
    for (const auto& [name, text, declare] : experiments::list) {
        CLI::App* command = tool.add_subcommand(name, text);
        commands.emplace_back(command, declare(*command));
    }
    try {
        tool.parse(argc, argv);
        set_threads(threads);
        for (const auto& [command, run] : commands)
            if (command->parsed()) run();
        return 0;
    } catch (const CLI::ParseError& error) {
        return tool.exit(error) == 0 ? 0 : 2;
    } catch (const Error& error) {
        std::cerr << "ostraka_experiments: " << error.what() << '\n';
        return error.kind() == ErrorKind::usage ? 2 : 1;
    }
}

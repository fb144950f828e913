// Experiments that show how faithful transfer is and how sound cages are. Each prints Markdown tables and writes the raw rows as
// CSV.
#include "experiments.h"

#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"

#include <CLI/CLI.hpp>

#include <iostream>

int main(int argc, char** argv) {
    using namespace ostraka;
    CLI::App tool("Experiments on annotation transfer and cages", "ostraka_experiments");
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

    try {
        tool.parse(argc, argv);
        set_threads(threads);
        if (table_command->parsed()) experiments::transfer_table(table);
        if (cage_command->parsed()) experiments::cages(cages);
        if (label_command->parsed()) experiments::label_transfer(labels);
        return 0;
    } catch (const CLI::ParseError& error) {
        return tool.exit(error) == 0 ? 0 : 2;
    } catch (const Error& error) {
        std::cerr << "ostraka_experiments: " << error.what() << '\n';
        return error.kind() == ErrorKind::usage ? 2 : 1;
    }
}

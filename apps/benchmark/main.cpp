#include "benchmarks.h"

#include <exception>
#include <iostream>
#include <string>

namespace {

/// Removes "--name=value" from the arguments and returns the value.
std::string take_value(int& argc, char** argv, const std::string& name) {
    const std::string start = "--" + name + "=";
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument.rfind(start, 0) != 0) continue;
        for (int k = i; k < argc; ++k) argv[k] = argv[k + 1];
        --argc;
        return argument.substr(start.size());
    }
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    using namespace ostraka::bench;
    try {
        if (argc == 5 && std::string(argv[1]) == read_and_build_tree) return run_read_and_build_tree({argv + 2, argv + 5});
        if (argc == 3 && std::string(argv[1]) == read_mesh_only) return run_read_mesh(argv[2]);
        if ((argc == 3 || argc == 4) && std::string(argv[1]) == measure_cancelling)
            return run_cancelling(argv[2], argc == 4 ? argv[3] : "");
        register_command_benchmarks();
        register_bandwidth_benchmarks();
        register_query_benchmarks();
        register_reading_benchmarks();
        register_picture_benchmarks();
        register_relation_benchmarks();
        register_solver_benchmarks();
        register_coordinate_benchmarks();
        register_slicing_benchmarks();
        register_fitting_benchmarks();
        register_transfer_benchmarks();
        const std::string page = take_value(argc, argv, "page");
        benchmark::Initialize(&argc, argv);
        if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
        PageReporter reporter;
        benchmark::RunSpecifiedBenchmarks(&reporter);
        if (!page.empty()) reporter.write(page);
    } catch (const std::exception& error) {
        std::cerr << "ostraka_benchmark: " << error.what() << '\n';
        return 1;
    }
    benchmark::Shutdown();
    return 0;
}

#include "benchmarks.h"

#include <exception>
#include <iostream>

int main(int argc, char** argv) {
    using namespace ostraka::bench;
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
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    try {
        benchmark::RunSpecifiedBenchmarks();
    } catch (const std::exception& error) {
        std::cerr << "ostraka_benchmark: " << error.what() << '\n';
        return 1;
    }
    benchmark::Shutdown();
    return 0;
}

// The built command as a whole: wall time, processor time, peak memory.
#include "benchmarks.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/files/file.h"
#include "ostraka/io/mesh_file.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <string>

namespace ostraka::bench {

namespace {

struct CommandResult {
    int exit_code = -1;
    double seconds = 0, processor_seconds = 0, peak_bytes = 0;
};

double seconds(const timeval& time) { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); }

/// The peak memory of a child counts from the fork, so this process must be smaller than the measured one.
CommandResult run_program(const std::string& program, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), program);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    const auto start = std::chrono::steady_clock::now();
    const pid_t child = ::fork();
    if (child == 0) {
        const int nowhere = ::open("/dev/null", O_WRONLY);
        ::dup2(nowhere, STDOUT_FILENO);
        ::execv(pointers.front(), pointers.data());
        ::_exit(127);
    }
    CommandResult run;
    int status = 0;
    rusage usage{};
    if (child < 0 || ::wait4(child, &status, 0, &usage) != child || !WIFEXITED(status)) return run;
    run.exit_code = WEXITSTATUS(status);
    run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    run.processor_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    run.peak_bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
    return run;
}

CommandResult run_command(std::vector<std::string> arguments) { return run_program(OSTRAKA_COMMAND, std::move(arguments)); }

std::string path_of(const std::string& name) { return (scratch_folder() / name).string(); }

/// The teapot made by the command: binary PLY with labels (and, unless refined, colours).
bool make_teapot(const std::string& name, std::size_t vertices, int seed) {
    static std::map<std::string, bool> is_made;
    const auto [entry, is_new] = is_made.try_emplace(name, false);
    if (!is_new) return entry->second;
    const TargetMeshing meshing = meshing_of(vertices);
    const std::string coarse = meshing.levels > 0 ? "coarse.ply" : name;
    entry->second = run_command({"mesh", "make", "teapot", path_of(coarse), "--vertices", std::to_string(meshing.vertices),
                                 "--seed", std::to_string(seed), "--quiet"})
                        .exit_code == 0;
    if (meshing.levels > 0)
        entry->second = entry->second && run_command({"mesh", "refine", path_of(coarse), path_of(name), "--levels",
                                                      std::to_string(meshing.levels), "--quiet"})
                                                 .exit_code == 0;
    return entry->second;
}

void report(benchmark::State& state, const CommandResult& run, std::size_t vertices) {
    state.SetIterationTime(run.seconds);
    state.counters["cpu_s"] = run.processor_seconds;
    state.counters["peak_MB"] = run.peak_bytes / 1e6;
    state.counters["peak_B_per_vertex"] = run.peak_bytes / static_cast<double>(vertices);
}

CommandResult measure_command(benchmark::State& state, const std::vector<std::string>& arguments, std::size_t vertices,
                              const std::string& program = OSTRAKA_COMMAND) {
    CommandResult run;
    for ([[maybe_unused]] const auto lap : state) {
        rusage own_usage{};
        ::getrusage(RUSAGE_SELF, &own_usage);
        run = run_program(program, arguments);
        if (run.exit_code != 0) state.SkipWithError(("exit code " + std::to_string(run.exit_code)).c_str());
        else if (run.peak_bytes < 2048.0 * static_cast<double>(own_usage.ru_maxrss))
            state.SkipWithError("this process is too large for a measurement: run the command benchmarks alone");
        report(state, run, vertices);
    }
    return run;
}

std::string target_file(std::size_t vertices) { return "target" + std::to_string(vertices) + ".ply"; }

bool make_transfer_files(std::size_t vertices) {
    static std::map<std::size_t, bool> is_made;
    const auto [entry, is_new] = is_made.try_emplace(vertices, false);
    if (is_new)
        entry->second = make_teapot("source.ply", 50'000, 1) && make_teapot(target_file(vertices), vertices, 2) &&
                        run_command({"annotation", "apply", path_of("source.ply"), path_of("source.ant.json"),
                                     "--from-ply-labels", "--quiet"})
                                .exit_code == 0;
    return entry->second;
}

/// Minimal wall time of reading a transfer's input and building CGAL's tree over the target, by number of target vertices.
std::map<std::size_t, double> min_seconds;

void read_and_build(benchmark::State& state, std::size_t vertices) {
    if (!make_transfer_files(vertices)) {
        state.SkipWithError("the inputs could not be made");
        return;
    }
    const CommandResult run = measure_command(
        state, {read_and_build_tree, path_of("source.ply"), path_of("source.ant.json"), path_of(target_file(vertices))}, vertices,
        "/proc/self/exe");
    if (run.exit_code == 0) min_seconds[vertices] = run.seconds;
}

void transfer_command(benchmark::State& state, std::size_t vertices, const std::vector<std::string>& more_arguments) {
    if (!make_transfer_files(vertices)) {
        state.SkipWithError("the inputs could not be made");
        return;
    }
    std::vector<std::string> arguments{"annotation",
                                       "transfer",
                                       path_of("source.ply"),
                                       path_of("source.ant.json"),
                                       path_of(target_file(vertices)),
                                       path_of("result.ant.json"),
                                       "--quiet"};
    arguments.insert(arguments.end(), more_arguments.begin(), more_arguments.end());
    const CommandResult run = measure_command(state, arguments, vertices);
    if (const auto entry = min_seconds.find(vertices); entry != min_seconds.end())
        state.counters["of_reading_and_cgal_tree"] = run.seconds / entry->second;
}

/// Runs a command on the target only; `more_arguments`: those after the mesh file.
void mesh_command(benchmark::State& state, std::size_t vertices, std::vector<std::string> arguments,
                  const std::vector<std::string>& more_arguments, const std::string& program = OSTRAKA_COMMAND) {
    if (!make_teapot(target_file(vertices), vertices, 2)) {
        state.SkipWithError("the input could not be made");
        return;
    }
    arguments.push_back(path_of(target_file(vertices)));
    for (const std::string& argument : more_arguments) arguments.push_back(argument);
    measure_command(state, arguments, vertices, program);
}

/// Five operations on one mesh as a study, compared with five separate commands.
void study_command(benchmark::State& state, std::size_t vertices) {
    const std::string mesh = path_of(target_file(vertices)), study = path_of("five.study.json");
    if (!make_teapot(target_file(vertices), vertices, 2)) {
        state.SkipWithError("the input could not be made");
        return;
    }
    const auto step = [&](const std::string& operation, const std::string& input, const std::string& output,
                          const std::string& more_options) {
        return R"({"operation": ")" + operation + R"(", "keep": [")" + output + R"("], "with": {")" + input + R"(": ")" + mesh +
               R"(")" + more_options + "}}";
    };
    write_file(study, R"({"format": "ostraka-study", "version": 1, "title": "Five operations", "steps": {"curvature": )" +
                          step("measure map", "mesh", "output", R"(, "of": "mean-curvature")") + R"(, "thickness": )" +
                          step("measure map", "mesh", "output", R"(, "of": "gaussian-curvature")") + R"(, "slices": )" +
                          step("slice", "mesh", "output", R"(, "count": 20)") + R"(, "small": )" +
                          step("mesh simplify", "input", "output", R"(, "vertices": 100000)") + R"(, "picture": )" +
                          step("render", "meshes", "picture", "") + "}}");
    double separate_seconds = 0;
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"measure", "map", mesh, path_of("five-1.npy"), "--of", "mean-curvature", "--quiet"},
          {"measure", "map", mesh, path_of("five-2.npy"), "--of", "gaussian-curvature", "--quiet"},
          {"slice", mesh, "--output", path_of("five-3"), "--count", "20", "--quiet"},
          {"mesh", "simplify", mesh, path_of("five-4.ply"), "--vertices", "100000", "--quiet"},
          {"render", mesh, path_of("five-5.png"), "--quiet"}}) {
        const CommandResult command = run_command(arguments);
        if (command.exit_code != 0) state.SkipWithError((arguments.front() + " failed").c_str());
        separate_seconds += command.seconds;
    }
    const CommandResult run =
        measure_command(state, {"run", study, "--output", path_of("five-run"), "--again", "--quiet"}, vertices);
    state.counters["of_bare_commands"] = run.seconds / separate_seconds;
}

}  // namespace

int run_read_mesh(const std::string& file) { return read_mesh(file).mesh.is_empty() ? 1 : 0; }

int run_read_and_build_tree(const std::vector<std::string>& files) {
    const Mesh source = read_mesh(files[0]).mesh;
    const AnnotationSet annotations = read_annotations(files[1], source);
    const Mesh target = read_mesh(files[2]).mesh;
    return !annotations.annotations.empty() && seconds_of_cgal_tree(target) > 0 ? 0 : 1;
}

void register_command_benchmarks() {
    const auto add = [](const std::string& name, auto run) {
        benchmark::RegisterBenchmark(("command/" + name).c_str(), run)
            ->UseManualTime()
            ->Iterations(1)
            ->Unit(benchmark::kMillisecond);
        return "command/" + name;
    };
    for (const std::size_t vertices : {1'000'000, 8'000'000, 27'000'000}) {
        const std::string ending = "/" + std::to_string(vertices);
        add("reading_and_cgal_tree" + ending, [vertices](benchmark::State& state) { read_and_build(state, vertices); });
        for (const bool overlap : {false, true}) {
            const std::string name =
                add("transfer" + std::string(overlap ? "" : "_without_overlap") + ending,
                    [vertices, overlap](benchmark::State& state) {
                        transfer_command(state, vertices,
                                         overlap ? std::vector<std::string>{} : std::vector<std::string>{"--no-overlap"});
                    });
            set_aim(name, "of_reading_and_cgal_tree", 1.5);
            set_aim(name, "peak_B_per_vertex", 600);
        }
    }
    set_aim(add("run_of_five_steps/1000000", [](benchmark::State& state) { study_command(state, 1'000'000); }),
            "of_bare_commands", 1.05);
    for (const std::size_t vertices : {1'000'000, 8'000'000, 27'000'000}) {
        const auto add_mesh = [&](const std::string& name, const std::vector<std::string>& arguments,
                                  const std::vector<std::string>& more_arguments, const std::string& program = OSTRAKA_COMMAND) {
            return add(name + "/" + std::to_string(vertices),
                       [vertices, arguments, more_arguments, program](benchmark::State& state) {
                           mesh_command(state, vertices, arguments, more_arguments, program);
                       });
        };
        add_mesh("reading", {read_mesh_only}, {}, "/proc/self/exe");
        add_mesh("mesh_info", {"mesh", "info"}, {"--quiet"});
        add_mesh("mesh_simplify", {"mesh", "simplify"},
                 {path_of("simplified.ply"), "--vertices", std::to_string(vertices / 10), "--quiet"});
        add_mesh("slice", {"slice"}, {"--output", path_of("slices.csv"), "--quiet"});
        const std::string render = add_mesh("render", {"render"}, {path_of("picture.png"), "--quiet"});
        if (vertices == 1'000'000) set_aim(render, "seconds", 2);
    }
}

}  // namespace ostraka::bench

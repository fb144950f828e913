// How long operations on a million faces take to stop when they are cancelled.
#include "benchmarks.h"
#include "calls.h"
#include "ostraka/core/stopwatch.h"
#include "ostraka/files/json.h"
#include "ostraka/operations/table.h"

#include <atomic>
#include <iomanip>
#include <iostream>
#include <thread>

namespace ostraka::bench {

namespace {

/// An operation with its settings; file names are relative to a folder. Later steps use its outputs.
struct Step {
    const char* operation;
    const char* variant;  ///< distinguishes runs of the same operation
    const char* settings;
};

const Step steps[]{
    {"mesh make", "", R"({"object": "teapot", "output": "pot.ply", "vertices": 500000})"},
    {"mesh make", "statuette", R"({"object": "statuette", "output": "statuette.ply", "vertices": 500000})"},
    {"mesh make", "another seed", R"({"object": "teapot", "output": "other.ply", "vertices": 500000, "seed": 2})"},
    {"mesh info", "", R"({"input": "pot.ply"})"},
    {"mesh convert", "to OBJ", R"({"input": "pot.ply", "output": "pot.obj"})"},
    {"mesh convert", "from OBJ", R"({"input": "pot.obj", "output": "pot.stl"})"},
    {"mesh repair", "of triangles", R"({"input": "pot.stl", "output": "sound.ply"})"},
    {"mesh repair", "wrap",
     R"({"input": "pot.ply", "output": "wrap.ply", "wrap": true, "wrap-alpha": 0.005, "wrap-offset": 0.001})"},
    {"annotation apply", "", R"({"mesh": "pot.ply", "recipe": "teapot.recipe.json", "output": "pot.ant.json"})"},
    {"annotation apply", "statuette",
     R"({"mesh": "statuette.ply", "recipe": "statuette.recipe.json", "output": "statuette.ant.json"})"},
    {"annotation list", "", R"({"mesh": "pot.ply", "annotations": "pot.ant.json"})"},
    {"annotation check", "", R"({"mesh": "pot.ply", "annotations": "pot.ant.json"})"},
    {"mesh simplify", "", R"({"input": "pot.ply", "output": "coarse.ply", "vertices": 20000, "annotations": "pot.ant.json",
                              "annotations-out": "coarse.ant.json"})"},
    {"mesh simplify", "lindstrom-turk",
     R"({"input": "pot.ply", "output": "coarse-2.ply", "vertices": 20000, "method": "lindstrom-turk"})"},
    {"mesh refine", "", R"({"input": "coarse.ply", "output": "fine.ply", "vertices": 500000, "annotations": "coarse.ant.json",
                            "annotations-out": "fine.ant.json"})"},
    {"mesh remesh", "", R"({"input": "pot.ply", "output": "new.ply", "vertices": 500000})"},
    {"mesh extract", "closed", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "body.ply", "annotation": ["body"],
                                   "closed": true})"},
    {"mesh extract", "open",
     R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "open.ply", "annotation": ["body"]})"},
    {"mesh repair", "holes", R"({"input": "open.ply", "output": "filled.ply", "fill-holes": 100000, "fill-holes-size": 1})"},
    {"mesh break", "", R"({"input": "statuette.ply", "annotations": "statuette.ant.json", "output": "piece.ply",
                           "annotations-out": "piece.ant.json", "at": "head", "share": 0.5, "seed": 2})"},
    {"annotation facets", "", R"({"mesh": "piece.ply", "annotations": "piece.ant.json", "output": "facets.ant.json"})"},
    {"annotation transfer", "", R"({"source": "pot.ply", "annotations": "pot.ant.json", "target": "other.ply",
                                    "output": "other.ant.json", "back": "back.ant.json", "refine": true,
                                    "refined-mesh": "refined.ply"})"},
    {"annotation survival", "", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "ratio": 0.5})"},
    {"annotation select", "brush", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "brush.ant.json",
                                       "brush": ["-59,0,50"], "radius": 30, "tag": "patch"})"},
    {"annotation select", "thickness", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "thick.ant.json",
                                           "threshold": "thickness", "above": 0.1, "tag": "patch"})"},
    {"annotation select", "grow", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "grown.ant.json",
                                      "sphere": [-59, 0, 50, 20], "grow": 1000, "tag": "patch"})"},
    {"annotation creases", "", R"({"mesh": "pot.ply", "output": "creases.ant.json", "scale": 0.01})"},
    {"annotation segment", "", R"({"mesh": "pot.ply", "output": "segments.ant.json"})"},
    {"annotation smooth", "", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "smooth.ant.json"})"},
    {"annotation export", "GLB", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "features.glb"})"},
    {"annotation import", "GLB", R"({"mesh": "pot.ply", "input": "features.glb", "output": "imported.ant.json"})"},
    {"measure take", "tape", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "tape.ant.json", "tool": "tape",
                                 "geodesic": "exact", "at": ["0,-59,50", "59,0,50"]})"},
    {"measure describe", "", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "described.ant.json"})"},
    {"measure map", "curvature", R"({"mesh": "pot.ply", "output": "curvature.npy", "of": "mean-curvature"})"},
    {"measure map", "thickness", R"({"mesh": "pot.ply", "output": "thickness.npy", "of": "thickness"})"},
    {"measure clay", "", R"({"mesh": "pot.ply"})"},
    {"relation extract", "", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "pot.graph.json"})"},
    {"relation check", "", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "graph": "pot.graph.json"})"},
    {"cage make", "", R"({"mesh": "pot.ply", "output": "cage.ply", "vertices": 100})"},
    {"cage check", "", R"({"mesh": "pot.ply", "cage": "cage.ply"})"},
    {"cage weights", "", R"({"mesh": "pot.ply", "cage": "cage.ply", "output": "weights.npy"})"},
    {"cage weights", "harmonic", R"({"mesh": "pot.ply", "cage": "cage.ply", "output": "harmonic.npy", "kind": "harmonic"})"},
    {"deform", "", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "edit": "teapot-stretch.edit.json",
                       "output": "stretched.ply", "cage": "cage.ply", "weights": "weights.npy",
                       "annotations-out": "stretched.ant.json"})"},
    {"axis", "", R"({"mesh": "pot.ply"})"},
    {"axis", "rotation", R"({"mesh": "pot.ply", "method": "rotation"})"},
    {"slice", "", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "count": 50, "output": ["slices.json"]})"},
    {"study segments", "", R"({"mesh": "pot.ply", "output": "slices.ant.json"})"},
    {"render", "", R"({"meshes": ["pot.ply"], "annotations": ["pot.ant.json"], "picture": "pot.png"})"},
    {"publish", "", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "folder": "published",
                        "address": "https://pots.example/1"})"},
    {"report", "", R"({"results": ["pot.ply", "pot.ant.json", "pot.graph.json"], "page": "pot.html"})"},
    {"template pack", "", R"({"output": "statuette.template.json", "mesh": "small.ply", "annotations": "small.ant.json"})"},
    {"fit", "", R"({"template": "statuette.template.json", "fragments": ["piece.ply"], "output": "fit"})"},
    {"template propagate", "",
     R"({"template": "statuette.template.json", "members": ["statuette.ply"], "output": "propagated"})"},
};

/// Seconds from the cancellation to the end of the operation; empty if it finished before. Throws if it ends with another
/// error.
std::optional<double> seconds_to_stop(const Step& step, const Path& folder, double after) {
    Context context;
    std::atomic<bool> is_done = false;
    double cancelled_at = -1;
    const Stopwatch clock;
    std::thread other([&] {
        while (!is_done && clock.seconds() < after) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        cancelled_at = clock.seconds();
        context.watch.cancel();
    });
    bool is_cancelled = false;
    std::exception_ptr failure;
    try {
        static_cast<void>(test::call_in(folder, step.operation, step.settings).run(context));
    } catch (const Error& error) {
        is_cancelled = error.kind() == ErrorKind::cancelled;
        if (!is_cancelled) failure = std::current_exception();
    }
    const double ended = clock.seconds();
    is_done = true;
    other.join();
    if (failure) std::rethrow_exception(failure);
    return is_cancelled ? std::optional(ended - cancelled_at) : std::nullopt;
}

void measure_step(const Step& step, const Path& folder) {
    const std::string name = std::string(step.operation) + (*step.variant == 0 ? "" : std::string(", ") + step.variant);
    constexpr double time_limit = 60;
    const Stopwatch clock;
    const auto first_stop = seconds_to_stop(step, folder, time_limit);
    const double full_duration = first_stop ? time_limit : clock.seconds();
    double longest = first_stop.value_or(0);
    for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9})
        if (const auto seconds = seconds_to_stop(step, folder, share * full_duration)) longest = std::max(longest, *seconds);
    std::cout << "| " << name << " | " << (first_stop ? "over " : "") << std::fixed << std::setprecision(first_stop ? 0 : 1)
              << full_duration << " | " << std::setprecision(2) << longest << " |" << std::endl;
}

}  // namespace

int run_cancelling(const std::string& folder, const std::string& only) {
    const Path data = Path(OSTRAKA_SOURCE_DIR) / "data", work_folder = folder;
    make_folder(work_folder);
    for (const char* name : {"teapot.recipe.json", "statuette.recipe.json", "teapot-stretch.edit.json"})
        write_file(work_folder / name, read_file(data / name));
    for (const char* ending : {".ply", ".ant.json"})
        write_file(work_folder / (std::string("small") + ending), read_file(data / (std::string("statuette") + ending)));
    std::cout << "| operation, a million faces | total, seconds | slowest stop, seconds |\n|---|---|---|\n";
    int code = 0;
    for (const Step& step : steps) {
        if (std::string(step.operation).find(only) == std::string::npos) continue;
        try {
            measure_step(step, work_folder);
        } catch (const std::exception& error) {
            std::cout << "| " << step.operation << ", " << step.variant << " | failed: " << error.what() << " | |" << std::endl;
            code = 1;
        }
    }
    return code;
}

}  // namespace ostraka::bench

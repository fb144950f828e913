// Operations cancelled at any time end with that error, leave no file behind, and damage no cached object.
#include "ostraka/cage/cage.h"
#include "ostraka/geom/geodesic.h"
#include "ostraka/geom/point_tree.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/io/wrap.h"
#include "ostraka/measure/solid.h"
#include "ostraka/operations/table.h"
#include "ostraka/remesh/refine.h"
#include "ostraka/remesh/remesh.h"
#include "ostraka/remesh/simplify.h"
#include "ostraka/select/scalars.h"

#include "calls.h"
#include "meshes.h"
#include "scratch.h"

#include <atomic>
#include <chrono>
#include <map>
#include <thread>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// An operation with its settings. Names of files are within a folder.
struct Step {
    const char* operation;
    const char* settings;
};

/// Each works on a mesh, the later ones on outputs of earlier ones.
const std::vector<Step>& steps() {
    static const std::vector<Step> list{
        {"mesh make", R"({"object": "teapot", "output": "pot.ply", "vertices": 2500, "labels": "pot.labels.txt"})"},
        {"mesh make", R"({"object": "teapot", "output": "other.ply", "vertices": 2500, "seed": 2})"},
        {"mesh info", R"({"input": "pot.ply"})"},
        {"mesh convert", R"({"input": "pot.ply", "output": "pot.obj"})"},
        {"mesh repair", R"({"input": "pot.obj", "output": "sound.ply"})"},
        {"mesh repair", R"({"input": "pot.ply", "output": "wrap.ply", "wrap": true})"},
        {"annotation apply", R"({"mesh": "pot.ply", "recipe": "teapot.recipe.json", "output": "pot.ant.json"})"},
        {"annotation check", R"({"mesh": "pot.ply", "annotations": "pot.ant.json"})"},
        {"mesh simplify", R"({"input": "pot.ply", "output": "coarse.ply", "vertices": 1000, "annotations": "pot.ant.json",
                              "annotations-out": "coarse.ant.json"})"},
        {"mesh refine", R"({"input": "pot.ply", "output": "fine.ply", "vertices": 20000})"},
        {"mesh remesh", R"({"input": "pot.ply", "output": "new.ply", "vertices": 2500})"},
        {"mesh bake", R"({"target": "new.ply", "source": "pot.ply", "output": "baked.ply", "of": "occlusion"})"},
        {"mesh register", R"({"source": "pot.ply", "target": "other.ply", "output": "registered.ply"})"},
        {"mesh extract", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "spout.ply", "annotation": ["spout"],
                             "closed": true})"},
        {"mesh break", R"({"input": "pot.ply", "output": "piece.ply", "at": "59,0,50", "share": 0.4})"},
        {"annotation facets", R"({"mesh": "piece.ply", "annotations": "piece.ant.json"})"},
        {"annotation transfer", R"({"source": "pot.ply", "annotations": "pot.ant.json", "target": "other.ply",
                                    "output": "other.ant.json", "back": "back.ant.json"})"},
        {"annotation survival", R"({"mesh": "coarse.ply", "annotations": "coarse.ant.json", "ratio": 0.5})"},
        {"annotation select", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "brush.ant.json",
                                  "brush": ["-59,0,50"], "radius": 40, "tag": "patch"})"},
        {"annotation segment", R"({"mesh": "pot.ply", "output": "segments.ant.json"})"},
        {"annotation creases", R"({"mesh": "pot.ply", "output": "creases.ant.json", "scale": 0.03})"},
        {"annotation smooth", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "smooth.ant.json"})"},
        {"annotation find", R"q({"query": "area(spout) < area(body)", "objects": ["pot.ply"]})q"},
        {"measure take", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "tape.ant.json", "tool": "tape",
                             "geodesic": "exact", "at": ["-100,0,61", "102,0,89"]})"},
        {"measure describe", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "described.ant.json"})"},
        {"measure map", R"({"mesh": "pot.ply", "output": "thickness.npy", "of": "thickness"})"},
        {"measure clay", R"({"mesh": "pot.ply"})"},
        {"measure distance", R"({"mesh": "pot.ply", "reference": "other.ply", "output": "distance.npy"})"},
        {"relation extract", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "pot.graph.json"})"},
        {"relation check", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "graph": "pot.graph.json"})"},
        {"cage make", R"({"mesh": "coarse.ply", "output": "cage.ply", "vertices": 60})"},
        {"cage check", R"({"mesh": "coarse.ply", "cage": "cage.ply"})"},
        {"cage weights", R"({"mesh": "coarse.ply", "cage": "cage.ply", "output": "weights.npy"})"},
        {"deform", R"({"mesh": "coarse.ply", "annotations": "coarse.ant.json", "edit": "teapot-stretch.edit.json",
                       "output": "stretched.ply", "cage": "cage.ply", "weights": "weights.npy"})"},
        {"axis", R"({"mesh": "pot.ply"})"},
        {"axis", R"({"mesh": "coarse.ply", "method": "skeleton"})"},
        {"slice", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "count": 20, "output": "slices.json"})"},
        {"render", R"({"meshes": ["pot.ply"], "annotations": ["pot.ant.json"], "picture": "pot.png", "size": "300x200"})"},
        {"publish", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "folder": "published",
                        "address": "https://pots.example/1"})"},
        {"report", R"({"results": ["pot.ply", "pot.ant.json"], "page": "pot.html"})"},
    };
    return list;
}

void furnish(const Scratch& scratch) {
    for (const char* name : {"teapot.recipe.json", "teapot-stretch.edit.json"})
        write_file(scratch / name, read_file(Path(OSTRAKA_SOURCE_DIR) / "data" / name));
}

/// Every file below a folder, hidden ones too, with the checksum of its bytes.
std::map<std::string, std::string> files_below(const Path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file())
            files[entry.path().lexically_relative(folder).generic_string()] = sha256(read_file(entry.path()));
    return files;
}

/// The kind of error of a call that is cancelled after the given time; nullopt if it had finished.
std::optional<ErrorKind> cancelled_after(double seconds, const Step& step, const Path& folder, Context& cache) {
    Context context;
    context.share_objects(cache);
    std::atomic<bool> ended = false;
    std::thread other([&] {
        const auto begin = std::chrono::steady_clock::now();
        while (!ended && std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() < seconds)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        context.watch.cancel();
    });
    std::optional<ErrorKind> kind;
    try {
        static_cast<void>(call_in(folder, step.operation, step.settings).run(context));
    } catch (const Error& error) {
        kind = error.kind();
        EXPECT_EQ(error.kind(), ErrorKind::cancelled) << step.operation << ": " << error.what();
    }
    ended = true;
    other.join();
    return kind;
}

}  // namespace

TEST(Cancelling, LeavesNoFileAndDamagesNoCachedObject) {
    const Scratch scratch;
    furnish(scratch);
    Context cache;
    cache.keep_objects = true;
    for (const Step& step : steps()) {
        SCOPED_TRACE(step.settings);
        const auto before = files_below(scratch.path());
        const auto begin = std::chrono::steady_clock::now();
        {
            Context first;  // the cache does not yet contain objects of the others
            static_cast<void>(call_in(scratch.path(), step.operation, step.settings).run(first));
        }
        const double whole = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        const auto after = files_below(scratch.path());
        for (const auto& [name, sum] : after)
            if (!before.contains(name)) std::filesystem::remove(scratch / name);
        for (const double share : {0.1, 0.6}) {
            const auto existing_files = files_below(scratch.path());
            if (cancelled_after(share * whole, step, scratch.path(), cache)) {
                EXPECT_EQ(files_below(scratch.path()), existing_files) << step.operation << " left something behind";
            } else {
                for (const auto& [name, sum] : files_below(scratch.path()))
                    if (!before.contains(name)) std::filesystem::remove(scratch / name);
            }
        }
        // With the cache of the cancelled calls it gives the same result.
        Context last;
        last.share_objects(cache);
        static_cast<void>(call_in(scratch.path(), step.operation, step.settings).run(last));
        for (const auto& [name, sum] : files_below(scratch.path()))
            EXPECT_EQ(after.contains(name) ? after.at(name) : "nothing", sum) << step.operation << ": " << name;
    }
}

TEST(Cancelling, EachAlgorithmChecksForIt) {
    const Mesh mesh = build_mesh(octahedron_sphere(5));
    const Scratch scratch;
    write_mesh(scratch / "sphere.obj", mesh);
    const Mesh small = build_mesh(octahedron_sphere(3));
    const TriangleSoup soup = to_soup(mesh);
    const std::vector<double> thickness = [&] {
        std::vector<double> list(mesh.number_of_faces(), 1);
        for (std::size_t f = 0; f < list.size() / 2; ++f) list[f] = 2;
        return list;
    }();
    std::vector<Point> points(mesh.points().begin(), mesh.points().end());
    const auto far = [&] {
        return *std::min_element(mesh.vertices().begin(), mesh.vertices().end(),
                                 [&](Vertex a, Vertex b) { return mesh.point(a).x() < mesh.point(b).x(); });
    }();
    RemeshOptions remeshed;
    remeshed.vertices = 500;
    SimplifyOptions fewer;
    fewer.vertices = 500;
    RefineOptions more;
    more.vertices = 50000;
    const std::pair<const char*, std::function<void()>> works[]{
        {"remesh", [&] { static_cast<void>(remesh(mesh, remeshed)); }},
        {"simplify",
         [&] {
             Mesh copy = mesh;
             static_cast<void>(simplify(copy, fewer));
         }},
        {"refine",
         [&] {
             Mesh copy = mesh;
             static_cast<void>(refine(copy, more));
         }},
        {"distances", [&] { static_cast<void>(geodesic_distances(mesh, {0}, 10)); }},
        {"curve", [&] { static_cast<void>(geodesic_curve(mesh, vertex_point(0), vertex_point(far))); }},
        {"wrap", [&] { static_cast<void>(wrap_soup(soup, 0.05, 0.01)); }},
        {"cage", [&] { static_cast<void>(make_cage(small, {})); }},
        {"segments", [&] { static_cast<void>(segment(mesh, thickness)); }},
        {"self-intersections", [&] { static_cast<void>(self_intersections(soup, 10)); }},
        {"hull", [&] { static_cast<void>(convex_hull_size(points)); }},
        {"points", [&] { const PointTree tree(points); }},
        {"faces", [&] { const SurfaceSearch search(mesh); }},
        {"read", [&] { static_cast<void>(read_mesh(scratch / "sphere.obj")); }},
        {"write", [&] { static_cast<void>(write_mesh(scratch / "again.obj", mesh)); }},
    };
    for (const auto& [name, work] : works) {
        EXPECT_NO_THROW(work()) << name;
        std::filesystem::remove(scratch / "again.obj");
        Watch watch;
        watch.cancel();
        const WatchScope scope(&watch);
        try {
            work();
            ADD_FAILURE() << name << " does not ask whether it is to stop";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::cancelled) << name << ": " << error.what();
        }
    }
    EXPECT_EQ(count_files(scratch.path()), 1U);
}

#include "benchmarks.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/remesh/refine.h"
#include "ostraka/synthetic/make_mesh.h"

#include <unistd.h>

#include <memory>

namespace ostraka::bench {

namespace {

SyntheticMesh make_teapot(std::size_t vertices, std::uint64_t seed) {
    MakeOptions options;
    options.vertices = vertices;
    options.seed = seed;
    return make_mesh(synthetic_object("teapot"), options);
}

struct Target {
    std::size_t vertices = 0;
    Mesh mesh;
    std::unique_ptr<SurfaceSearch> search;
};

Target& kept_target(std::size_t vertices) {
    static std::unique_ptr<Target> kept;
    if (!kept || kept->vertices != vertices) {
        kept.reset();
        kept = std::make_unique<Target>();
        const Making making = making_of(vertices);
        kept->mesh = make_teapot(making.vertices, 2).mesh;
        RefineOptions options;
        options.levels = making.levels;
        if (options.levels > 0) refine(kept->mesh, options);
        kept->vertices = vertices;
    }
    return *kept;
}

struct Folder {
    Path path = std::filesystem::temp_directory_path() / ("ostraka-benchmark-" + std::to_string(::getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
};

}  // namespace

Making making_of(std::size_t vertices) {
    Making making{vertices, 0};
    for (; making.vertices > 500'000; making.vertices /= 4) ++making.levels;
    return making;
}

const Source& source() {
    static const Source made = [] {
        Source result;
        SyntheticMesh teapot = make_teapot(50'000, 1);
        result.regions = regions_from_labels(teapot.mesh, teapot.face_labels);
        result.regions.annotations.resize(10);
        result.mesh = std::move(teapot.mesh);
        return result;
    }();
    return made;
}

const Mesh& target(std::size_t vertices) { return kept_target(vertices).mesh; }

const SurfaceSearch& target_search(std::size_t vertices) {
    Target& kept = kept_target(vertices);
    if (!kept.search) kept.search = std::make_unique<SurfaceSearch>(kept.mesh);
    return *kept.search;
}

const Path& scratch_folder() {
    static const Folder folder;
    return folder.path;
}

}  // namespace ostraka::bench

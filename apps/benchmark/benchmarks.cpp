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
    static std::unique_ptr<Target> cached;
    if (!cached || cached->vertices != vertices) {
        cached.reset();
        cached = std::make_unique<Target>();
        const TargetMeshing meshing = meshing_of(vertices);
        cached->mesh = make_teapot(meshing.vertices, 2).mesh;
        RefineOptions options;
        options.levels = meshing.levels;
        if (options.levels > 0) refine(cached->mesh, options);
        cached->vertices = vertices;
    }
    return *cached;
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

TargetMeshing meshing_of(std::size_t vertices) {
    TargetMeshing meshing{vertices, 0};
    for (; meshing.vertices > 500'000; meshing.vertices /= 4) ++meshing.levels;
    return meshing;
}

const AnnotatedMesh& source() {
    static const AnnotatedMesh source_data = [] {
        AnnotatedMesh result;
        SyntheticMesh teapot = make_teapot(50'000, 1);
        result.annotations = regions_from_labels(teapot.mesh, teapot.face_labels);
        result.annotations.annotations.resize(10);
        result.mesh = std::move(teapot.mesh);
        return result;
    }();
    return source_data;
}

const Mesh& target(std::size_t vertices) { return kept_target(vertices).mesh; }

const SurfaceSearch& target_search(std::size_t vertices) {
    Target& cached = kept_target(vertices);
    if (!cached.search) cached.search = std::make_unique<SurfaceSearch>(cached.mesh);
    return *cached.search;
}

const Path& scratch_folder() {
    static const Folder folder;
    return folder.path;
}

}  // namespace ostraka::bench

#include "mould_heads.h"

#include "scenes.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/diffusion.h"
#include "ostraka/geom/submesh.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <map>

namespace ostraka::experiments {

namespace {

/// Generates a planned head. If its features touch, so that the surface has a handle, it is drawn again: another cast of its
/// mould or, for hand-formed heads, another head with such a hat.
HeadCast cast_planned(PlannedHead& head, const MouldPopulationOptions& population) {
    constexpr int attempts = 10;
    const HeadShape::Hat hat = head.shape.hat;
    for (int attempt = 1;; ++attempt) {
        try {
            return cast_head(head.shape, head.cast);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::failure || attempt == attempts) throw;
        }
        ++head.cast.seed;
        if (hat == HeadShape::Hat::none) continue;
        ArchetypeOptions archetype;
        archetype.hand_made = true;
        archetype.difference = population.difference;
        archetype.seed = head.cast.seed;
        do head.shape = head_archetype(archetype), ++archetype.seed;
        while (head.shape.hat != hat);
    }
}

}  // namespace

Heads synthetic_heads(const MouldPopulationOptions& population, const CastOptions& cast) {
    auto plan = plan_heads(population, cast);
    Heads heads;
    heads.meshes.resize(plan.size());
    heads.labels.resize(plan.size());
    std::vector<HeadCast> casts(plan.size());
    parallel_for(plan.size(), 1, [&](std::size_t i) { casts[i] = cast_planned(plan[i], population); });
    for (std::size_t i = 0; i < plan.size(); ++i) {
        heads.meshes[i] = std::move(casts[i].mesh);
        heads.labels[i] = std::move(casts[i].face_labels);
        heads.moulds.push_back(plan[i].mould);
        heads.names.push_back(plan[i].name);
        heads.beard.push_back(casts[i].beard);
        heads.long_hair.push_back(plan[i].shape.long_hair);
        heads.hand_made.push_back(plan[i].shape.hat != HeadShape::Hat::none);
    }
    return heads;
}

Heads scanned_heads(const std::vector<std::string>& files, int objects, std::uint64_t vertices, double difference, double wear) {
    std::vector<MeshFile> faces;
    for (const auto& file : files) faces.push_back(read_mesh(file));
    std::vector<Eigen::MatrixXd> places;
    for (const auto& face : faces) {
        places.push_back(positions(face.mesh));
        if (places.back().rows() != places.front().rows() || faces.size() < 2)
            fail_usage("the faces are not in correspondence", "give two or more with the same vertices");
    }
    // The largest component is the shell of the face; eyes and teeth are separate components.
    const SubMesh shell = keep_faces(faces.front().mesh, std::vector<bool>(faces.front().mesh.number_of_faces(), true), true);
    Heads heads;
    Random random(11);
    constexpr int moulds = 4;
    std::vector<Eigen::MatrixXd> archetypes;
    for (int mould = 0; mould < moulds; ++mould) {
        Eigen::MatrixXd mix = places.front();
        for (std::size_t k = 1; k < places.size(); ++k) mix += difference * random.normal() * (places[k] - places.front());
        archetypes.push_back(mix);
    }
    for (int i = 0; i < objects; ++i) {
        const Eigen::MatrixXd& archetype = archetypes[static_cast<std::size_t>(i % moulds)];
        std::vector<Point> points;
        for (const Index v : shell.vertices) points.push_back(point_of(archetype.row(static_cast<Eigen::Index>(v)).transpose()));
        heads.meshes.push_back(with_points(shell.mesh, points));
        heads.moulds.push_back("mould-" + std::to_string(i % moulds + 1));
        heads.names.push_back("head-" + std::to_string(i + 1));
    }
    heads.labels.resize(heads.meshes.size());
    parallel_for(heads.meshes.size(), 1, [&](std::size_t i) {
        // A different number of vertices for each cast, so that no two meshes coincide.
        Random own(23, i);
        Mesh mesh =
            remeshed(heads.meshes[i], static_cast<std::uint64_t>(static_cast<double>(vertices / 2) * own.uniform(0.9, 1.1)));
        const double size = std::sqrt(surface_area(mesh));
        if (wear > 0) set_positions(mesh, Diffusion(mesh).smoothed(positions(mesh), wear * own.uniform(0.5, 1) * size, 3));
        std::vector<Vector> normals;
        for (const Vertex v : mesh.vertices()) normals.push_back(vertex_normal(mesh, v));
        for (const Vertex v : mesh.vertices()) mesh.point(v) += 0.001 * size * own.normal() * normals[v];
        const Eigen::Matrix3d rotation =
            Eigen::Quaterniond(own.normal(), own.normal(), own.normal(), own.normal()).normalized().toRotationMatrix();
        heads.meshes[i] = warped(std::move(mesh), [&](const Eigen::Vector3d& p) { return rotation * p; });
    });
    return heads;
}

Compared compare(const Heads& heads, const std::function<bool(std::size_t)>& chosen,
                 const std::function<std::vector<HeadPart>(std::size_t)>& without) {
    std::vector<std::size_t> list;
    for (std::size_t i = 0; i < heads.meshes.size(); ++i)
        if (chosen(i)) list.push_back(i);
    std::vector<Mesh> meshes(list.size());
    std::vector<double> sizes(list.size());
    parallel_for(list.size(), 1, [&](std::size_t k) {
        const auto& labels = heads.labels[list[k]];
        const auto parts = without(list[k]);
        std::vector<bool> keep;
        for (std::size_t f = 0; f < heads.meshes[list[k]].number_of_faces(); ++f)
            keep.push_back(labels.empty() ||
                           std::find(parts.begin(), parts.end(), static_cast<HeadPart>(labels[f])) == parts.end());
        meshes[k] = keep_faces(heads.meshes[list[k]], keep, true).mesh;
        sizes[k] = std::sqrt(surface_area(meshes[k]));
    });
    CompareOptions options;
    options.features.size = upper_median(sizes);

    Compared result;
    std::vector<std::optional<PreparedHead>> ready(list.size());
    Stopwatch finding;
    parallel_for(list.size(), 1, [&](std::size_t k) { ready[k].emplace(prepare_head(meshes[k], options)); });
    result.finding = finding.seconds();
    std::vector<PreparedHead> prepared;
    std::vector<std::string> names;
    std::map<std::string, int> numbers;
    for (std::size_t k = 0; k < list.size(); ++k) {
        result.features += static_cast<double>(ready[k]->features.features.size()) / static_cast<double>(list.size());
        prepared.push_back(std::move(*ready[k]));
        names.push_back(heads.names[list[k]]);
        result.moulds.push_back(heads.moulds[list[k]]);
        result.truth.push_back(numbers.try_emplace(heads.moulds[list[k]], static_cast<int>(numbers.size())).first->second);
    }
    Stopwatch comparing;
    result.matrices = compare_heads(names, prepared, options);
    result.comparing = comparing.seconds();
    return result;
}

}  // namespace ostraka::experiments

// Synthetic classes: vessels and figures whose members vary like hand-made objects.
#include "class_objects.h"

#include "ostraka/geom/eigen.h"
#include "ostraka/stats/random.h"
#include "ostraka/synthetic/heads.h"
#include "ostraka/synthetic/make_mesh.h"
#include "ostraka/synthetic/statuettes.h"

#include <cmath>

namespace ostraka::experiments {

namespace {

/// Random side lengths, taper and bend along the height, each with a deviation of 0.1.
void vary(Mesh& mesh, Random& random) {
    constexpr double deviation = 0.1;
    Eigen::AlignedBox3d box;
    for (const Point& p : mesh.points()) box.extend(eigen(p));
    const Eigen::Vector3d sides{std::exp(random.normal(0, deviation)), std::exp(random.normal(0, deviation)),
                                std::exp(random.normal(0, deviation))};  // evaluated in this order
    const double taper = random.normal(0, deviation), bend_x = random.normal(0, deviation), bend_y = random.normal(0, deviation);
    const double height = box.sizes().z();
    for (const Vertex v : mesh.vertices()) {
        Eigen::Vector3d p = eigen(mesh.point(v)) - box.center();
        const double up = 2 * p.z() / height;  // -1 to 1
        p.head<2>() *= std::exp(taper * up);
        p.x() += 0.5 * height * bend_x * up * up;
        p.y() += 0.5 * height * bend_y * up * up;
        mesh.point(v) = point_of(Eigen::Vector3d(sides.cwiseProduct(p)));
    }
}

}  // namespace

std::vector<ClassObject> made_classes(std::size_t learnt, std::size_t asked, std::uint64_t seed, std::uint64_t vertices) {
    std::vector<ClassObject> objects;
    Random random(seed);
    const std::size_t count = learnt + asked;
    PopulationOptions population;
    population.objects = static_cast<int>(count);
    population.seed = seed;
    const std::vector<StatuetteParameters> figurines = draw_population(population);
    for (const char* name : {"capsule", "chair", "figurine", "hand", "head", "statuette", "teapot", "vase"})
        for (std::size_t i = 0; i < count; ++i) {
            ClassObject& object = objects.emplace_back();
            object.class_name = name;
            object.member.name = object.class_name + " " + std::to_string(i + 1);
            object.learnt = i < learnt;
            object.asked = !object.learnt;
            MakeOptions how;
            how.vertices = vertices;
            how.seed = seed + i;
            if (object.class_name == "head") {
                ArchetypeOptions archetype;
                archetype.seed = seed + i;
                object.member.mesh = make_mesh(*head_object(head_archetype(archetype)), how).mesh;
            } else if (object.class_name == "figurine") {
                object.member.mesh = make_mesh(*statuette_object(figurines[i]), how).mesh;
            } else {
                object.member.mesh = make_mesh(synthetic_object(name), how).mesh;
            }
            vary(object.member.mesh, random);
        }
    return objects;
}

}  // namespace ostraka::experiments

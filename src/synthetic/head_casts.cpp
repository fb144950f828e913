#include "ostraka/synthetic/head_casts.h"

#include "ostraka/stats/random.h"

#include "ostraka/geom/diffusion.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/submesh.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ostraka {

namespace {

enum Stream : std::uint64_t {
    hand_stream = 1,
    pressure_stream,
    wear_stream,
    noise_stream,
    break_stream,
    pose_stream,
    body_stream
};

/// Surface area of a head, mm^2.
constexpr double head_area = 4300;

HandWork draw_hand_work(const CastOptions& options, bool beard) {
    Random draw(options.seed, hand_stream);
    HandWork work;
    work.back_depth = draw.uniform(-1.5, 2.5);
    work.back_width = draw.uniform(-1, 1);
    work.cut_back = draw.uniform(-2.5, -0.5);
    work.cut_tilt = draw.uniform(-0.06, 0.06);
    work.cut_turn = draw.uniform(-0.06, 0.06);
    work.beard = beard;
    work.beard_width *= draw.uniform(0.8, 1.25);
    work.beard_length *= draw.uniform(0.7, 1.3);
    work.beard_forward += draw.uniform(-1, 1);
    work.beard_skew = draw.uniform(-1, 1);
    const auto dents = options.dents > 0 ? draw.below(static_cast<std::uint64_t>(options.dents) + 1) : 0;
    for (std::uint64_t i = 0; i < dents; ++i)
        work.dents.push_back({draw.uniform(-8, 8), draw.uniform(5, 33), draw.uniform(1, 2.5), draw.uniform(0.15, 0.5)});
    if (options.body) {
        Random body(options.seed, body_stream);
        work.body = {body.uniform(70, 110), body.uniform(16, 22), body.uniform(11, 15), body.uniform(13, 18)};
    }
    return work;
}

/// A smooth random field between 0 and 1, with a few periods across the head.
class Waves {
public:
    Waves(Random& draw) {
        for (auto& wave : waves_) {
            wave.along = Vector3d(draw.normal(), draw.normal(), draw.normal()) * (2.5 / head_height);
            wave.phase = draw.uniform(0, 6.283185307179586);
        }
    }
    [[nodiscard]] double at(const Vector3d& p) const {
        double sum = 0;
        for (const auto& wave : waves_) sum += std::sin(wave.along.dot(p) + wave.phase);
        return std::clamp(0.5 + sum / static_cast<double>(waves_.size()), 0.0, 1.0);
    }

private:
    struct Wave {
        Vector3d along;
        double phase;
    };
    std::array<Wave, 3> waves_;
};

/// If two features almost touch, some lattices connect them by a handle: then another lattice is tried.
SyntheticMesh meshed(const SyntheticObject& head, MakeOptions options) {
    constexpr int attempts = 4;
    for (int attempt = 1;; ++attempt, options.seed += 1000003) {
        try {
            return make_mesh(head, options);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::failure || attempt == attempts) throw;
        }
    }
}

void wear_down(Mesh& mesh, double sigma, Random& draw) {
    const Waves waves(draw);
    const Eigen::MatrixXd original = positions(mesh);
    Eigen::MatrixXd smoothed = Diffusion(mesh).smoothed(original, sigma, 3);
    for (Eigen::Index v = 0; v < smoothed.rows(); ++v) {
        const double share = 0.5 + 0.5 * waves.at(original.row(v).transpose());
        smoothed.row(v) = original.row(v) + share * (smoothed.row(v) - original.row(v));
    }
    set_positions(mesh, smoothed);
}

void press(Mesh& mesh, double strength, Random& draw) {
    const auto drawn = [&] { return strength * std::clamp(draw.normal(), -2.0, 2.0); };
    const Vector3d stretch(1 + drawn(), 1 + drawn(), 1 + drawn());
    const double bend_forward = drawn() / head_height, bend_side = drawn() / head_height, twist = drawn() / head_height;
    for (const Vertex v : mesh.vertices()) {
        Vector3d p = stretch.cwiseProduct(eigen(mesh.point(v)));
        const double up = p.z() - head_height / 2, angle = 2 * twist * up;
        p = Vector3d(p.x() * std::cos(angle) - p.y() * std::sin(angle), p.x() * std::sin(angle) + p.y() * std::cos(angle), p.z());
        p.x() += bend_forward * up * up, p.y() += bend_side * up * up;
        mesh.point(v) = point_of(p);
    }
}

void scan(Mesh& mesh, double deviation, Random& draw) {
    std::vector<Vector> normals;
    for (const Vertex v : mesh.vertices()) normals.push_back(vertex_normal(mesh, v));
    for (const Vertex v : mesh.vertices()) mesh.point(v) += deviation * draw.normal() * normals[v];
}

}  // namespace

HeadCast cast_head(const HeadShape& shape, const CastOptions& options) {
    check_options(options, "head");
    HeadCast cast;
    Random break_random(options.seed, break_stream);
    cast.beard = break_random.uniform() < options.beard;
    cast.chunk = break_random.uniform() < options.chunk;
    MakeOptions make_options;
    const HandWork work = draw_hand_work(options, cast.beard);
    make_options.vertices =
        static_cast<std::uint64_t>(static_cast<double>(options.vertices) * (1 + work.body.area() / head_area));
    make_options.seed = options.seed;
    SyntheticMesh head_mesh = meshed(*head_object(shape, work), make_options);
    Mesh& mesh = head_mesh.mesh;

    Random wear(options.seed, wear_stream), pressure(options.seed, pressure_stream), noise(options.seed, noise_stream);
    cast.wear = options.wear * wear.uniform(0.5, 1);
    if (cast.wear > 0) wear_down(mesh, cast.wear * head_height, wear);
    if (options.pressure > 0) press(mesh, options.pressure, pressure);
    cast.shrinkage = options.shrinkage * pressure.uniform();
    if (options.noise > 0) scan(mesh, options.noise * head_height, noise);

    std::vector<bool> keep(mesh.number_of_faces(), true);
    // A piece is broken off the brow, a cheek or the hair, never the whole face.
    const Vector3d break_centre(break_random.uniform(6, 11),
                                (break_random.uniform() < 0.5 ? -1 : 1) * break_random.uniform(6, 11),
                                break_random.uniform(8, 36));
    const double break_radius = break_random.uniform(4.5, 7);
    for (const Face face : mesh.faces()) {
        if (!options.body && head_mesh.face_labels[face] == static_cast<std::int32_t>(HeadPart::stump)) keep[face] = false;
        if (cast.chunk && (eigen(centroid(mesh, face)) - break_centre).norm() < break_radius) keep[face] = false;
    }
    SubMesh remaining = keep_faces(mesh, keep, true);
    cast.mesh = std::move(remaining.mesh);
    for (const Index face : remaining.faces) cast.face_labels.push_back(head_mesh.face_labels[face]);

    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Vector3d translation = Vector3d::Zero();
    if (!options.keep_pose) {
        Random pose(options.seed, pose_stream);
        rotation = Eigen::Quaterniond(pose.normal(), pose.normal(), pose.normal(), pose.normal()).normalized().toRotationMatrix();
        translation = 3 * head_height * Vector3d(pose.uniform(), pose.uniform(), pose.uniform());
    }
    const Vector3d up = rotation.col(2);
    cast.up = {up.x(), up.y(), up.z()};
    for (const Vertex v : cast.mesh.vertices())
        cast.mesh.point(v) = point_of((1 - cast.shrinkage) * (rotation * eigen(cast.mesh.point(v))) + translation);
    return cast;
}

std::vector<PlannedHead> plan_heads(const MouldPopulationOptions& population, const CastOptions& cast) {
    check_options(population, "heads");
    check_options(cast, "heads");
    Random draw(population.seed, 1);
    const auto draw_seed = [&draw] { return draw.below(std::uint64_t{1} << 48); };
    std::vector<PlannedHead> heads;
    std::vector<HeadShape> moulds;
    for (int mould = 0; mould < population.moulds; ++mould) {
        ArchetypeOptions archetype;
        archetype.long_hair = mould % 2 == 1;
        archetype.difference = population.difference;
        archetype.seed = draw_seed();
        moulds.push_back(head_archetype(archetype));
    }
    for (int i = 0; i < population.objects + population.hand_made; ++i) {
        PlannedHead head;
        head.cast = cast;
        head.cast.seed = draw_seed();
        if (i < population.objects) {
            const int mould = i % population.moulds;
            head.mould = "mould-" + std::to_string(mould + 1);
            head.shape = moulds[static_cast<std::size_t>(mould)];
        } else {
            ArchetypeOptions archetype;
            archetype.hand_made = true;
            archetype.difference = population.difference;
            archetype.seed = draw_seed();
            head.shape = head_archetype(archetype);
            using Hat = HeadShape::Hat;
            head.mould = head.shape.hat == Hat::pointed     ? "hand, pointed hat"
                         : head.shape.hat == Hat::truncated ? "hand, truncated hat"
                                                            : "hand, turban";
        }
        heads.push_back(std::move(head));
    }
    for (std::size_t i = heads.size(); i-- > 1;) std::swap(heads[i], heads[draw.below(i + 1)]);
    for (std::size_t i = 0; i < heads.size(); ++i) {
        const std::string digits = std::to_string(i + 1);
        heads[i].name = "head-" + std::string(digits.size() < 3 ? 3 - digits.size() : 0, '0') + digits;
    }
    return heads;
}

void CastOptions::declare_options(OptionList& list) {
    list("wear", wear,
         "maximum wear of a cast: standard deviation of the Gaussian that smooths the surface; the wear of a cast is 50 to 100 "
         "% of this value, and half as large at some places",
         Range{0, 0.1}, "share of the head's height");
    list("pressure", pressure, "deformation of soft clay: standard deviation of relative stretches and of a bend", Range{0, 0.1});
    list("shrinkage", shrinkage, "maximum linear shrinkage of a cast, as a fraction of its size", Range{0, 0.3});
    list("noise", noise, "scan noise: standard deviation of the vertex displacements along the normals", Range{0, 0.01},
         "share of the head's height");
    list("beard", beard, "share of the casts with a beard added by hand", Range{0, 1});
    list("chunk", chunk, "share of the casts that lack a piece of the face", Range{0, 1});
    list("dents", dents, "maximum number of small dents in the front of a cast", Range{0, 20});
    list("body", body, "make whole statuettes: each head on a body of its own that does not depend on the mould");
    list("keep-pose", keep_pose, "keep heads upright, facing x, instead of rotating and translating them at random", Anything{});
    list("vertices", vertices, "number of vertices of the whole head", Range{1500, 1e6});
    list("cast-seed", seed, "random seed of the wear, deformation and mesh of the casts", Range{0, 9007199254740992.0});
}

void MouldPopulationOptions::declare_options(OptionList& list) {
    list("objects", objects, "number of moulded heads", Range{1, 100000});
    list("moulds", moulds, "number of moulds; every second mould has long hair", Range{1, 1000});
    list("hand-made", hand_made, "number of hand-made heads", Range{0, 100000});
    list("difference", difference, "difference between the archetypes of moulds: 1 means that proportions vary by about 8 %",
         Range{0, 3});
    list("seed", seed, "random seed from which all objects are made", Range{0, 9007199254740992.0});
}

}  // namespace ostraka

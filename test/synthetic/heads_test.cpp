#include "ostraka/synthetic/head_casts.h"

#include "meshes.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"

#include <gtest/gtest.h>

#include <set>

namespace ostraka {
namespace {

CastOptions quick(std::uint64_t seed) {
    CastOptions options;
    options.vertices = 2500;
    options.seed = seed;
    options.keep_pose = true;
    return options;
}

HeadShape archetype(std::uint64_t seed, bool long_hair = false) {
    ArchetypeOptions options;
    options.seed = seed;
    options.long_hair = long_hair;
    return head_archetype(options);
}

/// Root mean square distance of the faces of `a` with this label to `b`.
double distance(const HeadCast& a, const HeadCast& b, HeadPart part) {
    const SurfaceSearch search(b.mesh);
    double sum = 0;
    int count = 0;
    for (const Face face : a.mesh.faces()) {
        if (a.face_labels[face] != static_cast<std::int32_t>(part)) continue;
        const double d = search.closest(centroid(a.mesh, face)).distance;
        sum += d * d, ++count;
    }
    return std::sqrt(sum / count);
}

TEST(Heads, EveryKindCanBeCast) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        for (const int kind : {0, 1, 2}) {
            ArchetypeOptions options;
            options.seed = seed;
            options.long_hair = kind == 1;
            options.hand_made = kind == 2;
            CastOptions cast = quick(seed);
            cast.beard = cast.chunk = 1;
            cast.dents = 3;
            const HeadCast head = cast_head(head_archetype(options), cast);
            EXPECT_TRUE(test::is_sound(head.mesh));
            EXPECT_EQ(test::components(head.mesh), 1U);
            EXPECT_EQ(head.face_labels.size(), head.mesh.number_of_faces());
            std::set<int> labels(head.face_labels.begin(), head.face_labels.end());
            for (const HeadPart part : {HeadPart::face, HeadPart::nose, HeadPart::eyes, HeadPart::beard, HeadPart::back})
                EXPECT_TRUE(labels.contains(static_cast<int>(part))) << static_cast<int>(part);
            EXPECT_FALSE(labels.contains(static_cast<int>(HeadPart::stump)));
            EXPECT_EQ(labels.contains(static_cast<int>(HeadPart::hat)), kind == 2);
        }
    }
}

TEST(Heads, CastsOfAMouldAgreeInTheFaceAndOthersDoNot) {
    const HeadCast a = cast_head(archetype(1), quick(1)), b = cast_head(archetype(1), quick(2)),
                   c = cast_head(archetype(2), quick(3));
    for (const HeadPart part : {HeadPart::nose, HeadPart::mouth, HeadPart::eyes})
        EXPECT_LT(3 * distance(a, b, part), distance(a, c, part)) << static_cast<int>(part);
    // Their backs are formed by hand.
    EXPECT_GT(distance(a, b, HeadPart::back), 3 * distance(a, b, HeadPart::nose));
}

TEST(Heads, WearErodesTheNoseInProportion) {
    double last = 0;
    for (const double wear : {0.01, 0.02, 0.04}) {
        CastOptions options = quick(4);
        const HeadCast fresh = cast_head(archetype(3), options);
        options.wear = wear;
        const HeadCast worn = cast_head(archetype(3), options);
        EXPECT_GE(worn.wear, wear / 2);
        EXPECT_LE(worn.wear, wear);
        const double erosion = distance(worn, fresh, HeadPart::nose);
        EXPECT_GT(erosion, 1.5 * last);
        last = erosion;
    }
}

TEST(Heads, ShrinkageIsAScale) {
    CastOptions options = quick(5);
    const HeadCast fresh = cast_head(archetype(3), options);
    options.shrinkage = 0.2;
    const HeadCast shrunk = cast_head(archetype(3), options);
    EXPECT_GT(shrunk.shrinkage, 0);
    for (const Vertex v : fresh.mesh.vertices())
        EXPECT_LT((eigen(shrunk.mesh.point(v)) - (1 - shrunk.shrinkage) * eigen(fresh.mesh.point(v))).norm(), 1e-9);
}

TEST(Heads, SameForAnyNumberOfThreads) {
    CastOptions options = quick(6);
    options.wear = 0.01, options.pressure = 0.01, options.noise = 0.001, options.keep_pose = false;
    set_threads(1);
    const std::string checksum = mesh_checksum(cast_head(archetype(4, true), options).mesh);
    set_threads(2);
    EXPECT_EQ(mesh_checksum(cast_head(archetype(4, true), options).mesh), checksum);
    set_threads(0);
    options.seed = 7;
    EXPECT_NE(mesh_checksum(cast_head(archetype(4, true), options).mesh), checksum);
}

TEST(Heads, APlanDistributesHeadsEvenlyAndNamesRevealNothing) {
    MouldPopulationOptions population;
    population.objects = 12, population.moulds = 3, population.hand_made = 2;
    const auto plan = plan_heads(population, {});
    std::map<std::string, int> count;
    std::set<std::string> names;
    for (const auto& head : plan) ++count[head.mould], names.insert(head.name);
    EXPECT_EQ(plan.size(), 14U);
    EXPECT_EQ(names.size(), 14U);
    for (const char* mould : {"mould-1", "mould-2", "mould-3"}) EXPECT_EQ(count[mould], 4) << mould;
    bool in_turn = true;
    for (std::size_t i = 0; i < 12; ++i) in_turn = in_turn && plan[i].mould == "mould-" + std::to_string(i % 3 + 1);
    EXPECT_FALSE(in_turn);
}

TEST(Heads, StandOnTheirOwnBodies) {
    CastOptions options = quick(3);
    options.keep_pose = false;
    const HeadCast head = cast_head(archetype(2), options);
    options.body = true;
    const HeadCast complete = cast_head(archetype(2), options);
    EXPECT_TRUE(CGAL::is_closed(complete.mesh));
    const auto area_where = [](const HeadCast& cast, const std::function<bool(HeadPart)>& holds) {
        double sum = 0;
        for (const Face f : cast.mesh.faces())
            if (holds(static_cast<HeadPart>(cast.face_labels[f]))) sum += face_area(cast.mesh, f);
        return sum;
    };
    const auto of_head = [](HeadPart part) { return part != HeadPart::stump && part != HeadPart::body; };
    EXPECT_NEAR(area_where(complete, of_head) / area_where(head, of_head), 1, 0.05);
    EXPECT_GT(area_where(complete, [](HeadPart part) { return part == HeadPart::body; }), area_where(head, of_head));
    // The upward direction points from the body to the head.
    const Vector up(complete.up[0], complete.up[1], complete.up[2]);
    double low = 1e300, high = -1e300;  // of the body's faces, of the head's
    for (const Face f : complete.mesh.faces()) {
        const double height = up * (centroid(complete.mesh, f) - CGAL::ORIGIN);
        if (of_head(static_cast<HeadPart>(complete.face_labels[f]))) high = std::max(high, height);
        else low = std::min(low, height);
    }
    EXPECT_GT(high - low, 100);
    EXPECT_NEAR(up.squared_length(), 1, 1e-9);
}

TEST(Heads, RefusesImpossibleOptions) {
    CastOptions options = quick(1);
    options.vertices = 100;
    EXPECT_THROW((void)cast_head(archetype(1), options), Error);
    options.vertices = 2500;
    options.wear = -1;
    EXPECT_THROW((void)cast_head(archetype(1), options), Error);
    MouldPopulationOptions none;
    none.moulds = 0;
    EXPECT_THROW((void)plan_heads(none, {}), Error);
}

}  // namespace
}  // namespace ostraka

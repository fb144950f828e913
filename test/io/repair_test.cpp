#include "ostraka/io/repair.h"
#include "ostraka/core/error.h"
#include "soups.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

using namespace ostraka;
using namespace ostraka::soups;

namespace {

Place place(const Mesh& mesh, Index v) {
    const Point& p = mesh.point(Vertex(v));
    return {p.x(), p.y(), p.z()};
}

/// Properties of every repair: maps in range and consistent, and elements at the positions of the old ones.
void check_maps(const TriangleSoup& old, const RepairResult& r) {
    ASSERT_EQ(r.vertex_map.size(), old.points.size());
    ASSERT_EQ(r.face_map.size(), old.triangles.size());
    ASSERT_EQ(r.vertex_source.size(), r.mesh.number_of_vertices());
    ASSERT_EQ(r.face_source.size(), r.mesh.number_of_faces());
    for (Index v = 0; v < r.vertex_source.size(); ++v)
        if (r.vertex_source[v] != no_index) {
            EXPECT_EQ(place(r.mesh, v), old.points.at(r.vertex_source[v]));
        }
    for (Index f = 0; f < r.face_source.size(); ++f) {
        if (r.face_source[f] == no_index) continue;
        std::multiset<Place> was, is;
        for (const Index v : old.triangles.at(r.face_source[f])) was.insert(old.points[v]);
        for (const Vertex v : corners(r.mesh, Face(f))) is.insert(place(r.mesh, static_cast<Index>(v)));
        EXPECT_EQ(was, is) << "face " << f;
        EXPECT_NE(r.face_map[r.face_source[f]], no_index);
    }
    for (Index v = 0; v < old.points.size(); ++v)
        if (r.vertex_map[v] != no_index) {
            ASSERT_LT(r.vertex_map[v], r.mesh.number_of_vertices());
            EXPECT_EQ(place(r.mesh, r.vertex_map[v]), old.points[v]);
        }
    for (const Index f : r.face_map)
        if (f != no_index) {
            ASSERT_LT(f, r.mesh.number_of_faces());
        }
}

std::size_t counted(const RepairResult& r, const std::string& step, const std::string& name) {
    for (const auto& s : r.steps)
        if (s.name == step)
            for (const auto& [key, value] : s.counts)
                if (key == name) return value;
    ADD_FAILURE() << "no " << step << " / " << name;
    return 0;
}

double length_of(const Place& a, const Place& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

RepairOptions no_filling() {
    RepairOptions options;
    options.fill_holes = 0;
    return options;
}

}  // namespace

TEST(Repair, SoundMeshComesOutUnchanged) {
    for (const auto& s : {cube(), sphere(), torus(), both(cube(), cube({1, 1, 1}))}) {
        const auto r = repair(s);
        EXPECT_TRUE(r.after.defects().empty());
        const auto out = to_soup(r.mesh);
        EXPECT_EQ(out.points, s.points);
        EXPECT_EQ(out.triangles, s.triangles);
        check_maps(s, r);
    }
}

TEST(Repair, FlippedTrianglesAreReversedAtAnyScaleAndPosition) {
    for (const double scale : {1e-12, 1.0, 1e12})
        for (const double far : {0.0, 1e5}) {
            auto s = moved(sphere(), scale, {far * scale, far * scale, 0});
            std::mt19937 random(3);
            for (std::size_t t = 0; t < s.triangles.size(); ++t)
                if (random() % 10 < 3) flip(s, t);
            const auto r = repair(s);
            EXPECT_TRUE(r.after.defects().empty()) << scale << " " << far << " " << r.after.defects().front();
            EXPECT_NEAR(r.after.volume / (scale * scale * scale), 4.0 / 3 * std::numbers::pi, 0.3);
            check_maps(s, r);
        }
}

TEST(Repair, InsideOutMeshesAreReversedAndCavitiesStay) {
    auto inner = cube({0.25, 0.25, 0.25}, 0.5);
    for (std::size_t t = 0; t < 12; ++t) flip(inner, t);
    EXPECT_DOUBLE_EQ(repair(inner).after.volume, 0.125);
    const auto hollow = repair(both(cube(), inner));
    EXPECT_DOUBLE_EQ(hollow.after.volume, 0.875);
    EXPECT_TRUE(hollow.after.defects().empty());
}

TEST(Repair, TriangleSoupIsJoined) {
    TriangleSoup loose;
    for (const auto& t : sphere().triangles)
        for (const Index v : t) {
            if (loose.points.size() % 3 == 0) {
                const auto n = static_cast<Index>(loose.points.size());
                loose.triangles.push_back({n, n + 1, n + 2});
            }
            loose.points.push_back(sphere().points[v]);
        }
    const auto r = repair(loose);
    EXPECT_TRUE(r.after.defects().empty());
    EXPECT_EQ(r.mesh.number_of_vertices(), sphere().points.size());
    check_maps(loose, r);
    // The same with noise, joined within a distance.
    std::mt19937 random(5);
    std::uniform_real_distribution<double> noise(-1e-6, 1e-6);
    for (auto& p : loose.points)
        for (auto& x : p) x += noise(random);
    auto exact = no_filling();
    exact.merge_gap = 0;
    const auto cracked = repair(loose, {}, exact);
    EXPECT_FALSE(cracked.after.closed());
    EXPECT_TRUE(repair(loose).after.defects().empty()) << "cracks are far narrower than edges";
    // The suggested distance closes the cracks.
    const std::string remedy = "--merge-distance ";
    const std::string& note = cracked.notes.front();
    ASSERT_NE(note.find(remedy), std::string::npos) << note;
    RepairOptions near = exact;
    near.merge_distance = std::stod(note.substr(note.find(remedy) + remedy.size()));
    EXPECT_LT(near.merge_distance, 1e-5);
    const auto joined = repair(loose, {}, near);
    EXPECT_TRUE(joined.after.defects().empty()) << joined.after.defects().front();
    EXPECT_EQ(joined.mesh.number_of_vertices(), sphere().points.size());
}

// Copies of a point, up to 3.5 times `noise` apart, are distinguished from neighbouring points if edges are about as short.
TEST(Repair, CracksAreClosedWhereEdgesAreEquallyShort) {
    auto intact = sphere(20, 40);
    const double noise = 1e-5 * diagnose(intact).diagonal;
    for (std::size_t t = 100; t < 1400; t += 130) {  // an end of an edge comes close to the other
        const Place to = intact.points[intact.triangles[t][1]];
        Place& from = intact.points[intact.triangles[t][0]];
        const double share = 5 * noise / length_of(from, to);
        for (std::size_t k = 0; k < 3; ++k) from[k] = to[k] + share * (from[k] - to[k]);
    }
    const auto was = diagnose(intact);
    ASSERT_TRUE(was.closed() && was.manifold());
    for (const unsigned seed : {1u, 2u, 3u}) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> move(-noise, noise);
        TriangleSoup loose;
        for (const auto& t : intact.triangles) {
            const auto n = static_cast<Index>(loose.points.size());
            loose.triangles.push_back({n, n + 1, n + 2});
            for (const Index v : t) {
                loose.points.push_back(intact.points[v]);
                for (double& x : loose.points.back()) x += move(random);
            }
        }
        const auto r = repair(loose, {}, no_filling());
        EXPECT_TRUE(r.after.closed() && r.after.manifold() && r.after.oriented()) << seed;
        EXPECT_EQ(r.after.euler(), 2) << seed;
        EXPECT_EQ(r.after.components.size(), 1u) << seed;
        EXPECT_EQ(r.mesh.number_of_vertices(), intact.points.size()) << "nothing is lost";
        EXPECT_EQ(r.mesh.number_of_faces(), intact.triangles.size());
        EXPECT_NEAR(r.after.volume / was.volume, 1, 1e-4);
    }
}

TEST(Repair, CubesThatShareAnEdgeAVertexOrAWallAreSeparated) {
    for (const auto& s :
         {welded(both(cube(), cube({1, 1, 0}))), welded(both(cube(), cube({1, 1, 1}))), welded(both(cube(), cube({1, 0, 0})))}) {
        const auto r = repair(s);
        EXPECT_TRUE(r.after.manifold() && r.after.closed() && r.after.oriented());
        EXPECT_EQ(r.after.components.size(), 2u);
        EXPECT_DOUBLE_EQ(r.after.volume, 2);
        check_maps(s, r);
    }
}

TEST(Repair, SolidThatTouchesItselfAlongAnEdgeStaysManifold) {
    // A ring of eight cubes-in-a-square with one corner pushed in would share an edge with itself; two cubes at an edge that
    // are joined by a third block over both do so directly.
    auto s = welded(both(both(cube(), cube({1, 1, 0})), both(cube({0, 0, 1}), both(cube({1, 0, 1}), cube({1, 1, 1})))));
    // Inner walls (a triangle and its reverse) are left out so that one solid remains.
    std::map<std::set<Index>, int> count;
    for (const auto& t : s.triangles) ++count[{t[0], t[1], t[2]}];
    std::erase_if(s.triangles, [&](const auto& t) { return count[{t[0], t[1], t[2]}] > 1; });
    const auto before = diagnose(s);
    EXPECT_GT(before.nonmanifold_edges, 0u);
    const auto r = repair(s);
    EXPECT_TRUE(r.after.manifold() && r.after.closed() && r.after.oriented());
    EXPECT_NEAR(r.after.volume, before.volume, 1e-12);
    EXPECT_NEAR(r.after.area, before.area, 1e-12);
}

TEST(Repair, DuplicatesAreDroppedAndMapToTheOneKept) {
    auto s = cube();
    s.triangles.push_back(s.triangles[3]);
    s.triangles.push_back({s.triangles[4][1], s.triangles[4][2], s.triangles[4][0]});
    const auto r = repair(s);
    EXPECT_TRUE(r.after.defects().empty());
    EXPECT_EQ(counted(r, "drop triangles", "duplicate triangles"), 2u);
    EXPECT_EQ(r.face_map[12], r.face_map[3]);
    EXPECT_EQ(r.face_map[13], r.face_map[4]);
    check_maps(s, r);
}

TEST(Repair, OppositeDuplicatesOfAClosedSurfaceAreRemoved) {
    for (const int every : {40, 7, 5}) {  // alone, side by side at corners and at edges
        auto s = sphere(20, 40);
        const auto intact = s;
        for (std::size_t t = 0; t < intact.triangles.size(); t += static_cast<std::size_t>(every)) {
            s.triangles.push_back(intact.triangles[t]);
            flip(s, s.triangles.size() - 1);
            if (every == 5) {  // and the next one, which shares an edge
                s.triangles.push_back(intact.triangles[t + 1 < intact.triangles.size() ? t + 1 : 0]);
                flip(s, s.triangles.size() - 1);
            }
        }
        if (every == 7) flip(s, 0), flip(s, 700);
        const auto r = repair(s);
        EXPECT_TRUE(r.after.defects().empty()) << every << " " << r.after.defects().front();
        EXPECT_EQ(r.after.components.size(), 1u) << every;
        EXPECT_EQ(r.mesh.number_of_faces(), intact.triangles.size()) << every;
        EXPECT_NEAR(r.after.volume, diagnose(intact).volume, 1e-12);
        check_maps(s, r);
    }
}

TEST(Repair, VerticesOnASideAreInsertedThere) {
    for (const double scale : {1e-9, 1.0, 1e9}) {
        auto s = moved(sphere(20, 40), scale, {0, 0, 0});
        const auto original_diagnosis = diagnose(s);
        const auto split = [&](std::size_t t, std::size_t k, double at) {
            const auto corners = s.triangles[t];
            const Index a = corners[k], b = corners[(k + 1) % 3], c = corners[(k + 2) % 3],
                        m = static_cast<Index>(s.points.size());
            Place place{};
            for (std::size_t i = 0; i < 3; ++i) place[i] = (1 - at) * s.points[a][i] + at * s.points[b][i];
            s.points.push_back(place);
            s.triangles[t] = {a, m, c};
            s.triangles.push_back({m, b, c});
        };
        for (std::size_t t = 100; t < 1000; t += 37) split(t, t % 3, 0.3);
        // Both sides of one edge, at different places: triangles 200 and 201 share it.
        const auto shared = s.triangles[201];
        split(200, 2, 0.4);
        for (std::size_t k = 0; k < 3; ++k)
            if (shared == s.triangles[201]) split(201, k, 0.35);
        const auto before = diagnose(s);
        ASSERT_GT(before.border_edges, 50u);
        const auto r = repair(s);
        EXPECT_TRUE(r.after.defects().empty()) << scale << r.after.defects().front();
        EXPECT_EQ(r.mesh.number_of_vertices(), s.points.size()) << "no point is lost or merged";
        EXPECT_NEAR(r.after.volume / original_diagnosis.volume, 1, 1e-12);
        EXPECT_GT(counted(r, "T-junctions", "vertices inserted into sides beside them"), 20u);
    }
}

TEST(Repair, VerdictOnStlIsThatOfTheFile) {
    auto r = repair(welded(both(cube(), cube({1, 1, 0}))));
    ASSERT_TRUE(r.after.defects().empty());
    prepare_for_stl(r);
    EXPECT_TRUE(r.after.manifold() && r.after.closed());
    EXPECT_EQ(r.after.components.size(), 2u);
    EXPECT_NEAR(r.after.volume, 2, 1e-4);
    EXPECT_NE(r.notes.back().find("moved apart"), std::string::npos);
    // Single precision is taken into account: far from the origin vertices coincide, and the check reports it.
    auto far = repair(moved(sphere(), 1e-6, {100, 100, 100}));
    ASSERT_TRUE(far.after.defects().empty());
    prepare_for_stl(far);
    EXPECT_FALSE(far.after.defects().empty());
    // If no vertices coincide, nothing moves.
    auto sound = repair(cube());
    prepare_for_stl(sound);
    EXPECT_TRUE(sound.after.defects().empty());
    EXPECT_EQ(to_soup(sound.mesh).points, cube().points);
    EXPECT_TRUE(sound.notes.empty());
}

TEST(Repair, SheetWrittenOnceForEachSideBecomesOneSheet) {
    TriangleSoup s{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}}};
    const auto r = repair(s, {}, no_filling());
    EXPECT_EQ(r.mesh.number_of_faces(), 2u);
    EXPECT_TRUE(r.after.manifold() && r.after.oriented());
    EXPECT_EQ(r.after.border_edges, 4u);
    EXPECT_EQ(r.after.self_intersections, 0u);
}

TEST(Repair, MoebiusStripIsCutAndReported) {
    const auto s = moebius();
    const auto r = repair(s, {}, no_filling());
    EXPECT_TRUE(r.after.manifold() && r.after.oriented());
    EXPECT_FALSE(r.after.closed());
    EXPECT_EQ(r.mesh.number_of_faces(), s.triangles.size());
    ASSERT_FALSE(r.notes.empty());
    EXPECT_NE(r.notes[0].find("one-sided"), std::string::npos);
    check_maps(s, r);
}

TEST(Repair, SmallHolesAreFilledLargeOnesNot) {
    auto s = sphere(40, 80);
    TriangleSoup holed{s.points, {}};
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        const auto& p = s.points[s.triangles[t][0]];
        if (p[2] < 0.97 && p[2] > -0.5) holed.triangles.push_back(s.triangles[t]);
    }
    const auto r = repair(holed);
    EXPECT_EQ(counted(r, "fill holes", "filled"), 1u);
    EXPECT_EQ(counted(r, "fill holes", "left: too wide"), 1u);
    EXPECT_EQ(r.after.border_loops.size(), 1u);
    EXPECT_EQ(r.after.self_intersections, 0u);
    check_maps(holed, r);
    RepairOptions all;
    all.fill_holes_size = 1;
    const auto closed = repair(holed, {}, all);
    EXPECT_TRUE(closed.after.defects().empty()) << closed.after.defects().front();
    EXPECT_LT(closed.after.volume, 4.0 / 3 * std::numbers::pi);
    EXPECT_GT(closed.after.volume, 3);
    RepairOptions short_ones;
    short_ones.fill_holes = 10;
    EXPECT_EQ(counted(repair(holed, {}, short_ones), "fill holes", "left: too many edges"), 2u);
}

TEST(Repair, FlatHoleIsFilledFlat) {
    auto s = cube();
    s.triangles.erase(s.triangles.begin(), s.triangles.begin() + 2);
    RepairOptions all;
    all.fill_holes_size = 1;
    const auto r = repair(s, {}, all);
    EXPECT_TRUE(r.after.defects().empty());
    EXPECT_DOUBLE_EQ(r.after.volume, 1);
}

TEST(Repair, LongBorderTerminates) {
    TriangleSoup s;  // a long thin collar: two borders of 20000 edges
    const Index n = 20000;
    for (Index i = 0; i < n; ++i) {
        const double a = 2 * std::numbers::pi * i / n;
        s.points.push_back({std::cos(a), std::sin(a), 0});
        s.points.push_back({std::cos(a), std::sin(a), 0.001});
        const Index j = (i + 1) % n;
        s.triangles.push_back({2 * i, 2 * j, 2 * i + 1});
        s.triangles.push_back({2 * j, 2 * j + 1, 2 * i + 1});
    }
    RepairOptions all;
    all.fill_holes = 100000;
    all.fill_holes_size = 1;
    const auto r = repair(s, {}, all);
    EXPECT_TRUE(r.after.closed() && r.after.manifold());
    EXPECT_NEAR(r.after.volume, 0.001 * std::numbers::pi, 1e-6);
}

TEST(Repair, TrianglesWithoutAreaAreFlippedAway) {
    auto s = cube();
    // A vertex in the middle of edge 0-1 on one side only, the other side keeps a triangle without area.
    s.points.push_back({0.5, 0, 0});
    s.triangles[0] = {0, 2, 8};  // was 0 2 1
    s.triangles.push_back({8, 2, 1});
    s.triangles.push_back({0, 8, 1});  // without area, between them and 0 1 4
    const auto before = diagnose(s);
    EXPECT_EQ(before.degenerate_triangles, 1u);
    EXPECT_TRUE(before.closed() && before.manifold());
    const auto r = repair(s);
    EXPECT_TRUE(r.after.defects().empty()) << r.after.defects().front();
    EXPECT_DOUBLE_EQ(r.after.volume, 1);
}

TEST(Repair, ComponentsStayByDefault) {
    const auto s = both(both(cube(), cube({3, 0, 0}, 0.1)), sphere(12, 24, 2, {8, 0, 0}));
    EXPECT_EQ(repair(s).after.components.size(), 3u);
    RepairOptions largest;
    largest.keep_largest = true;
    const auto r = repair(s, {}, largest);
    EXPECT_EQ(r.after.components.size(), 1u);
    EXPECT_GT(r.after.volume, 20);
    EXPECT_EQ(r.face_map[0], no_index);
    EXPECT_EQ(r.vertex_map[0], no_index);
    check_maps(s, r);
    RepairOptions share;
    share.min_component_share = 0.01;
    EXPECT_EQ(repair(s, {}, share).after.components.size(), 2u);
}

TEST(Repair, IsolatedVerticesAreDroppedByDefault) {
    auto s = cube();
    s.points.insert(s.points.begin(), {5, 5, 5});
    for (auto& t : s.triangles)
        for (auto& v : t) ++v;
    const auto r = repair(s);
    EXPECT_EQ(r.mesh.number_of_vertices(), 8u);
    EXPECT_EQ(r.vertex_map[0], no_index);
    check_maps(s, r);
    RepairOptions keep;
    keep.keep_isolated = true;
    EXPECT_EQ(repair(s, {}, keep).mesh.number_of_vertices(), 9u);
}

TEST(Repair, RefusesInputWithoutSurface) {
    const auto refusal = [](const TriangleSoup& s) {
        try {
            repair(s);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(refusal({}).find("empty"), std::string::npos);
    EXPECT_NE(refusal({{{0, 0, 0}, {1, 2, 3}}, {}}).find("no faces"), std::string::npos);
    EXPECT_NE(refusal({{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}}}).find("no face with an area"), std::string::npos);
    EXPECT_NE(refusal({{{0, 0, 0}, {1, 1, 1}, {2, 2, NAN}}, {{0, 1, 2}}}).find("vertex 2"), std::string::npos);
    RepairOptions bad;
    bad.merge_distance = -1;
    EXPECT_THROW(repair(cube(), {}, bad), Error);
}

TEST(Repair, SingleTriangleStaysAnOpenTriangle) {
    RepairOptions all;
    all.fill_holes_size = 1;
    const auto r = repair({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, {}, all);
    EXPECT_EQ(r.mesh.number_of_faces(), 1u);
    EXPECT_EQ(r.after.border_edges, 3u);
}

TEST(Repair, SelfIntersectionsAreCutOut) {
    auto s = sphere(30, 60);
    for (const std::size_t v : {400ul, 900ul, 1200ul})
        for (auto& x : s.points[v]) x *= -0.2;  // spikes through the other side of their ring
    for (auto& x : s.points[700]) x *= 0.3;
    s.points[700][0] += 0.9;
    const auto before = diagnose(s);
    RepairOptions options;
    options.remove_self_intersections = true;
    const auto r = repair(s, {}, options);
    EXPECT_EQ(r.after.self_intersections, 0u) << "of " << before.self_intersections;
    EXPECT_TRUE(r.after.defects().empty());
    // The least destructive way: spikes are smoothed, nothing is cut out.
    EXPECT_EQ(counted(r, "self-intersections", "triangles cut out"), 0u);
    EXPECT_EQ(r.mesh.number_of_vertices(), s.points.size());
    ASSERT_TRUE(r.before);
    EXPECT_EQ(r.before->components.size(), r.after.components.size());
    std::size_t same = 0;
    for (Index v = 0; v < s.points.size(); ++v) {
        EXPECT_EQ(r.vertex_map[v], v);
        same += place(r.mesh, v) == s.points[v];
    }
    EXPECT_EQ(same + counted(r, "self-intersections", "vertices moved to smooth folds"), s.points.size());
}

TEST(Repair, SmallBodiesAreNotSmoothedAway) {
    const auto s = both(cube(), cube({0.5, 0.3, 0.2}));
    RepairOptions options;
    options.remove_self_intersections = true;
    EXPECT_GT(repair(s, {}, options).after.area, 0.5 * diagnose(s).area);
}

TEST(Repair, ChangesByRemovingIntersectionsAreReported) {
    RepairOptions options;
    options.remove_self_intersections = true;
    const auto r = repair(both(sphere(16, 32), sphere(16, 32, 0.8, {0.9, 0, 0})), {}, options);
    ASSERT_TRUE(r.before);
    const auto reported = [&](const std::string& text) {
        return std::any_of(r.notes.begin(), r.notes.end(),
                           [&](const auto& note) { return note.find(text) != std::string::npos; });
    };
    EXPECT_EQ(reported("the number of components changed"), r.before->components.size() != r.after.components.size());
    EXPECT_EQ(reported("the area changed"), std::abs(r.after.area - r.before->area) > 0.01 * r.before->area);
    EXPECT_GT(std::abs(r.after.volume - r.before->volume) / r.before->volume, 0.01) << "or this test tells nothing";
    EXPECT_TRUE(reported("the volume changed"));
    EXPECT_EQ(r.after.isolated_vertices, 0u);
}

TEST(Repair, WrapEnclosesTheSoupAndMapsByDistance) {
    auto s = both(sphere(16, 32), sphere(16, 32, 0.8, {0.9, 0, 0}));
    MeshExtras extras;
    extras.face_labels.assign(s.triangles.size(), 1);
    std::fill(extras.face_labels.begin() + static_cast<std::ptrdiff_t>(s.triangles.size() / 2), extras.face_labels.end(), 2);
    RepairOptions options;
    options.wrap = true;
    options.wrap_alpha = 0.05;
    options.wrap_offset = 0.005;
    const auto r = repair(s, extras, options);
    EXPECT_TRUE(r.after.defects().empty());
    EXPECT_TRUE(r.maps_by_distance);
    for (const Index f : r.face_map) EXPECT_LT(f, r.mesh.number_of_faces());
    for (const Face f : r.mesh.faces()) {
        const double x = centroid(r.mesh, f).x();
        if (x < 0.2) {
            EXPECT_EQ(r.extras.face_labels[f], 1);
        }
        if (x > 1.2) {
            EXPECT_EQ(r.extras.face_labels[f], 2);
        }
    }
}

TEST(Repair, ColoursLabelsAndTextureFollow) {
    auto s = welded(both(cube(), cube({1, 1, 1})));
    flip(s, 4);
    s.triangles.push_back(s.triangles[0]);
    s.points.insert(s.points.begin(), {7, 7, 7});
    for (auto& t : s.triangles)
        for (auto& v : t) ++v;
    MeshExtras extras;
    for (std::size_t v = 0; v < s.points.size(); ++v) {
        extras.vertex_labels.push_back(static_cast<std::int32_t>(100 + v));
        extras.vertex_colours.push_back({static_cast<std::uint8_t>(v), 0, 0, 255});
    }
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        extras.face_labels.push_back(static_cast<std::int32_t>(t));
        for (const Index v : s.triangles[t]) extras.corner_texture.push_back({static_cast<float>(v), static_cast<float>(t)});
    }
    const auto r = repair(s, extras);
    ASSERT_TRUE(r.after.defects().empty());
    ASSERT_EQ(r.extras.face_labels.size(), r.mesh.number_of_faces());
    for (Index v = 0; v < r.mesh.number_of_vertices(); ++v) {
        EXPECT_EQ(r.extras.vertex_labels[v], static_cast<std::int32_t>(100 + r.vertex_source[v]));
        EXPECT_EQ(r.extras.vertex_colours[v][0], r.vertex_source[v]);
    }
    for (Index f = 0; f < r.mesh.number_of_faces(); ++f) {
        EXPECT_EQ(r.extras.face_labels[f], static_cast<std::int32_t>(r.face_source[f]));
        const auto new_corners = corners(r.mesh, Face(f));
        for (std::size_t k = 0; k < 3; ++k)  // texture stays with its corner even if the triangle was flipped
            EXPECT_EQ(static_cast<Index>(r.extras.corner_texture[3 * f + k][0]), r.vertex_source[new_corners[k]]);
    }
    check_maps(s, r);
}

// Random defects: any input gives an oriented manifold with valid maps.
TEST(Repair, RandomSoupsBecomeOrientedManifolds) {
    std::mt19937 random(11);
    for (int trial = 0; trial < 300; ++trial) {
        TriangleSoup s;
        const Index n = 4 + random() % 12;
        for (Index v = 0; v < n; ++v) s.points.push_back({double(random() % 4), double(random() % 4), double(random() % 4)});
        const std::size_t triangles = 1 + random() % 40;
        for (std::size_t t = 0; t < triangles; ++t)
            s.triangles.push_back(
                {static_cast<Index>(random() % n), static_cast<Index>(random() % n), static_cast<Index>(random() % n)});
        RepairOptions options;
        options.fill_holes_size = trial % 2 == 0 ? 1 : 0.3;
        options.remove_self_intersections = trial % 3 == 0;
        try {
            const auto r = repair(s, {}, options);
            EXPECT_TRUE(r.mesh.is_valid(false));
            EXPECT_TRUE(r.after.manifold() && r.after.oriented());
            EXPECT_EQ(r.after.inside_out_components, 0u) << trial;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("no face"), std::string::npos) << error.what();
        }
    }
}

TEST(Repair, WallBetweenSolidsGoesWithTheSelfIntersections) {
    const auto s = welded(both(cube(), cube({1, 0, 0})));
    RepairOptions options;
    options.remove_self_intersections = true;
    const auto r = repair(s, {}, options);
    EXPECT_TRUE(r.after.defects().empty()) << r.after.defects().front();
    EXPECT_EQ(r.after.components.size(), 1u);
    EXPECT_DOUBLE_EQ(r.after.volume, 2);
    check_maps(s, r);
}

TEST(Repair, HolesThatTouchAreFilledOneByOne) {
    auto s = sphere(20, 40);
    const auto first = s.triangles[200];  // and one that shares its second corner only
    const auto shared = [&](const auto& t) {
        int count = 0;
        for (const Index v : t) count += std::count(first.begin(), first.end(), v) > 0;
        return count;
    };
    const auto second = *std::find_if(s.triangles.begin(), s.triangles.end(), [&](const auto& t) {
        return shared(t) == 1 && std::find(t.begin(), t.end(), first[1]) != t.end();
    });
    std::erase(s.triangles, first);
    std::erase(s.triangles, second);
    ASSERT_GT(diagnose(s).nonmanifold_vertices, 0u);
    const auto r = repair(s);
    EXPECT_TRUE(r.after.defects().empty()) << r.after.defects().front();
    EXPECT_EQ(r.mesh.number_of_vertices(), s.points.size());
    check_maps(s, r);
}

TEST(Repair, SlitIsClosedHoweverLong) {
    auto s = sphere(20, 40);
    const Index v = s.triangles[300][0];
    auto far = s.points[v];
    far[2] += 1e-4;  // a duplicated vertex with one of its fans slightly moved: a slit
    const auto copy = static_cast<Index>(s.points.size());
    s.points.push_back(far);
    int seen = 0;
    for (auto& t : s.triangles)
        for (auto& w : t)
            if (w == v && seen++ < 3) w = copy;
    ASSERT_GT(diagnose(s).border_edges, 0u);
    EXPECT_TRUE(repair(s).after.closed());
}

#include "ostraka/fracture/facets.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "scratch.h"
#include "sherds.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"

#include <iterator>
#include <sstream>

namespace ostraka {
namespace {

using test::agreement;
using test::synthetic_bar;
using test::synthetic_sherd;
using test::SyntheticSherd;

TEST(Facets, ASherdHasTwoSidesAndAFracture) {
    const SyntheticSherd sherd = synthetic_sherd(1, 2, 0, 1);
    const Facets facets = find_facets(sherd.mesh);
    EXPECT_TRUE(facets.shell);
    EXPECT_NEAR(facets.thickness, 0.7, 0.05);
    EXPECT_GT(agreement(sherd, facets.of_face), 0.95);
    EXPECT_GT(facets.confidence, 0.8);
    double area = 0;
    std::vector<int> count(sherd.mesh.number_of_faces(), 0);
    for (const FacetSegment& segment : facets.segments) {
        area += segment.area;
        for (const Index f : segment.faces) {
            EXPECT_EQ(facets.of_face[f], segment.facet);
            ++count[f];
        }
    }
    EXPECT_NEAR(area, surface_area(sherd.mesh), 1e-9 * area);
    EXPECT_EQ(std::count(count.begin(), count.end(), 1), static_cast<std::ptrdiff_t>(count.size()));
}

TEST(Facets, UnitPoseResolutionAndThreadsDoNotMatter) {
    const SyntheticSherd sherd = synthetic_sherd(1, 2, 0, 1);
    const Facets facets = find_facets(sherd.mesh);
    Motion motion;
    motion.rotation = Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    for (const double scale : {1e-6, 1.0, 1e6}) {
        motion.scale = scale;
        motion.translation = 1000 * scale * Eigen::Vector3d(1, -1, 2);
        EXPECT_GT(agreement({moved(sherd.mesh, motion), facets.of_face}, find_facets(moved(sherd.mesh, motion)).of_face), 0.995)
            << scale;
    }
    const SyntheticSherd fine = synthetic_sherd(1, 2, 0, 1, 2);
    EXPECT_GT(agreement(fine, find_facets(fine.mesh).of_face), 0.95);
    const int before = threads();
    for (const int count : {1, 3}) {
        set_threads(count);
        const Facets again = find_facets(sherd.mesh);
        EXPECT_EQ(again.of_face, facets.of_face);
        EXPECT_EQ(again.confidence, facets.confidence);
    }
    set_threads(before);
}

TEST(Facets, ASolidHasARoughFracture) {
    for (const int fineness : {1, 2}) {
        const SyntheticSherd bar = synthetic_bar(fineness);
        const Facets facets = find_facets(bar.mesh);
        EXPECT_FALSE(facets.shell);
        EXPECT_EQ(facets.answer, Facets::Answer::broken);
        EXPECT_EQ(facets.area(Facet::inner), 0);
        // The flat end may be cut or shaped: its classification is uncertain.
        double missed = 0, flat = 0;
        for (const Face f : bar.mesh.faces()) {
            if (centroid(bar.mesh, f).z() < 1e-9) flat = std::max(flat, facets.probability[f]);
            else if (facets.of_face[f] != bar.facets[f]) missed += face_area(bar.mesh, f);
        }
        EXPECT_LT(missed, 0.03 * surface_area(bar.mesh)) << fineness;
        EXPECT_LT(flat, 0.8);
    }
}

TEST(Facets, AnIntactObjectHasNoFracture) {
    for (const auto& soup : {test::octahedron_sphere(4), test::torus(48, 24), test::patch(30, 30)}) {
        const Mesh mesh = build_mesh(soup);
        const Facets facets = find_facets(mesh);
        EXPECT_EQ(facets.area(Facet::fracture), 0);
        EXPECT_NEAR(facets.area(Facet::outer), surface_area(mesh), 1e-9 * surface_area(mesh));
    }
    // A cube may be cut from another object: the answer is unclear.
    EXPECT_NE(find_facets(build_mesh(test::box(12))).answer, Facets::Answer::broken);
}

// The same log odds are evidence of a fracture at the end of a bar, which an edge surrounds, and none on a smooth ball.
TEST(Facets, AFractureNeedsAnEdgeAroundIt) {
    const auto answer = [](const Mesh& mesh, const std::function<bool(const Point&)>& is_likely) {
        const FacetEvidence evidence = facet_evidence(mesh);
        std::vector<double> log_odds;
        for (const Point& place : evidence.graph.places) log_odds.push_back(is_likely(place) ? 3 : -5);
        return find_facets(mesh, evidence, log_odds);
    };
    const Facets ball = answer(build_mesh(test::octahedron_sphere(5)), [](const Point& p) { return p.z() > 0.9; });
    EXPECT_EQ(ball.answer, Facets::Answer::whole);
    EXPECT_EQ(ball.area(Facet::fracture), 0);
    const Facets large = answer(build_mesh(test::octahedron_sphere(5)), [](const Point& p) { return p.z() > 0; });
    EXPECT_EQ(large.answer, Facets::Answer::unclear);
    const SyntheticSherd bar = synthetic_bar(1);
    const Facets broken = answer(bar.mesh, [](const Point& p) { return p.z() < 1e-9; });
    EXPECT_EQ(broken.answer, Facets::Answer::broken);
    EXPECT_GT(broken.area(Facet::fracture), 0);
}

TEST(Facets, PinholesAndScrapsAreNoOpening) {
    TriangleSoup soup = test::octahedron_sphere(5);
    EXPECT_FALSE(has_opening(build_mesh(soup)));
    soup.triangles.pop_back();
    EXPECT_FALSE(has_opening(build_mesh(soup))) << "a pinhole";
    const TriangleSoup scrap = test::moved(test::patch(1, 1), 0.02, {3, 0, 0});
    EXPECT_FALSE(has_opening(build_mesh(test::joined(soup, scrap)))) << "a loose scrap";
    std::erase_if(soup.triangles, [&](const auto& t) { return soup.points[t[0]][2] > 0.9; });
    EXPECT_TRUE(has_opening(build_mesh(soup)));
    EXPECT_TRUE(has_opening(build_mesh(test::patch(4, 4))));
    EXPECT_TRUE(has_opening(Mesh()));
}

TEST(Facets, AShapedFlatEndIsNoCertainFracture) {
    for (const double top : {0.5, 2.0}) {
        TriangleSoup ball = test::octahedron_sphere(5);
        for (auto& p : ball.points) p = {p[0], 1.2 * p[1], std::clamp(p[2], -0.4, top)};
        const Facets facets = find_facets(build_mesh(ball));
        for (const FacetSegment& segment : facets.segments)
            EXPECT_TRUE(segment.facet != Facet::fracture || segment.confidence < 0.9) << top;
    }
}

TEST(Facets, ContextFeaturesDescribeTheSurroundings) {
    const SyntheticSherd sherd = synthetic_sherd(1, 2, 0, 1);
    const FacetEvidence evidence = facet_evidence(sherd.mesh);
    const std::vector<std::string>& names = facet_context_names();
    const std::size_t feature_count = facet_feature_names().size();
    ASSERT_EQ(evidence.features.columns, feature_count);
    const auto column = [&](const FeatureTable& table, const std::string& name) {
        const auto index = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
        std::vector<double> values;
        for (std::size_t r = 0; r < table.rows(); ++r) values.push_back(static_cast<double>(table.row(r)[feature_count + index]));
        return values;
    };
    std::vector<double> odds(evidence.graph.count(), 0);
    const FeatureTable even = with_context(evidence, odds);
    ASSERT_EQ(even.columns, feature_count + names.size());
    for (const char* name : {"likely in the fragment", "part: likely", "likely about, at 3"})
        for (const double value : column(even, name)) EXPECT_NEAR(value, 0.5, 1e-6) << name;
    // Faces are patches here. Where the fractures are known, sides lie over sides, and parts are of one kind.
    ASSERT_EQ(odds.size(), sherd.facets.size());
    for (std::size_t p = 0; p < odds.size(); ++p) odds[p] = sherd.facets[p] == Facet::fracture ? 8 : -8;
    const FeatureTable certain = with_context(evidence, odds);
    const std::vector<double> part = column(certain, "part: likely"),
                              across = column(certain, "part: likely across its boundary"),
                              behind = column(certain, "likely behind");
    double right = 0, beside = 0, behind_sides = 0, sides = 0;
    for (std::size_t p = 0; p < odds.size(); ++p) {
        const double area = evidence.graph.areas[p] / evidence.graph.area;
        right += (part[p] > 0.5) == (odds[p] > 0) ? area : 0;
        if (odds[p] > 0) continue;
        sides += area;
        beside += across[p] > 0.5 ? area : 0;
        behind_sides += behind[p] < 0.5 ? area : 0;
    }
    EXPECT_GT(right, 0.95);
    EXPECT_GT(beside, 0.9 * sides) << "fractures lie between the sides";
    EXPECT_GT(behind_sides, 0.9 * sides);
}

TEST(Facets, RejectsMeshesWithoutAreaAndInvalidOptions) {
    EXPECT_THROW(find_facets(Mesh()), Error);
    TriangleSoup flat;
    flat.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    flat.triangles = {{0, 1, 2}};
    EXPECT_THROW(find_facets(build_mesh(flat)), Error);
    flat.points[2] = {0, 1, 0};
    EXPECT_EQ(find_facets(build_mesh(flat)).of_face, std::vector<Facet>{Facet::outer});
    FacetOptions options;
    options.crease_angle = 0;
    EXPECT_THROW(find_facets(build_mesh(flat), options), Error);
}

TEST(Facets, ScannedSherds) {
    const Path folder = Path(OSTRAKA_SHARED_DATA) / "fragments-vessel-sherds";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "THE SHERDS ARE NOT THERE: " << folder;
    std::vector<Mesh> meshes;
    for (int i = 1; i <= 5; ++i) meshes.push_back(read_mesh(folder / ("TU_96_2_5f_piece0" + std::to_string(i) + ".obj")).mesh);
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const Facets facets = find_facets(meshes[i]);
        EXPECT_TRUE(facets.shell);
        EXPECT_GT(facets.area(Facet::outer), facets.area(Facet::inner)) << "the outside of a vessel is larger";
        // Near another sherd and facing it: on the fracture, or close beside it.
        double right = 0, predicted = 0, total = 0, same = 0;
        std::vector<double> area(meshes[i].number_of_faces());
        std::vector<bool> facing(area.size(), false);
        for (std::size_t j = 0; j < meshes.size(); ++j) {
            if (j == i) continue;
            const SurfaceSearch other(meshes[j]);
            for (const Face face : meshes[i].faces()) {
                const Vector n = area_vector(meshes[i], face);
                area[face] = std::sqrt(n.squared_length());
                const SurfaceHit hit = other.closest(centroid(meshes[i], face));
                if (hit.distance < 1.3 && other.normal(hit.face) * n < -0.3 * area[face]) facing[face] = true;
            }
        }
        for (std::size_t f = 0; f < area.size(); ++f) {
            const bool broken = facets.of_face[f] == Facet::fracture;
            total += area[f];
            same += broken == facing[f] ? area[f] : 0;
            predicted += broken ? area[f] : 0;
            right += broken && facing[f] ? area[f] : 0;
        }
        EXPECT_GT(same / total, 0.9) << "sherd " << i + 1;
        EXPECT_GT(right / predicted, 0.8) << "sherd " << i + 1;
    }
}

std::string quoted(const Path& path) { return "'" + path.string() + "'"; }

TEST(FacetsCommand, WritesThreeRegions) {
    const test::Scratch scratch;
    const SyntheticSherd sherd = synthetic_sherd(1, 2, 0, 1);
    write_mesh(scratch / "sherd.ply", sherd.mesh);
    const auto run =
        test::run_command("annotation facets " + quoted(scratch / "sherd.ply") + " " + quoted(scratch / "sherd.ant.json") +
                          " --unit mm --json --probability " + quoted(scratch / "likely.txt"));
    ASSERT_EQ(run.code, 0) << run.err;
    std::istringstream values(read_file(scratch / "likely.txt"));
    const std::vector<double> likely{std::istream_iterator<double>(values), {}};
    ASSERT_EQ(likely.size(), sherd.mesh.number_of_faces());
    double broken = 0, others = 0;
    for (std::size_t f = 0; f < likely.size(); ++f) (sherd.facets[f] == Facet::fracture ? broken : others) += likely[f];
    const auto count = static_cast<double>(std::count(sherd.facets.begin(), sherd.facets.end(), Facet::fracture));
    EXPECT_GT(broken / count, 0.7);
    EXPECT_LT(others / (static_cast<double>(likely.size()) - count), 0.1);
    const Json report = parse_json(run.out, "report");
    EXPECT_TRUE(report["result"]["shell"].GetBool());
    const AnnotationSet set = read_annotations(scratch / "sherd.ant.json", sherd.mesh);
    ASSERT_EQ(set.annotations.size(), 3U);
    EXPECT_GT(agreement(sherd, facets_of({sherd.mesh, set})), 0.95);
    // Again, with existing landmarks and other regions, one facet with a different spelling and one duplicated.
    AnnotationSet more = read_annotations(scratch / "sherd.ant.json", sherd.mesh);
    Annotation mark, handle;
    mark.id = free_id(more);
    mark.tag = "outer";
    mark.type = AnnotationType::point;
    mark.points = {7};
    handle.id = mark.id + 1;
    handle.tag = "handle";
    handle.faces = {1, 2, 3};
    const int outer = more.annotations[0].id, again = handle.id + 1;
    more.annotations[0].tag = "Outer";
    more.annotations[0].faces = {0};
    more.annotations[0].attributes.emplace_back();
    more.annotations[0].attributes.back().id = 9;
    more.annotations[0].attributes.back().name = "glaze";
    more.annotations[0].attributes.back().value = Note{"brown", {}};
    more.annotations.erase(more.annotations.begin() + 1);
    Annotation twice = more.annotations[0];
    twice.id = again;
    more.annotations.insert(more.annotations.end(), {mark, handle, twice});
    write_annotations(scratch / "sherd.ant.json", {sherd.mesh, more}, "sherd.ply", {});
    const std::string update = "annotation facets " + quoted(scratch / "sherd.ply") + " " + quoted(scratch / "sherd.ant.json");
    EXPECT_EQ(test::run_command(update + " --unit cm").code, 2) << "the file says mm";
    ASSERT_EQ(test::run_command(update).code, 0);
    const AnnotationSet updated = read_annotations(scratch / "sherd.ant.json", sherd.mesh);
    EXPECT_EQ(updated.unit, "mm");
    const std::string provenance = to_text(updated.provenance);
    for (const char* part : {"\"sherd.ply\"", "\"sherd.ant.json\"", "\"facet-crease-angle\"", "\"force-mesh\""})
        EXPECT_NE(provenance.find(part), std::string::npos) << part << provenance;
    EXPECT_NE(to_text(set.provenance).find("\"unit\": \"mm\""), std::string::npos);
    const std::string before = read_file(scratch / "sherd.ant.json");
    ASSERT_EQ(test::run_command(update + " --output " + quoted(scratch / "other.ant.json")).code, 0);
    EXPECT_EQ(read_file(scratch / "sherd.ant.json"), before) << "--output leaves the file as it is";
    EXPECT_EQ(facets_of({sherd.mesh, read_annotations(scratch / "other.ant.json", sherd.mesh)}), facets_of({sherd.mesh, set}));
    EXPECT_EQ(test::run_command(update + " --output " + quoted(scratch / "sherd.ant.json")).code, 2);
    EXPECT_EQ(test::run_command("annotation facets " + quoted(scratch / "sherd.ply") + " " + quoted(scratch / "sherd.ply")).code,
              2)
        << "the mesh is not written over";
    EXPECT_EQ(updated.annotations.size(), 5U);
    EXPECT_EQ(facets_of({sherd.mesh, updated}), facets_of({sherd.mesh, set}));
    ASSERT_NE(updated.find(outer), nullptr);
    EXPECT_EQ(updated.find(outer)->tag, "Outer");
    EXPECT_EQ(updated.find(outer)->faces, set.annotations[0].faces);
    EXPECT_EQ(updated.find(outer)->attributes.size(), set.annotations[0].attributes.size() + 1) << "the glaze is kept";
    EXPECT_EQ(updated.find(again), nullptr);
    ASSERT_NE(updated.find(mark.id), nullptr);
    EXPECT_EQ(updated.find(mark.id)->points, mark.points);
    ASSERT_NE(updated.find(handle.id), nullptr);
    EXPECT_EQ(updated.find(handle.id)->faces, handle.faces);

    write_mesh(scratch / "whole.ply", build_mesh(test::octahedron_sphere(3)));
    EXPECT_EQ(
        test::run_command("annotation facets " + quoted(scratch / "whole.ply") + " " + quoted(scratch / "whole.ant.json")).code,
        3);
    EXPECT_FALSE(std::filesystem::exists(scratch / "whole.ant.json")) << "no fracture, nothing written";
    EXPECT_EQ(test::run_command("annotation facets " + quoted(scratch / "whole.ply") + " " + quoted(scratch / "x.ant.json") +
                                " --facet-crease-angle 0")
                  .code,
              2);
}

}  // namespace
}  // namespace ostraka

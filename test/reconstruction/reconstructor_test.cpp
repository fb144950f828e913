#include "ostraka/reconstruction/reconstruct.h"

#include "pieces.h"

#include "ostraka/core/error.h"
#include "ostraka/files/json.h"
#include "ostraka/mesh/orientation.h"

#include <gtest/gtest.h>

#include <numeric>

namespace ostraka {
namespace {

using namespace test;
using Eigen::Vector3d;

/// All results of a reconstruction, to the bit.
void expect_same(const Reconstruction& a, const Reconstruction& b, const std::string& context) {
    EXPECT_EQ(a.placement.scale, b.placement.scale) << context;
    ASSERT_EQ(a.placement.fragments.size(), b.placement.fragments.size()) << context;
    for (std::size_t k = 0; k < a.placement.fragments.size(); ++k) {
        const FragmentPlacement &first = a.placement.fragments[k], &second = b.placement.fragments[k];
        EXPECT_EQ(first.pose.rotation, second.pose.rotation) << context;
        EXPECT_EQ(first.pose.translation, second.pose.translation) << context;
        EXPECT_EQ(first.residual, second.residual) << context;
        EXPECT_EQ(first.problem, second.problem) << context;
    }
    EXPECT_EQ(a.points, b.points) << context;
    EXPECT_EQ(a.distance, b.distance) << context;
    EXPECT_EQ(mesh_checksum(a.object.mesh), mesh_checksum(b.object.mesh)) << context;
    EXPECT_EQ(a.object.fragment, b.object.fragment) << context;
    EXPECT_EQ(a.object.confidence, b.object.confidence) << context;
    EXPECT_EQ(a.crossings, b.crossings) << context;
    EXPECT_EQ(a.strain, b.strain) << context;
    EXPECT_EQ(a.verdict, b.verdict) << context;
    ASSERT_EQ(a.annotations.size(), b.annotations.size()) << context;
    for (std::size_t k = 0; k < a.annotations.size(); ++k) {
        ASSERT_EQ(a.annotations[k].size(), b.annotations[k].size()) << context;
        for (std::size_t i = 0; i < a.annotations[k].size(); ++i) {
            EXPECT_EQ(a.annotations[k][i].template_annotation, b.annotations[k][i].template_annotation) << context;
            EXPECT_EQ(a.annotations[k][i].score, b.annotations[k][i].score) << context;
        }
    }
}

/// A template with landmarks and a region, and three fragments of a deformed object; one has no landmarks.
struct Pieces {
    explicit Pieces(int levels) : mesh(body(levels)), set(landmarks_of(mesh)) {
        const Mesh original = deformed_by(
            mesh, [](const Vector3d& p) { return Vector3d(1.05 * p.x(), p.y() + 0.04 * p.z() * p.z(), 1.08 * p.z()); });
        Annotation head;
        head.id = 100;
        head.tag = "head";
        for (const Face face : mesh.faces())
            if (centroid(mesh, face).z() > 1.2) head.faces.push_back(face);
        set.annotations.push_back(head);
        AnnotationSet points = landmarks_of(mesh);
        FragmentOptions options;
        options.share = 0.3;
        options.noise = 0.001;
        const std::vector<Point> places{Point(0, 0, 1.9), Point(0, 0, -1.9), Point(1.2, 0, 0)};
        for (std::size_t k = 0; k < places.size(); ++k) {
            Cut cut_piece = cut({original, points}, places[k], options);
            cut_piece.fragment.name = "piece " + std::to_string(k);
            if (k == 0) {
                Annotation part = head;
                part.faces.clear();
                for (Index f = 0; f < cut_piece.piece.faces.size(); ++f)
                    if (std::binary_search(head.faces.begin(), head.faces.end(), cut_piece.piece.faces[f]))
                        part.faces.push_back(f);
                cut_piece.fragment.annotations.annotations.push_back(part);
            }
            if (k == 2) cut_piece.fragment.annotations.annotations.clear();
            fragments.push_back(std::move(cut_piece.fragment));
        }
    }
    Mesh mesh;
    AnnotationSet set;
    std::vector<Fragment> fragments;
    RelationGraph graph;
};

TEST(Reconstructor, AddingAndRemovingIsTheSameAsFromScratch) {
    // With and without a simplified template.
    for (const int levels : {4, 6}) {
        const Pieces pieces(levels);
        Reconstructor reconstructor({pieces.mesh, pieces.set}, pieces.graph);
        std::vector<std::size_t> present;
        const auto check = [&](const std::string& context) {
            std::vector<const Fragment*> fragments;
            for (const std::size_t k : present) fragments.push_back(&pieces.fragments[k]);
            expect_same(reconstructor.run(), reconstruct({pieces.mesh, pieces.set}, pieces.graph, fragments), context);
        };
        const auto add = [&](std::size_t k) {
            reconstructor.add(pieces.fragments[k]);
            present.push_back(k);
        };
        const auto remove = [&](std::size_t position) {
            reconstructor.remove(position);
            present.erase(present.begin() + static_cast<std::ptrdiff_t>(position));
        };
        add(0);
        check("one");
        check("one again");
        add(1);
        check("two");
        remove(0);
        check("the second");
        if (levels > 4) continue;  // longer paths on the small one only
        add(2);
        check("and the third");
        add(0);
        check("all");
        remove(1);
        check("without the third");
        remove(0);
        check("the first again");
        EXPECT_EQ(reconstructor.size(), 1U);
    }
}

TEST(Reconstructor, AFragmentIsSearchedOnce) {
    const Pieces pieces(4);
    Reconstructor reconstructor({pieces.mesh, pieces.set}, pieces.graph);
    reconstructor.add(pieces.fragments[2]);
    (void)reconstructor.run();
    EXPECT_EQ(reconstructor.searches().made(), 1U);
    reconstructor.remove(0);
    reconstructor.add(pieces.fragments[2]);
    (void)reconstructor.run();
    EXPECT_EQ(reconstructor.searches().made(), 1U);
    EXPECT_EQ(reconstructor.searches().reused(), 1U);
}

TEST(Reconstructor, RefusesMissingFragmentsAndPositions) {
    const Pieces pieces(3);
    Reconstructor reconstructor({pieces.mesh, pieces.set}, pieces.graph);
    EXPECT_THROW((void)reconstructor.run(), Error);
    EXPECT_THROW(reconstructor.remove(0), Error);
    reconstructor.add(pieces.fragments[0]);
    EXPECT_THROW(reconstructor.remove(1), Error);
}

TEST(Reconstructor, TurnsFragmentsOverThatAreInsideOut) {
    const Pieces pieces(3);
    Fragment whole{{pieces.mesh, pieces.set}, "whole", {}}, turned = whole;
    turned.mesh = turned_over(whole.mesh);
    std::vector<std::vector<Point>> placed;
    for (const Fragment* fragment : {&whole, &turned}) {
        Reconstructor reconstructor({pieces.mesh, pieces.set}, pieces.graph);
        reconstructor.add(*fragment);
        const Reconstruction result = reconstructor.run();
        ASSERT_EQ(result.notes.size(), 1U);
        const bool is_noted = std::any_of(result.notes[0].begin(), result.notes[0].end(), [](const std::string& note) {
            return note.find("is inside out") != std::string::npos;
        });
        EXPECT_EQ(is_noted, fragment == &turned);
        placed.push_back(result.points);
    }
    ASSERT_FALSE(placed[0].empty());
    EXPECT_EQ(placed[0].size(), placed[1].size());
    for (std::size_t i = 0; i < placed[0].size(); ++i)
        ASSERT_LT(std::sqrt((placed[0][i] - placed[1][i]).squared_length()), 1e-6 * box_diagonal(pieces.mesh)) << i;
}

class PoseSearchFile : public ::testing::Test {
protected:
    PoseSearchFile() : pieces(4), searches(pieces.mesh, {}) {
        const auto result = searches.find(pieces.fragments[2], 1, 1);
        EXPECT_TRUE(result.has_value());
        document.CopyFrom(parse_json(to_text(searches.to_json(document.GetAllocator())), "searches"), document.GetAllocator());
    }
    Pieces pieces;
    PoseSearches searches;
    Json document;
};

TEST_F(PoseSearchFile, IsRestoredToTheBit) {
    validate(document, "searches", "searches");
    PoseSearches again(pieces.mesh, {});
    EXPECT_EQ(again.add(document, "searches"), 0U);
    const auto restored = again.find(pieces.fragments[2], 1, 1), other = searches.find(pieces.fragments[2], 1, 1);
    EXPECT_EQ(again.made(), 0U);
    EXPECT_EQ(again.reused(), 1U);
    ASSERT_EQ(restored->candidates.size(), other->candidates.size());
    for (std::size_t i = 0; i < restored->candidates.size(); ++i) {
        EXPECT_EQ(restored->candidates[i].pose.rotation, other->candidates[i].pose.rotation);
        EXPECT_EQ(restored->candidates[i].pose.translation, other->candidates[i].pose.translation);
        EXPECT_EQ(restored->candidates[i].score, other->candidates[i].score);
    }
    EXPECT_EQ(restored->confidence, other->confidence);
    EXPECT_EQ(restored->slippable.kind, other->slippable.kind);
    EXPECT_EQ(to_text(again.to_json(document.GetAllocator())), to_text(searches.to_json(document.GetAllocator())));
}

TEST_F(PoseSearchFile, IsNotUsedForOtherInputs) {
    // Another fragment, other facets, another range, other options, another template.
    PoseSearches again(pieces.mesh, {});
    EXPECT_EQ(again.add(document, "searches"), 0U);
    Fragment moved_one{{pieces.fragments[2].mesh, {}}, "moved", {}};
    moved_one.mesh.point(Vertex(0)) = moved_one.mesh.point(Vertex(0)) + Vector(1e-9, 0, 0);
    (void)again.find(moved_one, 1, 1);
    Fragment broken{{pieces.fragments[2].mesh, {}}, "broken", {}};
    broken.facets.assign(broken.mesh.number_of_faces(), Facet::outer);
    broken.facets[0] = Facet::fracture;
    (void)again.find(broken, 1, 1);
    (void)again.find(pieces.fragments[2], 1.1, 1.1);
    EXPECT_EQ(again.reused(), 0U);
    EXPECT_EQ(again.made(), 3U);
    PoseSearchOptions options;
    options.seed = 2;
    PoseSearches otherwise(pieces.mesh, options);
    EXPECT_EQ(otherwise.add(document, "searches"), 0U);
    EXPECT_TRUE(otherwise.empty());
    Mesh other = pieces.mesh;
    other.point(Vertex(0)) = other.point(Vertex(0)) + Vector(1e-9, 0, 0);
    PoseSearches elsewhere(other, {});
    EXPECT_EQ(elsewhere.add(document, "searches"), 0U);
    EXPECT_TRUE(elsewhere.empty());
}

TEST_F(PoseSearchFile, DetectsChanges) {
    document["searches"][0]["result"]["candidates"][0]["pose"]["shift"][0].SetDouble(0.5);
    PoseSearches again(pieces.mesh, {});
    EXPECT_EQ(again.add(document, "searches"), 1U);
    EXPECT_TRUE(again.empty());
    document["searches"][0]["result"].RemoveMember("margin");
    EXPECT_THROW((void)again.add(document, "searches"), Error);
    EXPECT_THROW((void)again.add(parse_json("{}", "x"), "x"), Error);
}

}  // namespace
}  // namespace ostraka

#include "../../src/transfer/face_parts.h"

#include "meshes.h"
#include "ostraka/annotation/annotation.h"
#include "ostraka/annotation/outline.h"
#include "ostraka/execution/parallel.h"

#include <gtest/gtest.h>

#include <random>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// Outlines of a region as directed edges.
std::vector<Halfedge> outline_edges(const Mesh& mesh, const std::vector<Index>& faces) {
    std::vector<Halfedge> edges;
    for (const Outline& outline : extract_outlines(mesh, faces))
        for (std::size_t i = 0; i < outline.size(); ++i)
            edges.push_back(find_halfedge(mesh, Vertex(outline[i]), Vertex(outline[(i + 1) % outline.size()])));
    return edges;
}

std::vector<Edge> edges_of(const Mesh& mesh, const std::vector<std::vector<Halfedge>>& regions) {
    std::vector<Edge> edges;
    for (const auto& region : regions)
        for (const Halfedge h : region) edges.push_back(mesh.edge(h));
    return edges;
}

}  // namespace

TEST(FaceParts, OverlappingRegionsAreRecoveredWithTheirMeasures) {
    std::mt19937_64 random(3);
    for (const auto& [name, soup] : group()) {
        const Mesh mesh = build_mesh(soup);
        const double radius = 0.08 * box_diagonal(mesh);
        std::vector<std::vector<Index>> regions(6);
        std::vector<std::vector<Halfedge>> outlines;
        for (auto& region : regions) {
            const Point centre = centroid(mesh, Face(static_cast<Index>(random() % mesh.number_of_faces())));
            for (const Face f : mesh.faces())
                if (CGAL::squared_distance(centroid(mesh, f), centre) < radius * radius) region.push_back(f);
            outlines.push_back(outline_edges(mesh, region));
        }
        for (const int thread_count : {1, 3}) {
            set_threads(thread_count);
            const FaceParts parts(mesh, edges_of(mesh, outlines));
            set_threads(0);
            for (std::size_t i = 0; i < regions.size(); ++i) {
                const FaceParts::Choice choice = parts.left_of(outlines[i]);
                const RegionMeasures measures = measure_region(mesh, regions[i]);
                EXPECT_FALSE(choice.crossing) << name;
                EXPECT_EQ(flagged(parts.faces(choice)), regions[i]) << name;
                EXPECT_NEAR(choice.area, measures.area, 1e-9 * measures.area) << name;
                EXPECT_NEAR(choice.perimeter, measures.perimeter, 1e-9 * measures.perimeter) << name;
            }
        }
    }
}

TEST(FaceParts, EdgesThatBoundNothingAreFilledByTheFallback) {
    std::mt19937_64 random(5);
    for (const auto& [name, soup] : group()) {
        const Mesh mesh = build_mesh(soup);
        // Rings around single faces, some of them in both directions, and arbitrary edges.
        std::vector<std::vector<Halfedge>> regions(20);
        for (auto& region : regions)
            for (int i = 0; i < 12; ++i) {
                const Face face(static_cast<Index>(random() % mesh.number_of_faces()));
                for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(face), mesh)) {
                    if (i % 4 != 3) region.push_back(h);
                    if (i % 4 == 2) region.push_back(mesh.opposite(h));
                }
                if (i % 6 == 5) region.push_back(mesh.halfedge(face));
            }
        const FaceParts parts(mesh, edges_of(mesh, regions));
        for (const auto& region : regions) {
            const FaceParts::Choice choice = parts.left_of(region);
            const Filling filling = fill_edges(mesh, region);
            EXPECT_EQ(parts.faces(choice), filling.selected) << name;
            EXPECT_EQ(choice.crossing, filling.conflicts > 0) << name;
        }
        EXPECT_TRUE(flagged(parts.faces(parts.left_of({}))).empty()) << name;
    }
}

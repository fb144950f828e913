#include "../../src/transfer/disjoint_regions.h"

#include "annotation/example_meshes.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/remesh/remesh.h"
#include "ostraka/remesh/simplify.h"
#include "ostraka/transfer/transfer.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <cstdlib>

using namespace ostraka;
using ostraka::example::grid;

namespace {

Annotation region(int id, std::vector<Index> faces) {
    Annotation annotation;
    annotation.id = id;
    annotation.faces = std::move(faces);
    return annotation;
}

/// Number of faces that belong to the given number of regions.
std::size_t claimed(AnnotatedMeshView object, std::size_t times) {
    std::vector<std::size_t> count(object.mesh.number_of_faces(), 0);
    for (const Annotation& annotation : object.annotations.annotations)
        for (const Index f : annotation.faces) ++count[f];
    return static_cast<std::size_t>(std::count(count.begin(), count.end(), times));
}

}  // namespace

TEST(DisjointRegions, AFaceInTwoRegionsIsAssignedToTheOneWithTheLargerShare) {
    // Eight by eight cells over two by two: the target's face 0 lies in the source's cells (0..3, 0..3) below the diagonal.
    const Mesh source = grid(8, 0.25), target = grid(2, 1);
    AnnotationSet set;
    std::vector<Index> left, right, low;
    for (const Face f : source.faces()) {
        const Point c = centroid(source, f);
        (c.x() < 0.8 ? left : right).push_back(f);
        if (c.y() < 0.5) low.push_back(f);
    }
    set.annotations = {region(0, right), region(1, left), region(2, low)};
    std::size_t queries = 0;
    const SurfaceSearch search(source);
    const auto source_search = [&]() -> const SurfaceSearch& { return ++queries, search; };
    const std::vector<bool> none(8, false), all(8, true);
    std::vector<std::vector<bool>> selected{all, all, all};
    keep_disjoint({source, set}, source_search, target, selected);
    // Both faces of the left cells, three quarters of which are left of 0.8; the third region overlaps both.
    EXPECT_EQ(selected[0], (std::vector<bool>{false, false, true, true, false, false, true, true}));
    EXPECT_EQ(selected[1], (std::vector<bool>{true, true, false, false, true, true, false, false}));
    EXPECT_EQ(selected[2], all);
    // In case of a tie: to the first.
    set.annotations = {region(0, low), region(1, {})};
    for (const Face f : source.faces())
        if (centroid(source, f).y() >= 0.5) set.annotations[1].faces.push_back(f);
    queries = 0;
    // Unassigned faces are assigned if the regions partition the whole.
    selected = {none, {}};
    keep_disjoint({source, set}, source_search, target, selected);
    ASSERT_EQ(selected[1].size(), 8U);
    for (std::size_t f = 0; f < 8; ++f) EXPECT_NE(selected[0][f], selected[1][f]) << f;
    EXPECT_TRUE(selected[1][4] && selected[1][7]);
    EXPECT_GT(queries, 0U);
    // If they do not, the faces stay unassigned, and no query is made.
    set.annotations.pop_back();
    queries = 0;
    selected = {none};
    keep_disjoint({source, set}, source_search, target, selected);
    EXPECT_EQ(selected[0], none);
    EXPECT_EQ(queries, 0U);
}

TEST(DisjointRegions, PartitionsOfBustsStayPartitions) {
    const Path data = Path(OSTRAKA_SHARED_DATA) / "psb-seg";
    if (!std::filesystem::exists(data)) GTEST_SKIP() << "no segmented meshes at " << data;
    const test::Scratch scratch;
    const std::string to = " -C " + scratch.path().string() + " ";
    ASSERT_EQ(std::system(("tar xJf " + (data / "off.tar.xz").string() + to + "off/bust/309.off").c_str()), 0);
    ASSERT_EQ(std::system(("tar xJf " + (data / "seg.tar.xz").string() + to + "seg/bust/309").c_str()), 0);
    const Mesh source = read_mesh(scratch / "off/bust/309.off").mesh;
    SimplifyOptions fewer;
    fewer.vertices = 1291;
    Mesh simplified = source;
    simplify(simplified, fewer);
    RemeshOptions anew;
    anew.vertices = 1291;
    const Mesh remeshed = remesh(source, anew).mesh;
    TransferOptions along_edges;
    along_edges.outlines = TransferOptions::Outlines::kept;
    for (const Mesh* target : {static_cast<const Mesh*>(&simplified), &remeshed}) {
        const SurfaceSearch search(*target);
        for (const int number : {1, 3, 5}) {
            const Path labels = scratch / ("seg/bust/309/309_" + std::to_string(number) + ".seg");
            const AnnotationSet set = regions_from_labels(source, read_labels(labels, source.number_of_faces()));
            ASSERT_EQ(claimed({source, set}, 1), source.number_of_faces());
            const AnnotationSet transferred = transfer({source, set}, search, along_edges).annotations;
            EXPECT_EQ(claimed({*target, transferred}, 1), target->number_of_faces()) << number;
            set_threads(1);
            const AnnotationSet alone = transfer({source, set}, search, along_edges).annotations;
            set_threads(0);
            for (std::size_t i = 0; i < transferred.annotations.size(); ++i)
                EXPECT_EQ(transferred.annotations[i].faces, alone.annotations[i].faces);
        }
    }
}

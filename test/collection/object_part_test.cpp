// Parts of the objects of a collection.
#include "ostraka/collection/object_part.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/part.h"
#include "ostraka/collection/technique_objects.h"
#include "ostraka/core/error.h"
#include "ostraka/fields/thickness.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/select/scalars.h"
#include "ostraka/synthetic/head_casts.h"
#include "scratch.h"

#include <gtest/gtest.h>

using namespace ostraka;

namespace {

Annotation region_of_part(int id, const std::string& tag, const HeadCast& cast,
                          const std::function<bool(HeadPart)>& is_in_region) {
    Annotation region;
    region.id = id;
    region.tag = tag;
    for (std::size_t f = 0; f < cast.face_labels.size(); ++f)
        if (is_in_region(static_cast<HeadPart>(cast.face_labels[f]))) region.faces.push_back(static_cast<Index>(f));
    return region;
}

/// A statuette in any pose, annotated: its head, without the stump of the neck, and the body.
struct OneStatuette {
    test::Scratch scratch;
    HeadCast cast;
    Collection collection;
    OneStatuette() {
        CastOptions options;
        options.body = true;
        options.vertices = 2500;
        options.seed = 5;
        cast = cast_head(head_archetype({}), options);
        AnnotationSet set;
        set.up = cast.up;
        set.annotations = {
            region_of_part(1, "Kopf", cast, [](HeadPart part) { return part != HeadPart::stump && part != HeadPart::body; }),
            region_of_part(2, "body", cast, [](HeadPart part) { return part == HeadPart::body; }),
            region_of_part(3, "hair", cast, [](HeadPart part) { return part == HeadPart::hair; })};
        MeshExtras extras;
        extras.face_labels = cast.face_labels;
        write_mesh(scratch / "one.ply", cast.mesh, extras, {});
        write_annotations(scratch / "one.ant.json", {cast.mesh, set}, "one.ply", Provenance{"test", {}, {}});
        collection = read_collection(scratch.path());
    }
    [[nodiscard]] double area(const std::function<bool(HeadPart)>& is_in_region) const {
        return area_of(cast.mesh, region_of_part(0, "", cast, is_in_region).faces);
    }
};

PartOptions named(std::vector<std::string> annotations, std::vector<std::string> without = {}) {
    PartOptions options;
    options.annotations = std::move(annotations);
    options.without = std::move(without);
    return options;
}

}  // namespace

TEST(ObjectParts, AreCutAlongTheirOutlines) {
    const OneStatuette statuette;
    const CollectionObject& object = statuette.collection.objects.at(0);
    const ObjectPart body = ObjectParts(named({"body"})).read(object);
    const double expected = statuette.area([](HeadPart part) { return part == HeadPart::body; });
    EXPECT_NEAR(surface_area(body.mesh), expected, 1e-6 * expected);
    for (const auto label : body.face_labels) EXPECT_EQ(label, static_cast<std::int32_t>(HeadPart::body));
    ASSERT_TRUE(body.up);
    // Parts that an object does not have need not be left out.
    const ObjectPart without_beard = ObjectParts(named({"body"}, {"beard"})).read(object);
    EXPECT_EQ(without_beard.mesh.number_of_faces(), body.mesh.number_of_faces());
    const ObjectPart bald = ObjectParts(named({"Kopf"}, {"hair"})).read(object);
    const double skin =
        statuette.area([](HeadPart part) { return part != HeadPart::stump && part != HeadPart::body && part != HeadPart::hair; });
    EXPECT_NEAR(surface_area(bald.mesh), skin, 1e-6 * skin);
}

TEST(ObjectParts, AreNamedByConcepts) {
    const OneStatuette statuette;
    const CollectionObject& object = statuette.collection.objects.at(0);
    EXPECT_THROW((void)ObjectParts(named({"head"})).read(object), Error);
    const Vocabulary vocabulary =
        vocabulary_from_json(parse_json(R"({"format": "ostraka-vocabulary", "version": 1, "uri": "http://example.org/figurines",
            "concepts": [{"id": "head", "label": {"en": "head", "de": "Kopf"}}]})",
                                        "test"),
                             "test");
    EXPECT_GT(ObjectParts(named({"head"}), TagMatcher(&vocabulary)).read(object).mesh.number_of_faces(), 0U);
}

TEST(ObjectParts, TheTopLiesAboveTheNeck) {
    const OneStatuette statuette;
    PartOptions options;
    options.proposed = PartOptions::Proposal::top;
    const ObjectPart top = ObjectParts(options).read(statuette.collection.objects.at(0));
    // The body's area is that without head and neck, and the neck is cut at some height.
    const double head = statuette.area([](HeadPart part) { return part != HeadPart::stump && part != HeadPart::body; });
    EXPECT_NEAR(surface_area(top.mesh) / head, 1, 0.2);
    double of_body = 0;
    for (const Face f : top.mesh.faces())
        if (top.face_labels[f] == static_cast<std::int32_t>(HeadPart::body)) of_body += face_area(top.mesh, f);
    EXPECT_LT(of_body, 0.05 * head);
    // Lying on its side it has no neck.
    EXPECT_THROW((void)ObjectParts(options).read(
                     statuette.collection.objects.at(0),
                     std::array<double, 3>{-statuette.cast.up[0], -statuette.cast.up[1], -statuette.cast.up[2]}),
                 Error);
}

TEST(ObjectParts, TheLargestSegmentMatchesTheSegmentation) {
    const OneStatuette statuette;
    PartOptions options;
    options.proposed = PartOptions::Proposal::segment;
    const ObjectPart part = ObjectParts(options).read(statuette.collection.objects.at(0));
    const Mesh mesh = read_mesh(statuette.scratch / "one.ply").mesh;
    const std::vector<Index> numbers = segment(mesh, thickness(mesh), {});
    double area = 0;
    for (const Face f : mesh.faces())
        if (numbers[f] == 0) area += face_area(mesh, f);
    EXPECT_NEAR(surface_area(part.mesh) / area, 1, 1e-12);
    EXPECT_LT(area, 0.95 * surface_area(mesh));
    EXPECT_EQ(part.face_labels.size(), part.mesh.number_of_faces());
}

TEST(ObjectParts, ProposalsAndNamesExcludeEachOther) {
    PartOptions options = named({"head"});
    options.proposed = PartOptions::Proposal::tube;
    EXPECT_THROW(ObjectParts{options}, Error);
}

TEST(ObjectParts, StudiesOfAPartMatchStudiesOfTheExtractedPart) {
    const OneStatuette statuette;
    const test::Scratch cut;
    const MeshFile file = read_mesh(statuette.scratch / "one.ply");
    const AnnotationSet set = read_annotations(statuette.scratch / "one.ant.json", file.mesh);
    const CutPart part = cut_out_part({file.mesh, set}, {1});
    write_mesh(cut / "one.ply", part.mesh, {}, {});
    const auto on_whole = measure_technique(statuette.collection, set.up, {}, ResultStore(), ObjectParts(named({"body"})));
    const auto on_part = measure_technique(read_collection(cut.path()), set.up);
    ASSERT_TRUE(on_whole.at(0).problem.empty()) << on_whole.at(0).problem;
    ASSERT_TRUE(on_part.at(0).problem.empty()) << on_part.at(0).problem;
    const TechniqueMeasures a = technique_from_json(on_whole[0].result), b = technique_from_json(on_part[0].result);
    ASSERT_EQ(a.slices.size(), b.slices.size());
    // The coordinates are equal, since both were read from one file.
    for (std::size_t i = 0; i < a.slices.size(); ++i) EXPECT_NEAR(a.slices[i].roundness, b.slices[i].roundness, 1e-6);
}

// Relationships planted in synthetic objects are found at every noise level, and false ones are not.
#include "ostraka/relation/geometric.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/select/recipe.h"
#include "ostraka/synthetic/make_mesh.h"
#include "ostraka/synthetic/synthetic_object.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

using namespace ostraka;
using namespace ostraka::test;

namespace {

struct Planted {
    bool holds;
    std::string type;
    std::vector<int> annotations;
    std::string attribute = {};
};

const std::map<std::string, std::vector<Planted>>& planted() {
    static const std::map<std::string, std::vector<Planted>> table{
        {"teapot",
         {{true, "same level", {7, 8, 9, 10, 11}},
          {true, "equal attributes", {7, 8, 9, 10, 11}, "area"},
          {true, "co-axiality", {1, 2}},
          {true, "co-axiality", {1, 3}},
          {true, "mirror symmetry", {6}},
          {true, "part similarity", {7, 9}},
          {true, "horizontal support", {2, 1}},
          {true, "horizontal support", {3, 4}},
          {true, "side contact", {1, 6}},
          {false, "same level", {7, 4}},
          {false, "same level", {5, 3}},
          {false, "mirror symmetry", {5, 6}},
          {false, "co-axiality", {1, 5}},
          {false, "part similarity", {5, 6}},
          {false, "equal attributes", {1, 7}, "area"},
          {false, "horizontal support", {4, 3}}}},
        {"chair",
         {{true, "mirror symmetry", {3, 5}},
          {true, "mirror symmetry", {4, 6}},
          {true, "mirror symmetry", {7, 8}},
          {true, "mirror symmetry", {1}},
          {true, "same level", {3, 5}},
          {true, "same level", {7, 8, 9, 10}},
          {true, "equal attributes", {3, 5}, "length"},
          {true, "equal attributes", {7, 8, 9, 10}, "height"},
          {true, "part similarity", {3, 5}},
          {true, "horizontal support", {7, 1}},
          {true, "horizontal support", {4, 3}},
          {true, "side contact", {2, 3}},
          {true, "co-axiality", {4, 7}},
          {true, "co-axiality", {6, 8}},
          {false, "mirror symmetry", {3, 4}},
          {false, "mirror symmetry", {2, 3}},
          {false, "same level", {3, 4}},
          {false, "co-axiality", {7, 10}},
          {false, "co-axiality", {4, 6}},
          {false, "perpendicular axes", {7, 8}},
          {false, "part similarity", {3, 7}},
          {false, "horizontal support", {3, 4}},
          {false, "co-planarity", {1, 2}},
          {false, "equal attributes", {4, 7}, "height"}}},
        {"statuette",
         {{true, "mirror symmetry", {5, 6}},
          {true, "mirror symmetry", {3}},
          {true, "equal attributes", {5, 6}, "area"},
          {true, "same level", {5, 6}},
          {true, "part similarity", {5, 6}},
          {true, "perpendicular axes", {1, 7}},
          {false, "mirror symmetry", {3, 7}},
          {false, "co-axiality", {1, 7}},
          {false, "same level", {3, 7}},
          {false, "equal attributes", {1, 5}, "area"}}},
    };
    return table;
}

Relationship stated(const std::string& type, std::vector<int> members, const std::string& attribute = {}) {
    Relationship relationship;
    relationship.type = type;
    relationship.directed = find_relation_type(type)->directed;
    relationship.annotations = std::move(members);
    relationship.origin = "stated";
    relationship.parameters.attribute = attribute;
    return relationship;
}

/// Vertices moved along their normals, Gaussian with the given share of the diagonal as standard deviation.
void add_noise(Mesh& mesh, double share, unsigned seed = 11) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, share * box_diagonal(mesh));
    std::vector<Vector> moves;
    for (const Vertex v : mesh.vertices()) moves.push_back(normal(random) * vertex_normal(mesh, v));
    for (const Vertex v : mesh.vertices()) mesh.point(v) = mesh.point(v) + moves[v];
}

Annotation region(int id, const std::string& tag, const std::vector<bool>& flags) {
    Annotation a;
    a.id = id, a.tag = tag, a.faces = flagged(flags);
    return a;
}

std::string words(const RelationCheck& check) {
    std::string text = to_string(check.verdict) + " " + check.text;
    for (const auto& d : check.parameters.deviations)
        text +=
            "; " + d.quantity + " " + std::to_string(d.value.value_or(-1)) + " of " + std::to_string(d.tolerance.value_or(-1));
    return text;
}

}  // namespace

TEST(GeometricRelations, PlantedRelationsAreFoundAndFalseOnesAreNot) {
    for (const auto& [name, list] : planted())
        for (const auto& [noise, seed] :
             {std::pair{0.0, 0U}, {0.001, 11U}, {0.001, 71U}, {0.005, 11U}, {0.005, 72U}, {0.005, 73U}}) {
            SyntheticMesh object = make_mesh(synthetic_object(name), {.vertices = 12000});
            const AnnotationSet set =
                apply_recipe(Path(OSTRAKA_SOURCE_DIR) / "data" / (name + ".recipe.json"), object.mesh, object.face_labels);
            add_noise(object.mesh, noise, seed);
            RelationOptions options;
            if (noise > 0.004)
                options.max_difference = 12;  // such noise alone makes the areas of small parts differ by up to 11 %
            RelationMeter meter({object.mesh, set}, options);
            for (const auto& [holds, type, members, attribute] : list) {
                const RelationCheck check = meter.measure(stated(type, members, attribute));
                std::string text = name + " " + std::to_string(noise) + " " + std::to_string(seed) + " " + type;
                for (const int id : members) text += " " + set.find(id)->tag + ",";
                EXPECT_EQ(check.verdict == Verdict::holds, holds) << text << ": " << words(check);
            }
        }
}

TEST(GeometricRelations, ExtractionFindsThePlantedRelations) {
    const SyntheticMesh object = make_mesh(synthetic_object("teapot"), {.vertices = 12000});
    const AnnotationSet set = apply_recipe(Path(OSTRAKA_SOURCE_DIR) / "data/teapot.recipe.json", object.mesh, object.face_labels);
    RelationMeter meter({object.mesh, set});
    RelationGraph graph;
    graph.relationships = meter.extract({}, 3);
    ASSERT_FALSE(graph.relationships.empty());
    EXPECT_EQ(graph.relationships.front().id, 3);
    const auto has = [&](const std::string& type, const std::vector<int>& members) {
        return std::any_of(graph.relationships.begin(), graph.relationships.end(),
                           [&](const auto& r) { return r.type == type && r.annotations == members; });
    };
    // The five flowers are in one group, possibly with other parts on their level.
    const std::vector<int> flowers{7, 8, 9, 10, 11};
    EXPECT_TRUE(std::any_of(graph.relationships.begin(), graph.relationships.end(), [&](const auto& r) {
        return r.type == "same level" &&
               std::includes(r.annotations.begin(), r.annotations.end(), flowers.begin(), flowers.end());
    }));
    EXPECT_TRUE(has("co-axiality", {1, 2}));
    EXPECT_FALSE(has("mirror symmetry", {5, 6}));
    // Extracted relationships hold when checked.
    for (const auto& check : check_relations({object.mesh, set}, graph)) EXPECT_EQ(check.verdict, Verdict::holds) << words(check);
    // Selected types only.
    for (const auto& relationship : meter.extract({"same level"}, 0)) EXPECT_EQ(relationship.type, "same level");
}

TEST(GeometricRelations, UserSpecifiedRelationsAreNotExtractedAgain) {
    const SyntheticMesh object = make_mesh(synthetic_object("teapot"), {.vertices = 12000});
    AnnotationSet set = apply_recipe(Path(OSTRAKA_SOURCE_DIR) / "data/teapot.recipe.json", object.mesh, object.face_labels);
    const ExtractedRelations all = extract_relations({object.mesh, set});
    EXPECT_TRUE(all.stated.empty());
    EXPECT_TRUE(all.skipped_types.empty());
    RelationGraph old;
    for (const auto& relationship : all.graph.relationships)
        if (relationship.type == "co-axiality" || relationship.type == "adjacency") {
            old.relationships.push_back(relationship);
            if (relationship.type == "co-axiality") old.relationships.back().origin = "stated";
        }
    std::size_t stated = 0;
    for (const auto& relationship : old.relationships) stated += relationship.origin == "stated";
    ASSERT_GT(stated, 0U);
    const ExtractedRelations again = extract_relations({object.mesh, set}, old, {"Co-Axiality", "containment"});
    EXPECT_EQ(again.stated.size(), stated);
    std::set<int> ids;
    for (const auto& relationship : again.graph.relationships) {
        EXPECT_TRUE(ids.insert(relationship.id).second);
        EXPECT_EQ(relationship.type, relationship.origin == "stated" ? "co-axiality" : "containment");
    }
    set.up.reset();
    EXPECT_EQ(extract_relations({object.mesh, set}, {}, {"same level", "containment"}).skipped_types,
              std::vector<std::string>{"same level"});
    EXPECT_THROW(extract_relations({object.mesh, set}, {}, {"proportion"}), Error);
}

TEST(GeometricRelations, SupportOnTheAxisOfItsLeg) {
    // Leg and support are one leaning rod with a joint; a second support leans by ten degrees more.
    const auto rod = [](double x, double lean) {
        return grid(40, 60, true, false, [=](double u, double v) {
            const double h = 3 * v, s = std::sin(lean), c = std::cos(lean);
            const double p = 0.2 * std::cos(2 * M_PI * u), q = 0.2 * std::sin(2 * M_PI * u);
            return std::array<double, 3>{x + p * c + h * s, q, h * c - p * s};
        });
    };
    Mesh mesh = build_mesh(joined(rod(0, 0.1), rod(5, 0.28)));
    std::vector<bool> leg(mesh.number_of_faces(), false), support = leg, other = leg;
    for (std::size_t f = 0; f < leg.size(); ++f) {
        const bool first = f < leg.size() / 2, low = f % (leg.size() / 2) < leg.size() / 4;
        leg[f] = first && low, support[f] = first && !low, other[f] = !first;
    }
    AnnotationSet set;
    set.annotations = {region(0, "leg", leg), region(1, "support", support), region(2, "other", other)};
    for (const double noise : {0.0, 0.001, 0.005}) {
        Mesh noisy = mesh;
        add_noise(noisy, noise);
        RelationMeter meter({noisy, set});
        const RelationCheck good = meter.measure(stated("co-axiality", {0, 1}));
        EXPECT_EQ(good.verdict, Verdict::holds) << noise << words(good);
        EXPECT_LT(*good.parameters.deviations[0].value, 0.1 + 400 * noise);
        const RelationCheck bad = meter.measure(stated("co-axiality", {0, 2}));
        EXPECT_EQ(bad.verdict, Verdict::fails) << noise << words(bad);
        EXPECT_NEAR(*bad.parameters.deviations[0].value, 0.18 * 180 / M_PI, 0.3 + 400 * noise);
        EXPECT_EQ(meter.measure(stated("parallel axes", {0, 1})).verdict, Verdict::holds);
        EXPECT_EQ(meter.measure(stated("perpendicular axes", {0, 1})).verdict, Verdict::fails);
        // The relationship's own tolerance decides.
        Relationship loose = stated("parallel axes", {0, 2});
        loose.parameters.deviations = {{"angle", {}, 20.0, "degree"}};
        EXPECT_EQ(meter.measure(loose).verdict, Verdict::holds);
    }
}

TEST(GeometricRelations, PointsAndPlanes) {
    const Mesh mesh = build_mesh(box(8));
    AnnotationSet set;
    std::vector<bool> top(mesh.number_of_faces(), false), low = top, side = top;
    std::vector<Index> edge, bent;
    for (const Face f : mesh.faces()) {
        const Vector n = area_vector(mesh, f);
        top[f] = n.z() > 0.9 * std::sqrt(n.squared_length());
        low[f] = n.z() < -0.9 * std::sqrt(n.squared_length());
        side[f] = n.x() > 0.9 * std::sqrt(n.squared_length());
    }
    for (const Vertex v : mesh.vertices()) {
        const Point& p = mesh.point(v);
        if (p.x() == 0 && p.y() == 0) edge.push_back(v.idx()), bent.push_back(v.idx());
        if (p.x() == 1 && p.y() == 1 && p.z() == 1) bent.push_back(v.idx());
    }
    set.annotations = {region(0, "top", top), region(1, "low", low), region(2, "side", side)};
    for (const auto& points : {edge, bent}) {
        Annotation a;
        a.id = static_cast<int>(set.annotations.size()), a.tag = "points", a.type = AnnotationType::point, a.points = points;
        set.annotations.push_back(a);
    }
    RelationMeter meter({mesh, set});
    EXPECT_EQ(meter.measure(stated("co-linearity", {3})).verdict, Verdict::holds);
    EXPECT_EQ(meter.measure(stated("co-linearity", {4})).verdict, Verdict::fails);
    EXPECT_EQ(meter.measure(stated("co-linearity", {0})).verdict, Verdict::unknown);
    EXPECT_EQ(meter.measure(stated("co-planarity", {0})).verdict, Verdict::holds);
    EXPECT_EQ(meter.measure(stated("co-planarity", {0, 1})).verdict, Verdict::fails);
    EXPECT_NEAR(*meter.measure(stated("co-planarity", {0, 1})).parameters.deviations[0].value, std::sqrt(1.0 / 12), 0.005);
    const RelationCheck mirrored = meter.measure(stated("mirror symmetry", {0, 1}));
    EXPECT_EQ(mirrored.verdict, Verdict::holds) << words(mirrored);
    EXPECT_NEAR(mirrored.parameters.plane->point[2], 0.5, 1e-9);
    EXPECT_NEAR(std::abs(mirrored.parameters.plane->direction[2]), 1, 1e-9);
    EXPECT_LT(*mirrored.parameters.deviations[0].value, 1e-9);
    // The upward direction is unknown until it is given.
    EXPECT_EQ(meter.measure(stated("same level", {0, 1})).verdict, Verdict::unknown);
    Relationship level = stated("same level", {0, 1});
    level.parameters.up = std::array<double, 3>{0, 0, 1};
    EXPECT_NEAR(*meter.measure(level).parameters.deviations[0].value, 1, 1e-12);
    level.parameters.up = std::array<double, 3>{0, 1, 0};
    EXPECT_EQ(meter.measure(level).verdict, Verdict::holds);
    EXPECT_EQ(meter.measure(stated("parallel axes", {0, 1})).verdict, Verdict::unknown) << "a square has no axis";
    EXPECT_EQ(meter.measure(stated("equal attributes", {0, 1}, "area")).verdict, Verdict::unknown)
        << "there is no such attribute";
    RelationOptions wrong;
    wrong.angle = -1;
    EXPECT_THROW(RelationMeter({mesh, set}, wrong), Error);
}

TEST(GeometricRelations, OmittedRelationsAreReported) {
    const SyntheticMesh object = make_mesh(synthetic_object("teapot"), {.vertices = 4000});
    AnnotationSet set;
    const auto faces = static_cast<Index>(object.mesh.number_of_faces());
    for (int i = 0; i < 500; ++i) {
        Annotation annotation;
        annotation.id = i, annotation.tag = "r" + std::to_string(i);
        for (Index f = static_cast<Index>(i % 2); f < faces; f += 2) annotation.faces.push_back(f);
        set.annotations.push_back(annotation);
    }
    const ExtractedRelations extracted = extract_relations({object.mesh, set}, {}, {"adjacency", "containment", "side contact"});
    EXPECT_LE(extracted.graph.relationships.size(), 60000U);
    ASSERT_FALSE(extracted.notes.empty());
    EXPECT_NE(extracted.notes.front().find("are reported"), std::string::npos) << extracted.notes.front();
    for (const auto& check : check_relations({object.mesh, set}, extracted.graph)) EXPECT_EQ(check.verdict, Verdict::holds);
}

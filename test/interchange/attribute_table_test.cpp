// Attributes as a table: round trip, edited, damaged; no cell is a formula.
#include "interchange/attribute_table.h"
#include "mutate.h"
#include "ostraka/core/error.h"
#include "sets.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::example;

namespace {

std::string message(const std::string& table, const AnnotationSet& original) {
    AnnotationSet set = copy_of(original);
    try {
        apply_attribute_table(table, set, "table");
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

}  // namespace

TEST(AttributeTable, RoundTripKeepsEverything) {
    const Mesh mesh = spheres(3);
    const AnnotationSet set = wild_set(mesh);
    const std::string table = attribute_table(set);
    EXPECT_TRUE(is_attribute_table(table));
    // Onto a set without the attributes of the table.
    AnnotationSet bare = copy_of(set);
    for (Annotation& annotation : bare.annotations) {
        annotation.attributes.clear();
        annotation.tag = "lost";
        annotation.colour = {1, 2, 3};
    }
    EXPECT_EQ(apply_attribute_table(table, bare, "t"), set.annotations.size());
    EXPECT_EQ(as_file(bare, mesh), as_file(set, mesh));
}

TEST(AttributeTable, NoCellIsAFormula) {
    const std::string table = attribute_table(wild_set(spheres(3)));
    for (const std::string start : {",=", ",\"=", ",@", ",\"@", ",+", ",\"+", ",\"\t", ",\"\n", ",-2+"})
        EXPECT_EQ(occurrences(table, start), 0U) << start;
}

TEST(AttributeTable, EditsAreApplied) {
    const Mesh mesh = spheres(3);
    AnnotationSet set = wild_set(mesh);
    const std::string edited =
        "annotation;tag;attribute;name;kind;value;unit;note\r\n3;better;0;height;descriptor;12.5;mm;\r\n3;better;1;age;semantic;;"
        ";"
        "\"old; very\"\r\n";
    EXPECT_EQ(apply_attribute_table(edited, set, "t"), 1U);
    const Annotation* annotation = set.find(3);
    ASSERT_EQ(annotation->attributes.size(), 2U);
    EXPECT_EQ(annotation->tag, "better");
    EXPECT_EQ(annotation->attributes[0].descriptor()->values, std::vector<double>{12.5});
    EXPECT_EQ(annotation->attributes[1].note()->text, "old; very");
}

TEST(AttributeTable, RefusalsNameLineAndColumn) {
    const AnnotationSet set = wild_set(spheres(3));
    const std::string header = "annotation,tag,type,colour,attribute,name,kind,value,points,direction,stale\n";
    EXPECT_NE(message("", set), "");
    EXPECT_NE(message("a,b\n", set).find("line 1"), std::string::npos);
    EXPECT_NE(message(header + "99,t,,,0,n,semantic\n", set).find("no annotation 99"), std::string::npos);
    EXPECT_NE(message(header + "3,t,region,,0,n,semantic\n", set).find("'type'"), std::string::npos);
    EXPECT_NE(message(header + "3,t,,1 2 300,0,n,semantic\n", set).find("'colour'"), std::string::npos);
    EXPECT_NE(message(header + "3,t,,,0,n,other\n", set).find("'kind'"), std::string::npos);
    EXPECT_NE(message(header + "3,t,,,0,n,descriptor,\"1,5\"\n", set).find("line 2: column 'value'"), std::string::npos)
        << message(header + "3,t,,,0,n,descriptor,\"1,5\"\n", set);
    EXPECT_NE(message(header + "3,t,,,0,n,measure,1,1 -2\n", set).find("'points'"), std::string::npos);
    EXPECT_NE(message(header + "3,t,,,0,n,measure,1,1 2,1 2\n", set).find("'direction'"), std::string::npos);
    EXPECT_NE(message(header + "3,t,,,0,n,semantic,,,,maybe\n", set).find("'stale'"), std::string::npos);
    EXPECT_NE(message(header + "3,t,,,0,n,semantic\n3,u,,,1,n,semantic\n", set).find("earlier row"), std::string::npos);
    EXPECT_NE(message(header + "3,t,,,0,n,semantic\n3,t,,,0,m,semantic\n", set).find("twice"), std::string::npos);
}

TEST(AttributeTable, DamagedTablesAreRefusedWithAMessage) {
    const Mesh mesh = spheres(3);
    const AnnotationSet set = wild_set(mesh);
    const std::string table = attribute_table(set);
    std::size_t successes = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        try {
            AnnotationSet copy = copy_of(set);
            apply_attribute_table(test::mutate(table, seed), copy, "t");
            check_annotations({mesh, copy}, "t");
            ++successes;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
        }
    }
    EXPECT_LT(successes, 200U);
}

// Drawings of graphs: no brackets overlap, and the tree is that of the containment.
#include "ostraka/relation/layout.h"
#include "ostraka/core/error.h"
#include "ostraka/figures/bracket_graph.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <random>

using namespace ostraka;

namespace {

AnnotationSet set_of(std::size_t count) {
    AnnotationSet set;
    for (std::size_t i = 0; i < count; ++i) {
        Annotation& annotation = set.annotations.emplace_back();
        annotation.id = static_cast<int>(10 * i);
        annotation.tag = "part " + std::to_string(i);
    }
    return set;
}

ContainmentOrder chain_of(std::size_t count) {
    ContainmentOrder order;
    order.containers.resize(count), order.direct.resize(count);
    for (std::size_t i = 0; i < count; ++i) order.parent.push_back(i == 0 ? std::nullopt : std::optional((i - 1) / 3));
    return order;
}

}  // namespace

TEST(Layout, BracketsThatShareRowsLieInDifferentLanes) {
    const std::size_t n = 30;
    const AnnotationSet set = set_of(n);
    RelationGraph graph;
    std::mt19937 random(4);
    for (int i = 0; i < 80; ++i) {
        Relationship& relationship = graph.relationships.emplace_back();
        relationship.id = i;
        relationship.type = i % 9 == 0 ? "containment" : "adjacency";
        for (int k = 0; k < 2 + i % 3; ++k) relationship.annotations.push_back(static_cast<int>(10 * (random() % n)));
    }
    graph.relationships.emplace_back().annotations = {12345};  // of missing annotations
    const GraphLayout layout = layout_of(graph, set, chain_of(n));
    ASSERT_EQ(layout.rows.size(), n);
    std::map<int, std::size_t> row_of;
    for (std::size_t r = 0; r < n; ++r) row_of[set.annotations[layout.rows[r].annotation].id] = r;
    EXPECT_EQ(row_of.size(), n) << "each once";
    std::set<std::pair<int, std::size_t>> occupied;
    for (std::size_t i = 0; i < graph.relationships.size(); ++i) {
        const Relationship& relationship = graph.relationships[i];
        EXPECT_EQ(layout.lanes[i].has_value(), relationship.type == "adjacency");
        if (!layout.lanes[i]) continue;
        std::size_t low = n, high = 0;
        for (const int id : relationship.annotations) low = std::min(low, row_of[id]), high = std::max(high, row_of[id]);
        for (std::size_t r = low; r <= high; ++r) EXPECT_TRUE(occupied.emplace(*layout.lanes[i], r).second) << i << " on another";
    }
}

TEST(BracketGraph, IsWrittenInThreeFormatsOnly) {
    const test::Scratch scratch;
    BracketGraph graph;
    graph.title = "a pot";
    write_plot(scratch / "empty.svg", graph);
    graph.rows = {{"pot", 0, {1, 2, 3}}, {"body", 1, {1, 2, 3}}, {"</svg><script>", 1, {200, 2, 3}}};
    graph.brackets = {{"adjacency", {1, 2}, 0, true, true}};
    for (const char* name : {"a.svg", "a.pdf", "a.png"}) {
        write_plot(scratch / name, graph);
        write_plot(scratch / ("again-" + std::string(name)), graph);
        EXPECT_EQ(read_file(scratch / name), read_file(scratch / ("again-" + std::string(name))));
    }
    EXPECT_EQ(read_file(scratch / "a.svg").find("<script"), std::string::npos);
    EXPECT_THROW(write_plot(scratch / "a.gif", graph), Error);
}

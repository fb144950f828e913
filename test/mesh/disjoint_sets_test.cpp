#include "ostraka/mesh/disjoint_sets.h"

#include <gtest/gtest.h>

#include <random>

namespace ostraka {
namespace {

TEST(DisjointSets, EachElementIsItsOwnSetInitially) {
    EXPECT_EQ(DisjointSets(0).size(), 0U);
    DisjointSets sets(3);
    for (Index i = 0; i < 3; ++i) EXPECT_EQ(sets.find(i), i);
}

TEST(DisjointSets, TheRootIsTheSmallestMemberWhateverTheOrder) {
    std::vector<std::pair<Index, Index>> joined{{7, 3}, {3, 9}, {4, 5}, {5, 1}, {9, 7}, {8, 8}};
    std::mt19937 random(1);
    for (int round = 0; round < 20; ++round) {
        DisjointSets sets(10);
        int united = 0;
        for (const auto& [a, b] : joined) united += sets.unite(a, b);
        EXPECT_EQ(united, 4) << "of six pairs one closes a ring and one is an element with itself";
        std::vector<Index> roots;
        for (Index i = 0; i < 10; ++i) roots.push_back(sets.find(i));
        EXPECT_EQ(roots, (std::vector<Index>{0, 1, 2, 3, 1, 1, 6, 3, 8, 3}));
        std::shuffle(joined.begin(), joined.end(), random);
    }
}

TEST(DisjointSets, TheTargetRootStays) {
    DisjointSets sets(6);
    sets.unite_into(5, 2);
    sets.unite_into(2, 0);
    for (const Index i : {0U, 2U, 5U}) EXPECT_EQ(sets.find(i), 5U);
    sets.unite_into(0, 5);
    EXPECT_EQ(sets.find(0), 5U) << "one set already";
    sets.unite_into(3, 0);
    for (const Index i : {0U, 2U, 3U, 5U}) EXPECT_EQ(sets.find(i), 3U);
    EXPECT_EQ(sets.find(4), 4U);
}

TEST(DisjointSets, AgreesWithRelabelling) {
    std::mt19937 random(2);
    for (int round = 0; round < 30; ++round) {
        const std::size_t n = 1 + random() % 40;
        DisjointSets sets(n);
        std::vector<std::size_t> label(n);
        std::iota(label.begin(), label.end(), std::size_t{0});
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t a = random() % n, b = random() % n, target = label[a], source = label[b];
            sets.unite_into(a, b);
            std::replace(label.begin(), label.end(), source, target);
        }
        for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(sets.find(i), label[i]);
    }
}

}  // namespace
}  // namespace ostraka

// Diff and merge: laws over synthetic sets, each kind of conflict.
#include "ostraka/interchange/difference.h"
#include "ostraka/core/error.h"
#include "sets.h"

#include <gtest/gtest.h>

#include <random>

using namespace ostraka;
using namespace ostraka::example;

namespace {

/// A few random edits of a set, as a user might make.
AnnotationSet edited(const AnnotationSet& set, const Mesh& mesh, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    AnnotationSet copy = copy_of(set);
    for (int step = 0; step < 6; ++step) {
        const std::size_t index = random() % copy.annotations.size();
        Annotation& annotation = copy.annotations[index];
        switch (random() % 10) {
            case 0:
                annotation.tag += "!";
                break;
            case 1:
                annotation.colour[random() % 3] = static_cast<int>(random() % 256);
                break;
            case 2:
                if (!annotation.attributes.empty()) annotation.attributes.erase(annotation.attributes.begin());
                break;
            case 3:
                annotation.attributes.push_back(
                    semantic(100 + static_cast<int>(random() % 3), "new", std::to_string(random() % 2)));
                if (annotation.attributes.size() > 1 && annotation.attributes[annotation.attributes.size() - 2].id >= 100)
                    annotation.attributes.pop_back();
                break;
            case 4:
                if (!annotation.faces.empty() && !annotation.all) annotation.faces.erase(annotation.faces.begin());
                break;
            case 5:
                copy.annotations.erase(copy.annotations.begin() + static_cast<std::ptrdiff_t>(index));
                break;
            case 6: {
                Annotation added;
                added.id = free_id(copy);
                added.tag = "fresh " + std::to_string(random() % 2);
                added.type = AnnotationType::point;
                added.points = {static_cast<Index>(random() % mesh.number_of_vertices())};
                copy.annotations.insert(copy.annotations.begin() + static_cast<std::ptrdiff_t>(index), added);
                break;
            }
            case 8:
                for (Attribute& attribute : annotation.attributes) {  // other possible differences, one at a time
                    if (Note* note = attribute.note()) {
                        note->origin += "rule";
                    } else if (attribute.measure() != nullptr) {
                        Measure& measure = *attribute.measure();
                        const auto field = random() % 3;
                        if (field == 0) measure.uncertainty = measure.uncertainty.value_or(0) + 0.5;
                        if (field == 1 && measure.tool == "tape") measure.exact = !measure.exact;
                        if (field == 2) measure.repeats.push_back(measure.points);
                    }
                }
                break;
            case 7:
                std::swap(copy.annotations[index], copy.annotations[random() % copy.annotations.size()]);
                break;
            default:
                copy.unit = random() % 2 == 0 ? "cm" : "m";
                break;
        }
    }
    return copy;
}

std::vector<std::string> conflict_fields(const MergedAnnotations& merged) {
    std::vector<std::string> fields;
    for (const Conflict& conflict : merged.conflicts)
        fields.push_back((conflict.id ? std::to_string(*conflict.id) + " " : "") + conflict.field);
    return fields;
}

}  // namespace

TEST(Difference, OfASetToItselfIsEmpty) {
    const Mesh mesh = spheres(3);
    const AnnotationSet set = wild_set(mesh);
    EXPECT_TRUE(differences(set, copy_of(set)).empty());
    EXPECT_TRUE(differences({}, {}).empty());
}

TEST(Difference, IsEmptyExactlyIfFilesAgreeAndIsAntisymmetric) {
    const Mesh mesh = spheres(3);
    const AnnotationSet set = wild_set(mesh);
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const AnnotationSet a = edited(set, mesh, seed), b = edited(a, mesh, seed + 1000);
        const auto forward = differences(a, b), backward = differences(b, a);
        EXPECT_EQ(forward.empty(), as_file(a, mesh) == as_file(b, mesh));
        ASSERT_EQ(forward.size(), backward.size());
        for (std::size_t i = 0; i < forward.size(); ++i) {
            EXPECT_EQ(forward[i].id, backward[i].id);
            EXPECT_EQ(forward[i].field, backward[i].field);
            EXPECT_EQ(forward[i].before, backward[i].after);
            EXPECT_EQ(forward[i].after, backward[i].before);
            EXPECT_EQ(forward[i].only_before, backward[i].only_after);
            EXPECT_EQ(forward[i].only_after, backward[i].only_before);
            EXPECT_EQ(forward[i].kind == Difference::Kind::added, backward[i].kind == Difference::Kind::removed);
        }
    }
}

TEST(Merge, TakesUncertaintiesAndRepeatsOfOneSide) {
    const Mesh mesh = spheres(3);
    const AnnotationSet base = wild_set(mesh);
    AnnotationSet changed = copy_of(base);
    for (Annotation& annotation : changed.annotations)
        for (Attribute& attribute : annotation.attributes)
            if (attribute.measure() != nullptr)
                attribute.measure()->uncertainty = 3, attribute.measure()->repeats.push_back(attribute.measure()->points);
    AnnotationSet their_set = copy_of(base);
    their_set.annotations.back().tag = "another";
    for (const bool swapped : {false, true}) {
        const MergedAnnotations merged =
            swapped ? merge_annotations(base, their_set, changed) : merge_annotations(base, changed, their_set);
        EXPECT_TRUE(merged.conflicts.empty());
        EXPECT_EQ(merged.set.annotations.back().tag, "another");
        changed.annotations.back().tag = "another";
        EXPECT_TRUE(differences(merged.set, changed).empty());
        changed.annotations.back().tag = base.annotations.back().tag;
    }
}

TEST(Difference, CountsChangedElements) {
    AnnotationSet a, b;
    Annotation region;
    region.id = 4;
    region.faces = {1, 2, 3, 4};
    a.annotations = {region};
    region.faces = {3, 4, 5};
    region.tag = "new";
    b.annotations = {region};
    const auto found_differences = differences(a, b);
    ASSERT_EQ(found_differences.size(), 2U);
    EXPECT_EQ(found_differences[0].field, "tag");
    EXPECT_EQ(found_differences[1].field, "geometry");
    EXPECT_EQ(found_differences[1].only_before, 2U);
    EXPECT_EQ(found_differences[1].only_after, 1U);
}

TEST(Merge, OneSidedChangesAreApplied) {
    const Mesh mesh = spheres(3);
    const AnnotationSet base = wild_set(mesh);
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const AnnotationSet a = edited(base, mesh, seed);
        for (const char* prefer : {"none", "ours", "theirs"}) {
            MergeOptions options;
            set_option(options, "prefer", prefer);
            const MergedAnnotations ours = merge_annotations(base, a, base, options),
                                    theirs = merge_annotations(base, base, a, options),
                                    both = merge_annotations(base, a, a, options);
            EXPECT_TRUE(ours.conflicts.empty() && theirs.conflicts.empty() && both.conflicts.empty());
            EXPECT_EQ(as_file(ours.set, mesh), as_file(a, mesh)) << seed;
            EXPECT_EQ(as_file(theirs.set, mesh), as_file(a, mesh)) << seed;
            EXPECT_EQ(as_file(both.set, mesh), as_file(a, mesh)) << seed;
        }
    }
}

TEST(Merge, ConflictsAreTheSameFromBothSides) {
    const Mesh mesh = spheres(3);
    const AnnotationSet base = wild_set(mesh);
    std::size_t with_conflicts = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const AnnotationSet a = edited(base, mesh, seed), b = edited(base, mesh, seed + 500);
        auto forward = conflict_fields(merge_annotations(base, a, b)), backward = conflict_fields(merge_annotations(base, b, a));
        std::sort(forward.begin(), forward.end());
        std::sort(backward.begin(), backward.end());
        EXPECT_EQ(forward, backward);
        with_conflicts += forward.empty() ? 0 : 1;
        // A preferred side of a merge without conflicts changes nothing.
        MergeOptions ours;
        ours.prefer = MergeOptions::Side::ours;
        if (forward.empty()) {
            EXPECT_EQ(as_file(merge_annotations(base, a, b, ours).set, mesh), as_file(merge_annotations(base, a, b).set, mesh));
        }
        EXPECT_NO_THROW(check_annotations({mesh, merge_annotations(base, a, b, ours).set}, "merged"));
    }
    EXPECT_GT(with_conflicts, 5U);
}

TEST(Merge, NamesEachKindOfConflict) {
    const Mesh mesh = spheres(3);
    const AnnotationSet base = wild_set(mesh);
    const auto find = [&](AnnotationSet& set, const std::string& tag) -> Annotation& {
        return *std::find_if(set.annotations.begin(), set.annotations.end(), [&](const Annotation& a) { return a.tag == tag; });
    };

    AnnotationSet ours = copy_of(base), theirs = copy_of(base);
    Annotation& a = find(ours, "cap & more");
    Annotation& b = find(theirs, "cap & more");
    a.tag = "crown";
    b.tag = "lid";
    a.colour = {1, 1, 1};  // one side only
    a.attributes[0].measure()->value = 1;
    b.attributes[0].measure()->value = 2;
    a.faces.pop_back();
    b.faces.erase(b.faces.begin());
    find(ours, "two patches").tag = "changed";
    theirs.annotations.erase(std::find_if(theirs.annotations.begin(), theirs.annotations.end(),
                                          [](const Annotation& x) { return x.tag == "two patches"; }));
    Annotation added;
    added.id = 900;
    added.type = AnnotationType::point;
    added.points = {1};
    added.tag = "mine";
    ours.annotations.push_back(added);
    added.tag = "yours";
    theirs.annotations.push_back(added);
    const MergedAnnotations merged = merge_annotations(base, ours, theirs);
    const std::string id = std::to_string(find(ours, "crown").id), removed_id = std::to_string(find(ours, "changed").id);
    EXPECT_EQ(conflict_fields(merged),
              (std::vector<std::string>{id + " tag", id + " geometry", id + " attribute 4",
                                        removed_id + " removed by one, changed by the other", "900 both added"}));
    EXPECT_FALSE(merged.is_resolved({}));
    MergeOptions options;
    options.prefer = MergeOptions::Side::theirs;
    const MergedAnnotations settled = merge_annotations(base, ours, theirs, options);
    EXPECT_TRUE(settled.is_resolved(options));
    const Annotation* lid = settled.set.find(find(ours, "crown").id);
    EXPECT_EQ(lid->tag, "lid");
    EXPECT_EQ(lid->colour, (std::array<int, 3>{1, 1, 1})) << "what one side alone changed is kept";
    EXPECT_EQ(settled.set.find(std::stoi(removed_id)), nullptr);
    EXPECT_EQ(settled.set.find(900)->tag, "yours");
    // Merged face by face, with both new annotations.
    options = {};
    options.merge_faces = true;
    options.renumber = true;
    const MergedAnnotations both = merge_annotations(base, ours, theirs, options);
    EXPECT_EQ(both.conflicts.size(), 3U);
    EXPECT_EQ(both.set.find(lid->id)->faces.size() + 2, base.find(lid->id)->faces.size());
    EXPECT_EQ(both.set.annotations.size(), ours.annotations.size() + 1);
    EXPECT_EQ(both.notes.size(), 2U);
}

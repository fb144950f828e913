#include "ostraka/collection/moulds.h"

#include "meshes.h"
#include "scratch.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/npy.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/stats/scores.h"
#include "ostraka/synthetic/head_casts.h"

namespace ostraka {
namespace {

using test::Scratch;

/// Distances of objects in groups of these sizes: 0.3 within, 0.8 between, minus small variations.
Eigen::MatrixXd blocks(const std::vector<int>& sizes, double within = 0.3, double between = 0.8) {
    std::vector<int> group;
    for (std::size_t g = 0; g < sizes.size(); ++g)
        group.insert(group.end(), static_cast<std::size_t>(sizes[g]), static_cast<int>(g));
    const auto n = static_cast<Eigen::Index>(group.size());
    Eigen::MatrixXd d = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < i; ++j) {
            const bool same = group[static_cast<std::size_t>(i)] == group[static_cast<std::size_t>(j)];
            d(i, j) = d(j, i) = (same ? within : between) - 0.05 * static_cast<double>((i * 7 + j * 3) % 5) / 5;
        }
    return d;
}

std::vector<int> labels_of(const std::vector<int>& sizes) {
    std::vector<int> labels;
    for (std::size_t g = 0; g < sizes.size(); ++g)
        labels.insert(labels.end(), static_cast<std::size_t>(sizes[g]), static_cast<int>(g));
    return labels;
}

TEST(MouldGroups, EveryMethodFindsDistinctGroups) {
    const std::vector<int> sizes{7, 5, 4};
    for (const char* method : {"linkage", "dbscan", "embedding"}) {
        GroupOptions options;
        set_option(options, "method", method);
        const MouldGroups groups = group_heads(blocks(sizes), options);
        EXPECT_EQ(groups.labels, labels_of(sizes)) << method;
        EXPECT_TRUE(groups.clear);
        EXPECT_GT(groups.epsilon, 0);
    }
}

TEST(MouldGroups, AGivenEpsilonIsUsedUnchanged) {
    GroupOptions options;
    options.epsilon = "0.1";
    EXPECT_EQ(adjusted_rand_index(group_heads(blocks({3, 3}), options).labels, {0, 1, 2, 3, 4, 5}), 1);
    options.epsilon = "0.5";
    EXPECT_EQ(group_heads(blocks({3, 3}), options).labels, labels_of({3, 3}));
    options.epsilon = "0.99";
    EXPECT_EQ(group_heads(blocks({3, 3}), options).labels, std::vector<int>(6, 0));
    for (const char* wrong : {"-1", "nan", "0.1x", "much", ""}) {
        options.epsilon = wrong;
        EXPECT_THROW((void)group_heads(blocks({3, 3}), options), Error) << wrong;
    }
}

TEST(MouldGroups, GroupsWithinGroupsAreFound) {
    // Two similar moulds and a third that differs from both.
    Eigen::MatrixXd d = blocks({6, 6, 6}, 0.3, 0.95);
    for (Eigen::Index i = 0; i < 6; ++i)
        for (Eigen::Index j = 6; j < 12; ++j) d(i, j) = d(j, i) = 0.5 + 0.01 * static_cast<double>((i + j) % 3);
    GroupOptions options;
    options.epsilon = "silhouette";
    EXPECT_EQ(group_heads(d, options).labels, labels_of({12, 6}));
    options.epsilon = "nested";
    EXPECT_EQ(group_heads(d, options).labels, labels_of({6, 6, 6}));
}

TEST(MouldGroups, WithoutDistinctGroupsThereIsOneGroup) {
    for (const std::vector<int>& sizes : {std::vector<int>{9}, std::vector<int>{1, 1, 1, 1, 1, 1}}) {
        const MouldGroups groups = group_heads(blocks(sizes));
        EXPECT_FALSE(groups.clear);
        EXPECT_EQ(groups.labels, std::vector<int>(groups.labels.size(), 0));
    }
    EXPECT_EQ(group_heads(Eigen::MatrixXd::Zero(1, 1)).labels, std::vector<int>{0});
    EXPECT_EQ(group_heads(Eigen::MatrixXd::Zero(5, 5)).labels, std::vector<int>(5, 0));
    EXPECT_THROW((void)group_heads(Eigen::MatrixXd()), Error);
    Eigen::MatrixXd skew = blocks({2, 2});
    skew(0, 1) = 0.9;
    EXPECT_THROW((void)group_heads(skew), Error);
}

TEST(MouldGroups, StabilityDistinguishesFirmFromLooseGroups) {
    const Eigen::MatrixXd firm = blocks({8, 8});
    for (const auto& group : group_stability(firm, group_heads(firm), {})) EXPECT_GT(group.jaccard, 0.99);
    GroupOptions options;
    options.epsilon = "0.27";  // in the midst of the distances within
    const Eigen::MatrixXd loose = blocks({16});
    const MouldGroups groups = group_heads(loose, options);
    double minimum = 1;
    for (const auto& group : group_stability(loose, groups, options)) minimum = std::min(minimum, group.jaccard);
    EXPECT_LT(minimum, 0.9);
}

TEST(MouldDistances, AreFractionsOfTheSelfSimilarity) {
    MouldMatrices m;
    m.matches.resize(2, 2);
    m.matches << 100, 30, 20, 50;
    m.consistent = m.matches;
    m.registration.resize(2, 2);
    m.registration << 0, 0.01, 0.01, 0;
    // The mean of 1 - 30/100 and 1 - 20/50.
    EXPECT_DOUBLE_EQ(mould_distances(m, "matches")(0, 1), 0.65);
    EXPECT_DOUBLE_EQ(mould_distances(m, "matches")(1, 0), 0.65);
    EXPECT_DOUBLE_EQ(mould_distances(m, "registration")(0, 1), 0.5);
    EXPECT_DOUBLE_EQ(mould_distances(m, "combined")(0, 1), 0.575);
    EXPECT_DOUBLE_EQ(mould_distances(m, "matches")(0, 0), 0);
    EXPECT_THROW((void)mould_distances(m, "taste"), Error);
}

TEST(MouldDistances, RelativeSizesAreMeansOverTheGroup) {
    MouldMatrices m;
    const std::vector<double> sizes{1, 0.9, 0.81, 5};
    m.scale.resize(4, 4);
    for (Eigen::Index i = 0; i < 4; ++i)
        for (Eigen::Index j = 0; j < 4; ++j)
            m.scale(i, j) = sizes[static_cast<std::size_t>(j)] / sizes[static_cast<std::size_t>(i)];
    const std::vector<double> mould_sizes = relative_sizes(m, {0, 0, 0, 1});
    EXPECT_NEAR(mould_sizes[0], 1 / 0.9, 1e-12);
    EXPECT_NEAR(mould_sizes[1], 1, 1e-12);
    EXPECT_NEAR(mould_sizes[2], 0.9, 1e-12);
    EXPECT_NEAR(mould_sizes[3], 1, 1e-12);
}

/// Nine heads of three moulds, worn and pressed, as PLY files; their moulds.
std::map<std::string, std::string> write_heads(const Path& folder) {
    MouldPopulationOptions population;
    population.objects = 9, population.moulds = 3, population.seed = 4;
    CastOptions cast;
    cast.vertices = 4500, cast.wear = 0.01, cast.pressure = 0.01, cast.noise = 0.001;
    std::map<std::string, std::string> moulds;
    std::filesystem::create_directories(folder);
    for (const auto& head : plan_heads(population, cast)) {
        const HeadCast head_cast = cast_head(head.shape, head.cast);
        MeshExtras extras;
        extras.face_labels = head_cast.face_labels;
        write_mesh(folder / (head.name + ".ply"), head_cast.mesh, extras);
        moulds[head.name] = head.mould;
    }
    return moulds;
}

class MouldStudy : public testing::Test {
protected:
    static void SetUpTestSuite() {
        scratch = new Scratch();
        moulds = write_heads(*scratch / "heads");
    }
    static void TearDownTestSuite() { delete scratch; }
    static MouldMatrices compare(const PreparedCollection& prepared, const ResultStore& store = ResultStore()) {
        return compare_heads(prepared.names, prepared.heads, prepared.options, store, prepared.checksums);
    }
    static Scratch* scratch;
    static std::map<std::string, std::string> moulds;
};
Scratch* MouldStudy::scratch = nullptr;
std::map<std::string, std::string> MouldStudy::moulds;

TEST_F(MouldStudy, FindsTheMouldsOfWornCasts) {
    const auto prepared = prepare_collection(read_collection(*scratch / "heads"), {}, {9}, ResultStore());
    ASSERT_EQ(prepared.heads.size(), 9U);
    const MouldMatrices matrices = compare(prepared);
    std::map<std::string, int> numbers;
    std::vector<int> truth;
    for (const auto& name : prepared.names)
        truth.push_back(numbers.try_emplace(moulds.at(name), static_cast<int>(numbers.size())).first->second);
    for (const auto& similarity : {"consistent", "combined"}) {
        const MouldGroups groups = group_heads(mould_distances(matrices, similarity));
        EXPECT_EQ(adjusted_rand_index(groups.labels, truth), 1) << similarity;
        EXPECT_TRUE(groups.clear) << similarity;
    }
    // Every head is at least as similar to itself as to any other.
    for (Eigen::Index i = 0; i < 9; ++i) EXPECT_EQ(matrices.consistent.row(i).maxCoeff(), matrices.consistent(i, i));
}

TEST_F(MouldStudy, GivesTheSameForAnyNumberOfThreadsAndAfterAnInterruption) {
    const Collection collection = read_collection(*scratch / "heads");
    Collection some = collection;
    some.objects.resize(5);
    CompareOptions options;
    options.features.size = 66;
    set_threads(1);
    const auto complete = prepare_collection(collection, options, {}, ResultStore());
    const MouldMatrices expected = compare(complete);
    set_threads(2);
    const ResultStore features(*scratch / "features"), pairs(*scratch / "pairs");
    // As after an interrupted run: five heads are done.
    (void)compare(prepare_collection(some, options, {}, features), pairs);
    const auto resumed = prepare_collection(collection, options, {}, features);
    EXPECT_EQ(std::count_if(resumed.results.begin(), resumed.results.end(), [](const auto& r) { return r.resumed; }), 5);
    for (int round = 0; round < 2; ++round) {
        const MouldMatrices resumed_matrices = compare(resumed, pairs);
        EXPECT_TRUE(resumed_matrices.matches == expected.matches);
        EXPECT_TRUE(resumed_matrices.consistent == expected.consistent);
        EXPECT_TRUE(resumed_matrices.registration == expected.registration);
        EXPECT_TRUE(resumed_matrices.scale == expected.scale);
    }
    set_threads(0);
}

/// Time of writing of each file in a folder and its subfolders.
std::map<std::string, std::filesystem::file_time_type> times(const Path& folder) {
    std::map<std::string, std::filesystem::file_time_type> result;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) result[entry.path().string()] = entry.last_write_time();
    return result;
}

TEST_F(MouldStudy, ASecondRunReadsAllResultsFromTheStore) {
    Collection collection = read_collection(*scratch / "heads");
    collection.objects.resize(4);
    const ResultStore features(*scratch / "again" / "features"), pairs(*scratch / "again" / "pairs");
    // The size is not given: it is measured, and stored as well.
    const MouldMatrices first = compare(prepare_collection(collection, {}, {}, features), pairs);
    const auto times_before = times(*scratch / "again");
    EXPECT_EQ(times_before.size(), 12U) << "sizes, features and pairs of four heads";
    const auto prepared = prepare_collection(collection, {}, {}, features);
    for (const auto& result : prepared.results) EXPECT_TRUE(result.resumed);
    EXPECT_EQ(compare(prepared, pairs).registration, first.registration);
    EXPECT_EQ(times(*scratch / "again"), times_before);
}

TEST_F(MouldStudy, ShardsGiveTheResultOfOneRun) {
    Collection collection = read_collection(*scratch / "heads");
    collection.objects.resize(5);
    const MouldMatrices expected = compare(prepare_collection(collection, {}, {}, ResultStore()), ResultStore());
    const Path folder = *scratch / "shares";
    const auto part = [&](const Share& shard) {
        const auto prepared = prepare_collection(collection, {}, {}, ResultStore(folder / "features", shard));
        if (prepared.waits_for.empty()) (void)compare(prepared, ResultStore(folder / "pairs", shard));
        return prepared.waits_for;
    };
    EXPECT_EQ(part({0, 3}), "sizes");
    EXPECT_EQ(part({0, 3}), "sizes") << "others have not begun";
    EXPECT_EQ(part({1, 3}), "sizes");
    EXPECT_EQ(part({2, 3}), "features") << "all sizes are there";
    EXPECT_EQ(part({0, 3}), "features");
    for (const std::size_t k : {1, 2, 0}) EXPECT_EQ(part({k, 3}), "");
    const auto times_before = times(folder);
    const auto prepared = prepare_collection(collection, {}, {}, ResultStore(folder / "features"));
    const MouldMatrices gathered = compare(prepared, ResultStore(folder / "pairs"));
    EXPECT_EQ(times(folder), times_before) << "nothing is done again";
    EXPECT_EQ(gathered.matches, expected.matches);
    EXPECT_EQ(gathered.registration, expected.registration);
    EXPECT_EQ(gathered.scale, expected.scale);
}

TEST_F(MouldStudy, AnAddedHeadComputesOnlyItsPairs) {
    const Collection collection = read_collection(*scratch / "heads");
    Collection some = collection, more = collection;
    some.objects.resize(4);
    some.objects.erase(some.objects.begin() + 1);
    more.objects.resize(4);
    CompareOptions options;
    options.features.size = 66;
    const ResultStore pairs(*scratch / "planted");
    const auto prepared = prepare_collection(some, options, {}, ResultStore());
    (void)compare(prepared, pairs);
    // Impossible distances are written to the store: pairs with these distances were not compared again.
    for (const auto& name : prepared.names) {
        Json document = read_json(*scratch / "planted" / (name + ".json"));
        for (auto& pair : document["result"].GetObject()) pair.value[4].SetDouble(77);
        pairs.keep(name, document["key"].GetString(), document["result"]);
    }
    const auto with_another = prepare_collection(more, options, {}, ResultStore());
    ASSERT_EQ(with_another.names.size(), 4U);
    const MouldMatrices extended = compare(with_another, pairs);
    for (Eigen::Index i = 0; i < 4; ++i)
        for (Eigen::Index j = 0; j < 4; ++j) {
            if (i == j) continue;
            const bool is_new = i == 1 || j == 1;
            EXPECT_EQ(extended.registration(i, j) == 77, !is_new) << i << " " << j;
        }
}

TEST_F(MouldStudy, HeadsThatCannotBeComparedAreLeftOut) {
    const Path folder = *scratch / "odd";
    std::filesystem::create_directories(folder);
    int count = 0;
    for (const auto& [name, mould] : moulds)
        if (count++ < 3) std::filesystem::copy_file(*scratch / "heads" / (name + ".ply"), folder / (name + ".ply"));
    write_mesh(folder / "ball.ply", build_mesh(test::octahedron_sphere(4)));
    write_file(folder / "broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
    const auto prepared = prepare_collection(read_collection(folder), {}, {}, ResultStore());
    EXPECT_EQ(prepared.heads.size(), 3U);
    ASSERT_EQ(prepared.results.size(), 5U);
    EXPECT_NE(prepared.results[0].problem.find("salient"), std::string::npos) << prepared.results[0].problem;
    EXPECT_NE(prepared.results[0].problem.find("ball.ply"), std::string::npos) << prepared.results[0].problem;
    EXPECT_NE(prepared.results[0].problem.find("another unit"), std::string::npos) << "a ball of radius 1 among heads of 44 mm";
    EXPECT_FALSE(prepared.results[1].problem.empty());
    // Parts can be left out only where faces have labels.
    const auto without = prepare_collection(read_collection(folder), {}, {9}, ResultStore());
    EXPECT_NE(without.results[0].problem.find("labels"), std::string::npos) << without.results[0].problem;
}

TEST_F(MouldStudy, TheCommandWritesAllOutputs) {
    std::string truth = "name,label\n";
    for (const auto& [name, mould] : moulds) truth += name + "," + mould + "\n";
    const Path table = scratch->file("truth.csv", truth), out = *scratch / "out";
    const std::string call = "study moulds " + (*scratch / "heads").string() + " --output " + out.string() + " --truth " +
                             table.string() + " --choices --json";
    const auto result = test::run_command(call);
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    EXPECT_EQ(report["result"]["adjustedRandIndex"].GetDouble(), 1);
    EXPECT_EQ(report["result"]["groups"].Size(), 3U);
    validate(read_json(out / "moulds.json"), "mould-study", "moulds.json");
    for (const char* name : {"matches", "consistent", "registration", "distances"}) {
        EXPECT_EQ(read_npy(out / (std::string(name) + ".npy")).shape, (std::vector<std::size_t>{9, 9})) << name;
        EXPECT_TRUE(std::filesystem::exists(out / (std::string(name) + ".csv"))) << name;
    }
    for (const char* name :
         {"groups.csv", "groups.md", "heads.csv", "choices.csv", "distances.svg", "dendrogram.svg", "embedding-1-2.svg"})
        EXPECT_TRUE(std::filesystem::exists(out / name)) << name;
    const std::string first_output = read_file(out / "moulds.json");
    const auto repeated = test::run_command(call + " --threads 1");
    ASSERT_EQ(repeated.code, 0) << repeated.err;
    EXPECT_EQ(read_file(out / "moulds.json"), first_output);
    EXPECT_EQ(report["result"]["truth"]["labelled"].GetInt(), 9);

    // With answers for a part, or of one kind only, the report gives their number, and a score if there is one.
    const std::string mould = moulds.begin()->second;
    std::string some = "name,label\n", single_mould = some;
    for (const auto& [name, label] : moulds) {
        if (some.size() < 60) some += name + "," + label + "\n";
        if (label == mould) single_mould += name + "," + label + "\n";
    }
    const auto study = [&](const std::string& answers, const std::string& options) {
        return test::run_command("study moulds " + (*scratch / "heads").string() + " --output " + out.string() + " --truth " +
                                 scratch->file("part.csv", answers).string() + options);
    };
    const auto part = study(some, "");
    EXPECT_NE(part.out.find("of 9 objects"), std::string::npos) << part.out;
    EXPECT_FALSE(std::filesystem::exists(out / "choices.csv")) << "of the run before";
    const Json of_one = parse_json(study(single_mould, " --json --plots png").out, "report");
    EXPECT_EQ(of_one["result"]["truth"]["kinds"].GetInt(), 1);
    EXPECT_FALSE(of_one["result"].HasMember("adjustedRandIndex"));
    EXPECT_FALSE(std::filesystem::exists(out / "dendrogram.svg"));
    EXPECT_TRUE(std::filesystem::exists(out / "dendrogram.png"));
    const auto none = study("name,label\nanother,1\n", "");
    EXPECT_EQ(none.code, 1);
    EXPECT_NE(none.err.find("'another'"), std::string::npos) << none.err;
    EXPECT_TRUE(std::filesystem::exists(out / "dendrogram.png")) << "a run that fails replaces nothing";
}

TEST(MouldCommand, ReportsWrongArguments) {
    const Scratch scratch;
    std::filesystem::create_directories(scratch / "heads");
    write_mesh(scratch / "heads" / "ball.ply", build_mesh(test::octahedron_sphere(3)));
    const auto truncated =
        test::run_command("study moulds " + (scratch / "heads").string() + " --output " + (scratch / "out").string());
    EXPECT_EQ(truncated.code, 1);
    EXPECT_NE(truncated.err.find("at least two"), std::string::npos) << truncated.err;
    EXPECT_EQ(test::run_command("study moulds " + (scratch / "heads").string() + " --output " + (scratch / "out").string() +
                                " --similarity taste")
                  .code,
              2);
}

TEST(MouldCommand, MakesAPopulationWithItsTruth) {
    const Scratch scratch;
    const std::string call = "study make moulds " + (scratch / "heads").string() +
                             " --objects 3 --moulds 2 --hand-made 1 --vertices 1800 --beard 1 --seed 3";
    const auto result = test::run_command(call);
    ASSERT_EQ(result.code, 0) << result.err;
    const auto labels = read_labels(scratch / "heads" / "truth.csv");
    EXPECT_EQ(labels.size(), 4U);
    const Collection collection = read_collection(scratch / "heads");
    ASSERT_EQ(collection.objects.size(), 4U);
    for (const auto& object : collection.objects) {
        const MeshFile file = read_mesh(object.mesh);
        EXPECT_EQ(file.extras.face_labels.size(), file.mesh.number_of_faces());
        EXPECT_TRUE(labels.contains(object.name));
    }
    EXPECT_EQ(test::run_command(call + " --wear 5").code, 2);
}

}  // namespace
}  // namespace ostraka

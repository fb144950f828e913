#include "ostraka/collection/objects.h"

#include "meshes.h"
#include "scratch.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/io/mesh_file.h"

#include <atomic>
#include <chrono>

namespace ostraka {
namespace {

using test::Scratch;

Path sphere_file(const Scratch& scratch, const std::string& name, int levels = 1) {
    write_mesh(scratch / name, build_mesh(test::octahedron_sphere(levels)));
    return scratch / name;
}

std::vector<std::string> names_of(const Collection& collection) {
    std::vector<std::string> names;
    for (const auto& object : collection.objects) names.push_back(object.name);
    return names;
}

/// Faces of the object's mesh.
Json faces_of(const CollectionObject& object) {
    Json result;
    result.SetUint64(read_mesh(object.mesh).mesh.number_of_faces());
    return result;
}

TEST(Collection, AFolderGivesItsMeshesByName) {
    const Scratch scratch;
    sphere_file(scratch, "b.ply");
    sphere_file(scratch, "a.off", 2);
    sphere_file(scratch, "twin.obj");
    sphere_file(scratch, "twin.off");
    (void)scratch.file("a.ant.json", "{}");
    (void)scratch.file("a.mrk.json", "{}");
    (void)scratch.file("points.mrk.json", "{}");
    (void)scratch.file("truth.csv", "name,label\n");
    (void)scratch.file(".hidden.ply", "ply\n");
    const Collection collection = read_collection(scratch.path());
    EXPECT_EQ(names_of(collection), (std::vector<std::string>{"a", "b", "points", "twin.obj", "twin.off"}));
    EXPECT_EQ(collection.objects[0].annotations, scratch / "a.ant.json");
    EXPECT_EQ(collection.objects[0].landmarks, scratch / "a.mrk.json");
    EXPECT_TRUE(collection.objects[2].mesh.empty());
    for (const auto& object : collection.objects) EXPECT_EQ(object.checksum.size(), 64U) << object.name;
}

TEST(Collection, AFolderInMemoryIsACollection) {
    const Path folder = "memory:collection-test";
    const Mesh mesh = build_mesh(test::octahedron_sphere(1));
    for (const char* name : {"b.ply", "a.off", "deeper/c.ply"}) write_mesh(folder / name, mesh);
    write_file(folder / "list.study.json", R"({"format": "ostraka-study", "version": 1, "objects": [{"mesh": "deeper/c.ply"}]})");
    const Collection collection = read_collection(folder), listed = read_collection(folder / "list.study.json");
    EXPECT_EQ(names_of(collection), (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(names_of(listed), (std::vector<std::string>{"c"}));
    EXPECT_EQ(listed.objects[0].checksum, collection.objects[1].checksum);
    const ResultStore store(folder / "kept");
    for (const bool resumed : {false, true})
        for (const ObjectResult& each : for_each_object(collection, store, {"faces"}, faces_of)) {
            EXPECT_EQ(each.resumed, resumed);
            EXPECT_EQ(each.result.GetUint64(), mesh.number_of_faces());
        }
    remove_memory_files(folder);
    EXPECT_THROW(read_collection(folder), Error);
}

TEST(Collection, CopiesAreNoted) {
    const Scratch scratch;
    sphere_file(scratch, "a.ply");
    sphere_file(scratch, "b.ply", 2);
    std::filesystem::copy_file(scratch / "a.ply", scratch / "c.ply");
    const Collection collection = read_collection(scratch.path());
    ASSERT_EQ(collection.notes.size(), 1U);
    EXPECT_NE(collection.notes[0].find("a, c"), std::string::npos);
}

TEST(Collection, AStudyFileListsItsObjects) {
    const Scratch scratch;
    sphere_file(scratch, "b.ply");
    const Path study = scratch.file("s.study.json", R"({"format": "ostraka-study", "version": 1, "objects": [
        {"name": "z", "mesh": "b.ply", "unit": "cm", "label": "wheel"}, {"mesh": "gone.ply"}]})");
    const Collection collection = read_collection(study);
    ASSERT_EQ(names_of(collection), (std::vector<std::string>{"gone", "z"}));
    EXPECT_TRUE(collection.objects[0].checksum.empty());
    EXPECT_EQ(collection.objects[1].unit, "cm");
    EXPECT_EQ(collection.objects[1].label, "wheel");
}

TEST(Collection, InvalidCollectionsAreRefused) {
    const Scratch scratch;
    EXPECT_THROW(read_collection(scratch / "nowhere"), Error);
    EXPECT_THROW(read_collection(scratch.path()), Error);
    EXPECT_THROW(read_collection(sphere_file(scratch, "a.ply")), Error);
    const auto study = [&](const std::string& objects) {
        return scratch.file("s.study.json", R"({"format": "ostraka-study", "version": 1, "objects": [)" + objects + "]}");
    };
    EXPECT_THROW(read_collection(study("")), Error);
    EXPECT_THROW(read_collection(study(R"({"name": "x"})")), Error);
    EXPECT_THROW(read_collection(study(R"({"name": "../x", "mesh": "a.ply"})")), Error);
    EXPECT_THROW(read_collection(study(R"({"name": "x", "mesh": "a.ply"}, {"name": "x", "mesh": "a.ply"})")), Error);
    EXPECT_NO_THROW(read_collection(study(R"({"name": "x", "mesh": "a.ply"})")));
}

TEST(Collection, LabelsComeFromATable) {
    const Scratch scratch;
    sphere_file(scratch, "a.ply");
    sphere_file(scratch, "b.ply", 2);
    const Path file = scratch.file("truth.csv", "label;name;level\nwheel;a;1\n\"by; hand\";c;2\n");
    const auto labels = read_labels(file);
    EXPECT_EQ(labels, (std::map<std::string, std::string>{{"a", "wheel"}, {"c", "by; hand"}}));
    EXPECT_EQ(read_labels(file, "level").at("c"), "2");
    EXPECT_THROW(read_labels(file, "wrong"), Error);
    EXPECT_THROW(read_labels(scratch.file("twice.csv", "name,label\na,1\na,2\n")), Error);
    EXPECT_THROW(read_labels(scratch.file("short.csv", "name,x,label\na,1\n")), Error);
    EXPECT_THROW(read_labels(scratch.file("empty.csv", "")), Error);
    Collection collection = read_collection(scratch.path());
    set_labels(collection, labels);
    EXPECT_EQ(collection.objects[0].label, "wheel");
    EXPECT_EQ(collection.objects[1].label, "");
    EXPECT_EQ(collection.notes.size(), 2U);
}

TEST(Collection, LabelsNeedTheirColumnsAndAnObject) {
    const Scratch scratch;
    sphere_file(scratch, "a.ply");
    sphere_file(scratch, "b.ply", 2);
    const auto problem = [](const auto& work) {
        try {
            work();
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input);
            return std::string(error.what());
        }
        return std::string();
    };
    const Path unnamed = scratch.file("unnamed.csv", "object,label\na,wheel\n"),
               other = scratch.file("o.csv", "name,mould\na,1\n");
    EXPECT_NE(problem([&] { read_labels(unnamed); }).find("no column 'name'; the columns are 'object', 'label'"),
              std::string::npos);
    EXPECT_NE(problem([&] { read_labels(other); }).find("no column 'label'; the columns are 'name', 'mould'"), std::string::npos);
    EXPECT_EQ(read_labels(other, "mould").at("a"), "1");
    Collection collection = read_collection(scratch.path());
    const std::string none = problem([&] { set_labels(collection, {{"x.ply", "wheel"}, {"y.ply", "hand"}}, "truth.csv"); });
    for (const char* word : {"truth.csv", "'x.ply', 'y.ply'", "'a', 'b'", "without their endings"})
        EXPECT_NE(none.find(word), std::string::npos) << none;
    EXPECT_NE(problem([&] { set_labels(collection, {{"a", ""}}); }).find("empty"), std::string::npos);
    EXPECT_EQ(problem([&] { set_labels(collection, {{"a", "x"}}); }), "");
}

TEST(Collection, ObjectsWithInvalidNamesAreLeftOut) {
    const Scratch scratch;
    sphere_file(scratch, "a.ply");
    for (const std::string name : {"new\nline", "back\\slash", "escape\x1b[31m", "no utf-8 \xff", "turned \xE2\x80\xAE round"})
        std::filesystem::copy_file(scratch / "a.ply", scratch / (name + ".ply"));
    std::filesystem::copy_file(scratch / "a.ply", scratch / (std::string(201, 'x') + ".ply"));
    const Collection collection = read_collection(scratch.path());
    EXPECT_EQ(names_of(collection), (std::vector<std::string>{"a"}));
    ASSERT_EQ(collection.left_out.size(), 6U);
    for (const auto& [name, why] : collection.left_out) {
        EXPECT_EQ(name.find_first_of("\n\x1b\xff"), std::string::npos) << name;
        EXPECT_NE(why.find("its name"), std::string::npos) << why;
    }
    std::filesystem::remove(scratch / "a.ply");
    EXPECT_THROW(read_collection(scratch.path()), Error) << "no object remains";
}

TEST(Collection, BrokenLinksAreLeftOut) {
    const Scratch scratch;
    sphere_file(scratch, "a.ply");
    std::filesystem::create_symlink("gone", scratch / "gone.ply");
    std::filesystem::create_symlink("loop.ply", scratch / "loop.ply");
    std::filesystem::create_symlink("gone", scratch / "notes.txt");
    std::filesystem::create_directory(scratch / "folder.ply");
    const Collection collection = read_collection(scratch.path());
    EXPECT_EQ(names_of(collection), (std::vector<std::string>{"a"}));
    ASSERT_EQ(collection.left_out.size(), 2U);
    EXPECT_EQ(collection.left_out[0].first, "gone.ply");
    EXPECT_EQ(collection.left_out[1].first, "loop.ply");
}

TEST(Collection, SyntheticObjectsAreNotMixedWithOthers) {
    const Scratch scratch;
    EXPECT_NO_THROW(check_new_collection(scratch / "missing"));
    write_file(scratch / "notes.txt", "x");
    std::filesystem::create_symlink(scratch / "nowhere", scratch / "link");
    EXPECT_NO_THROW(check_new_collection(scratch.path()));
    const Path memory = "memory:made";
    write_file(memory / "notes.txt", "x");
    EXPECT_NO_THROW(check_new_collection(memory));
    for (const char* name : {"pot.PLY", "pot.ant.json", "truth.csv"})
        for (const Path& folder : {scratch.path(), memory}) {
            write_file(folder / name, "x");
            try {
                check_new_collection(folder);
                ADD_FAILURE() << folder / name;
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::failure);
                EXPECT_NE(error.problem().find(name), std::string::npos) << error.what();
            }
            remove_file(folder / name);
        }
    remove_memory_files(memory);
}

TEST(ForEachObject, OneThatFailsDoesNotStopTheOthers) {
    const Scratch scratch;
    sphere_file(scratch, "a.ply");
    (void)scratch.file("b.ply", "no mesh");
    sphere_file(scratch, "c.ply", 2);
    const Collection collection = read_collection(scratch.path());
    const auto results = for_each_object(collection, ResultStore(), {"faces"}, faces_of);
    ASSERT_EQ(results.size(), 3U);
    EXPECT_EQ(results[0].result.GetUint64(), 32U);
    EXPECT_TRUE(results[1].result.IsNull());
    EXPECT_NE(results[1].problem.find("b.ply"), std::string::npos);
    EXPECT_EQ(results[2].result.GetUint64(), 128U);
}

TEST(ForEachObject, CompletedObjectsAreNotProcessedAgain) {
    const Scratch scratch;
    std::filesystem::create_directory(scratch / "in");
    for (const char* name : {"in/a.ply", "in/b.ply", "in/c.ply"}) sphere_file(scratch, name, 1);
    const ResultStore store(scratch / "out" / "objects");
    std::atomic<int> calls = 0;
    const auto run = [&](const std::string& options) {
        calls = 0;
        return for_each_object(read_collection(scratch / "in"), store, {"faces", options}, [&](const CollectionObject& object) {
            ++calls;
            return faces_of(object);
        });
    };
    run("x");
    EXPECT_EQ(calls, 3);
    EXPECT_TRUE(run("x")[1].resumed);
    EXPECT_EQ(calls, 0);
    write_file(scratch / "out" / "objects" / "b.json", "{ cut o");
    sphere_file(scratch, "in/c.ply", 2);
    const auto results = run("x");
    EXPECT_EQ(calls, 2);
    EXPECT_EQ(results[2].result.GetUint64(), 128U);
    run("y");
    EXPECT_EQ(calls, 3);
}

TEST(ForEachObject, ShardsAreGatheredWithoutWork) {
    const Scratch scratch;
    std::filesystem::create_directory(scratch / "in");
    for (const char* name : {"in/a.ply", "in/b.ply", "in/c.ply", "in/d.ply", "in/e.ply"}) sphere_file(scratch, name, 1);
    std::atomic<int> calls = 0;
    const auto run = [&](const Share& shard) {
        calls = 0;
        const Collection collection = read_collection(scratch / "in", shard);
        EXPECT_EQ(std::count_if(collection.objects.begin(), collection.objects.end(),
                                [](const auto& collection_object) { return collection_object.checksum.empty(); }),
                  shard.is_whole()   ? 0
                  : shard.index == 0 ? 2
                                     : 3);
        return for_each_object(collection, ResultStore(scratch / "out", shard), {"faces"}, [&](const CollectionObject& object) {
            ++calls;
            return faces_of(object);
        });
    };
    const auto second_half = run({0, 2});
    EXPECT_EQ(calls, 3);
    EXPECT_FALSE(second_half[2].elsewhere);
    EXPECT_TRUE(second_half[3].elsewhere);
    EXPECT_TRUE(second_half[3].problem.empty());
    run({1, 2});
    EXPECT_EQ(calls, 2);
    for (const auto& result : run({})) EXPECT_TRUE(result.resumed);
    EXPECT_EQ(calls, 0);
}

TEST(ResultStore, StoresAtOnceAndDetectsChanges) {
    const Scratch scratch;
    const ResultStore store(scratch.path());
    const Json result = parse_json(R"({"values": [1, 0.1, -0.0, 1e300, null, true, "x"]})", "test");
    {
        const OutputTransaction all_or_nothing;
        store.keep("a", "key", result);
    }
    ASSERT_TRUE(store.find("a", "key"));
    EXPECT_EQ(*store.find("a", "key"), result);
    EXPECT_FALSE(store.find("a", "other"));
    std::string text = read_file(scratch / "a.json");
    text.replace(text.find("0.1"), 3, "0.2");
    write_file(scratch / "a.json", text);
    EXPECT_FALSE(store.find("a", "key"));
}

TEST(ResultStore, RemovesTemporaryFilesOfKilledRuns) {
    const Scratch scratch;
    const auto now = std::filesystem::file_time_type::clock::now();
    for (const auto& [name, hours] : {std::pair{".ostraka-old000", 30}, {".ostraka-young0", 1}}) {
        (void)scratch.file(name, "half");
        std::filesystem::last_write_time(scratch / name, now - std::chrono::hours(hours));
    }
    const ResultStore store(scratch.path());
    EXPECT_FALSE(std::filesystem::exists(scratch / ".ostraka-old000"));
    EXPECT_TRUE(std::filesystem::exists(scratch / ".ostraka-young0")) << "another process may be writing it";
}

TEST(ResultStore, PartsSeparateResultsOfEqualNames) {
    const Scratch scratch;
    const ResultStore store(scratch.path());
    const Json first = parse_json("1", "test"), second = parse_json("2", "test");
    store.keep("a", "key", first);
    store.part("sizes").keep("a", "other", second);
    ASSERT_TRUE(store.find("a", "key"));
    EXPECT_EQ(*store.find("a", "key"), first);
    EXPECT_EQ(*store.part("sizes").find("a", "other"), second);
    EXPECT_FALSE(ResultStore().part("sizes").find("a", "other"));
}

TEST(ForEachObject, FailuresAreRetriedAndUsageErrorsAreThrown) {
    const Scratch scratch;
    sphere_file(scratch, "a.ply");
    const ResultStore store(scratch / "objects");
    const Collection collection = read_collection(scratch.path());
    const auto failing = [](const CollectionObject&) -> Json { fail_input("a", "no", "yes"); };
    EXPECT_EQ(for_each_object(collection, store, {"w"}, failing)[0].problem, "a: no (yes)");
    EXPECT_EQ(for_each_object(collection, store, {"w"}, faces_of)[0].result.GetUint64(), 32U);
    EXPECT_THROW(
        for_each_object(collection, ResultStore(), {"w"}, [](const CollectionObject&) -> Json { fail_usage("no", "yes"); }),
        Error);
}

TEST(ForEachObject, TheNumberOfThreadsDoesNotMatter) {
    const Scratch scratch;
    for (int i = 0; i < 9; ++i) sphere_file(scratch, std::string(1, char('a' + i)) + ".ply", i % 3);
    const Collection collection = read_collection(scratch.path());
    std::vector<std::vector<std::uint64_t>> runs;
    for (const int count : {1, 3}) {
        set_threads(count);
        runs.emplace_back();
        for (const auto& r : for_each_object(collection, ResultStore(), {"faces"}, faces_of))
            runs.back().push_back(r.result.GetUint64());
    }
    set_threads(0);
    EXPECT_EQ(runs[0], runs[1]);
}

}  // namespace
}  // namespace ostraka

// annotation find
#include "operations/study/common.h"

#include "ostraka/core/nearest_name.h"
#include "ostraka/relation/query.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

namespace ostraka {

namespace {

/// A collection of one object, given as its mesh or its annotations, which have the same name and folder.
Collection single_object(const Path& file) {
    const std::string name = file.filename().string(), ending = ".ant.json";
    CollectionObject object;
    if (name.ends_with(ending)) {
        object.name = name.substr(0, name.size() - ending.size());
        object.annotations = file;
        for (const char* mesh : {".ply", ".obj", ".off", ".stl", ".glb", ".gltf", ".3mf"})
            if (object.mesh.empty() && file_exists(file.parent_path() / (object.name + mesh)))
                object.mesh = file.parent_path() / (object.name + mesh);
        if (object.mesh.empty())
            fail_input(file.string(), "there is no mesh of the same name in its folder",
                       fmt::format("put {}.ply (or .obj, .glb, .gltf, .off, .stl, .3mf) into this folder", object.name));
    } else {
        object.name = file.stem().string();
        object.mesh = file;
        object.annotations = file.parent_path() / (object.name + ending);
        if (!file_exists(object.annotations))
            fail_input(file.string(), "there are no annotations of the same name in its folder",
                       fmt::format("put {}{} into this folder", object.name, ending));
    }
    object.checksum = ResultStore::key({sha256_of_file(object.mesh), sha256_of_file(object.annotations)});
    Collection collection;
    collection.objects.push_back(std::move(object));
    return collection;
}

Path graph_beside(const CollectionObject& object) {
    const std::string name = object.annotations.filename().string();
    const Path graph = object.annotations.parent_path() / (name.substr(0, name.find(".ant.json")) + ".graph.json");
    return file_exists(graph) ? graph : Path();
}

/// An object on which a query is evaluated.
struct ReadObject {
    MeshFile file;
    AnnotationSet set;
    std::optional<RelationGraph> graph;

    ReadObject(const CollectionObject& object, bool with_graph)
        : file(read_mesh(object.mesh)), set(read_annotations(object.annotations, file.mesh)) {
        if (set.unit.empty()) set.unit = object.unit;
        if (const Path beside = with_graph ? graph_beside(object) : Path(); !beside.empty()) graph = read_graph(beside, set);
    }
    [[nodiscard]] QueriedObject queried(const Vocabulary* vocabulary) const {
        return {{file.mesh, set}, graph ? &*graph : nullptr, vocabulary, {}};
    }
};

struct AnnotationFind final : Operation {
    void declare(Parameters& p) override {
        p.options("query", query, "query, such as '2 arm and 2 leg' or 'area(handle) >= area(body) / 3'").required().positional();
        p.input("objects", Kind::collection, objects,
                "folders of meshes, lists of objects (.study.json), meshes or annotations (.ant.json); annotations and "
                "relationships of NAME.ply are in NAME.ant.json and NAME.graph.json beside it")
            .many();
        p.order({"query", "objects"});
        p.input_option(
            "vocabulary", Kind::vocabulary, vocabulary,
            "vocabulary (.vocabulary.json, .ttl, .rdf): a word of the query also finds its translations and narrower concepts");
        p.report.values(text("query"), integer("objects"), integer("annotated"), integer("found"));
        p.report.table("matches", text("object", "object"), text("mesh"), any("annotations"), text_only("annotations"));
        p.report.table("failed", text("name"), text("problem"));
    }

    void check() const override { static_cast<void>(AnnotationQuery(query)); }

    void run(Context& context, Report& report) override {
        const AnnotationQuery parsed_query(query);
        const Vocabulary* words = vocabulary ? &vocabulary.load<Vocabulary>(read_vocabulary) : nullptr;
        Collection collection = read_all(context);
        const std::size_t object_count = collection.objects.size();
        std::erase_if(collection.objects,
                      [](const CollectionObject& object) { return object.annotations.empty() || object.mesh.empty(); });
        const auto values = values_of_references(parsed_query, collection, words);
        const std::vector<ObjectResult> results =
            for_each_object(collection, ResultStore(), {"annotation find"},
                            [&](const CollectionObject& object) { return answer(parsed_query, object, words, values); });
        report("query", query)("objects", object_count)("annotated", collection.objects.size());
        report_failures(report, collection, results);
        report_matches(report, collection, results);
        note_unknown(report, parsed_query, results, words);
        if (object_count > collection.objects.size())
            report.note(counted(object_count - collection.objects.size(), "object") + " without annotations");
    }

    using Values = std::map<QueryReference, std::vector<std::string>>;

    Collection read_all(Context& context) const {
        Collection collection;
        context.record([&] {
            for (std::size_t i = 0; i < objects.size(); ++i) {
                const Path path = objects.path(i);
                const std::string name = path.filename().string();
                const bool is_single = !is_folder(path) && (name.ends_with(".ant.json") || extension(path) != ".json");
                Collection added = is_single ? single_object(path) : read_collection(path);
                collection.objects.insert(collection.objects.end(), added.objects.begin(), added.objects.end());
                collection.left_out.insert(collection.left_out.end(), added.left_out.begin(), added.left_out.end());
                context.notes("", added.notes);
            }
        });
        for (const CollectionObject& object : collection.objects) {
            context.record_input(object.name, object.checksum);
            if (const Path graph = object.annotations.empty() ? Path() : graph_beside(object); !graph.empty())
                context.record_input(graph.filename().string(), sha256_of_file(graph));
        }
        return collection;
    }

    static Values values_of_references(const AnnotationQuery& parsed_query, const Collection& collection,
                                       const Vocabulary* words) {
        Values values;
        std::vector<std::string> names;
        for (const CollectionObject& object : collection.objects) names.push_back(object.name);
        for (const QueryReference& reference : parsed_query.references()) {
            const auto at = std::find(names.begin(), names.end(), reference.object);
            if (at == names.end()) {
                const std::string nearest = nearest_name(reference.object, names);
                fail_usage(
                    fmt::format("query: no annotated object is named '{}'", printable(reference.object, 60)),
                    nearest.empty() ? "name one of the collection" : fmt::format("did you mean '{}'?", printable(nearest, 60)));
            }
            const ReadObject object(collection.objects[static_cast<std::size_t>(at - names.begin())], false);
            values[reference] = values_of(object.queried(words), reference.attribute);
            if (values[reference].empty())
                fail_usage(fmt::format("query: object '{}' has no attribute '{}'", printable(reference.object, 60),
                                       printable(reference.attribute, 60)),
                           "'ostraka annotation list' shows its attributes");
        }
        return values;
    }

    static Json answer(const AnnotationQuery& parsed_query, const CollectionObject& object, const Vocabulary* words,
                       const Values& values) {
        const ReadObject read(object, true);
        QueriedObject queried = read.queried(words);
        queried.values_elsewhere = [&](const QueryReference& reference) { return values.at(reference); };
        const QueryAnswer query_answer = in_file(object.annotations.string(), [&] { return parsed_query.ask(queried); });
        Json result(rapidjson::kObjectType);
        auto& allocator = result.GetAllocator();
        std::vector<std::string> unknown, tags;
        const TagMatcher tag_words(words);
        for (const std::string& word : parsed_query.words())
            if (tag_words.find(read.set, word).empty()) unknown.push_back(word);
        for (const Annotation& annotation : read.set.annotations) tags.push_back(annotation.tag);
        add_members(result, allocator, "holds", query_answer.holds, "annotations",
                    json_list(query_answer.annotations, allocator,
                              [&](int id) { return json_object(allocator, "id", id, "tag", read.set.find(id)->tag); }),
                    "problems", query_answer.problems, "unknown", unknown, "tags", tags);
        return result;
    }

    static void report_matches(Report& report, const Collection& collection, const std::vector<ObjectResult>& results) {
        std::size_t match_count = 0;
        report.empty_table("matches", false);
        for (std::size_t i = 0; i < results.size(); ++i) {
            if (!results[i].problem.empty()) continue;
            const Json& result = results[i].result;
            for (const auto& problem : result["problems"].GetArray())
                report.note(fmt::format("{}, query {}", collection.objects[i].name, problem.GetString()));
            if (!result["holds"].GetBool()) continue;
            ++match_count;
            std::vector<std::string> parts;
            for (const auto& annotation : result["annotations"].GetArray())
                parts.push_back(fmt::format("{} {}", annotation["id"].GetInt(), printable(annotation["tag"].GetString(), 40)));
            report
                .row("matches")("object", collection.objects[i].name)("mesh", collection.objects[i].mesh.filename().string())(
                    "annotations", JsonValue(result["annotations"], report.allocator()))
                .shown("annotations", joined(parts));
        }
        report("found", match_count);
        report.line(
            fmt::format("{} of {} {}", counted(match_count, "object"), results.size(), match_count == 1 ? "matches" : "match"));
        if (match_count == 0) report.answer_no();
    }

    /// Reports words that no object has and the vocabulary does not contain, as they are probably typing errors.
    static void note_unknown(Report& report, const AnnotationQuery& parsed_query, const std::vector<ObjectResult>& results,
                             const Vocabulary* words) {
        std::set<std::string> unknown(parsed_query.words().begin(), parsed_query.words().end()), tags;
        for (const ObjectResult& result : results) {
            if (!result.problem.empty()) continue;
            std::set<std::string> unknown_in_object;
            for (const auto& word : result.result["unknown"].GetArray()) unknown_in_object.insert(word.GetString());
            std::erase_if(unknown, [&](const std::string& word) { return !unknown_in_object.contains(word); });
            for (const auto& tag : result.result["tags"].GetArray()) tags.insert(tag.GetString());
        }
        for (const std::string& word : unknown) {
            std::vector<std::string> suggestions;
            if (words != nullptr) {
                const VocabularySearch search(*words);
                if (!search.concepts_of(word).empty()) continue;
                suggestions = search.suggestions(word);
            }
            if (suggestions.empty())
                if (const std::string tag = nearest_name(word, {tags.begin(), tags.end()}); !tag.empty())
                    suggestions.push_back(tag);
            report.note(
                fmt::format("no object has a part '{}'{}", printable(word, 60),
                            suggestions.empty() ? "" : fmt::format(": did you mean '{}'?", printable(suggestions.front(), 60))));
        }
    }

    std::string query;
    FileInput objects, vocabulary;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_find() { return make<AnnotationFind>(); }

}  // namespace ostraka

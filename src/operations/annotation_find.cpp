// annotation find
#include "study.h"

#include "ostraka/core/nearest_name.h"
#include "ostraka/relation/query.h"

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
        for (const char* mesh : {".ply", ".obj", ".off", ".stl"})
            if (object.mesh.empty() && file_exists(file.parent_path() / (object.name + mesh)))
                object.mesh = file.parent_path() / (object.name + mesh);
        if (object.mesh.empty())
            fail_input(file.string(), "there is no mesh of its name beside it",
                       "put " + object.name + ".ply (or .obj, .off, .stl) there");
    } else {
        object.name = file.stem().string();
        object.mesh = file;
        object.annotations = file.parent_path() / (object.name + ending);
        if (!file_exists(object.annotations))
            fail_input(file.string(), "there are no annotations of its name beside it", "put " + object.name + ending + " there");
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
        return {&file.mesh, &set, graph ? &*graph : nullptr, vocabulary, {}};
    }
};

struct AnnotationFind final : Operation {
    void describe(Parameters& p) override {
        p.options("query", query, "query, such as '2 arm and 2 leg' or 'area(handle) >= area(body) / 3'").required().positional();
        p.input(
             "objects", Kind::collection, objects,
             "folders of meshes, lists of objects (.study.json), or single meshes or annotations (.ant.json); NAME.ant.json and "
             "NAME.graph.json stand beside NAME.ply")
            .many();
        p.order({"query", "objects"});
        p.input_option("vocabulary", Kind::vocabulary, vocabulary,
                       "vocabulary (.vocabulary.json, .ttl, .rdf): words in any of its languages, with what is narrower");
        p.report.values(text("query"), integer("objects"), integer("annotated"), integer("found"));
        p.report.table("matches", text("object", "object"), text("mesh"), any("annotations"), people("annotations"));
        p.report.table("failed", text("name"), text("problem"));
    }

    void check() const override { static_cast<void>(AnnotationQuery(query)); }

    void run(Context& context, Report& report) override {
        const AnnotationQuery asked(query);
        const Vocabulary* words = vocabulary ? &vocabulary.load<Vocabulary>(read_vocabulary) : nullptr;
        Collection collection = read_all(context);
        const std::size_t all = collection.objects.size();
        std::erase_if(collection.objects,
                      [](const CollectionObject& one) { return one.annotations.empty() || one.mesh.empty(); });
        const auto values = values_of_references(asked, collection, words);
        const std::vector<ObjectResult> results =
            for_each_object(collection, ResultStore(), {"annotation find"},
                            [&](const CollectionObject& object) { return answer(asked, object, words, values); });
        report("query", query)("objects", all)("annotated", collection.objects.size());
        report_failures(report, collection, results);
        report_matches(report, collection, results);
        note_unknown(report, asked, results, words);
        if (all > collection.objects.size())
            report.note(counted(all - collection.objects.size(), "object") + " without annotations");
    }

    using Values = std::map<QueryReference, std::vector<std::string>>;

    Collection read_all(Context& context) const {
        Collection collection;
        context.record([&] {
            for (std::size_t i = 0; i < objects.size(); ++i) {
                const Path path = objects.path(i);
                const std::string name = path.filename().string();
                const bool one = !is_folder(path) && (name.ends_with(".ant.json") || extension(path) != ".json");
                Collection more = one ? single_object(path) : read_collection(path);
                collection.objects.insert(collection.objects.end(), more.objects.begin(), more.objects.end());
                collection.left_out.insert(collection.left_out.end(), more.left_out.begin(), more.left_out.end());
                context.notes("", more.notes);
            }
        });
        for (const CollectionObject& object : collection.objects) {
            context.record_input(object.name, object.checksum);
            if (const Path graph = object.annotations.empty() ? Path() : graph_beside(object); !graph.empty())
                context.record_input(graph.filename().string(), sha256_of_file(graph));
        }
        return collection;
    }

    static Values values_of_references(const AnnotationQuery& asked, const Collection& collection, const Vocabulary* words) {
        Values values;
        std::vector<std::string> names;
        for (const CollectionObject& one : collection.objects) names.push_back(one.name);
        for (const QueryReference& reference : asked.references()) {
            const auto at = std::find(names.begin(), names.end(), reference.object);
            if (at == names.end()) {
                const std::string near = nearest_name(reference.object, names);
                fail_usage("query: no annotated object is named '" + printable(reference.object, 60) + "'",
                           near.empty() ? "name one of the collection" : "did you mean '" + printable(near, 60) + "'?");
            }
            const ReadObject object(collection.objects[static_cast<std::size_t>(at - names.begin())], false);
            values[reference] = values_of(object.queried(words), reference.attribute);
            if (values[reference].empty())
                fail_usage("query: object '" + printable(reference.object, 60) + "' has no attribute '" +
                               printable(reference.attribute, 60) + "'",
                           "'ostraka annotation list' shows what it has");
        }
        return values;
    }

    static Json answer(const AnnotationQuery& asked, const CollectionObject& object, const Vocabulary* words,
                       const Values& values) {
        const ReadObject read(object, true);
        QueriedObject queried = read.queried(words);
        queried.values_elsewhere = [&](const QueryReference& reference) { return values.at(reference); };
        const QueryAnswer found = in_file(object.annotations.string(), [&] { return asked.ask(queried); });
        Json result(rapidjson::kObjectType);
        auto& allocator = result.GetAllocator();
        std::vector<std::string> unknown, tags;
        const TagWords means(words);
        for (const std::string& word : asked.words())
            if (means.find(read.set, word).empty()) unknown.push_back(word);
        for (const Annotation& one : read.set.annotations) tags.push_back(one.tag);
        add_members(result, allocator, "holds", found.holds, "annotations",
                    json_list(found.annotations, allocator,
                              [&](int id) { return json_object(allocator, "id", id, "tag", read.set.find(id)->tag); }),
                    "problems", found.problems, "unknown", unknown, "tags", tags);
        return result;
    }

    static void report_matches(Report& report, const Collection& collection, const std::vector<ObjectResult>& results) {
        std::size_t found = 0;
        report.empty_table("matches", false);
        for (std::size_t i = 0; i < results.size(); ++i) {
            if (!results[i].problem.empty()) continue;
            const Json& result = results[i].result;
            for (const auto& problem : result["problems"].GetArray())
                report.note(collection.objects[i].name + ", query " + problem.GetString());
            if (!result["holds"].GetBool()) continue;
            ++found;
            std::vector<std::string> parts;
            for (const auto& one : result["annotations"].GetArray())
                parts.push_back(std::to_string(one["id"].GetInt()) + " " + printable(one["tag"].GetString(), 40));
            report
                .row("matches")("object", collection.objects[i].name)("mesh", collection.objects[i].mesh.filename().string())(
                    "annotations", JsonValue(result["annotations"], report.allocator()))
                .shown("annotations", joined(parts));
        }
        report("found", found);
        report.line(counted(found, "object") + " of " + std::to_string(results.size()) + (found == 1 ? " matches" : " match"));
        if (found == 0) report.answer_no();
    }

    /// Reports words that no object has and the vocabulary does not contain, as they are probably typing errors.
    static void note_unknown(Report& report, const AnnotationQuery& asked, const std::vector<ObjectResult>& results,
                             const Vocabulary* words) {
        std::set<std::string> unknown(asked.words().begin(), asked.words().end()), tags;
        for (const ObjectResult& one : results) {
            if (!one.problem.empty()) continue;
            std::set<std::string> here;
            for (const auto& word : one.result["unknown"].GetArray()) here.insert(word.GetString());
            std::erase_if(unknown, [&](const std::string& word) { return !here.contains(word); });
            for (const auto& tag : one.result["tags"].GetArray()) tags.insert(tag.GetString());
        }
        for (const std::string& word : unknown) {
            std::vector<std::string> near;
            if (words != nullptr) {
                const VocabularySearch search(*words);
                if (!search.concepts_of(word).empty()) continue;
                near = search.suggestions(word);
            }
            if (near.empty())
                if (const std::string tag = nearest_name(word, {tags.begin(), tags.end()}); !tag.empty()) near.push_back(tag);
            report.note("no object has a part '" + printable(word, 60) + "'" +
                        (near.empty() ? "" : ": did you mean '" + printable(near.front(), 60) + "'?"));
        }
    }

    std::string query;
    FileInput objects, vocabulary;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_find() { return make<AnnotationFind>(); }

}  // namespace ostraka

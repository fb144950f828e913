#include "study.h"

#include "ostraka/core/error.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace ostraka::app {

namespace fs = std::filesystem;

void StudyFiles::check() const {
    std::error_code code;
    if (output.empty()) fail_usage("--output is empty", "name a folder, which is made if it is missing");
    if (fs::exists(output, code) && !fs::is_directory(output, code))
        fail_usage("--output '" + output + "' is a file", "name a folder, which is made if it is missing");
    const Path folder = fs::is_directory(collection, code) ? Path(collection) : Path(collection).parent_path();
    if (fs::weakly_canonical(fs::absolute(output), code) == fs::weakly_canonical(fs::absolute(folder / "."), code))
        fail_usage("--output is the folder of the collection", "name another one, so that results are not taken for objects");
    if (truth.empty() && !truth_column.empty()) fail_usage("--truth-column without --truth", "name the table as well");
}

void StudyFiles::open(const Provenance& provenance) const {
    std::error_code code;
    fs::create_directories(output, code);
    if (code) throw Error(ErrorKind::failure, output, "the folder cannot be made: " + code.message(), "name another --output");
    // Known before the work, not after the first object of many hours.
    if (::access(output.c_str(), W_OK | X_OK) != 0)
        throw Error(ErrorKind::failure, output, "the folder cannot be written to", "check its rights, or name another --output");
    remove_stale_temporaries(output);
    std::string owner = provenance.command;
    std::replace(owner.begin(), owner.end(), ' ', '-');
    replace_outputs(output, owner);
}

Collection StudyFiles::read(const Session& session, Provenance& provenance) const {
    check();
    Collection result = read_collection(collection);
    if (!truth.empty()) {
        set_labels(result, read_labels(truth, truth_column), truth);
        provenance.add_input(truth);
    }
    open(provenance);
    for (const auto& object : result.objects) provenance.inputs.emplace_back(object.name, object.checksum);
    for (const auto& note : result.notes) session.note("note: " + note);
    return result;
}

ResultStore StudyFiles::store(const std::string& kind) const { return ResultStore(in(kind)); }

void add_study_files(CLI::App* command, StudyFiles& files, bool labels) {
    command->add_option("collection", files.collection, "folder of meshes, or a list of objects (.study.json)")->required();
    command
        ->add_option("--output", files.output,
                     "folder for tables, plots and the report; what is done is kept there and not done again")
        ->required();
    command->add_option("--plots", files.plots, "format of the plots")
        ->check(CLI::IsMember({"svg", "png"}))
        ->capture_default_str();
    if (!labels) return;
    command->add_option("--truth", files.truth, "known answers: CSV with the columns name and label");
    command->add_option("--truth-column", files.truth_column, "the column of the answers, if not 'label'");
}

std::size_t report_failures(const Session& session, const Collection& collection, const std::vector<ObjectResult>& results,
                            JsonValue& report, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    const auto add = [&](const std::string& name, const std::string& problem) {
        session.note("left out: " + (problem.starts_with(name + ": ") ? "" : name + ": ") + problem);
        JsonValue entry(rapidjson::kObjectType);
        add_member(entry, "name", name, allocator);
        add_member(entry, "problem", problem, allocator);
        list.PushBack(entry, allocator);
    };
    for (const auto& [name, problem] : collection.left_out) add(name, problem);
    for (std::size_t i = 0; i < results.size(); ++i)
        if (!results[i].problem.empty()) add(collection.objects[i].name, results[i].problem);
    const std::size_t count = list.Size();
    add_member(report, "failed", std::move(list), allocator);
    return count;
}

KnownAnswers::KnownAnswers(const std::vector<std::string>& labels) : objects(labels.size()) {
    std::set<std::string> different;
    for (const auto& label : labels) {
        if (label.empty()) continue;
        ++labelled;
        different.insert(label);
    }
    kinds = different.size();
}

std::string KnownAnswers::words() const {
    if (labelled == 0) return {};
    std::string text = "answers are known of " + std::to_string(labelled) + " of " + std::to_string(objects) + " objects";
    if (!scorable()) text += labelled < 2 ? ": too few to score by" : ", all of one kind: nothing to score by";
    return text + "\n";
}

void KnownAnswers::add_to(JsonValue& report, JsonAllocator& allocator) const {
    if (labelled == 0) return;
    JsonValue entry(rapidjson::kObjectType);
    for (const auto& [name, count] : {std::pair{"labelled", labelled}, {"objects", objects}, {"kinds", kinds}})
        add_member(entry, name, JsonValue(static_cast<std::uint64_t>(count)), allocator);
    add_member(report, "truth", std::move(entry), allocator);
}

void write_study_report(const Path& file, const std::string& kind, const JsonValue& result, const Provenance& provenance) {
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    add_member(document, "format", "ostraka-" + kind, allocator);
    add_member(document, "version", JsonValue(1), allocator);
    for (const auto& member : result.GetObject())
        add_member(document, std::string_view(member.name.GetString(), member.name.GetStringLength()),
                   JsonValue(member.value, allocator), allocator);
    add_member(document, "provenance", provenance.to_json(allocator), allocator);
    validate(document, kind, file.string());
    write_json(file, document);
}

void make_collection_folder(const std::string& folder) {
    std::error_code code;
    fs::create_directories(folder, code);
    if (code) throw Error(ErrorKind::failure, folder, "the folder cannot be made: " + code.message(), "name another one");
    std::vector<std::string> there;
    for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code)) {
        const std::string name = it->path().filename().string();
        if (is_object_file(it->path()) || extension(it->path()) == ".csv") there.push_back(name);
    }
    if (code) throw Error(ErrorKind::failure, folder, "the folder cannot be read: " + code.message(), "name another one");
    if (there.empty()) return;
    const std::string first = *std::min_element(there.begin(), there.end());
    throw Error(ErrorKind::failure, folder,
                "the folder holds objects or tables already (" + std::to_string(there.size()) + ", such as '" + first + "')",
                "name a folder that is new or empty, so that made objects are not mixed with others");
}

}  // namespace ostraka::app

#include "study.h"

#include "ostraka/core/error.h"

#include <filesystem>

namespace ostraka::app {

namespace fs = std::filesystem;

Collection StudyFiles::read(const Session& session, Provenance& provenance) const {
    std::error_code code;
    if (fs::exists(output, code) && !fs::is_directory(output, code))
        fail_usage("--output '" + output + "' is a file", "name a folder, which is made if it is missing");
    const Path folder = fs::is_directory(collection, code) ? Path(collection) : Path(collection).parent_path();
    if (fs::weakly_canonical(fs::absolute(output), code) == fs::weakly_canonical(fs::absolute(folder / "."), code))
        fail_usage("--output is the folder of the collection", "name another one, so that results are not taken for objects");
    Collection result = read_collection(collection);
    if (!truth.empty()) {
        set_labels(result, read_labels(truth, truth_column));
        provenance.add_input(truth);
    } else if (!truth_column.empty()) {
        fail_usage("--truth-column without --truth", "name the table as well");
    }
    for (const auto& object : result.objects) provenance.inputs.emplace_back(object.name, object.checksum);
    for (const auto& note : result.notes) session.note("note: " + note);
    return result;
}

ResultStore StudyFiles::store(const std::string& kind) const { return ResultStore(Path(output) / kind); }

Path StudyFiles::in(const std::string& name) const {
    std::error_code code;
    fs::create_directories(output, code);
    if (code) throw Error(ErrorKind::failure, output, "the folder cannot be made: " + code.message(), "name another --output");
    return Path(output) / name;
}

void add_study_files(CLI::App* command, StudyFiles& files, bool labels) {
    command->add_option("collection", files.collection, "folder of meshes, or a list of objects (.study.json)")->required();
    command
        ->add_option("--output", files.output,
                     "folder for tables, plots and the report; what is done is kept there and not done again")
        ->required();
    if (!labels) return;
    command->add_option("--truth", files.truth, "known answers: CSV with the columns name and label");
    command->add_option("--truth-column", files.truth_column, "the column of the answers, if not 'label'");
}

std::size_t report_failures(const Session& session, const Collection& collection, const std::vector<ObjectResult>& results,
                            JsonValue& report, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (std::size_t i = 0; i < results.size(); ++i) {
        if (results[i].problem.empty()) continue;
        session.note("left out: " + collection.objects[i].name + ": " + results[i].problem);
        JsonValue entry(rapidjson::kObjectType);
        add_member(entry, "name", collection.objects[i].name, allocator);
        add_member(entry, "problem", results[i].problem, allocator);
        list.PushBack(entry, allocator);
    }
    const std::size_t count = list.Size();
    add_member(report, "failed", std::move(list), allocator);
    return count;
}

}  // namespace ostraka::app

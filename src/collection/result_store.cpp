#include "ostraka/collection/objects.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/json_build.h"
#include "ostraka/files/provenance.h"
#include "ostraka/files/safe_path.h"

#include <new>

namespace ostraka {

ResultStore::ResultStore(Path folder, const Share& share) : folder_(std::move(folder)), share_(share) {
    if (folder_.empty()) return;
    std::error_code code;
    if (std::filesystem::is_symlink(folder_, code))
        fail_input(folder_.string(), "is a link, but results are kept in a separate folder", "remove the link");
    remove_stale_temporaries(folder_);
}

ResultStore ResultStore::part(const std::string& kind) const {
    return folder_.empty() ? ResultStore() : ResultStore(folder_ / kind, share_);
}

std::string ResultStore::key(const std::vector<std::string>& parts) {
    Sha256 hash;
    const auto add = [&](const std::string& text) {
        const std::string length = std::to_string(text.size()) + ":";
        hash.update(length.data(), length.size());
        hash.update(text.data(), text.size());
    };
    add(version());
    for (const auto& part : parts) add(part);
    return hash.hexadecimal();
}

std::optional<Json> ResultStore::find(const std::string& name, const std::string& key) const {
    if (folder_.empty()) return {};
    const Path file = folder_ / (name + ".json");
    if (!file_exists(file)) return {};
    try {
        Json document = read_json(file);
        if (!document.IsObject() || text_in(document, "key") != key) return {};
        const JsonValue* result = find_member(document, "result");
        if (result == nullptr || text_in(document, "checksum") != sha256(to_text(*result))) return {};
        Json copy;
        copy.CopyFrom(*result, copy.GetAllocator());
        return copy;
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::cancelled) throw;
        return {};
    }
}

void ResultStore::keep(const std::string& name, const std::string& key, const JsonValue& result) const {
    if (folder_.empty()) return;
    make_folder(folder_);
    require_writable_inside(folder_ / (name + ".json"), folder_);
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    add_members(document, allocator, "format", "ostraka-study-result", "version", 1, "key", key, "checksum",
                sha256(to_text(result)), "result", JsonValue(result, allocator));
    // Stored at once, even if the caller's own output transaction fails.
    OutputTransaction transaction;
    write_json(folder_ / (name + ".json"), document);
    transaction.commit();
}

std::vector<ObjectResult> for_each_object(const Collection& collection, const ResultStore& store,
                                          const std::vector<std::string>& key_parts,
                                          const std::function<Json(const CollectionObject&)>& work) {
    std::vector<ObjectResult> results(collection.objects.size());
    Progress progress("objects", results.size());
    parallel_for(results.size(), 1, [&](std::size_t i) {
        const CollectionObject& object = collection.objects[i];
        ObjectResult& object_result = results[i];
        std::vector<std::string> parts = key_parts;
        parts.insert(parts.end(), {object.name, object.checksum, object.unit});
        const std::string key = ResultStore::key(parts);
        try {
            if (!object.checksum.empty())
                if (auto kept = store.find(object.name, key)) {
                    object_result.result = std::move(*kept);
                    object_result.resumed = true;
                }
            if (!object_result.resumed && !store.share().has(i)) {
                object_result.elsewhere = true;
            } else if (!object_result.resumed) {
                object_result.result = work(object);
                if (!object.checksum.empty()) store.keep(object.name, key, object_result.result);
            }
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::usage || error.kind() == ErrorKind::cancelled) throw;
            object_result.result.SetNull();
            object_result.problem = error.what();
        } catch (const std::bad_alloc&) {
            object_result.result.SetNull();
            object_result.problem = object.name + ": out of memory (use a smaller mesh or --threads 1)";
        }
        progress.advance();
    });
    return results;
}

}  // namespace ostraka

// What the workbench's page asks for and is answered, without any network (doc/workbench.md, "Messages").
#pragma once

#include "ostraka/semantic/live.h"
#include "ostraka/workbench/session.h"

#include <memory>
#include <mutex>

namespace ostraka {

class Workbench {
public:
    /// As Session. `memory_limit`: bytes that the process may occupy; 0: what the machine has.
    Workbench(Path folder, Path root, double memory_limit = 0);
    ~Workbench();

    struct Reply {
        std::string json;      ///< {"id", "ok": true, "result"} or {"id", "ok": false, "error": {"problem", "where", "remedy"}}
        std::string bytes;     ///< what the JSON's blobs refer to; empty: none
        bool changed = false;  ///< the session is at another step than before
    };
    /// Answers {"id": NUMBER, "do": WORD, ...}. Whatever the text holds, it is answered and nothing is thrown.
    Reply answer(std::string_view request);

    /// Told of progress: a phase and its share. Called by the thread that answers.
    std::function<void(const std::string& phase, double share)> on_progress;
    /// The request that is being answered ends with an error as soon as its work can stop. From any thread.
    void cancel();

    /// Reads the meshes of the session before they are asked for; what cannot be read is told when it is.
    void prepare();

    [[nodiscard]] const Session& session() const { return session_; }

private:
    struct Shape;
    struct Deformation;
    using Answer = void (Workbench::*)(const JsonValue& request, Json& result, std::string& bytes);
    static const std::map<std::string, Answer>& answers();

    [[nodiscard]] std::unique_ptr<Context> fresh_context();

    void hello(const JsonValue& request, Json& result, std::string& bytes);
    void scene(const JsonValue& request, Json& result, std::string& bytes);
    void select(const JsonValue& request, Json& result, std::string& bytes);
    void run(const JsonValue& request, Json& result, std::string& bytes);
    void handles(const JsonValue& request, Json& result, std::string& bytes);
    void parts(const JsonValue& request, Json& result, std::string& bytes);
    void reach(const JsonValue& request, Json& result, std::string& bytes);
    void influence(const JsonValue& request, Json& result, std::string& bytes);
    void grab(const JsonValue& request, Json& result, std::string& bytes);
    void drag(const JsonValue& request, Json& result, std::string& bytes);
    void file(const JsonValue& request, Json& result, std::string& bytes);

    [[nodiscard]] JsonValue words(JsonAllocator& allocator) const;
    void add_session(Json& result) const;
    std::shared_ptr<const Shape> shape_of(const SessionObject& object, bool deformed);
    [[nodiscard]] Path located(const std::string& file) const;
    std::shared_ptr<const MeshFile> mesh_of(const std::string& file);
    Deformation& deformation();

    Session session_;
    double memory_limit_;
    std::mutex mutex_;  ///< guards context_, which is replaced after a cancelled request
    std::unique_ptr<Context> context_;
    std::map<std::string, std::shared_ptr<const MeshFile>> meshes_;  ///< by file and what it was when it was read
    std::unique_ptr<Deformation> deformation_;
};

}  // namespace ostraka

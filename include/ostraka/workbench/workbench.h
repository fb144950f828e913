// Answers requests of the workbench's page, independently of the network (doc/workbench.md, "Messages").
#pragma once

#include "ostraka/io/mesh_file.h"
#include "ostraka/semantic/live.h"
#include "ostraka/workbench/session.h"
#include "ostraka/workbench/uploads.h"

#include <memory>
#include <mutex>

namespace ostraka {

/// Processes the requests of the page on one session.
class Workbench {
public:
    /// Opens the session; arguments as for Session. `memory_limit`: max memory of the process in bytes; 0: the memory of the
    /// machine.
    Workbench(Path folder, Path root, double memory_limit = 0);
    ~Workbench();

    /// Answer to a request.
    struct Reply {
        std::string json;      ///< {"id", "ok": true, "result"} or {"id", "ok": false, "error": {"problem", "where", "remedy"}}
        std::string bytes;     ///< binary data to which the JSON refers; may be empty
        bool changed = false;  ///< true: the session is at a different step than before
    };
    /// Answers a request {"id": NUMBER, "do": WORD, ...}. Never throws, even if the text is invalid.
    Reply answer(std::string_view request);

    /// Called with the progress of a request: phase, and share done (0 to 1). The answering thread calls this function.
    std::function<void(const std::string& phase, double share)> on_progress;
    /// Cancels the request in progress, which then ends with an error. May be called from any thread.
    void cancel();

    /// Reads the meshes of the session in advance; errors are reported only when a mesh is requested.
    void prepare();

    [[nodiscard]] const Session& session() const { return session_; }
    /// Files that the page sends; may be used from any thread.
    Uploads& uploads() { return uploads_; }

private:
    struct Shape;
    struct Deformation;
    /// Member function that answers a request by filling in `result` and `bytes`.
    using Answer = void (Workbench::*)(const JsonValue& request, Json& result, std::string& bytes);
    /// The functions that answer requests, by the word in "do".
    static const std::map<std::string, Answer>& answers();

    [[nodiscard]] std::unique_ptr<Context> fresh_context();  ///< context with the memory limit

    void hello(const JsonValue& request, Json& result, std::string& bytes);  ///< version, operations, and state of the session
    void scene(const JsonValue& request, Json& result, std::string& bytes);  ///< shapes and tables to show
    /// Content with the shape of a file that can be opened, for a thumbnail: {"name"}; without content if the file is large.
    void preview(const JsonValue& request, Json& result, std::string& bytes);
    void select(const JsonValue& request, Json& result, std::string& bytes);   ///< elements that a selection expression selects
    void run(const JsonValue& request, Json& result, std::string& bytes);      ///< runs an operation
    void handles(const JsonValue& request, Json& result, std::string& bytes);  ///< cage vertices that influence an annotation
    /// For each cage vertex, the annotations that it influences.
    void parts(const JsonValue& request, Json& result, std::string& bytes);
    void reach(const JsonValue& request, Json& result, std::string& bytes);  ///< constraints that the cage cannot satisfy
    /// Influence of cage vertices on each mesh vertex.
    void influence(const JsonValue& request, Json& result, std::string& bytes);
    void grab(const JsonValue& request, Json& result, std::string& bytes);  ///< starts a drag of cage vertices
    /// Surface for the current positions of the dragged vertices.
    void drag(const JsonValue& request, Json& result, std::string& bytes);
    void file(const JsonValue& request, Json& result, std::string& bytes);  ///< content of a file of the session
    /// Announces files that the page will send: {"files": [{"name", "size"}, ...]}.
    void upload(const JsonValue& request, Json& result, std::string& bytes);

    [[nodiscard]] JsonValue words(JsonAllocator& allocator) const;  ///< labels of the concepts of all vocabularies, by language
    void add_session(Json& result) const;                           ///< adds the state of the session to a result
    /// Mesh, annotations, graph and cage of an object.
    std::shared_ptr<const Shape> shape_of(const SessionObject& object, bool deformed);
    [[nodiscard]] Path located(const std::string& file) const;         ///< path of a file of the session
    std::shared_ptr<const MeshFile> mesh_of(const std::string& file);  ///< mesh read from a file, from the cache if unchanged
    Deformation& deformation();                                        ///< data for deforming the active object

    Session session_;
    Uploads uploads_;
    double memory_limit_;
    std::mutex mutex_;  ///< guards context_, which is replaced after a cancelled request
    std::unique_ptr<Context> context_;
    /// Cached meshes, by file name, size and modification time of the file.
    std::map<std::string, std::shared_ptr<const MeshFile>> meshes_;
    std::unique_ptr<Deformation> deformation_;
};

}  // namespace ostraka

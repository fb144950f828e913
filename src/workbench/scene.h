// The content of a session that the page shows: content as in page/page.h, with exact shapes.
#pragma once

#include "ostraka/page/page.h"
#include "ostraka/workbench/session.h"

#include <set>

namespace ostraka::workbench {

/// An object with the data that are shown with it.
struct ShownShape {
    std::string name, key;  ///< key: identifies the shape, so that it is sent only once
    const Mesh* mesh = nullptr;
    const MeshExtras* extras = nullptr;  ///< colours and texture
    const AnnotationSet* set = nullptr;
    const RelationGraph* graph = nullptr;
    const Mesh* cage = nullptr;
    /// Files of the session that describe the object: maps, slices, the report of its deformation.
    std::vector<Path> files;
    std::vector<PageMap> maps;  ///< maps in the mesh file of the object
};

/// Files written by the latest steps on the active object that can be shown with it; `deformed`: for its deformed state.
std::vector<Path> files_for(const Session& session, bool deformed);

/// Builds the content for a page that already has the shapes with the known keys.
class Scene {
public:
    explicit Scene(const std::vector<std::string>& known_keys) : known_keys_(known_keys.begin(), known_keys.end()) {}
    void add(const ShownShape& shape);  ///< adds an object to the content
    /// Adds the tables of the report of an operation; `file`: the report file.
    void add_report(const Path& file, const std::string& operation);
    /// The content; `provenance_text`: provenance.
    [[nodiscard]] Page::Content content(const std::string& provenance_text) const { return page_.content(provenance_text); }

private:
    std::set<std::string> known_keys_;  ///< keys of the shapes that the page already has
    Page page_{"Ostraka"};
};

}  // namespace ostraka::workbench
